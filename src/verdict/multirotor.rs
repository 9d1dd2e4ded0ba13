//! The judge of multirotors, with plans made before the flight or in the loop.

mod between_nodes;
mod clearance;
mod cubic;
pub mod guard;
mod limits;
mod physics;
mod recorded;
mod reference;
mod rest;

use std::ops::Deref;

use scenarios::in_loop::Node;
use scenarios::multirotor::Trajectory;
use scenarios::{CheckSpec, Family, Plan};

use between_nodes::BetweenNodes;
pub use recorded::checks as recorded_checks;

pub use clearance::{Clearances, ObstacleApproach, closest};

use crate::verdict::case::{Case, CheckTable, function_of};
use crate::verdict::evidence::{CheckResult, Decide, Evidence};
use crate::verdict::missing_evidence::MissingEvidence;
use crate::verdict::motion::{Knot, Motion, Segment};
use crate::verdict::tube::{EndError, Stretch, Tube};
use crate::verdict::{Check, collision, flight_integrity, goal, in_loop_planner, requirements, separation};

/// Why a plan of positions and velocities has no defects.
const NO_DYNAMICS: &str = "positions and velocities determine the accelerations between them: see control_limits";
/// Why no accelerations are checked at the nodes of plans of positions.
const NO_NODE_ACCELERATIONS: &str = "the plan gives no velocities: see plan.control_limits";
/// Why a plan is not rolled out in open loop.
const NO_ROLLOUT: &str = "without feedback a double integrator drifts, whatever its plan";

/// Every check of multirotors, in the order of a verdict.
pub fn checks(case: &Case<'_>) -> Vec<Check> {
    let fleet = FleetCase::new(case);
    let mut checks = case.checks(Family::Multirotor, |spec| Some(function_of(CHECKS, spec)?(spec, &fleet)));
    requirements::insert(&mut checks, case, fleet.hovering(), fleet.flown_motions());
    checks
}

/// A fleet's plan and flight, with the plan as a continuous motion.
struct FleetCase<'a> {
    shared: &'a Case<'a>,
    planned: Result<Vec<Motion>, MissingEvidence>,
    /// The planned motions, each hovering at its end until the last vehicle has arrived.
    hovering: Result<Vec<Motion>, MissingEvidence>,
    /// The flown motions, as far as the plan is known between its nodes; `None` if it is known exactly.
    flown_in_tubes: Option<Vec<Motion>>,
    /// Vehicle by vehicle, how well the plan is known between its nodes.
    between: Vec<BetweenNodes>,
}

const CHECKS: &CheckTable<fn(&CheckSpec, &FleetCase<'_>) -> CheckResult> = &[
    ("nodes.separation", |spec, it| separation::check_nodes(spec, it.scenario, it.flyable())),
    ("nodes.clearance", |spec, it| clearance::check_nodes(spec, it.scenario, it.planned()?)),
    ("nodes.state_limits", |spec, it| limits::check_node_states(spec, it.scenario, it.planned()?, &it.between)),
    ("nodes.control_limits", |spec, it| match it.between.iter().any(BetweenNodes::gives_velocities) {
        true => limits::check_accelerations(spec, it.scenario, it.planned()?, &it.between),
        false => Ok(spec.skip(NO_NODE_ACCELERATIONS)),
    }),
    ("nodes.goal", |spec, it| goal::check_nodes(spec, it.scenario, it.flyable()?, |index, _| it.rounding(index))),
    ("plan.separation", |spec, it| separation::check(spec, it.scenario, it.hovering())),
    ("plan.clearance", |spec, it| clearance::check(spec, it.scenario, it.hovering()?)),
    ("plan.state_limits", |spec, it| limits::check_planned_states(spec, it.scenario, it.planned()?, &it.between)),
    ("plan.control_limits", |spec, it| limits::check_accelerations(spec, it.scenario, it.planned()?, &it.between)),
    ("plan.dynamics", |spec, _| Ok(spec.skip(NO_DYNAMICS))),
    ("plan.rollout", |spec, _| Ok(spec.skip(NO_ROLLOUT))),
    ("plan.goal", |spec, it| {
        goal::check_planned(spec, it.scenario, it.plan, it.planned()?, |index, _| it.rounding(index))
    }),
    ("plan.rest", |spec, it| rest::check_planned(spec, it.scenario, it.planned()?, it.provenance)),
    ("flight.complete", |spec, it| {
        Ok(flight_integrity::check_complete(spec, it.scenario, it.plan, it.flight()?, reference::defect))
    }),
    ("flight.crash", |spec, it| {
        let contact = || collision::deepest(it.scenario, it.shared.flown_motions().ok()?, clearance::entered_obstacle);
        Ok(flight_integrity::check_crash(spec, it.flight()?, it.mission_end_s(), contact))
    }),
    ("flight.planner", |spec, it| Ok(in_loop_planner::check(spec, it.scenario, it.flight()?))),
    ("flight.separation", |spec, it| separation::check(spec, it.scenario, it.flown_motions())),
    ("flight.clearance", |spec, it| clearance::check(spec, it.scenario, it.flown_motions()?)),
    ("flight.state_limits", |spec, it| limits::check_flown_states(spec, it.scenario, it.flown()?, it.flown_motions()?)),
    ("flight.control_limits", |spec, it| limits::check_flown_controls(spec, it.scenario, it.flown()?)),
    ("flight.dynamics", |spec, it| physics::check(spec, it.scenario, it.flight()?)),
    ("flight.goal", |spec, it| goal::check_flown(spec, it.scenario, it.flown()?, |index| it.rounding(index))),
    ("flight.rest", |spec, it| rest::check_flown(spec, it.scenario, it.plan, it.flown()?, it.provenance)),
];

impl<'a> FleetCase<'a> {
    /// What is not known of the end of a vehicle because its rows were rounded.
    fn rounding(&self, vehicle: usize) -> EndError {
        EndError { position_m: self.provenance.rounding_m(vehicle), ..EndError::default() }
    }

    fn new(shared: &'a Case<'a>) -> Self {
        let plan = shared.flyable().map_err(MissingEvidence::from);
        let vehicles = shared.scenario.vehicles.iter().enumerate();
        let between =
            |(index, vehicle)| BetweenNodes::of(shared.provenance, index, shared.scenario.multirotor_model(vehicle));
        let between: Vec<BetweenNodes> = vehicles.map(between).collect();
        let planned = plan.and_then(planned_motions);
        let tubes = planned.as_ref().map_or_else(|_| Vec::new(), |planned| tubes(shared, planned, &between));
        let planned = planned.map(|motions| surround(motions, &tubes));
        let hovering = planned.clone().map(until_all_have_arrived);
        let flown = shared.flown_motions().ok().filter(|_| tubes.iter().any(Tube::has_width));
        let flown_in_tubes = flown.map(|motions| surround(motions.to_vec(), &tubes));
        Self { shared, planned, hovering, flown_in_tubes, between }
    }

    fn flown_motions(&self) -> Evidence<'_, [Motion]> {
        self.flown_in_tubes.as_deref().map_or_else(|| self.shared.flown_motions(), Ok)
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

/// The tubes around the planned motions: what lies between the nodes, and the rounding of the rows.
fn tubes(case: &Case<'_>, planned: &[Motion], between: &[BetweenNodes]) -> Vec<Tube> {
    let tube = |(index, (motion, between)): (usize, (&Motion, &BetweenNodes))| {
        let stretch = |segment: Segment| {
            let end_s = segment.t_s[1];
            Stretch { end_s, position_m: between.distance_m(&segment), velocity_mps: 0.0 }
        };
        Tube::new(motion.segments().map(stretch).collect()).widened(case.provenance.rounding_m(index))
    };
    planned.iter().zip(between).enumerate().map(tube).collect()
}

/// The motions, each in its tube.
fn surround(motions: Vec<Motion>, tubes: &[Tube]) -> Vec<Motion> {
    motions.into_iter().zip(tubes).map(|(motion, tube)| tube.surround(motion)).collect()
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
