//! Avoidance rows: obstacles (eq. 11) and other vehicles (eq. 12), linearised about the last trajectory.
//!
//! ```text
//! n · C (s_i[k] - sbar_i[k]) >= r - |C (sbar_i[k] - p)|,      n = C (sbar_i[k] - p) / |C (sbar_i[k] - p)|
//! ```

use std::f64::consts::SQRT_2;

use super::iterate::Iterate;
use super::scaling::POSITION_M;
use crate::convex::HalfspaceConstraint;

/// A disc to stay out of, per node: an obstacle, or another vehicle where it last was.
pub struct KeepOut<'a> {
    /// Centre at node k, m.
    pub center_m: &'a dyn Fn(usize) -> [f64; 2],
    /// Radius r with the planner's margin, m.
    pub radius_m: f64,
    /// Direction n where the centre is met exactly, and eq. 11, 12 have none.
    pub tie_break: [f64; 2],
}

/// Appends the rows of one keep-out disc. Left out are those that cannot bind: inside a trust region of half-width ρ in
/// x and in y nobody moves farther than sqrt(2) ρ.
pub fn append_planes(
    trajectory: &Iterate,
    keep_out: &KeepOut,
    trust_region_m: f64,
    planes: &mut Vec<HalfspaceConstraint>,
) {
    for stage in 0..=trajectory.intervals() {
        let (at, center) = (trajectory.position_m(stage), (keep_out.center_m)(stage));
        let away = [at[0] - center[0], at[1] - center[1]];
        let distance_m = away[0].hypot(away[1]);
        if distance_m >= keep_out.radius_m + SQRT_2 * trust_region_m {
            continue;
        }
        let normal = if distance_m > 0.0 { away.map(|a| a / distance_m) } else { keep_out.tie_break };
        let bound = (distance_m - keep_out.radius_m) / POSITION_M;
        planes.push(HalfspaceConstraint { stage, current: [-normal[0], -normal[1]], next: [0.0; 2], bound });
    }
}
