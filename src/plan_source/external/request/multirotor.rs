use scenarios::multirotor::Model;
use scenarios::{Scenario, Vehicle, Waypoint};
use serde_json::{Value, json};

/// Parameters of an airframe that disturb a flight: planners do not know them.
const DISTURBANCES: [&str; 1] = ["rotor_time_constant_s"];

/// A multirotor: its plant, its size, its limits, the range of its sensor, start and goal.
pub fn vehicle(scenario: &Scenario, vehicle: &Vehicle) -> Value {
    let model = scenario.multirotor_model(vehicle);
    let state =
        |waypoint: &Waypoint| json!({ "position_m": waypoint.position_m(), "velocity_mps": waypoint.velocity_mps() });
    json!({
        "name": vehicle.name,
        "family": "multirotor",
        "plant": model.plant,
        "mass_kg": model.mass_kg,
        "body_radius_m": model.body_radius_m,
        "sensor_range_m": model.sensor_range_m,
        "limits": model.limits,
        "planning_limits": model.planning_limits,
        "airframe": airframe(model),
        "start": state(&vehicle.start),
        "goal": state(&vehicle.goal),
        "via": vehicle.via,
    })
}

/// Inertia and rotors; `null` for a point mass.
fn airframe(model: &Model) -> Value {
    let mut known = json!(model.airframe);
    if let Some(known) = known.as_object_mut() {
        known.retain(|name, _| !DISTURBANCES.contains(&name.as_str()));
    }
    known
}
