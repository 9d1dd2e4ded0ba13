//! Which field of the scenario file a check is held against.

use scenarios::Scenario;

use crate::verdict::Check;

/// Fields that the check's limit may stand in, the likeliest first; the last ones are always in the file.
pub(super) fn candidates(check: &Check, scenario: &Scenario) -> Vec<String> {
    let own = match check.question() {
        "separation" => vec!["fleet.separation_m".to_owned()],
        "clearance" | "crash" => obstacles(check, scenario),
        "envelope" => vec!["verdict.envelope_m".to_owned()],
        "state_limits" | "control_limits" | "swing" | "tension" => limits(check, scenario),
        "rest" => vec!["verdict.rest_mps".to_owned()],
        "slack" => vec!["verdict.switch_s".to_owned()],
        "goal" => [vec!["verdict.goal_m".to_owned()], vehicle_fields(check, scenario, ".goal")].concat(),
        "arrival" => vec!["verdict.arrival_spread_s".to_owned(), "fleet.simultaneous_arrival".to_owned()],
        "duration" => vec!["simulation.max_duration_s".to_owned()],
        "tracking_rms" => vec!["verdict.tracking_rms_m".to_owned()],
        "tracking_max" => vec!["verdict.tracking_max_m".to_owned()],
        "dynamics" => vec!["verdict.dynamics_m".to_owned()],
        "rollout" => vec!["verdict.rollout_m".to_owned()],
        "saturation" => vec!["verdict.saturation".to_owned()],
        _ => Vec::new(),
    };
    let last = ["verdict", "planner.command", "planner.name"].map(str::to_owned);
    own.into_iter().chain(last).collect()
}

fn obstacles(check: &Check, scenario: &Scenario) -> Vec<String> {
    let world = &scenario.world;
    let kinds: [(&str, Vec<&String>); 3] = [
        ("cylinders", world.cylinders.iter().map(|cylinder| &cylinder.name).collect()),
        ("boxes", world.boxes.iter().map(|block| &block.name).collect()),
        ("prisms", world.prisms.iter().map(|prism| &prism.name).collect()),
    ];
    let all = kinds.into_iter().flat_map(|(kind, names)| {
        names.into_iter().enumerate().map(move |(index, name)| (format!("world.{kind}[{index}].name"), name))
    });
    all.filter(|(_, name)| check.between.contains(name)).map(|(field, _)| field).collect()
}

/// The limits of the model of the vehicle concerned; the remark of such a check begins with the name of the quantity.
fn limits(check: &Check, scenario: &Scenario) -> Vec<String> {
    const KEYS: [(&str, &str); 12] = [
        ("altitude", "altitude_m"),
        ("speed", "speed_mps"),
        ("flight-path angle", "flight_path_deg"),
        ("n_x", "n_x"),
        ("n_y", "n_y"),
        ("n_z", "n_z"),
        ("thrust", "thrust_n"),
        ("roll", "attitude_deg"),
        ("pitch", "attitude_deg"),
        ("yaw", "attitude_deg"),
        ("cable angle", "cable_deg"),
        ("tension", "tension_n"),
    ];
    const MAP: [(&str, &str); 3] = [("x", "world.map.x_m"), ("y", "world.map.y_m"), ("z", "world.map.z_m")];
    let remark = check.reason.as_deref().unwrap_or_default();
    let is_about = |name: &str| remark.strip_prefix(name).is_some_and(|rest| rest.starts_with(' '));
    let table = if check.name.starts_with("nodes.") { "planning_limits" } else { "limits" };
    let key = KEYS.iter().find(|(name, _)| is_about(name)).map(|(_, key)| *key);
    let vehicles = scenario.vehicles.iter().filter(|vehicle| check.between.contains(&vehicle.name));
    let family = scenario.family().key();
    let model = vehicles.map(|vehicle| format!("models.{family}.{}.{table}", vehicle.model)).next();
    let on_map = MAP.iter().find(|(name, _)| is_about(name)).map(|(_, field)| (*field).to_owned());
    let of_model =
        model.into_iter().flat_map(|model| key.map(|key| format!("{model}.{key}")).into_iter().chain([model]));
    on_map.into_iter().chain(of_model).collect()
}

fn vehicle_fields(check: &Check, scenario: &Scenario, field: &str) -> Vec<String> {
    let vehicles = scenario.vehicles.iter().enumerate();
    let concerned = vehicles.filter(|(_, vehicle)| check.between.contains(&vehicle.name));
    concerned.map(|(index, _)| format!("vehicles[{index}]{field}")).collect()
}
