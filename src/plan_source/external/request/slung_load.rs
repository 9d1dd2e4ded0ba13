use scenarios::{Scenario, Vehicle, Waypoint, slung_load};
use serde_json::{Value, json};

/// Parameters of a model that disturb a flight: planners do not know them.
const DISTURBANCES: [&str; 3] = ["drag_area_m2", "load_drag_area_m2", "rotor_time_constant_s"];

/// A quadrotor with a load: its model as in a scenario file, start and goal as states with the load.
pub fn vehicle(scenario: &Scenario, vehicle: &Vehicle) -> Value {
    let model = scenario.slung_load_model(vehicle);
    let mut known = json!(model);
    if let Some(known) = known.as_object_mut() {
        known.retain(|name, _| !DISTURBANCES.contains(&name.as_str()));
    }
    let state = |waypoint: &Waypoint| slung_load::State::at(waypoint, model.cable_length_m);
    json!({
        "name": vehicle.name,
        "family": "slung-load",
        "model": known,
        "start": state(&vehicle.start),
        "goal": state(&vehicle.goal),
        "via": vehicle.via,
    })
}
