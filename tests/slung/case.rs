//! Flights that pass every check: a load that swings around a box, and one that is caught.

use std::sync::OnceLock;

use harness::verdict::{Check, Status, Verdict, judge};
use nalgebra::Vector3;
use scenarios::slung_load::{Cable, Control, GRAVITY_MPS2, State, Trajectory};
use scenarios::{BoxObstacle, LoadPoint, Plan, Scenario, Waypoint};
use sim::slung_load::{Plant, SlungLoadState, impact, propagate};
use sim::{Actuation, Commanded, Flight, LoadSample, Sample, fly};

use crate::arena::{model, plan, scenario, silent, trajectory};
use crate::flatness::Swing;

/// The input of the judge.
#[derive(Clone)]
pub struct Case {
    pub scenario: Scenario,
    pub plan: Plan,
    pub flight: Option<Flight>,
}

impl Case {
    /// From (-2, 0) to (2, 0), bowing 1.2 m to the south round the end of a wall.
    pub fn good() -> Self {
        static GOOD: OnceLock<Case> = OnceLock::new();
        GOOD.get_or_init(Self::swing).clone()
    }

    fn swing() -> Self {
        let swing = Swing {
            from_m: Vector3::new(-2.0, 0.0, 0.65),
            to_m: Vector3::new(2.0, 0.0, 0.85),
            bow_m: Vector3::new(0.0, -1.2, 0.0),
            duration_s: 6.0,
        };
        let mut scenario = scenario();
        let vehicle = &mut scenario.vehicles[0];
        vehicle.start = Waypoint::at_rest([-2.0, 0.0, 1.3]);
        vehicle.goal = Waypoint::at_rest([2.0, 0.0, 1.5]);
        let wall =
            BoxObstacle { name: "wall".into(), center_m: [0.0, 0.0], size_m: [0.1, 0.8], heading_deg: 0.0, z_m: None };
        scenario.world.boxes.push(wall);
        scenario.verdict.envelope_m = Some(0.05);
        Self::flown(scenario, swing.plan(&model()))
    }

    /// A load that falls 0.2 m before it is caught.
    pub fn caught() -> Self {
        let mut scenario = scenario();
        let model = model();
        let plant = Plant::nominal(&model, None);
        let hover = Control { thrust_n: [model.mass_kg * GRAVITY_MPS2 / 4.0; 4] };
        let brake = Control { thrust_n: [(model.mass_kg + model.load_mass_kg) * (GRAVITY_MPS2 + 2.0) / 4.0; 4] };
        let carry = Control { thrust_n: [model.hover_thrust_n(); 4] };
        let start =
            Waypoint { load: Some(LoadPoint { x_m: 0.0, y_m: 0.0, z_m: 1.55 }), ..Waypoint::at_rest([0.0, 0.0, 2.0]) };
        let first = State::at(&start, model.cable_length_m);
        let fall_s = (2.0 * 0.2 / GRAVITY_MPS2).sqrt();
        let last = |knots: Vec<sim::slung_load::Knot>| knots[knots.len() - 1].state;
        let before =
            last(propagate(&plant, &SlungLoadState::from(&first), [&hover; 2], Cable::Slack, [0.0, fall_s], 0.01));
        let (after, _) = impact(&plant, &before);
        let rest_s = fall_s - after.velocity_mps.z / 2.0;
        let rest = State::from(&last(propagate(&plant, &after, [&brake; 2], Cable::Taut, [fall_s, rest_s], 0.01)));
        let nodes = [
            (0.0, first, hover.thrust_n, Cable::Slack),
            (fall_s, State::from(&before), hover.thrust_n, Cable::Slack),
            (fall_s, State::from(&after), brake.thrust_n, Cable::Taut),
            (rest_s, rest, brake.thrust_n, Cable::Taut),
            (rest_s, rest, carry.thrust_n, Cable::Taut),
            (rest_s + 1.0, rest, carry.thrust_n, Cable::Taut),
        ];
        let vehicle = &mut scenario.vehicles[0];
        vehicle.start = start;
        vehicle.goal = Waypoint::at_rest(rest.position_m);
        Self::flown(scenario, trajectory(&nodes))
    }

    fn flown(scenario: Scenario, trajectory: Trajectory) -> Self {
        let plan = plan(trajectory);
        let flight = Some(fly(&scenario, &plan, 0, &mut silent));
        Self { scenario, plan, flight }
    }

    pub fn judge(&self) -> Verdict {
        judge(&self.scenario, &self.plan, self.flight.as_ref())
    }

    pub fn check(&self, name: &str) -> Check {
        let verdict = self.judge();
        verdict.checks.into_iter().find(|check| check.name == name).unwrap_or_else(|| panic!("no check {name}"))
    }

    pub fn status(&self, name: &str) -> Status {
        self.check(name).status
    }

    pub fn trajectory(&mut self) -> &mut Trajectory {
        let scenarios::Trajectory::SlungLoad(trajectory) = &mut self.plan.trajectories[0] else { panic!("no load") };
        trajectory
    }

    pub fn flight(&mut self) -> &mut Flight {
        self.flight.as_mut().expect("the case has a flight")
    }

    pub fn samples(&mut self) -> &mut Vec<Sample> {
        &mut self.flight().vehicles[0].samples
    }

    pub fn loads(&mut self) -> &mut Vec<LoadSample> {
        &mut self.flight().vehicles[0].loads
    }
}

/// The thrusts of a sample, to change them.
pub fn thrusts(sample: &mut Sample) -> &mut Commanded<Control> {
    let Actuation::Thrusts(thrusts) = &mut sample.actuation else { panic!("not that of a quadrotor") };
    thrusts
}
