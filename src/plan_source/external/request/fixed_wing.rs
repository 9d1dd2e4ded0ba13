use scenarios::fixed_wing::Limits;
use scenarios::{Range, Scenario, Vehicle, Waypoint};
use serde_json::{Value, json};

/// A fixed wing. Start and goal are states with the column names of a reply.
pub fn vehicle(scenario: &Scenario, vehicle: &Vehicle) -> Value {
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
        "via": vehicle.via,
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

fn waypoint(waypoint: &Waypoint) -> Value {
    json!(waypoint.fixed_wing_state())
}
