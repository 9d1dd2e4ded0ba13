//! Validation of multirotor scenarios.

use scenarios::{Scenario, parse};

const TEXT: &str = r#"name = "quad"
description = "Past a box and a cart."

[world]
map = { x_m = [-4, 14], y_m = [-4, 4], z_m = [0, 4] }
hidden = ["box"]

[[world.boxes]]
name = "box"
center_m = [4, 0]
size_m = [1, 1]

[[world.moving]]
name = "cart"
radius_m = 0.5
path_m = [[6, -3], [6, 3]]
speed_mps = 0.5

[models.multirotor.quad]
plant = "point-mass"
mass_kg = 1.5
body_radius_m = 0.35
sensor_range_m = 6
limits = { speed_mps = 4, acceleration_mps2 = 4 }
planning_limits = { speed_mps = 3, acceleration_mps2 = 3 }

[[vehicles]]
name = "uav-1"
model = "quad"
start = { x_m = 0, y_m = 0, z_m = 2 }
goal = { x_m = 10, y_m = 0, z_m = 2 }

[planner]
name = "any"

[simulation]
planning = { period_s = 0.25, deadline_s = 0.1 }
"#;

fn scenario() -> Scenario {
    parse("quad.toml", TEXT).expect("a valid scenario")
}

/// Asserts that the changed text has a single issue with this field, found and expected value.
#[track_caller]
fn assert_issue(old: &str, new: &str, field: &str, found: &str, expected: &str) {
    assert!(TEXT.contains(old), "{old}");
    let error = parse("quad.toml", &TEXT.replace(old, new)).expect_err("the change should be rejected");
    let [issue] = error.issues() else { panic!("expected one issue, found {:#?}", error.issues()) };
    assert_eq!(issue.issue.field, field, "{issue}");
    assert!(issue.issue.found.contains(found) && issue.issue.expected.contains(expected), "{issue}");
}

#[test]
fn the_sensor_range_must_suffice_to_stop() {
    // 1.5 m to brake, 3 m/s for 0.35 s, 0.5 m/s of the cart for 1.35 s, and the body radius: 3.575 m.
    let field = "models.multirotor.quad.sensor_range_m";
    assert_issue("sensor_range_m = 6", "sensor_range_m = 3.57", field, "3.57", "3.575 m or more");
    assert!(parse("quad.toml", &TEXT.replace("sensor_range_m = 6", "sensor_range_m = 3.58")).is_ok());
}

#[test]
fn the_whole_body_must_be_clear_at_start_and_goal() {
    assert_issue("x_m = 0, y_m = 0", "x_m = 3.2, y_m = 0", "vehicles[0].start", "0.300 m from `box`", "0.35 m");
    assert_issue("x_m = 0, y_m = 0", "x_m = -3.8, y_m = 0", "vehicles[0].start.x_m", "-3.8", "0.35 m, the body");
    assert_issue("x_m = 0, y_m = 0", "x_m = 6, y_m = -2.5", "vehicles[0].start", "0.000 m from `cart`", "0.35 m");
    assert_issue("x_m = 10, y_m = 0", "x_m = 15, y_m = 0", "vehicles[0].goal.x_m", "15", "the map");
    assert_issue("x_m = 10,", "speed_mps = 1, x_m = 10,", "vehicles[0].goal.speed_mps", "1", "0");
}

#[test]
fn hidden_and_moving_obstacles_are_validated() {
    assert_issue("hidden = [\"box\"]", "hidden = [\"bux\"]", "world.hidden[0]", "bux", "the name of a cylinder");
    assert_issue("hidden = [\"box\"]", "hidden = [\"cart\"]", "world.hidden[0]", "cart", "the name of a cylinder");
    assert_issue("[[6, -3], [6, 3]]", "[[6, -3]]", "world.moving[0].path_m", "1 corners", "two corners");
    assert_issue("name = \"cart\"", "name = \"box\"", "world.moving[0].name", "box", "a unique name");
}

#[test]
fn a_quadrotor_needs_an_airframe_and_recorded_planning_needs_times() {
    let field = "models.multirotor.quad.airframe";
    assert_issue("plant = \"point-mass\"", "plant = \"quadrotor\"", field, "nothing", "a table");
    let field = "simulation.planning.recorded_s";
    assert_issue("deadline_s = 0.1", "deadline_s = 0.1, time = \"recorded\"", field, "none", "planning times");
}

#[test]
fn the_planner_view_has_no_unknown_obstacles_and_no_disturbances() {
    let mut scenario = scenario();
    scenario.simulation.sensors.position_noise_m = 0.1;
    scenario.simulation.mismatch.mass_ratio = 1.1;
    let view = scenario.planner_view();
    assert_eq!(view.world.obstacle_names().count(), 0);
    assert!(view.world.hidden.is_empty());
    assert_eq!(view.simulation.sensors, scenarios::Sensors::default());
    assert_eq!(view.simulation.mismatch, scenarios::Mismatch::default());
    scenario.world.hidden.clear();
    assert_eq!(scenario.planner_view().world.obstacle_names().collect::<Vec<_>>(), ["box"]);
    assert!(scenario.is_planar());
}

#[test]
fn multirotors_may_start_above_each_other_and_fixed_wings_may_not() {
    let second = "\n[[vehicles]]\nname = \"uav-2\"\nmodel = \"quad\"\nstart = { x_m = 0, y_m = 0, z_m = HIGH }\n\
                  goal = { x_m = 10, y_m = 0, z_m = HIGH }\n\n[fleet]\nseparation_m = 1.5\n\n[planner]";
    let stacked = |high: &str| parse("quad.toml", &TEXT.replace("\n[planner]", &second.replace("HIGH", high)));
    assert!(stacked("3.5").is_ok(), "{:?}", stacked("3.5").err());
    let error = stacked("3.4").expect_err("0.1 m too close").to_string();
    assert!(!error.is_empty());
    let shaped = |rule: &str| {
        let text = TEXT.replace("\n[planner]", &second.replace("HIGH", "3.5").replace("separation_m = 1.5", rule));
        parse("quad.toml", &text).map_err(|error| error.to_string())
    };
    let cylinder = "separation_m = 9\nseparation_shape = \"cylinder\"\nseparation_height_m =";
    assert!(shaped(&format!("{cylinder} 1.5")).is_ok());
    assert!(shaped(&format!("{cylinder} 1.6")).is_err());
    assert!(shaped("separation_m = 1\nseparation_shape = \"horizontal\"").is_err());
    assert!(shaped("separation_volume = \"nmac\"").is_err());
}

#[test]
fn via_points_are_on_the_map_clear_of_obstacles_and_in_order_of_time() {
    let rejects = |via: &str, field: &str, found: &str| {
        let goal = "goal = { x_m = 10, y_m = 0, z_m = 2 }";
        let with_via = format!("{goal}\nvia = [{{ x_m = 8, y_m = 2, z_m = 2, radius_m = 0.5 }}, {{ {via} }}]");
        assert_issue(goal, &with_via, &format!("vehicles[0].via[1]{field}"), found, "");
    };
    rejects("x_m = 80, y_m = 2, z_m = 2, radius_m = 0.5", ".x_m", "80");
    rejects("x_m = 4, y_m = 0, z_m = 2, radius_m = 0.5", "", "box");
    rejects("x_m = 8, y_m = 2, z_m = 2, radius_m = 0", ".radius_m", "0");
    rejects("x_m = 8, y_m = 2, z_m = 2, radius_m = 0.5, window_s = [9, 4]", ".window_s", "[9, 4]");
    rejects("x_m = 8, y_m = 2, z_m = 2, radius_m = 0.5, window_s = [-1, 4]", ".window_s", "-1");
}

#[test]
fn a_separation_rule_is_stated_once_and_completely() {
    for (rule, field, expected) in [
        ("separation_shape = \"cylinder\"", "fleet.separation_shape", "`fleet.separation_m` beside it"),
        ("separation_m = 1\nseparation_shape = \"ellipsoid\"", "fleet.separation_shape", "`fleet.separation_height_m`"),
        ("separation_m = 1\nseparation_height_m = 2", "fleet.separation_height_m", "only cylinders and ellipsoids"),
        (
            "separation_m = 1\nseparation_shape = \"cylinder\"\nseparation_height_m = 0",
            "fleet.separation_height_m",
            "greater than 0",
        ),
        (
            "separation_m = 1\nseparation_volume = \"nmac\"",
            "fleet.separation_m",
            "no such key beside `separation_volume`",
        ),
    ] {
        let rule = format!("\n[fleet]\n{rule}\n\n[planner]");
        assert_issue("\n[planner]", &rule, field, "", expected);
    }
}

#[test]
fn parameters_of_a_search_have_ranges_and_so_has_its_size() {
    let rejects = |options: &str, field: &str, found: &str, expected: &str| {
        let planner = format!("name = \"any\"\n\n[planner.horizon]\n{options}");
        assert_issue("name = \"any\"", &planner, &format!("planner.horizon.{field}"), found, expected);
    };
    rejects("swarm = { cognitive = -1 }", "swarm.cognitive", "-1", "0 or more");
    rejects("swarm = { social = -1 }", "swarm.social", "-1", "0 or more");
    rejects("swarm = { inertia_max = 0.3 }", "swarm.inertia_min", "0.4", "0.3, inertia_max, or less");
    rejects("swarm = { velocity_fraction = 0 }", "swarm.velocity_fraction", "0", "greater than 0 and at most 1");
    rejects("violation_weights = { speed = 0 }", "violation_weights.speed", "0", "greater than 0");
    rejects("stage_weight = -1", "stage_weight", "-1", "0 or more");
    rejects("steps = 101", "steps", "101", "from 1 to 100");
    let huge = "steps = 100\nparticles = 10000\niterations = 101";
    rejects(huge, "iterations", "101 iterations of 10000 particles over 100 steps", "at most 100000000");
    let largest = huge.replace("101", "100");
    let text = TEXT.replace("name = \"any\"", &format!("name = \"any\"\n\n[planner.horizon]\n{largest}"));
    assert!(parse("quad.toml", &text).is_ok());
}
