//! The request to an external planner: everything that a planner may know, so that it need not read any file.

use scenarios::fixed_wing::{GRAVITY_MPS2, Limits};
use scenarios::{Range, Scenario, Vehicle, Waypoint, World, slung_load};
use serde_json::{Value, json};

use super::PROTOCOL;
use crate::families;

/// The request for a plan. Angles are in radians; disturbances of the flight are left out.
pub(super) fn document(scenario: &Scenario, seed: u64, time_limit_s: f64) -> Value {
    let tell = families::of(scenario.family()).request;
    json!({
        "protocol": PROTOCOL,
        "request": "plan",
        "scenario": scenario.name,
        "seed": seed,
        "time_limit_s": time_limit_s,
        "gravity_mps2": GRAVITY_MPS2,
        "world": world(&scenario.world),
        "vehicles": scenario.vehicles.iter().map(|vehicle| tell(scenario, vehicle)).collect::<Vec<_>>(),
        "fleet": scenario.fleet,
        "verdict": scenario.limits(),
        "envelope_m": scenario.verdict.envelope_m,
        "max_duration_s": scenario.simulation.max_duration_s,
        "options": scenario.planner.options,
    })
}

/// Map, obstacles (boxes as prisms), gates and ground.
pub(super) fn world(world: &World) -> Value {
    json!({
        "map": world.map,
        "cylinders": world.cylinders,
        "prisms": world.prism_obstacles(),
        "moving": world.moving,
        "gates": world.gates,
        "ground_m": world.ground_m,
    })
}

/// A fixed wing: its model, start and goal as states.
pub fn fixed_wing(scenario: &Scenario, vehicle: &Vehicle) -> Value {
    let model = scenario.fixed_wing_model(vehicle);
    json!({
        "name": vehicle.name,
        "family": "fixed-wing",
        "mass_kg": model.mass_kg,
        "body_radius_m": model.body_radius_m,
        "limits": limits(&model.limits),
        "planning_limits": limits(&model.planning_limits),
        "start": waypoint(&vehicle.start),
        "goal": waypoint(&vehicle.goal),
    })
}

/// A slung load: its model as in a scenario file, without the parameters that only disturb a flight; start and goal as states.
pub fn slung_load(scenario: &Scenario, vehicle: &Vehicle) -> Value {
    let model = scenario.slung_load_model(vehicle);
    let mut planner_model = json!(model);
    if let Some(fields) = planner_model.as_object_mut() {
        for disturbance in ["drag_area_m2", "load_drag_area_m2", "rotor_time_constant_s"] {
            fields.remove(disturbance);
        }
    }
    let state = |waypoint: &Waypoint| slung_load::State::at(waypoint, model.cable_length_m);
    json!({
        "name": vehicle.name,
        "family": "slung-load",
        "model": planner_model,
        "start": state(&vehicle.start),
        "goal": state(&vehicle.goal),
    })
}

/// A multirotor: size, limits and sensor range; start and goal as positions and velocities.
pub fn multirotor(scenario: &Scenario, vehicle: &Vehicle) -> Value {
    let model = scenario.multirotor_model(vehicle);
    let state =
        |waypoint: &Waypoint| json!({ "position_m": waypoint.position_m(), "velocity_mps": waypoint.velocity_mps() });
    json!({
        "name": vehicle.name,
        "family": "multirotor",
        "body_radius_m": model.body_radius_m,
        "sensor_range_m": model.sensor_range_m,
        "limits": model.limits,
        "planning_limits": model.planning_limits,
        "start": state(&vehicle.start),
        "goal": state(&vehicle.goal),
    })
}

fn limits(limits: &Limits) -> Value {
    let Limits { altitude_m, speed_mps, flight_path_deg, n_x, n_y, n_z } = limits;
    let flight_path_rad: Range = flight_path_deg.to_radians();
    json!({
        "altitude_m": altitude_m,
        "speed_mps": speed_mps,
        "flight_path_rad": flight_path_rad,
        "n_x": n_x,
        "n_y": n_y,
        "n_z": n_z,
    })
}

/// As a state: the names are those of the columns of a reply.
fn waypoint(waypoint: &Waypoint) -> Value {
    json!(waypoint.fixed_wing_state())
}
