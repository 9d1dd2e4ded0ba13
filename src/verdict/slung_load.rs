//! The judge of quadrotors with slung loads.

mod cable;
mod clearance;
mod closest;
mod flown;
mod gates;
mod limits;
mod motion;
mod physics;
mod planned;
mod search_interval;
mod separating_plane;
mod shape_pairs;
mod terminal_conditions;

use scenarios::slung_load::{Model, Trajectory};
use scenarios::{CheckSpec, Family, Vehicle};

pub use cable::TENSION_WINDOW_S;
pub use flown::FlownMotion;
pub use planned::PlannedMotion;

use self::gates::Gates;
use self::limits::LimitChecks;
use self::shape_pairs::ShapePairs;
use self::terminal_conditions::TerminalConditions;
use crate::verdict::case::Case;
use crate::verdict::compare::is_larger;
use crate::verdict::evidence::{Decide, Evidence, Measurement};
use crate::verdict::{Check, separation};

/// In flight the envelope has to stay clear by this, m: what the plan keeps beyond it is for the tracker to use up.
const FLOWN_ENVELOPE_M: f64 = 0.0;
/// Why a plan is not flown open loop.
const NO_ROLLOUT: &str = "open loop a quadrotor is unstable, whatever its plan";

/// Every check of the one vehicle of a scenario with a slung load.
pub fn checks(case: &Case<'_>) -> Vec<Check> {
    let evidence = SlungLoadCase::new(case);
    case.checks(Family::SlungLoad, |spec| evidence.check(spec))
}

/// The vehicle, what it is held against, and its planned and flown motion.
struct SlungLoadCase<'a> {
    case: &'a Case<'a>,
    vehicle: &'a Vehicle,
    model: &'a Model,
    shape_pairs: ShapePairs<'a>,
    limited: LimitChecks<'a>,
    end: TerminalConditions<'a>,
    gates: Gates<'a>,
    planned: Result<PlannedMotion, String>,
    flown: Result<FlownMotion<'a>, String>,
}

impl<'a> SlungLoadCase<'a> {
    fn new(case: &'a Case<'a>) -> Self {
        let (scenario, vehicle) = (case.scenario, &case.scenario.vehicles[0]);
        Self {
            case,
            vehicle,
            model: scenario.slung_load_model(vehicle),
            shape_pairs: ShapePairs::of(scenario, vehicle),
            limited: LimitChecks::of(scenario, vehicle),
            end: TerminalConditions::of(scenario, vehicle),
            gates: Gates::of(scenario, vehicle),
            planned: case.flyable().map_err(str::to_owned).and_then(|plan| PlannedMotion::new(scenario, plan)),
            flown: case.flight().map_err(str::to_owned).and_then(FlownMotion::new),
        }
    }

    fn check(&self, spec: &CheckSpec) -> Check {
        let (scenario, name) = (self.case.scenario, self.vehicle.name.as_str());
        let (limits, envelope_m) = (scenario.limits(), scenario.verdict.envelope_m);
        let trajectory = self.trajectory();
        let planned = self.planned.as_ref().map_err(String::as_str);
        let flown = self.flown.as_ref().map_err(String::as_str);
        let planned_motion = planned.map(|planned| &planned.motion);
        let flown_motion = flown.map(|flown| &flown.motion);
        let log = flown.map(|flown| flown.log);
        let end_s = self.case.plan.flight_time_s().unwrap_or(f64::NAN);
        match spec.name {
            "nodes.separation" => separation::check_nodes(spec, scenario, self.case.flyable()),
            "nodes.clearance" => self.shape_pairs.check_nodes(spec, trajectory),
            "nodes.envelope" => self.shape_pairs.check_envelope_nodes(spec, trajectory, envelope_m),
            "nodes.state_limits" => self.limited.check_node_states(spec, trajectory),
            "nodes.control_limits" => self.limited.check_node_thrusts(spec, trajectory),
            "nodes.goal" => self.end.check_node_goal(spec, trajectory),
            "nodes.gates" => self.gates.check_nodes(spec, trajectory),
            "plan.separation" => separation::check(spec, scenario, planned.map(|planned| &planned.motions[..1])),
            "plan.clearance" => self.shape_pairs.check(spec, planned_motion),
            "plan.envelope" => self.shape_pairs.check_envelope(spec, planned_motion, envelope_m),
            "plan.state_limits" => self.limited.check_planned_states(spec, planned),
            "plan.control_limits" => self.limited.check_planned_thrusts(spec, trajectory),
            "plan.dynamics" => check_defects(spec, name, planned, limits.dynamics_m),
            "plan.rollout" => spec.skip(NO_ROLLOUT),
            "plan.goal" => self.end.check_planned_goal(spec, planned),
            "plan.rest" => self.end.check_planned_rest(spec, planned),
            "plan.tension" => cable::check_planned_tension(spec, self.model, name, planned),
            "plan.slack" => cable::check_planned_cable(spec, self.model, trajectory, planned, limits.dynamics_m),
            "plan.swing" => self.limited.check_planned_swing(spec, planned),
            "plan.gates" => self.gates.check(spec, planned_motion),
            // Body, cable and load are judged by their true shapes: what touches has no clearance.
            "flight.crash" => self.case.crash(spec, Err("")),
            "flight.separation" => separation::check(spec, scenario, flown.map(|flown| &flown.motions[..1])),
            "flight.clearance" => self.shape_pairs.check(spec, flown_motion),
            "flight.envelope" => {
                self.shape_pairs.check_envelope(spec, flown_motion, envelope_m.map(|_| FLOWN_ENVELOPE_M))
            }
            "flight.state_limits" => self.limited.check_flown_states(spec, flown),
            "flight.control_limits" => self.limited.check_flown_thrusts(spec, log),
            "flight.dynamics" => physics::check(spec, scenario, self.case.plan, self.case.flight()),
            "flight.goal" => self.end.check_flown_goal(spec, flown, end_s),
            "flight.rest" => self.end.check_flown_rest(spec, flown, end_s),
            "flight.tension" => cable::check_flown_tension(spec, self.model, log),
            "flight.slack" => cable::check_flown_cable(spec, trajectory, self.case.flight(), limits.switch_s),
            "flight.swing" => self.limited.check_flown_swing(spec, flown),
            "flight.gates" => self.gates.check(spec, flown_motion),
            _ => self.case.shared(spec),
        }
    }

    fn trajectory(&self) -> Evidence<'_, Trajectory> {
        self.case.flyable().map(|plan| plan.trajectories[0].slung_load())
    }
}

/// Largest defect of the plan.
fn check_defects(spec: &CheckSpec, vehicle: &str, planned: Evidence<'_, PlannedMotion>, limit_m: f64) -> Check {
    let worst = planned.map(|planned| {
        planned.defects.iter().copied().reduce(|a, b| if is_larger(b.defect_m, a.defect_m) { b } else { a })
    });
    match worst {
        Err(reason) => spec.fail(reason),
        Ok(None) => spec.fail("the plan has no interval"),
        Ok(Some(worst)) => spec.at_most(Measurement::value(worst.defect_m).at(worst.t_s).with(vehicle), limit_m),
    }
}
