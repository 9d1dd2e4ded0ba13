//! One rule for being at a limit, for every check, family and direction: a value counts as on the good side up to
//!
//! | checks | in metres | in other units |
//! |---|---|---|
//! | `nodes.*` | 1e-5 m | 1e-6 of the limit's range |
//! | `plan.*`, `flight.*` | 1e-9 of the limit, at least 1e-9 m | 1e-9 of the limit, at least 1e-9 |
//!
//! beyond the limit. At the nodes this is what a solver leaves, elsewhere what rounding leaves. A plan that is optimal lies
//! on its limits, and rounding must not decide on which side of them.

use scenarios::{CheckSpec, Group};

/// Of a value of order 1: what rounding leaves.
pub const ROUNDING_TOLERANCE: f64 = 1e-9;
/// How far a node may be outside a planning limit, as a fraction of the limit's range.
pub const SOLVER_TOLERANCE: f64 = 1e-6;
/// How far a distance at the nodes may be beyond its limit, m.
const SOLVER_TOLERANCE_M: f64 = 1e-5;

/// How far the value of a check may be beyond its limit, in the unit of the check. Ranges at the nodes are widened by
/// [`SOLVER_TOLERANCE`] where they are compared, so that the report shows it.
pub fn limit_tolerance(spec: &CheckSpec, limit: f64) -> f64 {
    let rounding = ROUNDING_TOLERANCE * limit.abs().max(1.0);
    match spec.group {
        Group::Nodes if spec.unit == "m" => rounding.max(SOLVER_TOLERANCE_M),
        Group::Nodes | Group::Plan | Group::Flight => rounding,
    }
}
