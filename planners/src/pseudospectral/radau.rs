//! Legendre-Gauss-Radau points on [-1, 1): quadrature weights, differentiation and integration matrices, interpolation.

use nalgebra::{DMatrix, DVector};

/// The rule of order N: N collocation points and, as point N (counting from 0), the segment's end +1, which is not
/// collocated.
#[derive(Clone, Debug)]
pub struct Radau {
    /// The N collocation points in increasing order, the first of which is -1; then the end +1. Length N + 1.
    pub points: Vec<f64>,
    /// Quadrature weights of the N points, exact to degree 2 N - 2; their sum is 2. Length N.
    pub weights: DVector<f64>,
    /// D, N x (N + 1): maps values at the N + 1 points to derivatives at the N points.
    pub differentiation: DMatrix<f64>,
    /// Ã, N x N, the inverse of D without its first column: row i maps values at the N points to the integral from -1
    /// to point i + 1.
    pub integration: DMatrix<f64>,
    barycentric_states: Vec<f64>,
    barycentric_controls: Vec<f64>,
}

impl Radau {
    /// The rule of order `n`.
    ///
    /// # Panics
    ///
    /// Panics if `n` is 0.
    ///
    /// # Examples
    ///
    /// ```
    /// use planners::pseudospectral::Radau;
    ///
    /// let rule = Radau::new(3);
    /// let integral: f64 = (0..3).map(|k| rule.weights[k] * rule.points[k].powi(4)).sum();
    /// assert!((integral - 2.0 / 5.0).abs() < 1e-14);
    /// ```
    pub fn new(n: usize) -> Self {
        assert!(n >= 1, "a segment has at least one collocation point");
        let mut points = collocation_points(n);
        let barycentric_controls = barycentric_weights(&points);
        let weights = DVector::from_iterator(n, points.iter().map(|&τ| weight(n, τ)));
        points.push(1.0);
        let barycentric_states = barycentric_weights(&points);
        let differentiation = differentiation(&points, &barycentric_states);
        let integration = differentiation.columns(1, n).into_owned().try_inverse().expect("the matrix is regular");
        Self { points, weights, differentiation, integration, barycentric_states, barycentric_controls }
    }

    /// Number N of collocation points.
    pub fn order(&self) -> usize {
        self.weights.len()
    }

    /// Values at τ of the N + 1 Lagrange polynomials of the states.
    pub fn state_basis(&self, τ: f64) -> Vec<f64> {
        basis(&self.points, &self.barycentric_states, τ)
    }

    /// Values at τ of the N Lagrange polynomials of the controls.
    pub fn control_basis(&self, τ: f64) -> Vec<f64> {
        basis(&self.points[..self.order()], &self.barycentric_controls, τ)
    }
}

/// The Legendre polynomial P_n and its derivative, by the three-term recurrence.
fn legendre(n: usize, τ: f64) -> (f64, f64) {
    let (mut before, mut value, mut slope_before, mut slope) = (0.0, 1.0, 0.0, 0.0);
    for k in 0..n {
        let k = k as f64;
        let next = ((2.0 * k + 1.0) * τ * value - k * before) / (k + 1.0);
        let slope_next = slope_before + (2.0 * k + 1.0) * value;
        (before, value, slope_before, slope) = (value, next, slope, slope_next);
    }
    (value, slope)
}

/// Roots of P_{n-1} + P_n, by Newton's method with deflation of the roots already found.
fn collocation_points(n: usize) -> Vec<f64> {
    let mut points = vec![-1.0];
    for k in 1..n {
        // the Chebyshev-Gauss-Radau point is the initial guess
        let mut τ = -(2.0 * std::f64::consts::PI * k as f64 / (2 * n - 1) as f64).cos();
        for _ in 0..50 {
            let ((p, dp), (q, dq)) = (legendre(n - 1, τ), legendre(n, τ));
            let deflation: f64 = points.iter().map(|root| 1.0 / (τ - root)).sum();
            let step = (p + q) / (dp + dq - (p + q) * deflation);
            τ -= step;
            if step.abs() < 1e-15 {
                break;
            }
        }
        points.push(τ);
    }
    points
}

/// Quadrature weight `w = (1 - τ)/(N P_{N-1}(τ))^2`.
fn weight(n: usize, τ: f64) -> f64 {
    let (p, _) = legendre(n - 1, τ);
    (1.0 - τ) / (n as f64 * p).powi(2)
}

fn barycentric_weights(points: &[f64]) -> Vec<f64> {
    let weight = |i: usize| (0..points.len()).filter(|&j| j != i).map(|j| 1.0 / (points[i] - points[j])).product();
    (0..points.len()).map(weight).collect()
}

/// D from barycentric weights. The diagonal is the negative sum of the other entries, so that constants have derivative
/// zero.
fn differentiation(points: &[f64], barycentric: &[f64]) -> DMatrix<f64> {
    let n = points.len() - 1;
    let mut matrix = DMatrix::zeros(n, n + 1);
    for k in 0..n {
        for i in (0..=n).filter(|&i| i != k) {
            matrix[(k, i)] = barycentric[i] / barycentric[k] / (points[k] - points[i]);
            matrix[(k, k)] -= matrix[(k, i)];
        }
    }
    matrix
}

/// Values at τ of the Lagrange polynomials of `points`, by the barycentric formula.
fn basis(points: &[f64], barycentric: &[f64], τ: f64) -> Vec<f64> {
    if let Some(hit) = points.iter().position(|&point| point == τ) {
        return (0..points.len()).map(|i| f64::from(u8::from(i == hit))).collect();
    }
    let terms: Vec<f64> = points.iter().zip(barycentric).map(|(point, weight)| weight / (τ - point)).collect();
    let sum: f64 = terms.iter().sum();
    terms.into_iter().map(|term| term / sum).collect()
}

#[cfg(test)]
mod tests {
    use super::Radau;

    #[test]
    fn quadrature_is_exact_to_degree_2n_minus_2() {
        for n in 1..=12 {
            let rule = Radau::new(n);
            for degree in 0..=2 * n - 2 {
                let sum: f64 = (0..n).map(|k| rule.weights[k] * rule.points[k].powi(degree as i32)).sum();
                let exact = if degree % 2 == 0 { 2.0 / (degree + 1) as f64 } else { 0.0 };
                assert!((sum - exact).abs() < 1e-13, "order {n}, degree {degree}: {sum} for {exact}");
            }
        }
    }

    #[test]
    fn derivatives_and_integrals_of_polynomials_are_exact() {
        for n in 1..=10 {
            let rule = Radau::new(n);
            for degree in 0..=n as i32 {
                for k in 0..n {
                    let slope: f64 = (0..=n).map(|i| rule.differentiation[(k, i)] * rule.points[i].powi(degree)).sum();
                    let exact = if degree == 0 { 0.0 } else { f64::from(degree) * rule.points[k].powi(degree - 1) };
                    assert!((slope - exact).abs() < 1e-11, "order {n}, degree {degree}");
                }
            }
            for (i, degree) in (0..n).flat_map(|i| (0..n as i32).map(move |degree| (i, degree))) {
                let sum: f64 = (0..n).map(|j| rule.integration[(i, j)] * rule.points[j].powi(degree)).sum();
                let to = rule.points[i + 1].powi(degree + 1) - (-1.0_f64).powi(degree + 1);
                assert!((sum - to / f64::from(degree + 1)).abs() < 1e-12, "order {n}, degree {degree}");
            }
        }
    }

    #[test]
    fn points_of_order_three_are_exact() {
        let rule = Radau::new(3);
        let known = [-1.0, (1.0 - 6.0_f64.sqrt()) / 5.0, (1.0 + 6.0_f64.sqrt()) / 5.0];
        assert!(rule.points.iter().zip(known).all(|(a, b)| (a - b).abs() < 1e-14));
    }

    #[test]
    fn interpolation_reproduces_polynomials() {
        let rule = Radau::new(5);
        let value = |τ: f64| 1.0 + τ * (2.0 - τ * (0.5 + τ * τ * 3.0));
        for τ in [-1.0, -0.3, 0.0, 0.77, 1.0] {
            let sum: f64 = rule.state_basis(τ).iter().zip(&rule.points).map(|(b, &p)| b * value(p)).sum();
            assert!((sum - value(τ)).abs() < 1e-12);
            let controls: f64 = rule.control_basis(τ).iter().zip(&rule.points).map(|(b, &p)| b * (p * p - 1.0)).sum();
            assert!((controls - (τ * τ - 1.0)).abs() < 1e-12);
        }
    }
}
