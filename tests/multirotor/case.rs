//! A flight that passes every check: two multirotors side by side past a wall and a cart, from rest to rest.

use std::sync::OnceLock;

use harness::verdict::{Check, Status, Verdict, judge};
use scenarios::in_loop::Node;
use scenarios::multirotor::Trajectory;
use scenarios::{Plan, Scenario};
use sim::{Actuation, Commanded, Flight, Sample, fly};

const TEXT: &str = r#"name = "pair"
description = "Two multirotors side by side."

[world]
map = { x_m = [-3, 9], y_m = [-5, 8], z_m = [0, 4] }

[[world.boxes]]
name = "wall"
center_m = [3, -2]
size_m = [2, 1]

[[world.moving]]
name = "cart"
radius_m = 0.5
path_m = [[0, 6], [6, 6]]
speed_mps = 1

[models.multirotor.quad]
mass_kg = 1.5
body_radius_m = 0.35
sensor_range_m = 8
limits = { speed_mps = 3, acceleration_mps2 = 3 }
planning_limits = { speed_mps = 2.5, acceleration_mps2 = 1.5 }

[[vehicles]]
name = "uav-1"
model = "quad"
start = { x_m = 0, y_m = 0, z_m = 2 }
goal = { x_m = 6, y_m = 0, z_m = 2 }

[[vehicles]]
name = "uav-2"
model = "quad"
start = { x_m = 0, y_m = 3, z_m = 2 }
goal = { x_m = 6, y_m = 3, z_m = 2 }

[fleet]
separation_m = 1
simultaneous_arrival = true

[planner]
name = "by-hand"

[simulation]
coast_s = 1
max_duration_s = 20
tracker = { natural_frequency_radps = 2.5 }
"#;

/// The scenario.
pub fn scenario() -> Scenario {
    scenarios::parse("pair.toml", TEXT).expect("a good scenario")
}

/// The input of the judge.
#[derive(Clone)]
pub struct Case {
    pub scenario: Scenario,
    pub plan: Plan,
    pub flight: Option<Flight>,
}

impl Case {
    /// 2 s at 1 m/s², 1 s at 2 m/s, 2 s of braking.
    pub fn good() -> Self {
        static GOOD: OnceLock<Case> = OnceLock::new();
        GOOD.get_or_init(Self::flown).clone()
    }

    fn flown() -> Self {
        let scenario = scenario();
        let trajectory = |name: &str, y_m: f64| {
            let node =
                |(t_s, x_m, speed_mps)| Node { t_s, position_m: [x_m, y_m, 2.0], velocity_mps: [speed_mps, 0.0, 0.0] };
            let nodes = [(0.0, 0.0, 0.0), (2.0, 2.0, 2.0), (3.0, 4.0, 2.0), (5.0, 6.0, 0.0)].map(node);
            Trajectory::through(name, &nodes).into()
        };
        let plan = Plan {
            objective: Some(5.0),
            ..Plan::new(&scenario.name, "by-hand", 0, vec![trajectory("uav-1", 0.0), trajectory("uav-2", 3.0)])
        };
        let flight = Some(fly(&scenario, &plan, 0, &mut |_| {}));
        Self { scenario, plan, flight }
    }

    /// Flies the plan again.
    pub fn fly(&mut self) {
        self.flight = Some(fly(&self.scenario, &self.plan, 0, &mut |_| {}));
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

    pub fn trajectory(&mut self, vehicle: usize) -> &mut Trajectory {
        let scenarios::Trajectory::Multirotor(trajectory) = &mut self.plan.trajectories[vehicle] else {
            panic!("not that of a multirotor")
        };
        trajectory
    }

    pub fn model(&mut self) -> &mut scenarios::multirotor::Model {
        self.scenario.models.multirotor.get_mut("quad").expect("the model")
    }

    pub fn flight(&mut self) -> &mut Flight {
        self.flight.as_mut().expect("the case has a flight")
    }

    pub fn samples(&mut self, vehicle: usize) -> &mut Vec<Sample> {
        &mut self.flight().vehicles[vehicle].samples
    }
}

/// The acceleration of a sample, to change it.
pub fn acceleration(sample: &mut Sample) -> &mut Commanded<[f64; 3]> {
    let Actuation::Acceleration(acceleration) = &mut sample.actuation else { panic!("not that of a point mass") };
    acceleration
}
