//! The subproblem P2 of one vehicle as an elastic program, in scaled deviations from the last trajectory:
//! w_k = ((s_k, u_k) - (sbar_k, ubar_k)) / units, θ = dt - dtbar.

use scenarios::Range;
use scenarios::fixed_wing::Limits;

use super::dynamics::{Control, State};
use super::iterate::Iterate;
use super::options::Options;
use super::scaling::{NODE_UNITS, scaled_rows, scaled_state};
use super::transcription;
use crate::convex::{DynamicsConstraint, FixedVariable, HalfspaceConstraint, Program, STAGE_LEN};

/// The data of one subproblem besides the last trajectory.
pub struct Context<'a> {
    /// Planner options.
    pub options: &'a Options,
    /// Penalty per unit of violation, s.
    pub penalty: f64,
    /// Initial and final state.
    pub boundary: [State; 2],
    /// Bounds of (s, u), one per node, SI.
    pub bounds: &'a [[Range; STAGE_LEN]],
    /// Half-widths of the trust region, in the units of the state.
    pub trust_region: State,
    /// Lower bound of dt, s (eq. 10).
    pub dt_bound_s: f64,
    /// Largest relative change of dt.
    pub dt_change: f64,
    /// Half-width of the trust region of the controls, as a fraction of their ranges.
    pub control_change: f64,
}

/// Half-width of the trust region of the controls that cannot bind.
pub const FREE_CONTROL_CHANGE: f64 = 4.0;

/// Bounds of (x, y, h, V, χ, γ, n_x, n_y, n_z) from the vehicle's planning limits and the map of its centre, SI. Heading is
/// free.
pub fn node_bounds(limits: &Limits, map: &scenarios::Map) -> [Range; STAGE_LEN] {
    let free = Range::new(f64::MIN, f64::MAX);
    let altitude = Range::new(limits.altitude_m.min.max(map.z_m.min), limits.altitude_m.max.min(map.z_m.max));
    let γ = limits.flight_path_deg.to_radians();
    [map.x_m, map.y_m, altitude, limits.speed_mps, free, γ, limits.n_x, limits.n_y, limits.n_z]
}

/// Assembles the subproblem about `last` with the given avoidance rows, in any order.
pub fn assemble(context: &Context, last: &Iterate, mut halfspaces: Vec<HalfspaceConstraint>) -> Program {
    halfspaces.sort_by_key(|halfspace| halfspace.stage);
    let mut program = Program {
        theta_cost: 1.0,
        offset: last.dt_s,
        penalty: context.penalty,
        row_units: context.options.row_units,
        dynamics: dynamics_constraints(context, last),
        fixed_variables: boundary_conditions(context, last),
        halfspaces,
        box_lower: Vec::new(),
        box_upper: Vec::new(),
        soft_lower: Vec::new(),
        soft_upper: Vec::new(),
    };
    for (node, bounds) in context.bounds.iter().enumerate() {
        append_node_bounds(context, bounds, &last.states[node], &last.controls[node], &mut program);
    }
    append_dt_bounds(context, last, &mut program);
    program
}

/// The trajectory of a solution of the subproblem.
pub fn updated(last: &Iterate, z: &[f64]) -> Iterate {
    let (nodes, _) = z.as_chunks::<STAGE_LEN>();
    let states = last.states.iter().zip(nodes).map(|(s, w)| State::from_fn(|i, _| s[i] + w[i] * NODE_UNITS[i]));
    let controls =
        last.controls.iter().zip(nodes).map(|(u, w)| Control::from_fn(|i, _| u[i] + w[6 + i] * NODE_UNITS[6 + i]));
    Iterate {
        states: states.collect(),
        controls: controls.collect(),
        dt_s: last.dt_s + z[z.len() - 1],
        ramp: last.ramp,
    }
}

/// Dynamics constraints: eq. 5, or multiple shooting.
fn dynamics_constraints(context: &Context, last: &Iterate) -> Vec<DynamicsConstraint> {
    let linearised =
        (0..last.intervals()).map(|k| transcription::linearise(context.options.transcription, &last.interval(k)));
    linearised
        .map(|defect| DynamicsConstraint {
            left: scaled_rows(&defect.by_node(0)),
            right: scaled_rows(&defect.by_node(1)),
            theta: scaled_state(&defect.by_dt),
            rhs: -scaled_state(&defect.value),
        })
        .collect()
}

/// `s[0] = s_0` and `s[K] = s_f`, eq. 6 and 7.
fn boundary_conditions(context: &Context, last: &Iterate) -> Vec<FixedVariable> {
    let ends = [(0, context.boundary[0]), (last.intervals(), context.boundary[1])];
    let conditions = ends.into_iter().flat_map(|(k, state)| {
        let value = scaled_state(&(state - last.states[k]));
        (0..6).map(move |i| FixedVariable { index: STAGE_LEN * k + i, value: value[i] })
    });
    conditions.collect()
}

/// Trust regions of state and control, and the bounds of eq. 8 and 9.
fn append_node_bounds(
    context: &Context,
    bounds: &[Range; STAGE_LEN],
    state: &State,
    control: &Control,
    program: &mut Program,
) {
    for i in 0..STAGE_LEN {
        let (value, bounds) = (if i < 6 { state[i] } else { control[i - 6] }, bounds[i]);
        let half = if i < 6 { context.trust_region[i] } else { context.control_change * bounds.width() };
        program.box_lower.push(-half / NODE_UNITS[i]);
        program.box_upper.push(half / NODE_UNITS[i]);
        // an elastic bound outside the trust region never binds: it is moved closer, to keep all numbers of similar
        // size
        program.soft_lower.push((bounds.min - value).max(-2.0 * half) / NODE_UNITS[i]);
        program.soft_upper.push((bounds.max - value).min(2.0 * half) / NODE_UNITS[i]);
    }
}

/// Trust region of dt, and eq. 10 as its elastic lower bound. The elastic upper bound lies outside the trust region and
/// never binds.
fn append_dt_bounds(context: &Context, last: &Iterate, program: &mut Program) {
    let half = context.dt_change * last.dt_s;
    program.box_lower.push(-half);
    program.box_upper.push(half);
    program.soft_lower.push(context.dt_bound_s - last.dt_s);
    program.soft_upper.push(2.0 * half);
}
