//! Interval arithmetic, and intervals with a bound of their slope.

use std::ops::{Add, Div, Mul, Neg, Sub};

/// Relative widening that covers the rounding of a few hundred operations.
const ROUNDING: f64 = 1e-12;

/// A closed interval of real numbers, possibly unbounded. What cannot be told is the whole line, never NaN.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Interval {
    /// Lower end.
    pub min: f64,
    /// Upper end.
    pub max: f64,
}

impl Interval {
    /// The whole line.
    pub const ALL: Self = Self { min: f64::NEG_INFINITY, max: f64::INFINITY };

    /// No number: it adds nothing to a union.
    pub const EMPTY: Self = Self { min: f64::INFINITY, max: f64::NEG_INFINITY };

    /// The interval between two ends; the whole line if one of them is NaN.
    pub fn new(min: f64, max: f64) -> Self {
        if min.is_nan() || max.is_nan() { Self::ALL } else { Self { min, max } }
    }

    /// A single number.
    pub fn point(value: f64) -> Self {
        Self::new(value, value)
    }

    /// All numbers whose magnitude is at most `radius`.
    pub fn within(radius: f64) -> Self {
        Self::new(-radius, radius)
    }

    /// The smallest interval around some numbers.
    pub fn hull(values: impl IntoIterator<Item = f64>) -> Self {
        let mut hull: Option<Self> = None;
        for value in values {
            let point = Self::point(value);
            hull = Some(hull.map_or(point, |hull| hull.union(point)));
        }
        hull.unwrap_or(Self::ALL)
    }

    /// The smallest interval around both.
    pub fn union(self, other: Self) -> Self {
        Self::new(self.min.min(other.min), self.max.max(other.max))
    }

    /// What both have in common. Two bounds of one number that miss each other do so by rounding.
    pub fn intersection(self, other: Self) -> Self {
        let (min, max) = (self.min.max(other.min), self.max.min(other.max));
        Self::new(min.min(max), max.max(min))
    }

    /// Every number of it, moved by up to `by`, and by what rounding may have done.
    pub fn widened(self, by: f64) -> Self {
        let finite = |end: f64| if end.is_finite() { end.abs() } else { 0.0 };
        let by = by + ROUNDING * (1.0 + finite(self.min).max(finite(self.max)));
        Self::new(self.min - by, self.max + by)
    }

    pub fn width(self) -> f64 {
        self.max - self.min
    }

    /// Largest magnitude.
    pub fn magnitude(self) -> f64 {
        self.min.abs().max(self.max.abs())
    }

    pub fn minimum(self, other: Self) -> Self {
        Self::new(self.min.min(other.min), self.max.min(other.max))
    }

    pub fn maximum(self, other: Self) -> Self {
        Self::new(self.min.max(other.min), self.max.max(other.max))
    }

    pub fn abs(self) -> Self {
        let magnitude = self.magnitude();
        if self.min <= 0.0 && self.max >= 0.0 {
            Self::new(0.0, magnitude)
        } else {
            Self::new(self.min.abs().min(self.max.abs()), magnitude)
        }
    }
}

impl Neg for Interval {
    type Output = Self;
    fn neg(self) -> Self {
        Self::new(-self.max, -self.min)
    }
}

impl Add for Interval {
    type Output = Self;
    fn add(self, other: Self) -> Self {
        Self::new(self.min + other.min, self.max + other.max)
    }
}

impl Sub for Interval {
    type Output = Self;
    fn sub(self, other: Self) -> Self {
        Self::new(self.min - other.max, self.max - other.min)
    }
}

impl Mul for Interval {
    type Output = Self;
    fn mul(self, other: Self) -> Self {
        let product = |a: f64, b: f64| if a == 0.0 || b == 0.0 { 0.0 } else { a * b };
        let corners = [(self.min, other.min), (self.min, other.max), (self.max, other.min), (self.max, other.max)];
        Self::hull(corners.map(|(a, b)| product(a, b)))
    }
}

impl Div for Interval {
    type Output = Self;
    fn div(self, other: Self) -> Self {
        if other.min <= 0.0 && other.max >= 0.0 {
            return Self::ALL;
        }
        self.mul(Self::new(1.0 / other.max, 1.0 / other.min))
    }
}

/// Euclidean norm of a vector of intervals.
pub fn norm(vector: &[Interval]) -> Interval {
    let sum = |end: fn(Interval) -> f64| vector.iter().map(|it| end(it.abs()).powi(2)).sum::<f64>().sqrt();
    Interval::new(sum(|it| it.min), sum(|it| it.max))
}

/// Scalar product of two vectors of intervals.
pub fn dot(a: &[Interval], b: &[Interval]) -> Interval {
    a.iter().zip(b).map(|(&a, &b)| a * b).fold(Interval::point(0.0), Add::add)
}

/// `atan2(y, x)` of y ≥ 0: rad, from 0 to π. It decreases with x, and grows with y where x is positive.
pub fn angle(y: Interval, x: Interval) -> Interval {
    let y = y.abs();
    let largest = if x.min >= 0.0 { y.max } else { y.min };
    let smallest = if x.max > 0.0 { y.min } else { y.max };
    Interval::new(smallest.atan2(x.max), largest.atan2(x.min))
}

/// A function of time over a cell: bounds of its value and of its slope, and how far the true function may be from it.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Jet {
    /// Bounds of the value.
    pub value: Interval,
    /// Bounds of the slope, 1/s.
    pub slope: Interval,
    /// Largest difference between this function and the true one.
    pub error: f64,
}

impl Jet {
    /// A constant.
    pub fn constant(value: f64) -> Self {
        Self { value: Interval::point(value), slope: Interval::point(0.0), error: 0.0 }
    }

    /// A function without a known slope.
    pub fn rough(value: Interval, error: f64) -> Self {
        Self { value, slope: Interval::ALL, error }
    }

    /// A function with values in `range` alone, whatever its error.
    pub fn inside(self, range: Interval) -> Self {
        let error = self.error.min(0.5 * range.width());
        let ends = Interval::new(range.min + error, range.max - error);
        Self { value: self.value.intersection(ends), error, ..self }
    }

    pub fn negate(self) -> Self {
        Self { value: -self.value, slope: -self.slope, error: self.error }
    }

    pub fn abs(self) -> Self {
        let slope = if self.value.min >= 0.0 {
            self.slope
        } else if self.value.max <= 0.0 {
            -self.slope
        } else {
            self.slope.union(-self.slope)
        };
        Self { value: self.value.abs(), slope, error: self.error }
    }

    pub fn plus(self, other: Self) -> Self {
        Self { value: self.value + other.value, slope: self.slope + other.slope, error: self.error + other.error }
    }

    pub fn times(self, other: Self) -> Self {
        let (a, b) = (self.value, other.value);
        let error = |error: f64, size: f64| if error == 0.0 { 0.0 } else { error * size };
        Self {
            value: a * b,
            slope: self.slope * b + a * other.slope,
            error: error(self.error, b.magnitude()) + error(other.error, a.magnitude() + self.error),
        }
    }

    /// 1 / f. Where f may be 0, nothing is known.
    pub fn reciprocal(self) -> Self {
        let true_value = self.value.widened(self.error);
        if true_value.min <= 0.0 && true_value.max >= 0.0 {
            return Self::rough(Interval::ALL, 0.0);
        }
        let smallest = true_value.abs().min;
        let one = Interval::point(1.0);
        Self {
            value: one / self.value,
            slope: -(self.slope / (self.value * self.value)),
            error: self.error / (smallest * smallest),
        }
    }

    pub fn minimum(self, other: Self) -> Self {
        let slope = if self.value.max <= other.value.min {
            self.slope
        } else if other.value.max <= self.value.min {
            other.slope
        } else {
            self.slope.union(other.slope)
        };
        Self { value: self.value.minimum(other.value), slope, error: self.error.max(other.error) }
    }

    pub fn maximum(self, other: Self) -> Self {
        self.negate().minimum(other.negate()).negate()
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_quotient_has_bounds_unless_its_divisor_may_be_zero() {
        let six_to_twelve = Interval::new(6.0, 12.0);
        assert_eq!(six_to_twelve / Interval::new(2.0, 3.0), Interval::new(2.0, 6.0));
        assert_eq!(six_to_twelve / Interval::new(-3.0, -2.0), Interval::new(-6.0, -2.0));
        for divisor in [Interval::new(-1.0, 1.0), Interval::new(0.0, 1.0), Interval::new(-1.0, 0.0)] {
            assert_eq!(six_to_twelve / divisor, Interval::ALL, "{divisor:?}");
        }
    }

    #[test]
    fn angles_are_largest_and_smallest_in_the_corners() {
        let bounds = |y: [f64; 2], x: [f64; 2]| {
            let angle = angle(Interval::new(y[0], y[1]), Interval::new(x[0], x[1]));
            [angle.min, angle.max].map(f64::to_degrees)
        };
        let is = |found: [f64; 2], expected: [f64; 2]| (0..2).all(|end| (found[end] - expected[end]).abs() < 1e-9);
        assert!(is(bounds([1.0, 2.0], [1.0, 2.0]), [0.5_f64.atan().to_degrees(), 2_f64.atan().to_degrees()]));
        assert!(is(bounds([1.0, 1.0], [-1.0, 1.0]), [45.0, 135.0]));
        let beyond = 180.0 - 0.5_f64.atan().to_degrees();
        assert!(is(bounds([1.0, 2.0], [-2.0, -1.0]), [180.0 - 2_f64.atan().to_degrees(), beyond]));
    }

    #[test]
    fn what_is_smaller_everywhere_gives_the_slope_of_a_minimum() {
        let jet = |value: [f64; 2], slope: f64| Jet {
            value: Interval::new(value[0], value[1]),
            slope: Interval::point(slope),
            error: 0.0,
        };
        let (low, high, across) = (jet([0.0, 1.0], 2.0), jet([3.0, 4.0], 5.0), jet([0.5, 3.5], 7.0));
        assert_eq!(low.minimum(high).slope, Interval::point(2.0));
        assert_eq!(high.minimum(low).slope, Interval::point(2.0));
        assert_eq!(high.maximum(low).slope, Interval::point(5.0));
        assert_eq!(low.minimum(across).slope, Interval::new(2.0, 7.0));
        assert_eq!(low.minimum(across).value, Interval::new(0.0, 1.0));
        let known_to = |error: f64| Jet { error, ..low };
        assert_eq!(known_to(0.5).minimum(known_to(0.25)).error.to_bits(), 0.5_f64.to_bits());
    }

    #[test]
    fn a_reciprocal_is_known_where_its_divisor_is_certainly_not_zero() {
        let jet = |min: f64, max: f64, error: f64| Jet { value: Interval::new(min, max), slope: Interval::ALL, error };
        let value = jet(2.0, 4.0, 0.0).reciprocal().value;
        assert!(value.min <= 0.25 && 0.5 <= value.max && value.width() < 0.25 + 1e-9, "{value:?}");
        let negative = jet(-4.0, -2.0, 0.0).reciprocal().value;
        assert!(negative.min <= -0.5 && -0.25 <= negative.max && negative.width() < 0.25 + 1e-9, "{negative:?}");
        for divisor in [jet(-1.0, 1.0, 0.0), jet(-2.0, -1.0, 1.5), jet(1.0, 2.0, 1.5)] {
            assert_eq!(divisor.reciprocal().value, Interval::ALL, "{:?} ± {}", divisor.value, divisor.error);
        }
    }
}
