//! Validation of slung-load scenarios.

const TEXT: &str = r#"name = "slung"
description = "A load round a box."

[world]
map = { x_m = [-4, 4], y_m = [-4, 4], z_m = [-1, 4] }
ground_m = 0

[[world.boxes]]
name = "box"
center_m = [0, 0]
size_m = [1, 1]

[[world.prisms]]
name = "wedge"
corners_m = [[0, 2], [1, 2], [0, 3]]
z_m = [0, 1]

[[world.gates]]
name = "high"
quadrotor = { x_m = [-1, 1], z_m = [0.5, 1] }
load = { z_m = [1.2, 2] }

[models.slung-load.quad]
mass_kg = 1.32
drag_area_m2 = 0.02
inertia_kgm2 = [0.018, 0.018, 0.026]
arm_m = 0.225
torque_per_thrust_m = 0.016
propeller_radius_m = 0.127
load_mass_kg = 0.2
load_radius_m = 0.03
cable_length_m = 0.65
limits = { thrust_n = [0, 7], attitude_deg = [-60, 60], cable_deg = [-80, 80], tension_n = 40 }
planning_limits = { thrust_n = [1, 5], attitude_deg = [-45, 45], cable_deg = [-60, 60], tension_n = 20 }

[[vehicles]]
name = "carrier"
model = "quad"
start = { x_m = -2, y_m = 0, z_m = 0.5, load = { x_m = -2, y_m = 0, z_m = 0.03 } }
goal = { x_m = 2, y_m = 0, z_m = 1.5 }

[planner]
name = "any"
collocation = { objective = "effort", flight_time_s = 4, segments = 10, points = 4, cable = ["slack", "taut"] }

[simulation]
wind = { mean_mps = [0, 0, 0], pulses = [{ start_s = 1, duration_s = 1, peak_mps = [3, 0, 0] }] }
sensors = { attitude_noise_deg = 0.1 }
mismatch = { load_mass_ratio = 1.05 }
"#;

/// Asserts that the changed text has a single issue with this field, found and expected value.
#[track_caller]
fn assert_issue(old: &str, new: &str, field: &str, found: &str, expected: &str) {
    assert!(TEXT.contains(old), "no `{old}`");
    let error = scenarios::parse("slung.toml", &TEXT.replace(old, new)).expect_err("the change should be rejected");
    let [issue] = error.issues() else { panic!("expected one issue, found {:#?}", error.issues()) };
    assert_eq!(issue.issue.field, field, "{issue}");
    assert!(issue.issue.found.contains(found) && issue.issue.expected.contains(expected), "{issue}");
    assert!(issue.line > 0);
}

#[test]
fn the_scenario_is_valid_and_has_the_limits_of_its_family() {
    let scenario = scenarios::parse("slung.toml", TEXT).unwrap();
    assert_eq!(scenario.family(), scenarios::Family::SlungLoad);
    assert_eq!((scenario.limits().tracking_max_m, scenario.limits().switch_s), (0.05, 0.02));
    assert_eq!(scenario.world.prism_obstacles().len(), 2);
    let text = toml::to_string(&scenario).unwrap();
    assert_eq!(scenarios::parse("slung.toml", &text).unwrap(), scenario);
}

#[test]
fn obstacles_are_convex_and_have_unique_names() {
    let dented = "[[0, 2], [1, 2], [0.1, 2.1], [0, 3]]";
    assert_issue("[[0, 2], [1, 2], [0, 3]]", dented, "world.prisms[0].corners_m", "4 corners", "convex polygon");
    assert_issue("\"wedge\"", "\"box\"", "world.prisms[0].name", "box", "world.boxes has the same");
    assert_issue("size_m = [1, 1]", "size_m = [1, 0]", "world.boxes[0].size_m[1]", "0", "greater than 0");
    assert_issue("z_m = [0, 1]", "z_m = [1, 0]", "world.prisms[0].z_m", "[1, 0]", "min below max");
}

#[test]
fn complementarity_has_no_phases() {
    let (phases, cable) = ("cable = [\"slack\", \"taut\"]", "planner.collocation.cable");
    let both = format!("{phases}, formulation = \"complementarity\"");
    assert_issue(phases, &both, cable, "phases", "none");
    let alone = TEXT.replace(phases, "formulation = \"complementarity\"");
    let scenario = scenarios::parse("slung.toml", &alone).expect("a valid formulation");
    let settings = scenario.planner.collocation.expect("settings of the collocation");
    assert_eq!(settings.formulation, Some(scenarios::Formulation::Complementarity));
}

#[test]
fn gate_windows_have_ordered_faces() {
    let scenario = scenarios::parse("slung.toml", TEXT).unwrap();
    assert_eq!(scenario.world.gates[0].load.z_m, Some(scenarios::Range::new(1.2, 2.0)));
    assert_issue("z_m = [1.2, 2]", "z_m = [2, 1.2]", "world.gates[0].load.z_m", "[2, 1.2]", "min below max");
    assert_issue("\"high\"", "\"hi gh\"", "world.gates[0].name", "hi gh", "letters, digits");
}

#[test]
fn the_load_is_within_the_cable_length_above_the_ground_and_outside_obstacles() {
    let start = "load = { x_m = -2, y_m = 0, z_m = 0.03 }";
    assert_issue(
        start,
        "load = { x_m = -2.7, y_m = 0, z_m = 0.4 }",
        "vehicles[0].start.load",
        "0.7071 m",
        "at most 0.65 m",
    );
    assert_issue(start, "load = { x_m = -2, y_m = 0, z_m = 0 }", "vehicles[0].start.load", "at 0 m", "at least 0.03 m");
    assert_issue(
        "x_m = 2, y_m = 0, z_m = 1.5",
        "x_m = 0.2, y_m = 2.2, z_m = 1.5",
        "vehicles[0].goal.load",
        "wedge",
        "outside",
    );
}

#[test]
fn the_load_does_not_overlap_the_body() {
    let (start, field) = ("load = { x_m = -2, y_m = 0, z_m = 0.03 }", "vehicles[0].start.load");
    let inside = "load = { x_m = -1.9, y_m = 0.1, z_m = 0.475 }";
    assert_issue(start, inside, field, "overlaps the body of the quadrotor by 0.0050 m", "at least 0.03 m");
    assert_issue(start, &inside.replace("0.475", "0.52"), field, "by 0.0100 m", "at least 0.03 m");
    for beside in [inside.replace("0.475", "0.469"), inside.replace("-1.9", "-1.61")] {
        assert!(scenarios::parse("slung.toml", &TEXT.replace(start, &beside)).is_ok(), "{beside}");
    }
}

#[test]
fn a_taut_cable_does_not_begin_or_end_in_an_obstacle() {
    let with_bar = |y_m: f64| {
        let place = format!("center_m = [2, {y_m}]\nsize_m = [0.02, 0.5]\nz_m = [1.1, 1.12]\n");
        scenarios::parse("slung.toml", &format!("{TEXT}\n[[world.boxes]]\nname = \"bar\"\n{place}"))
    };
    let lines = with_bar(0.2).expect_err("a bar in the cable").lines();
    let issue = "vehicles[0].goal.load: found a cable that passes through `bar`";
    assert!(lines.iter().any(|line| line.contains(issue)), "{lines:?}");
    assert!(with_bar(0.2499).is_err());
    assert!(with_bar(0.2501).is_ok());
}

#[test]
fn models_can_hover_and_rotors_cannot_pull_down() {
    let planning = "models.slung-load.quad.planning_limits.thrust_n";
    assert_issue("thrust_n = [1, 5]", "thrust_n = [1, 3]", planning, "[1, 3]", "contains 3.728 N");
    let limits = "models.slung-load.quad.limits.thrust_n";
    assert_issue("thrust_n = [0, 7]", "thrust_n = [-1, 7]", limits, "[-1, 7]", "rotors cannot pull down");
    assert_issue(
        "attitude_deg = [-45, 45]",
        "attitude_deg = [-65, 45]",
        "models.slung-load.quad.planning_limits.attitude_deg",
        "[-65, 45]",
        "inside",
    );
    assert_issue(
        "load_mass_kg = 0.2",
        "load_mass_kg = 0",
        "models.slung-load.quad.load_mass_kg",
        "0",
        "greater than 0",
    );
}

#[test]
fn a_slung_load_flies_alone_among_boxes_and_prisms() {
    let two = "[[vehicles]]\nname = \"other\"\nmodel = \"quad\"\nstart = { x_m = 2, y_m = 3, z_m = 1 }\n\
               goal = { x_m = 2, y_m = -3, z_m = 1 }\n\n[planner]";
    assert_issue("[planner]", two, "vehicles", "2 of them", "fly alone");
    let pillar =
        "[[world.cylinders]]\nname = \"pillar\"\ncenter_m = [3, 3]\nradius_m = 0.1\n\n[models.slung-load.quad]";
    assert_issue("[models.slung-load.quad]", pillar, "world.cylinders", "1 of them", "among boxes and prisms");
}

#[test]
fn disturbances_and_options_are_in_range() {
    assert_issue("duration_s = 1,", "duration_s = 0,", "simulation.wind.pulses[0].duration_s", "0", "greater than 0");
    assert_issue(
        "attitude_noise_deg = 0.1",
        "attitude_noise_deg = -1",
        "simulation.sensors.attitude_noise_deg",
        "-1",
        "0 or more",
    );
    assert_issue(
        "load_mass_ratio = 1.05",
        "load_mass_ratio = 0",
        "simulation.mismatch.load_mass_ratio",
        "0",
        "greater than 0",
    );
    assert_issue("flight_time_s = 4, ", "", "planner.collocation.flight_time_s", "nothing", "a duration");
    assert_issue("points = 4", "points = 1", "planner.collocation.points", "1", "from 2 to 20");
}

#[test]
fn the_flight_time_is_within_the_simulated_duration() {
    for time in ["1e6", "601", "1e-6"] {
        let options = format!("flight_time_s = {time}, ");
        assert_issue("flight_time_s = 4, ", &options, "planner.collocation.flight_time_s", " s", "max_duration_s");
    }
}

#[test]
fn a_gate_has_a_face() {
    let gate = "quadrotor = { x_m = [-1, 1], z_m = [0.5, 1] }\nload = { z_m = [1.2, 2] }";
    assert_issue(
        gate,
        "quadrotor = {}\nload = {}",
        "world.gates[0]",
        "without a face",
        "at least one of x_m, y_m, z_m",
    );
}

#[test]
fn a_start_at_which_a_rotor_or_the_load_touches_an_obstacle_is_refused() {
    let start = "x_m = -2, y_m = 0, z_m = 0.5, load = { x_m = -2, y_m = 0, z_m = 0.03 }";
    let beside = "x_m = -0.8, y_m = 0, z_m = 0.5, load = { x_m = -0.8, y_m = 0, z_m = 0.03 }";
    assert_issue(start, beside, "vehicles[0].start", "0.300 m from `box`", "at least 0.352 m");
    let swung = "x_m = -0.9, y_m = 0, z_m = 0.5, load = { x_m = -0.52, y_m = 0, z_m = 0.2 }";
    assert_issue(start, swung, "vehicles[0].start.load", "0.020 m from `box`", "at least 0.03 m");
}
