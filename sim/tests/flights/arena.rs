//! Small scenarios and plans, built in code.

use std::collections::BTreeMap;

use nalgebra::Vector3;
use scenarios::fixed_wing::{Control, Limits, Model, State, Trajectory};
use scenarios::{
    Cylinder, FleetRules, Interpolation, Map, Models, Plan, PlannerSettings, Range, Scenario, Simulation, Vehicle,
    VerdictLimits, Waypoint, World,
};
use sim::Sample;

pub const G: f64 = 9.81;

/// Radius of every aircraft, m.
pub const BODY_RADIUS_M: f64 = 1.5;

/// Mass of every aircraft, kg.
const MASS_KG: f64 = 13.0;

/// A wide empty map, for vehicles `uav-1`, `uav-2`, ... that fly the trajectories.
pub fn scenario(vehicles: usize) -> Scenario {
    let wide = Range::new(-20_000.0, 20_000.0);
    Scenario {
        name: "arena".into(),
        description: "Built in code.".into(),
        tags: vec![],
        world: World::empty(Map { x_m: wide, y_m: wide, z_m: Range::new(0.0, 2000.0) }),
        models: Models { fixed_wing: BTreeMap::from([("plane".into(), model())]), ..Models::default() },
        vehicles: (1..=vehicles).map(vehicle).collect(),
        fleet: FleetRules::default(),
        planner: PlannerSettings::default(),
        simulation: Simulation::default(),
        verdict: VerdictLimits::default(),
        requirements: Vec::new(),
    }
}

fn model() -> Model {
    let limits = Limits {
        altitude_m: Range::new(50.0, 1500.0),
        speed_mps: Range::new(20.0, 55.0),
        flight_path_deg: Range::new(-20.0, 20.0),
        n_x: Range::new(-0.4, 0.4),
        n_y: Range::new(-0.5, 0.5),
        n_z: Range::new(0.5, 1.6),
    };
    Model { mass_kg: MASS_KG, body_radius_m: BODY_RADIUS_M, limits: limits.clone(), planning_limits: limits }
}

fn vehicle(number: usize) -> Vehicle {
    let nowhere = Waypoint { speed_mps: 35.0, ..Waypoint::at_rest([0.0, 0.0, 400.0]) };
    Vehicle { name: format!("uav-{number}"), model: "plane".into(), start: nowhere, goal: nowhere, via: Vec::new() }
}

pub fn cylinder(name: &str, x_m: f64, y_m: f64, radius_m: f64) -> Cylinder {
    Cylinder { name: name.into(), center_m: [x_m, y_m], radius_m }
}

/// A plan of these trajectories, which are named in their order.
pub fn plan(mut trajectories: Vec<Trajectory>) -> Plan {
    for (index, trajectory) in trajectories.iter_mut().enumerate() {
        trajectory.vehicle = format!("uav-{}", index + 1);
    }
    Plan::new("arena", "by-hand", 0, trajectories.into_iter().map(Into::into).collect())
}

/// Level at 400 m.
pub fn level(x_m: f64, y_m: f64, speed_mps: f64, heading_deg: f64) -> State {
    State { x_m, y_m, z_m: 400.0, speed_mps, heading_rad: heading_deg.to_radians(), flight_path_rad: 0.0 }
}

/// Straight and level flight from `start`, with nodes every 5 s.
pub fn straight(start: State, duration_s: f64) -> Trajectory {
    let intervals = (duration_s / 5.0).ceil().max(1.0);
    let times_s: Vec<f64> = (0..=intervals as usize).map(|node| duration_s * node as f64 / intervals).collect();
    let [v_x, v_y, _] = start.velocity_mps();
    let at = |t_s: &f64| State { x_m: start.x_m + v_x * t_s, y_m: start.y_m + v_y * t_s, ..start };
    Trajectory {
        vehicle: String::new(),
        interpolation: Interpolation::FirstOrderHold,
        states: times_s.iter().map(at).collect(),
        controls: vec![Control::CRUISE; times_s.len()],
        times_s,
    }
}

/// Constant load factors from `start`. The states after the first are placeholders.
pub fn constant_controls(start: State, control: Control, duration_s: f64) -> Trajectory {
    Trajectory {
        vehicle: String::new(),
        interpolation: Interpolation::FirstOrderHold,
        times_s: vec![0.0, duration_s],
        states: vec![start; 2],
        controls: vec![control; 2],
    }
}

/// Turns, climbs and changes of speed for 230 s, with 5 s between the nodes: a consistent plan with states from the
/// polar equations. Each control counteracts the climb and the speed error of the node before, so that both stay
/// bounded.
pub fn manoeuvres() -> Trajectory {
    let times_s: Vec<f64> = (0..=46).map(|node| 5.0 * f64::from(node)).collect();
    let control = |t_s: f64, state: &State| Control {
        n_x: state.flight_path_rad.sin() + 0.05 * (0.11 * t_s).sin() + 0.01 * (35.0 - state.speed_mps),
        n_y: 0.2 * (0.07 * t_s + 0.4).sin(),
        n_z: 1.0 + 0.03 * (0.19 * t_s).cos() - 0.3 * state.flight_path_rad,
    };
    let mut states = vec![level(0.0, 0.0, 35.0, 20.0)];
    let mut controls = vec![control(0.0, &states[0])];
    for (node, times) in times_s.windows(2).enumerate() {
        controls.push(control(times[1], &states[node]));
        let ends = [controls[node], controls[node + 1]];
        states.push(crate::polar::integrate(&states[node], ends, times[1] - times[0]));
    }
    Trajectory { vehicle: String::new(), interpolation: Interpolation::FirstOrderHold, times_s, states, controls }
}

/// Ignores the progress.
pub fn silent(_: f64) {}

pub fn position(sample: &Sample) -> Vector3<f64> {
    sample.position_m.into()
}

pub fn velocity(sample: &Sample) -> Vector3<f64> {
    sample.velocity_mps.into()
}

/// Distance from the plan, m.
pub fn tracking_error_m(sample: &Sample) -> f64 {
    (position(sample) - Vector3::from(sample.reference_position_m)).norm()
}
