//! Dynamics of the plan: its defects and its open-loop rollout.
//!
//! The planned controls are integrated with the simulator's nonlinear equations, never with the planner's model: once
//! restarted at every node, once open loop over the whole horizon.

use scenarios::{CheckSpec, Plan, Scenario};

use super::planned::PlannedMotions;
use crate::verdict::compare::is_larger;
use crate::verdict::evidence::{CheckResult, Decide, Measurement};
use crate::verdict::missing_evidence::MissingEvidence;
use crate::verdict::provenance::{NO_CONTROLS, Provenance};

/// Largest distance between the end of an interval and the next node: the larger of |Δp| and |Δv| times the interval's
/// duration, m.
pub fn check_defects(spec: &CheckSpec, scenario: &Scenario, plan: &Plan, planned: &PlannedMotions) -> CheckResult {
    let defects = plan.trajectories.iter().zip(&planned.ends).flat_map(|(trajectory, ends)| {
        let (nodes, times_s) = (trajectory.nodes(), trajectory.times_s());
        ends.iter().enumerate().map(move |(interval, end)| {
            let node = interval + 1;
            let t_s = times_s[node];
            let dt_s = t_s - times_s[interval];
            let position_m = distance(end.position_m, nodes.position_m(node));
            let velocity_m = distance(end.velocity_mps, nodes.velocity_mps(node)) * dt_s;
            let defect_m = if is_larger(velocity_m, position_m) { velocity_m } else { position_m };
            (defect_m, t_s, trajectory.vehicle())
        })
    });
    largest(spec, defects, scenario.limits().dynamics_m)
}

/// Largest distance between the last node and the end of the open-loop integration from the start, m. Reconstructed
/// controls say nothing open loop: it is skipped if no vehicle gives any.
pub fn check_rollout(
    spec: &CheckSpec,
    scenario: &Scenario,
    plan: &Plan,
    planned: &PlannedMotions,
    provenance: &Provenance,
) -> CheckResult {
    if (0..scenario.vehicles.len()).all(|index| !provenance.gives_controls(index)) {
        return Ok(spec.skip(format!("{NO_CONTROLS}, and reconstructed ones say nothing open loop")));
    }
    let ends = plan.trajectories.iter().zip(&planned.open_loop_ends).enumerate();
    let given = ends.filter(|(index, _)| provenance.gives_controls(*index));
    let errors = given.filter_map(|(_, (trajectory, end))| {
        let last = trajectory.times_s().len().checked_sub(1)?;
        Some((distance(end.position_m, trajectory.nodes().position_m(last)), end.t_s, trajectory.vehicle()))
    });
    largest(spec, errors, scenario.limits().rollout_m)
}

fn largest<'a>(spec: &CheckSpec, errors: impl Iterator<Item = (f64, f64, &'a str)>, limit_m: f64) -> CheckResult {
    let worst = errors.reduce(|worst, error| if is_larger(error.0, worst.0) { error } else { worst });
    let (error_m, t_s, vehicle) = worst.ok_or(MissingEvidence::NoInterval)?;
    Ok(spec.at_most(Measurement::value(error_m).at(t_s).with(vehicle), limit_m))
}

fn distance(a: [f64; 3], b: [f64; 3]) -> f64 {
    (0..3).map(|axis| (a[axis] - b[axis]).powi(2)).sum::<f64>().sqrt()
}
