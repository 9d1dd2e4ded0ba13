//! Second-order forward-mode automatic differentiation: a value with its gradient and its Hessian.
//!
//! The equations are written once, in jets, and their derivatives are exact. The cost grows with N^2, so a function is
//! best split into factors of few variables each.

use std::ops::{Add, Mul, Neg, Sub};

/// Value, gradient and (full, symmetric) Hessian with respect to N variables.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Jet<const N: usize> {
    /// Value.
    pub value: f64,
    /// First derivatives.
    pub gradient: [f64; N],
    /// Second derivatives.
    pub hessian: [[f64; N]; N],
}

impl<const N: usize> Jet<N> {
    /// A constant.
    #[inline(always)]
    pub fn constant(value: f64) -> Self {
        Self { value, gradient: [0.0; N], hessian: [[0.0; N]; N] }
    }

    /// The variable of this index.
    #[inline(always)]
    pub fn variable(index: usize, value: f64) -> Self {
        let mut jet = Self::constant(value);
        jet.gradient[index] = 1.0;
        jet
    }

    /// All variables at once.
    #[inline(always)]
    pub fn variables(values: [f64; N]) -> [Self; N] {
        std::array::from_fn(|i| Self::variable(i, values[i]))
    }

    /// Adds `weight` times the Hessian to a row-major matrix of `width` columns; variable i has the index `at[i]`
    /// there. Only the first `count` variables take part.
    #[inline(always)]
    pub fn scatter(&self, matrix: &mut [f64], width: usize, at: [usize; N], count: usize, weight: f64) {
        for i in 0..count {
            for j in 0..count {
                matrix[at[i] * width + at[j]] += weight * self.hessian[i][j];
            }
        }
    }

    /// `f(self)` by the chain rule, given `f`, `f'` and `f''` at the value.
    #[inline(always)]
    fn chain(self, f: f64, df: f64, ddf: f64) -> Self {
        let mut image = Self::constant(f);
        for i in 0..N {
            image.gradient[i] = df * self.gradient[i];
            for j in 0..N {
                image.hessian[i][j] = df * self.hessian[i][j] + ddf * self.gradient[i] * self.gradient[j];
            }
        }
        image
    }

    /// Sine and cosine.
    #[inline(always)]
    pub fn sin_cos(self) -> (Self, Self) {
        let (sin, cos) = self.value.sin_cos();
        (self.chain(sin, cos, -sin), self.chain(cos, -sin, -cos))
    }

    /// Reciprocal.
    #[inline(always)]
    pub fn recip(self) -> Self {
        let r = 1.0 / self.value;
        self.chain(r, -r * r, 2.0 * r * r * r)
    }

    /// Absolute value; the derivatives at zero are those of positive values.
    #[inline(always)]
    pub fn abs(self) -> Self {
        self * self.value.signum()
    }

    /// Square root of a positive value.
    #[inline(always)]
    pub fn sqrt(self) -> Self {
        let root = self.value.sqrt();
        self.chain(root, 0.5 / root, -0.25 / (root * self.value))
    }

    /// Square.
    #[inline(always)]
    pub fn square(self) -> Self {
        self.chain(self.value * self.value, 2.0 * self.value, 2.0)
    }
}

impl<const N: usize> Add for Jet<N> {
    type Output = Self;
    #[inline(always)]
    fn add(mut self, other: Self) -> Self {
        self.value += other.value;
        for i in 0..N {
            self.gradient[i] += other.gradient[i];
            for j in 0..N {
                self.hessian[i][j] += other.hessian[i][j];
            }
        }
        self
    }
}

impl<const N: usize> Neg for Jet<N> {
    type Output = Self;
    #[inline(always)]
    fn neg(self) -> Self {
        self * -1.0
    }
}

impl<const N: usize> Sub for Jet<N> {
    type Output = Self;
    #[inline(always)]
    fn sub(self, other: Self) -> Self {
        self + other * -1.0
    }
}

impl<const N: usize> Mul<f64> for Jet<N> {
    type Output = Self;
    #[inline(always)]
    fn mul(self, factor: f64) -> Self {
        self.chain(factor * self.value, factor, 0.0)
    }
}

impl<const N: usize> Mul for Jet<N> {
    type Output = Self;
    #[inline(always)]
    fn mul(self, other: Self) -> Self {
        let mut product = Self::constant(self.value * other.value);
        for i in 0..N {
            product.gradient[i] = self.value * other.gradient[i] + other.value * self.gradient[i];
            for j in 0..N {
                product.hessian[i][j] = self.value * other.hessian[i][j]
                    + other.value * self.hessian[i][j]
                    + self.gradient[i] * other.gradient[j]
                    + other.gradient[i] * self.gradient[j];
            }
        }
        product
    }
}

#[cfg(test)]
mod tests {
    use super::Jet;

    /// `sin(x y)/(x + y^2) - 3 x` against central differences.
    #[test]
    fn derivatives_agree_with_differences() {
        let f = |x: f64, y: f64| {
            let [x, y] = Jet::<2>::variables([x, y]);
            (x * y).sin_cos().0 * (x + y.square()).recip() - x * 3.0
        };
        let (x, y, h) = (0.7, -1.3, 1e-5);
        let jet = f(x, y);
        let step = [[h, 0.0], [0.0, h]];
        for (i, [dx, dy]) in step.into_iter().enumerate() {
            let (ahead, behind) = (f(x + dx, y + dy), f(x - dx, y - dy));
            assert!((jet.gradient[i] - (ahead.value - behind.value) / (2.0 * h)).abs() < 1e-8);
            for j in 0..2 {
                let difference = (ahead.gradient[j] - behind.gradient[j]) / (2.0 * h);
                assert!((jet.hessian[i][j] - difference).abs() < 1e-8);
            }
        }
    }
}
