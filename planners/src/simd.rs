//! Arithmetic on four double-precision lanes, one per subproblem or particle.
//!
//! Every operation acts on each lane independently and rounds according to IEEE 754, the fused multiply-add included:
//! results are bit-identical on every processor and do not depend on the other lanes. Processors without a fused
//! multiply-add (x86 before 2013) emulate it in software, slowly.

use std::ops::{Add, AddAssign, Mul, Neg, Sub, SubAssign};

use pulp::{Simd, f64x4};

/// Number of lanes.
pub const WIDTH: usize = 4;

/// An instruction set with vectors of four lanes. A value of such a type proves that the processor supports it.
pub trait Simd4: Simd<f64s = f64x4> {}

impl<S: Simd<f64s = f64x4>> Simd4 for S {}

/// Four lanes of `f64`.
#[derive(Clone, Copy, Debug)]
pub struct Lanes<S: Simd4> {
    values: f64x4,
    simd: S,
}

/// The result of a comparison in each lane.
#[derive(Clone, Copy, Debug)]
pub struct Mask<S: Simd4> {
    bits: S::m64s,
    simd: S,
}

impl<S: Simd4> Lanes<S> {
    /// The same number in every lane.
    #[inline(always)]
    pub fn splat(simd: S, value: f64) -> Self {
        Self { values: simd.splat_f64s(value), simd }
    }

    /// One number per lane.
    #[inline(always)]
    pub fn new(simd: S, [a, b, c, d]: [f64; WIDTH]) -> Self {
        Self { values: f64x4(a, b, c, d), simd }
    }

    /// The same number in every lane, with the instruction set of `self`.
    #[inline(always)]
    pub fn like(self, value: f64) -> Self {
        Self::splat(self.simd, value)
    }

    /// The lanes as an array.
    #[inline(always)]
    pub fn to_array(self) -> [f64; WIDTH] {
        let f64x4(a, b, c, d) = self.values;
        [a, b, c, d]
    }

    /// The value of one lane.
    pub fn lane(self, lane: usize) -> f64 {
        self.to_array()[lane]
    }

    /// Sets the value of one lane.
    pub fn set_lane(&mut self, lane: usize, value: f64) {
        let mut values = self.to_array();
        values[lane] = value;
        *self = Self::new(self.simd, values);
    }

    /// Square root.
    #[inline(always)]
    pub fn sqrt(self) -> Self {
        Self { values: self.simd.sqrt_f64s(self.values), ..self }
    }

    /// 1/x.
    #[inline(always)]
    pub fn recip(self) -> Self {
        self.like(1.0).over(self)
    }

    /// self/other.
    #[inline(always)]
    pub fn over(self, other: Self) -> Self {
        Self { values: self.simd.div_f64s(self.values, other.values), ..self }
    }

    /// self · a + b, rounded once.
    #[inline(always)]
    pub fn mul_add(self, a: Self, b: Self) -> Self {
        Self { values: self.simd.mul_add_f64s(self.values, a.values, b.values), ..self }
    }

    /// Absolute value.
    #[inline(always)]
    pub fn abs(self) -> Self {
        Self { values: self.simd.abs_f64s(self.values), ..self }
    }

    /// The larger; `other` where `self` is not a number.
    #[inline(always)]
    pub fn max(self, other: Self) -> Self {
        self.is_above(other).select(self, other)
    }

    /// The smaller; `other` where `self` is not a number.
    #[inline(always)]
    pub fn min(self, other: Self) -> Self {
        other.is_above(self).select(self, other)
    }

    /// self > other.
    #[inline(always)]
    pub fn is_above(self, other: Self) -> Mask<S> {
        Mask { bits: self.simd.greater_than_f64s(self.values, other.values), simd: self.simd }
    }
}

impl<S: Simd4> Mask<S> {
    /// `yes` in the lanes of the mask, `no` in the others.
    #[inline(always)]
    pub fn select(self, yes: Lanes<S>, no: Lanes<S>) -> Lanes<S> {
        Lanes { values: self.simd.select_f64s(self.bits, yes.values, no.values), simd: self.simd }
    }

    /// Is any lane set?
    #[inline(always)]
    pub fn any(self) -> bool {
        self.simd.first_true_m64s(self.bits) < WIDTH
    }
}

impl<S: Simd4> Add for Lanes<S> {
    type Output = Self;
    #[inline(always)]
    fn add(self, other: Self) -> Self {
        Self { values: self.simd.add_f64s(self.values, other.values), ..self }
    }
}

impl<S: Simd4> Sub for Lanes<S> {
    type Output = Self;
    #[inline(always)]
    fn sub(self, other: Self) -> Self {
        Self { values: self.simd.sub_f64s(self.values, other.values), ..self }
    }
}

impl<S: Simd4> Mul for Lanes<S> {
    type Output = Self;
    #[inline(always)]
    fn mul(self, other: Self) -> Self {
        Self { values: self.simd.mul_f64s(self.values, other.values), ..self }
    }
}

impl<S: Simd4> Neg for Lanes<S> {
    type Output = Self;
    #[inline(always)]
    fn neg(self) -> Self {
        Self { values: self.simd.neg_f64s(self.values), ..self }
    }
}

impl<S: Simd4> AddAssign for Lanes<S> {
    #[inline(always)]
    fn add_assign(&mut self, other: Self) {
        *self = *self + other;
    }
}

impl<S: Simd4> SubAssign for Lanes<S> {
    #[inline(always)]
    fn sub_assign(&mut self, other: Self) {
        *self = *self - other;
    }
}
