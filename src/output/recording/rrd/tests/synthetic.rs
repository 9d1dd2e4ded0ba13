//! A made-up run to record: aircraft in line abreast that weave between cylinders, with a known closest approach.

use scenarios::fixed_wing::{self, Control, Limits, Model, State};
use scenarios::{
    Cylinder, FleetRules, Interpolation, Iteration, Map, Models, Plan, PlanTimings, PlannerSettings, Range, Scenario,
    Simulation, Trajectory, Vehicle, VerdictLimits, Waypoint, World,
};
use sim::{Actuation, Commanded, Event, EventKind, Flight, Sample, VehicleLog};

use crate::verdict::{Check, Outcome, Status, Verdict};

/// Distance between neighbours at start and goal, m.
pub const SPACING_M: f64 = 400.0;
const SPEED_MPS: f64 = 36.0;
const STEP_S: f64 = 0.01;

/// A run of `count` aircraft for `duration_s`.
pub struct Synthetic {
    pub scenario: Scenario,
    pub plan: Plan,
    pub flight: Flight,
    pub verdict: Verdict,
}

impl Synthetic {
    pub fn new(count: usize, duration_s: f64) -> Self {
        let scenario = scenario(count, duration_s);
        let plan = plan(&scenario, duration_s);
        let flight = flight(&scenario, duration_s);
        Self { verdict: verdict(), scenario, plan, flight }
    }

    pub fn run(&self) -> super::Run<'_> {
        super::Run {
            scenario: &self.scenario,
            plan: &self.plan,
            flight: Some(&self.flight),
            verdict: &self.verdict,
            waterfall: &[],
            ghost: None,
        }
    }

    pub fn trajectory(&mut self, vehicle: usize) -> &mut fixed_wing::Trajectory {
        let Trajectory::FixedWing(trajectory) = &mut self.plan.trajectories[vehicle] else {
            panic!("not a fixed wing")
        };
        trajectory
    }
}

/// The load factors of a sample, to change them.
pub fn factors(sample: &mut Sample) -> &mut Commanded<Control> {
    let Actuation::LoadFactors(factors) = &mut sample.actuation else { panic!("not that of a fixed wing") };
    factors
}

/// Lateral position (amplitude shrinks in the middle, so that neighbours close in) and its rate, m and m/s.
fn lateral(index: usize, count: usize, t_s: f64, duration_s: f64) -> (f64, f64) {
    let lane_m = SPACING_M * (index as f64 - (count - 1) as f64 / 2.0);
    let rate = std::f64::consts::PI / duration_s;
    let (sin, cos) = (rate * t_s).sin_cos();
    let (squeeze, squeeze_rate) = (1.0 - 0.7 * sin * sin, -1.4 * sin * cos * rate);
    (
        lane_m * squeeze + 250.0 * (6.0 * rate * t_s).sin(),
        lane_m * squeeze_rate + 1500.0 * rate * (6.0 * rate * t_s).cos(),
    )
}

fn state(index: usize, count: usize, t_s: f64, duration_s: f64) -> State {
    let (y_m, y_rate) = lateral(index, count, t_s, duration_s);
    let climb = 30.0 / duration_s * (t_s / 15.0).cos();
    let horizontal = SPEED_MPS.hypot(y_rate);
    State {
        x_m: SPEED_MPS * (t_s - duration_s / 2.0),
        y_m,
        z_m: 400.0 + 30.0 * 15.0 / duration_s * (t_s / 15.0).sin(),
        speed_mps: horizontal.hypot(climb),
        heading_rad: y_rate.atan2(SPEED_MPS),
        flight_path_rad: climb.atan2(horizontal),
    }
}

fn scenario(count: usize, duration_s: f64) -> Scenario {
    let waypoint = |index, t_s| {
        let state = state(index, count, t_s, duration_s);
        Waypoint {
            x_m: state.x_m,
            y_m: state.y_m,
            z_m: state.z_m,
            speed_mps: state.speed_mps,
            heading_deg: state.heading_rad.to_degrees(),
            flight_path_deg: state.flight_path_rad.to_degrees(),
            load: None,
        }
    };
    let vehicle = |index| Vehicle {
        name: format!("uav-{}", index + 1),
        model: "scout".to_owned(),
        start: waypoint(index, 0.0),
        goal: waypoint(index, duration_s),
        via: Vec::new(),
    };
    let half_m = (0.55 * SPEED_MPS * duration_s).max(0.6 * SPACING_M * count as f64);
    let cylinder = |k: i32| Cylinder {
        name: format!("threat-{}", k + 3),
        center_m: [f64::from(k) * 1100.0, f64::from(k % 2) * 900.0 + 150.0],
        radius_m: 400.0,
    };
    let map = Map {
        x_m: Range::new(-half_m, half_m),
        y_m: Range::new(-0.6 * half_m, 0.6 * half_m),
        z_m: Range::new(0.0, 600.0),
    };
    Scenario {
        name: "made-up".to_owned(),
        description: "Aircraft in line abreast weave between cylinders and close in on each other half way.".to_owned(),
        tags: Vec::new(),
        world: World { cylinders: (-2..=2).map(cylinder).collect(), ..World::empty(map) },
        models: Models { fixed_wing: [("scout".to_owned(), model())].into(), ..Models::default() },
        vehicles: (0..count).map(vehicle).collect(),
        fleet: FleetRules { separation_m: Some(100.0), simultaneous_arrival: true, ..FleetRules::default() },
        planner: PlannerSettings { name: "by-hand".to_owned(), ..PlannerSettings::default() },
        simulation: Simulation::default(),
        verdict: VerdictLimits::default(),
        requirements: Vec::new(),
    }
}

fn model() -> Model {
    let limits = |margin: f64| Limits {
        altitude_m: Range::new(300.0 - 50.0 * margin, 500.0 + 50.0 * margin),
        speed_mps: Range::new(30.0 - 4.0 * margin, 40.0 + 10.0 * margin),
        flight_path_deg: Range::new(-5.0 - 3.0 * margin, 5.0 + 3.0 * margin),
        n_x: Range::new(-0.2 - 0.1 * margin, 0.2 + 0.1 * margin),
        n_y: Range::new(-0.2 - 0.1 * margin, 0.2 + 0.1 * margin),
        n_z: Range::new(0.8 - 0.1 * margin, 1.2 + 0.1 * margin),
    };
    Model { mass_kg: 20.0, body_radius_m: 1.5, limits: limits(1.0), planning_limits: limits(0.0) }
}

fn plan(scenario: &Scenario, duration_s: f64) -> Plan {
    let count = scenario.vehicles.len();
    let times_s: Vec<f64> = (0..=40).map(|k| duration_s * f64::from(k) / 40.0).collect();
    let trajectory = |(index, vehicle): (usize, &Vehicle)| {
        Trajectory::FixedWing(fixed_wing::Trajectory {
            vehicle: vehicle.name.clone(),
            interpolation: Interpolation::FirstOrderHold,
            states: times_s.iter().map(|t_s| state(index, count, *t_s, duration_s)).collect(),
            controls: times_s.iter().map(|_| Control::CRUISE).collect(),
            times_s: times_s.clone(),
        })
    };
    let iteration = |k: i32| Iteration {
        objective: duration_s + 40.0 * 0.6_f64.powi(k),
        dt_s: duration_s / 40.0,
        defect_m: 300.0 * 0.3_f64.powi(k),
        slack: if k < 8 { 0.5_f64.powi(k) } else { 0.0 },
        separation_m: Some(100.0 - 80.0 * 0.5_f64.powi(k)),
        clearance_m: Some(1.0),
        change_m: 2000.0 * 0.45_f64.powi(k),
        trust_region_m: 4000.0 * 0.7_f64.powi(k),
        solver_iterations: 95 - k as usize,
        unsolved: 0,
        wall_s: 0.01,
        distributed_s: 0.002,
    };
    Plan {
        objective: Some(duration_s),
        history: (0..17).map(iteration).collect(),
        timings: PlanTimings { wall_s: 0.083, distributed_s: 0.021 },
        ..Plan::new(&scenario.name, "by-hand", 42, scenario.vehicles.iter().enumerate().map(trajectory).collect())
    }
}

fn flight(scenario: &Scenario, duration_s: f64) -> Flight {
    let count = scenario.vehicles.len();
    let steps = (duration_s / STEP_S) as usize;
    let log = |(index, vehicle): (usize, &Vehicle)| VehicleLog {
        vehicle: vehicle.name.clone(),
        samples: (0..=steps).map(|k| sample(index, count, k as f64 * STEP_S, duration_s)).collect(),
        loads: Vec::new(),
    };
    Flight {
        step_s: STEP_S,
        plan_end_s: duration_s,
        vehicles: scenario.vehicles.iter().enumerate().map(log).collect(),
        events: vec![
            Event { t_s: 31.0, kind: EventKind::SaturationBegan, vehicles: vec!["uav-1".to_owned()] },
            Event { t_s: 31.9, kind: EventKind::SaturationEnded, vehicles: vec!["uav-1".to_owned()] },
        ],
        planning: None,
        wall_s: 0.1,
    }
}

fn sample(index: usize, count: usize, t_s: f64, duration_s: f64) -> Sample {
    let state = state(index, count, t_s, duration_s);
    let (later, earlier) = (lateral(index, count, t_s + 0.5, duration_s), lateral(index, count, t_s - 0.5, duration_s));
    let n_y = (later.1 - earlier.1) / 9.81;
    let error_m = 1.5 * (t_s / 7.0 + index as f64).sin();
    let position_m = state.position_m();
    let control = Control { n_x: 0.05 * (t_s / 9.0).sin(), n_y, n_z: 1.0 + 0.03 * (t_s / 5.0).cos() };
    Sample {
        t_s,
        position_m: [position_m[0], position_m[1] + error_m, position_m[2]],
        velocity_mps: state.velocity_mps(),
        wind_mps: [0.0; 3],
        world_from_body: attitude(state.heading_rad, -n_y.atan()),
        measured_position_m: position_m,
        measured_velocity_mps: state.velocity_mps(),
        reference_position_m: position_m,
        reference_velocity_mps: state.velocity_mps(),
        actuation: Actuation::LoadFactors(Commanded { command: control, control }),
    }
}

/// Heading about z, then bank about x: quaternion (x, y, z, w).
fn attitude(heading_rad: f64, bank_rad: f64) -> [f64; 4] {
    let ((sz, cz), (sx, cx)) = ((heading_rad / 2.0).sin_cos(), (bank_rad / 2.0).sin_cos());
    [cz * sx, sz * sx, sz * cx, cz * cx]
}

fn verdict() -> Verdict {
    let check = |name: &str, status, value, limit, margin, at_s, between: &[&str]| Check {
        name: name.to_owned(),
        status,
        lower: None,
        upper: None,
        value: Some(value),
        limit: Some(limit),
        margin: Some(margin),
        unit: "m".to_owned(),
        at_s: Some(at_s),
        between: between.iter().map(|name| (*name).to_owned()).collect(),
        advisory: false,
        reason: None,
        limit_key: None,
    };
    let skipped = Check {
        status: Status::Skip,
        value: None,
        limit: None,
        margin: None,
        at_s: None,
        between: Vec::new(),
        reason: Some("no simultaneous arrival asked for".to_owned()),
        ..check("flight.arrival", Status::Pass, 0.0, 0.5, 0.5, 0.0, &[])
    };
    Verdict {
        integration: None,
        outcome: Outcome::Fail,
        overclaimed: true,
        checks: vec![
            check("nodes.separation", Status::Pass, 120.0, 100.0, 20.0, 100.0, &["uav-1", "uav-2"]),
            check("nodes.clearance", Status::Pass, 12.0, 0.0, 12.0, 60.0, &["uav-4", "threat-2"]),
            check("plan.dynamics", Status::Pass, 0.31, 1.0, 0.69, 45.0, &["uav-2"]),
            check("plan.separation", Status::Pass, 118.3, 100.0, 18.3, 100.2, &["uav-1", "uav-2"]),
            check("flight.separation", Status::Pass, 117.9, 100.0, 17.9, 100.0, &["uav-1", "uav-2"]),
            check("flight.clearance", Status::Fail, -37.2, 0.0, -37.2, 43.1, &["uav-4", "threat-2"]),
            check("flight.tracking_max", Status::Pass, 1.5, 5.0, 3.5, 11.0, &["uav-3"]),
            skipped,
        ],
    }
}
