//! A curve as cubics with certified errors, for vehicles whose motion is given as cubics between nodes.
//!
//! The cubic Hermite interpolant h of p over an interval of length T satisfies, for M = max|p''''|,
//!
//! ```text
//! |p - h| ≤ T⁴ M/384        |p' - h'| ≤ √3 T³ M/216        |p'' - h''| ≤ T² M/12
//! ```
//!
//! Birkhoff, Priver (1967), Hermite interpolation errors for derivatives, J. Math. Phys. 46. The constants are best
//! possible. M is bounded by the control points of p''''. A cubic is its own interpolant.

use super::{Curve, Piece};

/// Largest number of cubics for one piece; beyond it the errors stay larger than asked for.
const MAX_CUBICS: f64 = 4000.0;

/// Position and velocity at one instant.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct CubicNode {
    /// Time, s.
    pub t_s: f64,
    /// Position, m.
    pub position_m: [f64; 3],
    /// Velocity, m/s.
    pub velocity_mps: [f64; 3],
}

/// Upper bounds of the differences between a curve and its cubics.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct CubicsError {
    /// Of the position, m, what rounding of the curve's numbers leaves open included.
    pub position_m: f64,
    /// Of the velocity, m/s, likewise.
    pub velocity_mps: f64,
    /// Of the acceleration, m/s².
    pub acceleration_mps2: f64,
}

impl Curve {
    /// Nodes between which the cubics with their positions and velocities are the curve, up to the errors returned.
    ///
    /// Where two pieces meet up to the [rounding](super::PieceRounding) of their numbers there is one node; otherwise there
    /// are two at the same time, on either side of the jump.
    ///
    /// - `acceleration_error_mps2`: the error of the acceleration to aim at, > 0
    pub fn cubics(&self, acceleration_error_mps2: f64) -> (Vec<CubicNode>, CubicsError) {
        let continues: Vec<bool> = self.joints().map(|joint| joint.is_rounding).collect();
        let mut nodes: Vec<CubicNode> = Vec::new();
        let mut error = CubicsError::default();
        for (index, given) in self.pieces.iter().enumerate() {
            let before = index.checked_sub(1).filter(|joint| continues[*joint]).map(|joint| &self.pieces[joint]);
            let after = self.pieces.get(index + 1).filter(|_| continues[index]);
            let (piece, moved) = given.joined(before, after);
            let parts = piece.part_count(acceleration_error_mps2);
            error = error.larger(piece.error(parts).plus(moved));
            let first = usize::from(before.is_some());
            nodes.extend((first..=parts).map(|part| piece.node(part as f64 / parts as f64)));
        }
        (nodes, error)
    }
}

impl Piece {
    /// The piece with its ends moved to the middle between them and those of its neighbours, and how far that moves it.
    ///
    /// Position and velocity at an end depend on two control points each, which are different ones from degree 3 on. The
    /// difference is a polynomial, too, whose derivatives are bounded by its control points.
    fn joined(&self, before: Option<&Self>, after: Option<&Self>) -> (Self, CubicsError) {
        let mut piece = self.clone();
        if before.is_none() && after.is_none() {
            return (piece, CubicsError::default());
        }
        while piece.degree() < 3 {
            piece.points_m = elevated(&piece.points_m);
        }
        let mut moved = Self { points_m: vec![[0.0; 3]; piece.points_m.len()], ..piece.clone() };
        let (last, nth_s) = (piece.degree(), piece.duration_s() / piece.degree() as f64);
        let half =
            |from: [f64; 3], to: [f64; 3]| -> [f64; 3] { std::array::from_fn(|axis| (to[axis] - from[axis]) / 2.0) };
        if let Some(before) = before {
            let by_m = half(self.position_m(0.0), before.position_m(1.0));
            let by_mps = half(self.velocity_mps(0.0), before.velocity_mps(1.0));
            moved.points_m[0] = by_m;
            moved.points_m[1] = std::array::from_fn(|axis| by_m[axis] + nth_s * by_mps[axis]);
        }
        if let Some(after) = after {
            let by_m = half(self.position_m(1.0), after.position_m(0.0));
            let by_mps = half(self.velocity_mps(1.0), after.velocity_mps(0.0));
            moved.points_m[last] = by_m;
            moved.points_m[last - 1] = std::array::from_fn(|axis| by_m[axis] - nth_s * by_mps[axis]);
        }
        for (point, by) in piece.points_m.iter_mut().zip(&moved.points_m) {
            *point = std::array::from_fn(|axis| point[axis] + by[axis]);
        }
        let [position_m, velocity_mps, acceleration_mps2] = [0, 1, 2].map(|order| moved.max_derivative(order));
        (piece, CubicsError { position_m, velocity_mps, acceleration_mps2 })
    }

    /// Number of cubics of equal duration that represent it with this error of the acceleration.
    fn part_count(&self, acceleration_error_mps2: f64) -> usize {
        let fourth = self.max_derivative(4);
        let parts = self.duration_s() * (fourth / (12.0 * acceleration_error_mps2)).sqrt();
        parts.ceil().clamp(1.0, MAX_CUBICS) as usize
    }

    /// The errors with this number of cubics, and what rounding of the piece's numbers leaves open.
    fn error(&self, parts: usize) -> CubicsError {
        let fourth = self.max_derivative(4);
        let h = self.duration_s() / parts as f64;
        CubicsError {
            position_m: h.powi(4) * fourth / 384.0 + self.rounding.position_m,
            velocity_mps: 3.0_f64.sqrt() * h.powi(3) * fourth / 216.0 + self.rounding.velocity_mps,
            acceleration_mps2: h * h * fourth / 12.0,
        }
    }

    fn node(&self, u: f64) -> CubicNode {
        let [begin_s, end_s] = self.t_s;
        let t_s = if u == 1.0 { end_s } else { begin_s + u * (end_s - begin_s) };
        CubicNode { t_s, position_m: self.position_m(u), velocity_mps: self.velocity_mps(u) }
    }
}

/// The control points of the same polynomial as one of the next higher degree.
///
/// ```text
/// b_j' = j/(n + 1) b_{j-1} + (1 - j/(n + 1)) b_j                                       [Farin 2002, section 6.1]
/// ```
fn elevated(points_m: &[[f64; 3]]) -> Vec<[f64; 3]> {
    let count = points_m.len();
    let point = |j: usize| {
        let share = j as f64 / count as f64;
        let [low, high] = [points_m[j.max(1) - 1], points_m[j.min(count - 1)]];
        std::array::from_fn(|axis| share * low[axis] + (1.0 - share) * high[axis])
    };
    (0..=count).map(point).collect()
}

impl CubicsError {
    /// The sum.
    fn plus(self, other: Self) -> Self {
        Self {
            position_m: self.position_m + other.position_m,
            velocity_mps: self.velocity_mps + other.velocity_mps,
            acceleration_mps2: self.acceleration_mps2 + other.acceleration_mps2,
        }
    }

    /// The larger of the two, one by one.
    pub fn larger(self, other: Self) -> Self {
        Self {
            position_m: self.position_m.max(other.position_m),
            velocity_mps: self.velocity_mps.max(other.velocity_mps),
            acceleration_mps2: self.acceleration_mps2.max(other.acceleration_mps2),
        }
    }
}
