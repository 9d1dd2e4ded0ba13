//! The judge of quadrotors with slung loads. A scenario has one such vehicle.

mod cable;
mod clearance;
mod closest;
mod flown;
mod gates;
mod limits;
mod lowest_load;
mod motion;
mod physics;
mod planned;
mod reference;
mod search_interval;
mod separating_plane;
mod shape_pairs;
mod terminal_conditions;

use std::ops::Deref;

use scenarios::slung_load::{Model, Trajectory};
use scenarios::{CheckSpec, Family, Vehicle};

pub use cable::TENSION_WINDOW_S;
pub use flown::FlownMotion;
pub use planned::PlannedMotion;

use self::gates::Gates;
use self::limits::LimitChecks;
use self::motion::SlungLoadMotion;
use self::shape_pairs::ShapePairs;
use self::terminal_conditions::TerminalConditions;
use crate::verdict::case::{Case, CheckTable, function_of};
use crate::verdict::compare::is_larger;
use crate::verdict::evidence::{CheckResult, Decide, Evidence, Measurement};
use crate::verdict::missing_evidence::MissingEvidence;
use crate::verdict::{Check, flight_integrity, requirements, separation};

/// Required clearance of the envelope in flight, m. The plan keeps a larger one, which the tracker may use up.
const FLOWN_ENVELOPE_M: f64 = 0.0;

/// Every check of the vehicle, in the order of a verdict.
pub fn checks(case: &Case<'_>) -> Vec<Check> {
    let vehicle = VehicleCase::new(case);
    let mut checks = case.checks(Family::SlungLoad, |spec| Some(function_of(CHECKS, spec)?(spec, &vehicle)));
    requirements::insert(
        &mut checks,
        case,
        vehicle.planned().map(|it| it.motions.as_slice()),
        vehicle.flown().map(|it| it.motions.as_slice()),
    );
    checks
}

/// The vehicle, its planned and flown motion, and what they are compared with.
struct VehicleCase<'a> {
    shared: &'a Case<'a>,
    vehicle: &'a Vehicle,
    model: &'a Model,
    shape_pairs: ShapePairs<'a>,
    limits: LimitChecks<'a>,
    end: TerminalConditions<'a>,
    gates: Gates<'a>,
    planned: Result<PlannedMotion, MissingEvidence>,
    flown: Result<FlownMotion<'a>, MissingEvidence>,
}

const CHECKS: &CheckTable<fn(&CheckSpec, &VehicleCase<'_>) -> CheckResult> = &[
    ("nodes.separation", |spec, it| separation::check_nodes(spec, it.scenario, it.flyable())),
    ("nodes.clearance", |spec, it| it.shape_pairs.check_nodes(spec, it.trajectory())),
    ("nodes.envelope", |spec, it| it.shape_pairs.check_envelope_nodes(spec, it.trajectory(), it.envelope_m())),
    ("nodes.rotor_clearance", |spec, it| it.shape_pairs.check_own_nodes(spec, it.trajectory())),
    ("nodes.state_limits", |spec, it| it.limits.check_node_states(spec, it.trajectory()?)),
    ("nodes.control_limits", |spec, it| it.limits.check_node_thrusts(spec, it.trajectory()?)),
    ("nodes.goal", |spec, it| it.end.check_node_goal(spec, it.trajectory()?)),
    ("nodes.gates", |spec, it| it.gates.check_nodes(spec, it.trajectory())),
    ("plan.separation", |spec, it| separation::check(spec, it.scenario, it.planned().map(|it| &it.motions[..1]))),
    ("plan.clearance", |spec, it| it.shape_pairs.check(spec, it.planned_motion())),
    ("plan.envelope", |spec, it| it.shape_pairs.check_envelope(spec, it.planned_motion(), it.envelope_m())),
    ("plan.rotor_clearance", |spec, it| it.shape_pairs.check_own(spec, it.planned_motion())),
    ("plan.state_limits", |spec, it| it.limits.check_planned_states(spec, it.planned()?)),
    ("plan.control_limits", |spec, it| it.limits.check_planned_thrusts(spec, it.trajectory()?)),
    ("plan.dynamics", check_defects),
    ("plan.rollout", |spec, _| Ok(spec.skip("a quadrotor is unstable in open loop, whatever its plan"))),
    ("plan.goal", |spec, it| it.end.check_planned_goal(spec, it.planned()?)),
    ("plan.rest", |spec, it| it.end.check_planned_rest(spec, it.planned()?)),
    ("plan.tension", |spec, it| cable::check_planned_tension(spec, it.model, &it.vehicle.name, it.planned()?)),
    ("plan.slack", |spec, it| {
        let limit_m = it.scenario.limits().dynamics_m;
        cable::check_planned_cable(spec, it.model, it.trajectory()?, it.planned()?, limit_m)
    }),
    ("plan.swing", |spec, it| it.limits.check_planned_swing(spec, it.planned()?)),
    ("plan.gates", |spec, it| it.gates.check(spec, it.planned_motion())),
    ("flight.complete", |spec, it| {
        Ok(flight_integrity::check_complete(spec, it.scenario, it.plan, it.flight()?, reference::defect))
    }),
    // The clearance of body, cable and load is that of their true shapes: in a contact it is not positive.
    ("flight.crash", |spec, it| Ok(flight_integrity::check_crash(spec, it.flight()?, it.mission_end_s(), || None))),
    ("flight.separation", |spec, it| separation::check(spec, it.scenario, it.flown().map(|it| &it.motions[..1]))),
    ("flight.clearance", |spec, it| it.shape_pairs.check(spec, it.flown_motion())),
    ("flight.envelope", |spec, it| {
        it.shape_pairs.check_envelope(spec, it.flown_motion(), it.envelope_m().map(|_| FLOWN_ENVELOPE_M))
    }),
    ("flight.rotor_clearance", |spec, it| it.shape_pairs.check_own(spec, it.flown_motion())),
    ("flight.state_limits", |spec, it| it.limits.check_flown_states(spec, it.flown()?)),
    ("flight.control_limits", |spec, it| it.limits.check_flown_thrusts(spec, it.flown()?.log)),
    ("flight.dynamics", |spec, it| physics::check(spec, it.scenario, it.plan, it.flight()?)),
    ("flight.goal", |spec, it| it.end.check_flown_goal(spec, it.flown()?, it.planned_end_s())),
    ("flight.rest", |spec, it| it.end.check_flown_rest(spec, it.flown()?, it.planned_end_s())),
    ("flight.tension", |spec, it| cable::check_flown_tension(spec, it.model, it.flown()?.log, &it.flight()?.events)),
    ("flight.slack", |spec, it| {
        cable::check_flown_cable(spec, it.trajectory()?, it.flight()?, it.scenario.limits().switch_s)
    }),
    ("flight.swing", |spec, it| it.limits.check_flown_swing(spec, it.flown()?)),
    ("flight.gates", |spec, it| it.gates.check(spec, it.flown_motion())),
];

impl<'a> VehicleCase<'a> {
    fn new(shared: &'a Case<'a>) -> Self {
        let (scenario, vehicle) = (shared.scenario, &shared.scenario.vehicles[0]);
        let plan = shared.flyable().map_err(MissingEvidence::from);
        let flight = shared.flight().map_err(MissingEvidence::from);
        Self {
            shared,
            vehicle,
            model: scenario.slung_load_model(vehicle),
            shape_pairs: ShapePairs::new(scenario, vehicle),
            limits: LimitChecks::new(scenario, vehicle),
            end: TerminalConditions::new(scenario, vehicle),
            gates: Gates::new(scenario, vehicle),
            planned: plan.and_then(|plan| PlannedMotion::new(scenario, plan)),
            flown: flight.and_then(FlownMotion::new),
        }
    }

    fn trajectory(&self) -> Evidence<'_, Trajectory> {
        self.flyable().map(|plan| plan.trajectories[0].slung_load())
    }

    fn planned(&self) -> Evidence<'_, PlannedMotion> {
        self.planned.as_ref()
    }

    fn planned_motion(&self) -> Evidence<'_, SlungLoadMotion> {
        self.planned().map(|planned| &planned.motion)
    }

    fn flown(&self) -> Evidence<'_, FlownMotion<'a>> {
        self.flown.as_ref()
    }

    fn flown_motion(&self) -> Evidence<'_, SlungLoadMotion> {
        self.flown().map(|flown| &flown.motion)
    }

    /// Clearance that the scenario requires of the envelope, m; `None` if it has no envelope.
    fn envelope_m(&self) -> Option<f64> {
        self.scenario.verdict.envelope_m
    }

    fn planned_end_s(&self) -> f64 {
        self.plan.flight_time_s().unwrap_or(f64::NAN)
    }
}

impl<'a> Deref for VehicleCase<'a> {
    type Target = Case<'a>;

    fn deref(&self) -> &Case<'a> {
        self.shared
    }
}

/// Largest defect of the plan.
fn check_defects(spec: &CheckSpec, it: &VehicleCase<'_>) -> CheckResult {
    let defects = it.planned()?.defects.iter().copied();
    let worst = defects.reduce(|a, b| if is_larger(b.defect_m, a.defect_m) { b } else { a });
    let worst = worst.ok_or(MissingEvidence::NoInterval)?;
    let measured = Measurement::value(worst.defect_m).at(worst.t_s).with(&it.vehicle.name);
    Ok(spec.at_most(measured, it.scenario.limits().dynamics_m))
}

#[cfg(test)]
mod tests {
    use scenarios::Family;

    use super::CHECKS;
    use crate::verdict::case::tests::assert_complete;

    #[test]
    fn every_check_has_one_function() {
        assert_complete(Family::SlungLoad, CHECKS);
    }
}
