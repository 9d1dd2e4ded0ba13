//! Piecewise polynomial motions in Bernstein form: what polynomial pieces, Bézier curves and B-splines become.
//!
//! On a piece of degree n over [t₀, t₁], with u = (t - t₀)/(t₁ - t₀) and Bernstein polynomials B,
//!
//! ```text
//! p(t) = Σ_j b_j B_{j,n}(u)        p'(t) = n/(t₁ - t₀) Σ_j (b_{j+1} - b_j) B_{j,n-1}(u)
//! ```
//!
//! Farin (2002), Curves and Surfaces for CAGD, chapters 5 and 8.

mod cubics;
mod spline;

pub use self::cubics::{CubicNode, CubicsError};
pub use self::spline::BSpline;

/// Relative rounding of double precision that sums and differences of one piece's coefficients may leave.
const ROUNDING: f64 = 64.0 * f64::EPSILON;

/// The planned motion of one vehicle as polynomial pieces, one after the other.
#[derive(Clone, Debug, PartialEq)]
pub struct Curve {
    /// Name of the vehicle.
    pub vehicle: String,
    /// The pieces, in the order of time, each beginning when the one before it ends.
    pub pieces: Vec<Piece>,
}

/// A polynomial over an interval of time, by its control points. World frame.
#[derive(Clone, Debug, PartialEq)]
pub struct Piece {
    /// Beginning and end, s.
    pub t_s: [f64; 2],
    /// Control points, m: one more than the degree, at least one.
    pub points_m: Vec<[f64; 3]>,
    /// What the digits of its numbers leave open.
    pub rounding: PieceRounding,
}

/// How far the ends of a piece may be from what was meant, because its numbers were written with a limited number of
/// digits.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct PieceRounding {
    /// Of a position, m.
    pub position_m: f64,
    /// Of a velocity, m/s.
    pub velocity_mps: f64,
}

/// The difference between the end of a piece and the beginning of the next one.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Joint {
    /// When, s.
    pub t_s: f64,
    /// Distance of the positions, m.
    pub position_m: f64,
    /// Difference of the velocities, m/s.
    pub velocity_mps: f64,
    /// Whether both are what rounding of the numbers may leave: the motion that was meant is continuous.
    pub is_rounding: bool,
}

impl Piece {
    /// The polynomial Σ_k c_k τ^k with τ = t - `begin_s`.
    ///
    /// ```text
    /// b_j = Σ_{k ≤ j} C(j, k)/C(n, k) c_k T^k                                         [Farin 2002, section 5.8]
    /// ```
    ///
    /// - `coefficients`: of x, y and z, in m/s^k; shorter ones are continued by 0
    /// - `rounding`: see [`PieceRounding`]
    pub fn from_power(begin_s: f64, duration_s: f64, coefficients: &[Vec<f64>; 3], rounding: PieceRounding) -> Self {
        let degree = coefficients.iter().map(Vec::len).max().unwrap_or(0).max(1) - 1;
        let point = |j: usize| {
            coefficients.each_ref().map(|c| {
                let term = |(k, value): (usize, &f64)| {
                    binomial(j, k) / binomial(degree, k) * value * duration_s.powi(k as i32)
                };
                c.iter().enumerate().take(j + 1).map(term).sum()
            })
        };
        let points_m = (0..=degree).map(point).collect();
        Self { t_s: [begin_s, begin_s + duration_s], points_m, rounding }
    }

    /// Its degree.
    pub fn degree(&self) -> usize {
        self.points_m.len() - 1
    }

    /// Its duration, s.
    pub fn duration_s(&self) -> f64 {
        self.t_s[1] - self.t_s[0]
    }

    /// Position, m, at the fraction `u` of the interval (de Casteljau).
    pub fn position_m(&self, u: f64) -> [f64; 3] {
        value(&self.points_m, u)
    }

    /// Velocity, m/s, at the fraction `u` of the interval.
    pub fn velocity_mps(&self, u: f64) -> [f64; 3] {
        value(&self.derivative(1), u)
    }

    /// Control points of the derivative of this order, in m/s^order.
    pub fn derivative(&self, order: usize) -> Vec<[f64; 3]> {
        let mut points = self.points_m.clone();
        for _ in 0..order {
            let factor = (points.len() - 1) as f64 / self.duration_s();
            let difference = |pair: &[[f64; 3]]| std::array::from_fn(|axis| factor * (pair[1][axis] - pair[0][axis]));
            points = if points.len() < 2 { vec![[0.0; 3]] } else { points.windows(2).map(difference).collect() };
        }
        points
    }

    /// Upper bound of the magnitude of the derivative of this order: that of its control points, whose hull it lies in.
    pub fn max_derivative(&self, order: usize) -> f64 {
        self.derivative(order).into_iter().map(norm).fold(0.0, f64::max)
    }
}

impl Curve {
    /// The end, s; 0 without pieces.
    pub fn end_s(&self) -> f64 {
        self.pieces.last().map_or(0.0, |piece| piece.t_s[1])
    }

    /// The highest degree.
    pub fn degree(&self) -> usize {
        self.pieces.iter().map(Piece::degree).max().unwrap_or(0)
    }

    /// Position at the beginning, m; `None` without pieces.
    pub fn first_position_m(&self) -> Option<[f64; 3]> {
        self.pieces.first().map(|piece| piece.points_m[0])
    }

    /// The joints between successive pieces.
    pub fn joints(&self) -> impl Iterator<Item = Joint> + '_ {
        self.pieces.windows(2).map(|pair| {
            let [before, after] = [&pair[0], &pair[1]];
            let (p, q) = (before.position_m(1.0), after.position_m(0.0));
            let (v, w) = (before.velocity_mps(1.0), after.velocity_mps(0.0));
            let (position_m, velocity_mps) = (distance(p, q), distance(v, w));
            let size_m =
                [before, after].into_iter().flat_map(|piece| &piece.points_m).map(|p| norm(*p)).fold(0.0, f64::max);
            let shortest_s = before.duration_s().min(after.duration_s());
            let numeric_mps = ROUNDING * size_m * self.degree() as f64 / shortest_s;
            let rounding_m = before.rounding.position_m + after.rounding.position_m + ROUNDING * size_m;
            let rounding_mps = before.rounding.velocity_mps + after.rounding.velocity_mps + numeric_mps;
            let is_rounding = position_m <= rounding_m && velocity_mps <= rounding_mps;
            Joint { t_s: before.t_s[1], position_m, velocity_mps, is_rounding }
        })
    }
}

/// The value at `u` of the polynomial with these Bernstein coefficients.
fn value(points: &[[f64; 3]], u: f64) -> [f64; 3] {
    let mut points = points.to_vec();
    for length in (1..points.len()).rev() {
        for i in 0..length {
            points[i] = std::array::from_fn(|axis| points[i][axis] + u * (points[i + 1][axis] - points[i][axis]));
        }
    }
    points[0]
}

fn binomial(n: usize, k: usize) -> f64 {
    (0..k).map(|i| (n as f64 - i as f64) / (i as f64 + 1.0)).product()
}

fn norm([x, y, z]: [f64; 3]) -> f64 {
    (x * x + y * y + z * z).sqrt()
}

fn distance(a: [f64; 3], b: [f64; 3]) -> f64 {
    norm(std::array::from_fn(|axis| a[axis] - b[axis]))
}

#[cfg(test)]
mod tests;
