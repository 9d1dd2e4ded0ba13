//! The judge of multirotors, with plans made before the flight or in the loop.

mod clearance;
pub mod guard;
mod limits;
mod physics;
mod reference;
mod rest;

use std::ops::Deref;

use scenarios::in_loop::Node;
use scenarios::multirotor::Trajectory;
use scenarios::{CheckSpec, Family, Plan};

pub use clearance::{Clearances, ObstacleApproach, closest};

use crate::verdict::case::{Case, CheckTable, function_of};
use crate::verdict::evidence::{CheckResult, Decide, Evidence};
use crate::verdict::goal::EndError;
use crate::verdict::missing_evidence::MissingEvidence;
use crate::verdict::motion::{Knot, Motion};
use crate::verdict::separation_shape::SeparationShape;
use crate::verdict::{Check, Provenance, collision, flight_integrity, goal, in_loop_planner, separation};

/// Why a plan of positions and velocities has no defects.
const NO_DYNAMICS: &str = "positions and velocities determine the accelerations between them: see control_limits";
/// Why a plan is not rolled out in open loop.
const NO_ROLLOUT: &str = "without feedback a double integrator drifts, whatever its plan";

/// Every check of multirotors, in the order of a verdict.
pub fn checks(case: &Case<'_>) -> Vec<Check> {
    let fleet = FleetCase::new(case);
    case.checks(Family::Multirotor, |spec| Some(function_of(CHECKS, spec)?(spec, &fleet)))
}

/// A fleet's plan and flight, with the plan as a continuous motion.
struct FleetCase<'a> {
    shared: &'a Case<'a>,
    planned: Result<Vec<Motion>, MissingEvidence>,
    /// The planned motions, each hovering at its end until the last vehicle has arrived.
    hovering: Result<Vec<Motion>, MissingEvidence>,
    /// The flown motions, as far as a rounded plan is known; `None` if it was not rounded.
    flown_rounded: Option<Vec<Motion>>,
}

const CHECKS: &CheckTable<fn(&CheckSpec, &FleetCase<'_>) -> CheckResult> = &[
    ("nodes.separation", |spec, it| separation::check_nodes(spec, it.scenario, it.flyable(), SeparationShape::Spatial)),
    ("nodes.clearance", |spec, it| clearance::check_nodes(spec, it.scenario, it.planned()?)),
    ("nodes.state_limits", |spec, it| limits::check_node_states(spec, it.scenario, it.planned()?)),
    ("nodes.control_limits", |spec, it| limits::check_accelerations(spec, it.scenario, it.planned()?)),
    ("nodes.goal", |spec, it| goal::check_nodes(spec, it.scenario, it.flyable()?, |index, _| it.rounding(index))),
    ("plan.separation", |spec, it| separation::check(spec, it.scenario, it.hovering(), SeparationShape::Spatial)),
    ("plan.clearance", |spec, it| clearance::check(spec, it.scenario, it.hovering()?)),
    ("plan.state_limits", |spec, it| limits::check_planned_states(spec, it.scenario, it.planned()?)),
    ("plan.control_limits", |spec, it| limits::check_accelerations(spec, it.scenario, it.planned()?)),
    ("plan.dynamics", |spec, _| Ok(spec.skip(NO_DYNAMICS))),
    ("plan.rollout", |spec, _| Ok(spec.skip(NO_ROLLOUT))),
    ("plan.goal", |spec, it| goal::check_planned(spec, it.scenario, it.planned()?, |index, _| it.rounding(index))),
    ("plan.rest", |spec, it| rest::check_planned(spec, it.scenario, it.planned()?)),
    ("flight.complete", |spec, it| {
        Ok(flight_integrity::check_complete(spec, it.scenario, it.plan, it.flight()?, reference::defect))
    }),
    ("flight.crash", |spec, it| {
        let contact = || collision::deepest(it.scenario, it.shared.flown_motions().ok()?, clearance::entered_obstacle);
        Ok(flight_integrity::check_crash(spec, it.flight()?, it.mission_end_s(), contact))
    }),
    ("flight.planner", |spec, it| Ok(in_loop_planner::check(spec, it.scenario, it.flight()?))),
    ("flight.separation", |spec, it| {
        separation::check(spec, it.scenario, it.flown_motions(), SeparationShape::Spatial)
    }),
    ("flight.clearance", |spec, it| clearance::check(spec, it.scenario, it.flown_motions()?)),
    ("flight.state_limits", |spec, it| limits::check_flown_states(spec, it.scenario, it.flown()?)),
    ("flight.control_limits", |spec, it| limits::check_flown_controls(spec, it.scenario, it.flown()?)),
    ("flight.dynamics", |spec, it| physics::check(spec, it.scenario, it.flight()?)),
    ("flight.goal", |spec, it| goal::check_flown(spec, it.scenario, it.flown()?, |index| it.rounding(index))),
    ("flight.rest", |spec, it| rest::check_flown(spec, it.scenario, it.plan, it.flown()?)),
];

impl<'a> FleetCase<'a> {
    /// What is not known of the end of a vehicle because its rows were rounded.
    fn rounding(&self, vehicle: usize) -> EndError {
        EndError { position_m: self.provenance.rounding_m(vehicle), ..EndError::default() }
    }

    fn new(shared: &'a Case<'a>) -> Self {
        let plan = shared.flyable().map_err(MissingEvidence::from);
        let planned = plan.and_then(planned_motions).map(|motions| rounded(motions, shared.provenance));
        let hovering = planned.clone().map(until_all_have_arrived);
        let flown = shared.flown_motions().ok().filter(|_| shared.provenance.rounded.is_some());
        let flown_rounded = flown.map(|motions| rounded(motions.to_vec(), shared.provenance));
        Self { shared, planned, hovering, flown_rounded }
    }

    fn flown_motions(&self) -> Evidence<'_, [Motion]> {
        self.flown_rounded.as_deref().map_or_else(|| self.shared.flown_motions(), Ok)
    }

    fn hovering(&self) -> Evidence<'_, [Motion]> {
        self.hovering.as_deref()
    }

    fn planned(&self) -> Evidence<'_, [Motion]> {
        self.planned.as_deref()
    }
}

impl<'a> Deref for FleetCase<'a> {
    type Target = Case<'a>;

    fn deref(&self) -> &Case<'a> {
        self.shared
    }
}

/// The plan as continuous motions: the cubics between its nodes.
fn planned_motions(plan: &Plan) -> Result<Vec<Motion>, MissingEvidence> {
    let knot = |node: Node| Knot { t_s: node.t_s, position_m: node.position_m, velocity_mps: node.velocity_mps };
    let motion =
        |trajectory: &Trajectory| Motion::new(&trajectory.vehicle, trajectory.nodes().into_iter().map(knot).collect());
    plan.trajectories.iter().map(|trajectory| motion(trajectory.multirotor())).collect()
}

/// The motions, each in a tube as wide as its rows were rounded.
fn rounded(motions: Vec<Motion>, provenance: &Provenance) -> Vec<Motion> {
    let tube = |(index, motion): (usize, Motion)| match provenance.rounding_m(index) {
        0.0 => motion,
        rounding_m => motion.within(|_| rounding_m),
    };
    motions.into_iter().enumerate().map(tube).collect()
}

/// A vehicle that has arrived hovers there until the last one has.
fn until_all_have_arrived(motions: Vec<Motion>) -> Vec<Motion> {
    let end_s = motions.iter().map(Motion::end_s).fold(0.0, f64::max);
    motions.into_iter().map(|motion| motion.hovering_until(end_s)).collect()
}

#[cfg(test)]
mod tests {
    use scenarios::Family;

    use super::CHECKS;
    use crate::verdict::case::tests::assert_complete;

    #[test]
    fn every_check_has_one_function() {
        assert_complete(Family::Multirotor, CHECKS);
    }
}
