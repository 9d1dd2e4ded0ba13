//! The fields of a scenario file in which the limit of a check stands.

use scenarios::requirement::Requirement;
use scenarios::{LimitField, Scenario, Vehicle, check_spec};

use crate::verdict::{Check, LimitKey};

/// Fields in which the limit may stand, the most specific first. The last ones are in every file.
pub(super) fn candidates(check: &Check, scenario: &Scenario) -> Vec<String> {
    let own = match check_spec(&check.name).map(|spec| spec.limit) {
        Some(LimitField::Fields(fields)) => fields.iter().map(|field| (*field).to_owned()).collect(),
        Some(LimitField::Obstacles) => obstacles(check, scenario),
        Some(LimitField::Gates) => gates(check, scenario),
        Some(LimitField::ModelLimits) => model_limits(check, scenario),
        Some(LimitField::Goal) => goal(check, scenario),
        Some(LimitField::Requirement) => requirement(check, scenario).into_iter().collect(),
        Some(LimitField::None) | None => Vec::new(),
    };
    let fallback = ["verdict", "planner.command", "planner.name"].map(str::to_owned);
    own.into_iter().chain(fallback).collect()
}

/// The obstacles concerned; the map and the ground limit vehicles too.
fn obstacles(check: &Check, scenario: &Scenario) -> Vec<String> {
    let world = &scenario.world;
    let named = world.obstacle_lists().into_iter().flat_map(|(key, names)| match key {
        "terrain" => names
            .iter()
            .any(|name| check.between.iter().any(|it| it == name))
            .then(|| "world.terrain.file".to_owned())
            .into_iter()
            .collect(),
        key => list(key, check, names.into_iter()),
    });
    let bounds = [("ground", "world.ground_m"), ("map frame", "world.map")];
    let bounds = bounds.into_iter().filter(|(name, _)| check.between.iter().any(|concerned| concerned == name));
    named.chain(bounds.map(|(_, field)| field.to_owned())).collect()
}

fn gates(check: &Check, scenario: &Scenario) -> Vec<String> {
    list("gates", check, scenario.world.gates.iter().map(|gate| gate.name.as_str()))
}

/// The formula of the requirement that the check is about, or the via-points.
fn requirement(check: &Check, scenario: &Scenario) -> Option<String> {
    let is_asked = |it: &Requirement| it.check_names().any(|name| name == check.name);
    let stated = scenario.requirements.iter().position(is_asked).map(|index| format!("requirements[{index}].formula"));
    let of_vehicle = |vehicle: &Vehicle| vehicle.via_requirement().is_some_and(|it| is_asked(&it));
    let via = || scenario.vehicles.iter().position(of_vehicle).map(|index| format!("vehicles[{index}].via"));
    stated.or_else(via)
}

fn geofences(check: &Check, scenario: &Scenario) -> Vec<String> {
    list("geofences", check, scenario.world.geofences.iter().map(|fence| fence.name.as_str()))
}

/// The entries of a list of the world that the check names.
fn list<'a>(list: &str, check: &Check, names: impl Iterator<Item = &'a str>) -> Vec<String> {
    let concerned = names.enumerate().filter(|(_, name)| check.between.iter().any(|it| it == name));
    concerned.map(|(index, _)| format!("world.{list}[{index}].name")).collect()
}

/// The limit that decided, then the table in which it stands.
fn model_limits(check: &Check, scenario: &Scenario) -> Vec<String> {
    let table = if check.name.starts_with("nodes.") { "planning_limits" } else { "limits" };
    let mut concerned = scenario.vehicles.iter().filter(|vehicle| check.between.contains(&vehicle.name));
    let family = scenario.family().key();
    let model = concerned.next().map(|vehicle| format!("models.{family}.{}", vehicle.model));
    let limit = match (check.limit_key, &model) {
        (Some(LimitKey::Map(key)), _) => Some(format!("world.map.{key}")),
        (Some(LimitKey::Geofence), _) => geofences(check, scenario).into_iter().next(),
        (Some(LimitKey::Limits(key)), Some(model)) => Some(format!("{model}.{table}.{key}")),
        (Some(LimitKey::Airframe(key)), Some(model)) => Some(format!("{model}.airframe.{key}")),
        _ => None,
    };
    limit.into_iter().chain(model.map(|model| format!("{model}.{table}"))).collect()
}

/// The tolerance, then the goals of the vehicles concerned.
fn goal(check: &Check, scenario: &Scenario) -> Vec<String> {
    let vehicles = scenario.vehicles.iter().enumerate();
    let concerned = vehicles.filter(|(_, vehicle)| check.between.contains(&vehicle.name));
    let goals = concerned.map(|(index, _)| format!("vehicles[{index}].goal"));
    let tolerance = match check.limit_key {
        Some(LimitKey::Verdict(key)) => key,
        _ => "goal_m",
    };
    std::iter::once(format!("verdict.{tolerance}")).chain(goals).collect()
}

#[cfg(test)]
mod tests {
    use std::path::Path;

    use scenarios::{Scenario, check_spec};

    use super::candidates;
    use crate::verdict::{Check, LimitKey, Status};

    fn shipped(name: &str) -> Scenario {
        let path = Path::new(env!("CARGO_MANIFEST_DIR")).join("scenarios").join(name);
        scenarios::load(&path).expect("a shipped scenario loads")
    }

    /// The most specific field of a check that failed between these.
    fn field(name: &str, limit_key: Option<LimitKey>, between: &[&str], scenario: &Scenario) -> String {
        let check = Check {
            name: name.to_owned(),
            status: Status::Fail,
            value: Some(-1.0),
            lower: None,
            upper: None,
            limit: Some(0.0),
            margin: Some(-1.0),
            unit: check_spec(name).expect("a check").unit.to_owned(),
            at_s: None,
            between: between.iter().map(|name| (*name).to_owned()).collect(),
            advisory: false,
            reason: None,
            limit_key,
        };
        candidates(&check, scenario).swap_remove(0)
    }

    #[test]
    fn moving_obstacles_and_the_map_are_found() {
        let scenario = shipped("multirotor/corridor-moving.toml");
        let cart = scenario.world.moving[1].name.clone();
        assert_eq!(field("flight.clearance", None, &["uav-1", &cart], &scenario), "world.moving[1].name");
        assert_eq!(field("flight.crash", None, &["uav-1", &cart], &scenario), "world.moving[1].name");
        assert_eq!(field("flight.clearance", None, &["uav-1", "map frame"], &scenario), "world.map");
    }

    #[test]
    fn gates_and_the_ground_are_found() {
        let scenario = shipped("slung/gate.toml");
        let (gate, vehicle) = (scenario.world.gates[0].name.clone(), scenario.vehicles[0].name.clone());
        for group in ["nodes", "plan", "flight"] {
            let name = format!("{group}.gates");
            assert_eq!(field(&name, None, &[&vehicle, &gate], &scenario), "world.gates[0].name");
        }
        assert_eq!(field("flight.clearance", None, &[&vehicle, "ground"], &scenario), "world.ground_m");
    }

    #[test]
    fn the_limit_that_decided_is_found_whatever_the_reason_says() {
        let fleet = shipped("fixed-wing/rendezvous-7.toml");
        let model = format!("models.fixed-wing.{}", fleet.vehicles[0].model);
        let vehicle = fleet.vehicles[0].name.as_str();
        let limit = |name, key| field(name, Some(key), &[vehicle], &fleet);
        assert_eq!(limit("nodes.control_limits", LimitKey::Limits("n_z")), format!("{model}.planning_limits.n_z"));
        assert_eq!(limit("flight.state_limits", LimitKey::Limits("speed_mps")), format!("{model}.limits.speed_mps"));
        assert_eq!(limit("plan.state_limits", LimitKey::Map("x_m")), "world.map.x_m");
        let multirotor = shipped("multirotor/paper-map-quadrotor.toml");
        let model = format!("models.multirotor.{}", multirotor.vehicles[0].model);
        let vehicle = multirotor.vehicles[0].name.as_str();
        let tilt = field("flight.state_limits", Some(LimitKey::Airframe("tilt_deg")), &[vehicle], &multirotor);
        assert_eq!(tilt, format!("{model}.airframe.tilt_deg"));
    }
}
