//! A fleet that passes every check: three aircraft abreast, straight to the east for 20 s.

use harness::verdict::{Check, Status, Verdict, judge};
use scenarios::fixed_wing::{Control, Limits, Model, State, Trajectory};
use scenarios::{
    Cylinder, FleetRules, Interpolation, Map, Models, Plan, PlannerSettings, Range, Scenario, Simulation, Vehicle,
    VerdictLimits, Waypoint, World,
};
use sim::{Actuation, Commanded, Flight, Sample, VehicleLog};

pub const SPEED_MPS: f64 = 35.0;
pub const END_S: f64 = 20.0;
pub const STEP_S: f64 = 0.01;
const COAST_S: f64 = 2.0;
const NODE_S: f64 = 2.0;
const ALTITUDE_M: f64 = 400.0;
const ABREAST_M: f64 = 200.0;

/// The input of the judge.
#[derive(Clone)]
pub struct Case {
    pub scenario: Scenario,
    pub plan: Plan,
    pub flight: Option<Flight>,
}

impl Case {
    /// Three aircraft at y = 0, 200 and 400 m; 100 m from a pillar of 400 m; 100 m to keep between them.
    pub fn good() -> Self {
        Self::straight(&[0.0, ABREAST_M, 2.0 * ABREAST_M], STEP_S)
    }

    /// Aircraft straight to the east, at the given north coordinates, logged every `step_s`.
    pub fn straight(norths_m: &[f64], step_s: f64) -> Self {
        let vehicles: Vec<Vehicle> = norths_m.iter().enumerate().map(|(index, &y_m)| vehicle(index, y_m)).collect();
        let plan = plan(vehicles.iter().map(planned).collect());
        let logs = vehicles.iter().map(|vehicle| logged(vehicle, step_s)).collect();
        Self { scenario: scenario(vehicles, step_s), plan, flight: Some(flight(logs, step_s)) }
    }

    /// The same, but that the first aircraft arrives at x = 350 m, after 10 s, and flies on until the others arrive after 20 s.
    pub fn with_early_arrival(mut self) -> Self {
        self.scenario.fleet.simultaneous_arrival = false;
        self.scenario.vehicles[0].goal.x_m = 350.0;
        let trajectory = self.trajectory(0);
        trajectory.times_s.truncate(6);
        trajectory.states.truncate(6);
        trajectory.controls.truncate(6);
        self
    }

    pub fn judge(&self) -> Verdict {
        judge(&self.scenario, &self.plan, self.flight.as_ref())
    }

    pub fn check(&self, name: &str) -> Check {
        check(&self.judge(), name)
    }

    pub fn status(&self, name: &str) -> Status {
        self.check(name).status
    }

    pub fn trajectory(&mut self, vehicle: usize) -> &mut Trajectory {
        fixed_wing(&mut self.plan.trajectories[vehicle])
    }

    pub fn flight(&mut self) -> &mut Flight {
        self.flight.as_mut().expect("the case has a flight")
    }

    pub fn samples(&mut self, vehicle: usize) -> &mut Vec<Sample> {
        &mut self.flight().vehicles[vehicle].samples
    }
}

pub fn check(verdict: &Verdict, name: &str) -> Check {
    verdict.checks.iter().find(|check| check.name == name).unwrap_or_else(|| panic!("no check {name}")).clone()
}

fn vehicle(index: usize, y_m: f64) -> Vehicle {
    let at = |x_m| Waypoint { speed_mps: SPEED_MPS, ..Waypoint::at_rest([x_m, y_m, ALTITUDE_M]) };
    let (start, goal) = (at(0.0), at(SPEED_MPS * END_S));
    Vehicle { name: format!("uav-{}", index + 1), model: "paper".to_owned(), start, goal, via: Vec::new() }
}

fn scenario(vehicles: Vec<Vehicle>, step_s: f64) -> Scenario {
    let pillar = Cylinder { name: "pillar".to_owned(), center_m: [350.0, -500.0], radius_m: 400.0 };
    let wide = Range::new(-1e5, 1e5);
    let map = Map { x_m: wide, y_m: wide, z_m: Range::new(0.0, 1000.0) };
    Scenario {
        name: "abreast".to_owned(),
        description: "Straight flight side by side.".to_owned(),
        tags: Vec::new(),
        world: World { cylinders: vec![pillar], ..World::empty(map) },
        models: Models { fixed_wing: [("paper".to_owned(), model())].into(), ..Models::default() },
        vehicles,
        fleet: FleetRules { separation_m: Some(100.0), simultaneous_arrival: true, ..FleetRules::default() },
        planner: PlannerSettings { name: "by-hand".to_owned(), ..Default::default() },
        simulation: Simulation { step_s, coast_s: COAST_S, max_duration_s: 60.0, ..Default::default() },
        verdict: VerdictLimits::default(),
        requirements: Vec::new(),
    }
}

fn model() -> Model {
    let limits = |altitude_m, speed_mps, flight_path_deg: f64, n: f64| Limits {
        altitude_m,
        speed_mps,
        flight_path_deg: Range::new(-flight_path_deg, flight_path_deg),
        n_x: Range::new(-n, n),
        n_y: Range::new(-n, n),
        n_z: Range::new(1.0 - n, 1.0 + n),
    };
    Model {
        mass_kg: 10.0,
        body_radius_m: 1.0,
        limits: limits(Range::new(200.0, 600.0), Range::new(25.0, 45.0), 10.0, 0.4),
        planning_limits: limits(Range::new(300.0, 500.0), Range::new(30.0, 40.0), 5.0, 0.2),
    }
}

fn plan(trajectories: Vec<Trajectory>) -> Plan {
    Plan {
        objective: Some(END_S),
        ..Plan::new("abreast", "by-hand", 0, trajectories.into_iter().map(Into::into).collect())
    }
}

fn planned(vehicle: &Vehicle) -> Trajectory {
    let times_s: Vec<f64> = (0..=(END_S / NODE_S) as usize).map(|node| node as f64 * NODE_S).collect();
    let start = vehicle.start.fixed_wing_state();
    Trajectory {
        vehicle: vehicle.name.clone(),
        interpolation: Interpolation::FirstOrderHold,
        states: times_s.iter().map(|t_s| State { x_m: start.x_m + SPEED_MPS * t_s, ..start }).collect(),
        controls: vec![Control::CRUISE; times_s.len()],
        times_s,
    }
}

fn logged(vehicle: &Vehicle, step_s: f64) -> VehicleLog {
    let start = vehicle.start;
    let steps = ((END_S + COAST_S) / step_s).round() as usize;
    let sample = |step: usize| {
        let t_s = step as f64 * step_s;
        sample(t_s, [start.x_m + SPEED_MPS * t_s, start.y_m, start.z_m], [SPEED_MPS, 0.0, 0.0])
    };
    VehicleLog { vehicle: vehicle.name.clone(), samples: (0..=steps).map(sample).collect(), loads: Vec::new() }
}

/// The trajectory of a fixed wing, to change it.
pub fn fixed_wing(trajectory: &mut scenarios::Trajectory) -> &mut Trajectory {
    let scenarios::Trajectory::FixedWing(trajectory) = trajectory else { panic!("not that of a fixed wing") };
    trajectory
}

/// The load factors of a sample, to change them.
pub fn factors(sample: &mut Sample) -> &mut Commanded<Control> {
    let Actuation::LoadFactors(factors) = &mut sample.actuation else { panic!("not that of a fixed wing") };
    factors
}

/// A vehicle exactly on its plan, in still air.
pub fn sample(t_s: f64, position_m: [f64; 3], velocity_mps: [f64; 3]) -> Sample {
    Sample {
        t_s,
        position_m,
        velocity_mps,
        wind_mps: [0.0; 3],
        world_from_body: [0.0, 0.0, 0.0, 1.0],
        measured_position_m: position_m,
        measured_velocity_mps: velocity_mps,
        reference_position_m: position_m,
        reference_velocity_mps: velocity_mps,
        actuation: Actuation::LoadFactors(Commanded { command: Control::CRUISE, control: Control::CRUISE }),
    }
}

fn flight(vehicles: Vec<VehicleLog>, step_s: f64) -> Flight {
    Flight { step_s, plan_end_s: END_S, vehicles, events: Vec::new(), planning: None, wall_s: 0.0 }
}
