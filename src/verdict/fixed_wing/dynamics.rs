//! Dynamics of the plan: its defects and its open-loop rollout.
//!
//! The planned controls are integrated with the simulator's nonlinear equations, never with the planner's model: once
//! restarted at every node, once open loop over the whole horizon.

use scenarios::{CheckSpec, Plan, Scenario};

use super::between_rows::contradiction;
use super::planned::{NodeError, PlannedMotions};
use crate::verdict::compare::is_larger;
use crate::verdict::evidence::{CheckResult, Decide, Measurement};
use crate::verdict::missing_evidence::MissingEvidence;
use crate::verdict::provenance::{GivenRows, NO_CONTROLS, Provenance};

/// Largest distance between a node and the end of the motion that begins at an earlier one, over one interval or a window of
/// at least 1 s: the larger of |Δp| and |Δv| times the duration, m. Of a plan that gives no controls also the
/// [contradiction] between its positions and velocities.
pub fn check_defects(
    spec: &CheckSpec,
    scenario: &Scenario,
    plan: &Plan,
    planned: &PlannedMotions,
    provenance: &Provenance,
) -> CheckResult {
    let defects = planned.defects.iter().zip(&plan.trajectories).enumerate().map(|(index, (defect, trajectory))| {
        let GivenRows::States(velocities_mps) = provenance.given(index) else { return *defect };
        let limits = &scenario.fixed_wing_model(&scenario.vehicles[index]).limits;
        contradiction(trajectory.fixed_wing(), velocities_mps, limits).map_or(*defect, |other| defect.larger(other))
    });
    largest(spec, scenario, defects.enumerate(), scenario.limits().dynamics_m)
}

/// Largest distance between a node and the open-loop integration from the start, m. Reconstructed controls say nothing open
/// loop: it is skipped if no vehicle gives any.
pub fn check_rollout(
    spec: &CheckSpec,
    scenario: &Scenario,
    planned: &PlannedMotions,
    provenance: &Provenance,
) -> CheckResult {
    if (0..scenario.vehicles.len()).all(|index| !provenance.gives_controls(index)) {
        return Ok(spec.skip(format!("{NO_CONTROLS}, and reconstructed ones say nothing open loop")));
    }
    let all = planned.open_loop_errors.iter().copied().enumerate();
    largest(spec, scenario, all.filter(|(index, _)| provenance.gives_controls(*index)), scenario.limits().rollout_m)
}

/// - `errors`: of vehicles, with their indices
fn largest(
    spec: &CheckSpec,
    scenario: &Scenario,
    errors: impl Iterator<Item = (usize, NodeError)>,
    limit_m: f64,
) -> CheckResult {
    let worst = errors.reduce(|worst, error| if is_larger(error.1.error_m, worst.1.error_m) { error } else { worst });
    let (index, NodeError { error_m, t_s }) = worst.ok_or(MissingEvidence::NoInterval)?;
    Ok(spec.at_most(Measurement::value(error_m).at(t_s).with(&scenario.vehicles[index].name), limit_m))
}
