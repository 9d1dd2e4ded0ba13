//! The judge of quadrotors with slung loads: what it asks beyond what it asks of every vehicle.

mod behind;
mod cable;
mod clearance;
mod closest;
mod course;
mod end;
mod flown;
mod gates;
mod limits;
mod physics;
mod planned;
mod span;
mod surroundings;

use scenarios::slung_load::Trajectory;
use scenarios::{Plan, Scenario};
use sim::Flight;

pub use cable::TENSION_WINDOW_S;
pub use flown::Flown;
pub use planned::Planned;

use self::end::End;
use self::gates::Gates;
use self::limits::Limited;
use self::physics::Physics;
use self::surroundings::Surroundings;
use crate::verdict::compare::is_larger;
use crate::verdict::question::{Evidence, Group, Measured, Question};
use crate::verdict::{Check, arrival, flown as shared, integrity, physics as shared_physics, separation, tracking};

/// In flight the envelope has to stay clear by this, m: what the plan keeps beyond it is for the tracker to use up.
const FLOWN_ENVELOPE_M: f64 = 0.0;

/// Everything that is asked of the one vehicle of a scenario, from its plan and its flight.
pub struct Judge<'a> {
    scenario: &'a Scenario,
    plan: &'a Plan,
    flyable: Result<(), String>,
    surroundings: Surroundings<'a>,
    limited: Limited<'a>,
    end: End<'a>,
    gates: Gates<'a>,
}

impl<'a> Judge<'a> {
    /// `flyable`: why the plan is not, if it is not.
    pub fn new(scenario: &'a Scenario, plan: &'a Plan, flyable: Result<(), String>) -> Self {
        let vehicle = &scenario.vehicles[0];
        Self {
            scenario,
            plan,
            flyable,
            surroundings: Surroundings::of(scenario, vehicle),
            limited: Limited::of(scenario, vehicle),
            end: End::of(scenario, vehicle),
            gates: Gates::of(scenario, vehicle),
        }
    }

    /// The group `nodes`.
    pub fn nodes_checks(&self) -> Vec<Check> {
        let plan = self.flyable.as_ref().map(|()| self.plan).map_err(String::as_str);
        let trajectory = self.trajectory();
        vec![
            separation::check_nodes(self.scenario, plan),
            self.surroundings.check_nodes(trajectory),
            self.surroundings.check_envelope_nodes(trajectory, self.scenario.verdict.envelope_m),
            self.limited.check_node_states(trajectory),
            self.limited.check_node_thrusts(trajectory),
            self.end.check_node_goal(trajectory),
            self.gates.check_nodes(trajectory),
        ]
    }

    /// The group `plan`.
    pub fn plan_checks(&self) -> Vec<Check> {
        let scenario = self.scenario;
        let nodes = self.flyable.as_ref().map(|()| self.plan).map_err(String::as_str);
        let trajectory = self.trajectory();
        let planned = self.flyable.clone().and_then(|()| Planned::new(scenario, self.plan));
        let planned = planned.as_ref().map_err(String::as_str);
        let course = planned.map(|planned| &planned.course);
        let (model, name) = (scenario.slung_load_model(&scenario.vehicles[0]), &scenario.vehicles[0].name);
        vec![
            integrity::check_plan_finite(self.plan),
            integrity::check_plan_complete(scenario, self.plan),
            separation::check(Group::Plan, scenario, planned.map(|planned| &planned.motions[..1])),
            self.surroundings.check(Group::Plan, course),
            self.surroundings.check_envelope(Group::Plan, course, scenario.verdict.envelope_m),
            self.limited.check_planned_states(planned),
            self.limited.check_planned_thrusts(trajectory),
            check_defects(name, planned, scenario.limits().dynamics_m),
            Question::new(Group::Plan, "rollout", "m").skip("open loop a quadrotor is unstable, whatever its plan"),
            self.end.check_planned_goal(planned),
            self.end.check_planned_rest(planned),
            arrival::check_planned_arrival(scenario, nodes),
            arrival::check_planned_duration(scenario, nodes),
            cable::check_planned_tension(model, name, planned),
            cable::check_planned_cable(model, trajectory, planned, scenario.limits().dynamics_m),
            self.limited.check_planned_swing(planned),
            self.gates.check(Group::Plan, course),
        ]
    }

    /// The group `flight`, what concerns the log itself aside.
    pub fn flight_checks(&self, flight: Evidence<'_, Flight>) -> Vec<Check> {
        let scenario = self.scenario;
        let flown = flight.map_err(str::to_owned).and_then(Flown::new);
        let flown = flown.as_ref().map_err(String::as_str);
        let tracked = flight.map_err(str::to_owned).and_then(|flight| shared::Flown::new(scenario, self.plan, flight));
        let tracked = tracked.as_ref().map_err(String::as_str);
        let (course, log) = (flown.map(|flown| &flown.course), flown.map(|flown| flown.log));
        let model = scenario.slung_load_model(&scenario.vehicles[0]);
        let end_s = self.plan.flight_time_s().unwrap_or(f64::NAN);
        let envelope_m = scenario.verdict.envelope_m.map(|_| FLOWN_ENVELOPE_M);
        vec![
            separation::check(Group::Flight, scenario, flown.map(|flown| &flown.motions[..1])),
            self.surroundings.check(Group::Flight, course),
            self.surroundings.check_envelope(Group::Flight, course, envelope_m),
            self.limited.check_flown_states(flown),
            self.limited.check_flown_thrusts(log),
            self.check_flown_dynamics(flight),
            self.end.check_flown_goal(flown, end_s),
            self.end.check_flown_rest(flown, end_s),
            arrival::check_flown_arrival(scenario, tracked),
            arrival::check_flown_duration(scenario, tracked),
            tracking::check_root_mean_square(scenario, tracked),
            tracking::check_largest(scenario, tracked),
            tracking::check_saturation(scenario, tracked),
            cable::check_flown_tension(model, log),
            cable::check_flown_cable(self.trajectory(), flight, scenario.limits().switch_s),
            self.limited.check_flown_swing(flown),
            self.gates.check(Group::Flight, course),
        ]
    }

    fn check_flown_dynamics(&self, flight: Evidence<'_, Flight>) -> Check {
        shared_physics::answer(self.scenario, flight, shared_physics::LIMIT_M, |vehicle, log| {
            let trajectory = self.plan.trajectories[0].slung_load();
            Physics::of(self.scenario, vehicle, trajectory).largest_defect(log)
        })
    }

    fn trajectory(&self) -> Evidence<'_, Trajectory> {
        self.flyable.as_ref().map(|()| self.plan.trajectories[0].slung_load()).map_err(String::as_str)
    }
}

/// Largest defect of the plan.
fn check_defects(vehicle: &str, planned: Evidence<'_, Planned>, limit_m: f64) -> Check {
    let question = Question::new(Group::Plan, "dynamics", "m");
    let worst = planned.map(|planned| {
        planned.defects.iter().copied().reduce(|a, b| if is_larger(b.defect_m, a.defect_m) { b } else { a })
    });
    match worst {
        Err(reason) => question.fail(reason),
        Ok(None) => question.fail("the plan has no interval"),
        Ok(Some(worst)) => question.at_most(Measured::value(worst.defect_m).at(worst.t_s).with(vehicle), limit_m),
    }
}
