//! Avoidance constraints at the nodes: obstacles (eq. 11) and other vehicles (eq. 12), linearised about the last
//! trajectory.
//!
//! ```text
//! n · C (s_i[k] - sbar_i[k]) >= r - |C (sbar_i[k] - p)|,      n = C (sbar_i[k] - p) / |C (sbar_i[k] - p)|
//! ```

use std::f64::consts::SQRT_2;

use super::iterate::Iterate;
use super::scaling::POSITION_M;
use crate::convex::HalfspaceConstraint;

/// A keep-out disc at every node: an obstacle, or another vehicle on its last trajectory.
pub struct KeepOut<'a> {
    /// Centre at node k, m.
    pub center_m: &'a dyn Fn(usize) -> [f64; 2],
    /// Radius r including the planner's margin, m.
    pub radius_m: f64,
    /// Normal n at the centre itself, where eq. 11 and 12 define none.
    pub tie_break: [f64; 2],
}

/// Appends the rows of one keep-out disc. Rows that cannot bind are omitted: within a trust region of half-width ρ in x
/// and in y a vehicle moves by at most sqrt(2) ρ.
pub fn append_halfspaces(
    trajectory: &Iterate,
    keep_out: &KeepOut,
    trust_region_m: f64,
    halfspaces: &mut Vec<HalfspaceConstraint>,
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
        halfspaces.push(HalfspaceConstraint { stage, current: [-normal[0], -normal[1]], next: [0.0; 2], bound });
    }
}
