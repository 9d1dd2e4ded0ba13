//! The question, with everything in it that a planner may know: no file has to be read, no model to be looked up.

use scenarios::fixed_wing::{self, GRAVITY_MPS2, Limits};
use scenarios::{Family, Range, Scenario, Vehicle, Waypoint, World};
use scenarios::{multirotor, slung_load};
use serde_json::{Value, json};

use super::PROTOCOL;

/// The request for a plan. Angles are in radians; how the plan will be disturbed in flight is not told.
pub(super) fn document(scenario: &Scenario, seed: u64, time_limit_s: f64) -> Value {
    json!({
        "protocol": PROTOCOL,
        "request": "plan",
        "scenario": scenario.name,
        "seed": seed,
        "time_limit_s": time_limit_s,
        "gravity_mps2": GRAVITY_MPS2,
        "world": world(&scenario.world),
        "vehicles": scenario.vehicles.iter().map(|own| vehicle(scenario, own)).collect::<Vec<_>>(),
        "fleet": scenario.fleet,
        "verdict": scenario.limits(),
        "envelope_m": scenario.verdict.envelope_m,
        "max_duration_s": scenario.simulation.max_duration_s,
        "options": scenario.planner.options,
    })
}

/// Map and obstacles, the boxes as prisms.
pub(super) fn world(world: &World) -> Value {
    json!({
        "map": world.map,
        "cylinders": world.cylinders,
        "prisms": world.prism_obstacles(),
        "ground_m": world.ground_m,
    })
}

fn vehicle(scenario: &Scenario, vehicle: &Vehicle) -> Value {
    match scenario.family() {
        Family::FixedWing => fixed_wing(vehicle, scenario.fixed_wing_model(vehicle)),
        Family::SlungLoad => slung_load(vehicle, scenario.slung_load_model(vehicle)),
        Family::Multirotor => multirotor(vehicle, scenario.multirotor_model(vehicle)),
    }
}

fn fixed_wing(vehicle: &Vehicle, model: &fixed_wing::Model) -> Value {
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

/// The model as in a scenario file, without what disturbs a flight; start and goal as states.
fn slung_load(vehicle: &Vehicle, model: &slung_load::Model) -> Value {
    let mut told = json!(model);
    if let Some(told) = told.as_object_mut() {
        for disturbance in ["drag_area_m2", "load_drag_area_m2", "rotor_time_constant_s"] {
            told.remove(disturbance);
        }
    }
    let state = |waypoint: &Waypoint| slung_load::State::at(waypoint, model.cable_length_m);
    json!({
        "name": vehicle.name,
        "family": "slung-load",
        "model": told,
        "start": state(&vehicle.start),
        "goal": state(&vehicle.goal),
    })
}

/// What a planner may know: how large, how fast, how far it sees.
fn multirotor(vehicle: &Vehicle, model: &multirotor::Model) -> Value {
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
