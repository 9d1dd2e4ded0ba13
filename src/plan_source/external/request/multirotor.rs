use scenarios::{Scenario, Vehicle, Waypoint};
use serde_json::{Value, json};

/// A multirotor: its size, its limits, the range of its sensor, start and goal.
pub fn vehicle(scenario: &Scenario, vehicle: &Vehicle) -> Value {
    let model = scenario.multirotor_model(vehicle);
    let state =
        |waypoint: &Waypoint| json!({ "position_m": waypoint.position_m(), "velocity_mps": waypoint.velocity_mps() });
    json!({
        "name": vehicle.name,
        "family": "multirotor",
        "mass_kg": model.mass_kg,
        "body_radius_m": model.body_radius_m,
        "sensor_range_m": model.sensor_range_m,
        "limits": model.limits,
        "planning_limits": model.planning_limits,
        "start": state(&vehicle.start),
        "goal": state(&vehicle.goal),
    })
}
