//! Validation rules for well-formed scenarios: one test per rule, with field, line and column.

mod minimal;

use minimal::{TEXT, assert_issue, issues, load_changed};

const LIMITS: &str = "models.fixed-wing.glider.limits";
const PLANNING: &str = "models.fixed-wing.glider.planning_limits";

#[test]
fn the_name_is_well_formed_and_that_of_the_file() {
    assert_issue("\"minimal\"", "\"maximal\"", ("name", 1, 8), "maximal", "\"minimal\", as the file is named");
    for name in ["Bad Name", "", "-x", "a_b"] {
        let text = TEXT.replace("\"minimal\"", &format!("\"{name}\""));
        let error = scenarios::parse(&format!("{name}.toml"), &text).unwrap_err();
        assert!(error.to_string().contains("error"), "{name}");
        let malformed = error.issues().iter().find(|issue| issue.issue.expected.contains("lower case")).unwrap();
        assert_eq!((malformed.issue.field.as_str(), malformed.line, malformed.column), ("name", 1, 8));
    }
}

#[test]
fn ranges_are_ordered() {
    let ordered = "min below max";
    assert_issue("y_m = [-500, 500]", "y_m = [500, -500]", ("world.map.y_m", 5, 36), "[500, -500]", ordered);
    assert_issue("n_x = [-0.4, 0.4]", "n_x = [0.4, 0.4]", (&format!("{LIMITS}.n_x"), 20, 7), "[0.4, 0.4]", ordered);
}

#[test]
fn obstacles_have_unique_names_and_a_size() {
    assert_issue("radius_m = 50", "radius_m = 0", ("world.cylinders[0].radius_m", 10, 12), "0", "greater than 0");
    assert_issue("\"pillar\"", "\"a,b\"", ("world.cylinders[0].name", 8, 8), "a,b", "letters, digits");
    let twice = "radius_m = 50\n\n[[world.cylinders]]\nname = \"pillar\"\ncenter_m = [0, 300]\nradius_m = 50";
    assert_issue("radius_m = 50", twice, ("world.cylinders[1].name", 13, 8), "pillar", "world.cylinders[0] has");
}

#[test]
fn models_have_mass_and_size() {
    assert_issue("mass_kg = 10", "mass_kg = -1", ("models.fixed-wing.glider.mass_kg", 13, 11), "-1", "greater than 0");
    assert_issue(
        "body_radius_m = 1",
        "body_radius_m = 0",
        ("models.fixed-wing.glider.body_radius_m", 14, 17),
        "0",
        "greater than 0",
    );
    let text = TEXT.replace("fixed-wing.glider", "fixed-wing.'a glider'").replace("\"glider\"", "\"a glider\"");
    let error = scenarios::parse("minimal.toml", &text).unwrap_err();
    assert_eq!(
        error.lines(),
        [
            "minimal.toml:12:1: models.fixed-wing.a glider: found \"a glider\", expected letters, digits, `-` and `_`, a letter \
         or a digit first"
        ]
    );
}

#[test]
fn fixed_wing_limits_exclude_hover_and_vertical_flight() {
    assert_issue(
        "speed_mps = [20, 50]",
        "speed_mps = [0, 50]",
        (&format!("{LIMITS}.speed_mps"), 18, 13),
        "[0, 50]",
        "can't hover",
    );
    assert_issue(
        "flight_path_deg = [-10, 10]",
        "flight_path_deg = [-10, 90]",
        (&format!("{LIMITS}.flight_path_deg"), 19, 19),
        "[-10, 90]",
        "between -90 and 90 deg",
    );
}

#[test]
fn planning_limits_lie_inside_the_physical_ones() {
    assert_issue(
        "n_z = [0.8, 1.2]",
        "n_z = [0.5, 1.2]",
        (&format!("{PLANNING}.n_z"), 30, 7),
        "[0.5, 1.2]",
        "inside [0.6, 1.4]",
    );
    assert_issue(
        "speed_mps = [30, 40]",
        "speed_mps = [30, 60]",
        (&format!("{PLANNING}.speed_mps"), 26, 13),
        "[30, 60]",
        "inside [20, 50]",
    );
}

#[test]
fn vehicles_have_unique_names_and_known_models() {
    let (head, rest) = TEXT.split_once("[[vehicles]]").unwrap();
    let tail = &rest[rest.find("[fleet]").unwrap()..];
    let error = scenarios::parse("minimal.toml", &format!("vehicles = []\n{head}{tail}")).unwrap_err();
    assert_eq!(
        error.lines(),
        ["minimal.toml:1:12: vehicles: found none, expected at least one vehicle; add a `[[vehicles]]` table"]
    );
    assert_issue("\"uav-2\"", "\"uav-1\"", ("vehicles[1].name", 39, 8), "uav-1", "vehicles[0] has the same");
    assert_issue("\"uav-2\"", "\"\"", ("vehicles[1].name", 39, 8), "\"\"", "letters, digits");
    let unknown = "name = \"uav-2\"\nmodel = \"glidr\"";
    assert_issue("name = \"uav-2\"\nmodel = \"glider\"", unknown, ("vehicles[1].model", 40, 9), "glidr", "glider");
    assert_eq!(issues("name = \"uav-2\"\nmodel = \"glider\"", unknown)[0].issue.remedy, "did you mean \"glider\"?");
}

#[test]
fn starts_and_goals_are_on_the_map() {
    assert_issue(
        "-900, y_m = 200",
        "-1001, y_m = 200",
        ("vehicles[1].start.x_m", 41, 17),
        "-1001",
        "[-1000, 1000], the map",
    );
    assert_issue(
        "900, y_m = -200, z_m = 400, speed_mps = 35 }\n\n",
        "900, y_m = -501, z_m = 400, speed_mps = 35 }\n\n",
        ("vehicles[0].goal.y_m", 36, 27),
        "-501",
        "[-500, 500], the map",
    );
}

#[test]
fn starts_and_goals_are_within_the_planning_limits() {
    let start = "x_m = -900, y_m = 200, z_m = 400, speed_mps = 35";
    let with = |new| format!("x_m = -900, y_m = 200, {new}");
    assert_issue(start, &with("z_m = 550, speed_mps = 35"), ("vehicles[1].start.z_m", 41, 40), "550", "[300, 500]");
    assert_issue(start, &with("z_m = 400, speed_mps = 45"), ("vehicles[1].start.speed_mps", 41, 57), "45", "[30, 40]");
    assert_issue(
        start,
        &with("z_m = 400, speed_mps = 35, flight_path_deg = 6"),
        ("vehicles[1].start.flight_path_deg", 41, 79),
        "6",
        "[-5, 5]",
    );
}

#[test]
fn starts_and_goals_are_outside_obstacles() {
    assert_issue(
        "x_m = 900, y_m = 200",
        "x_m = 30, y_m = 30",
        ("vehicles[1].goal", 42, 8),
        "inside `pillar`",
        "outside",
    );
    let touching = load_changed("x_m = 900, y_m = 200", "x_m = 51, y_m = 0");
    assert!(touching.is_ok(), "a body of 1 m on the surface is outside");
}

#[test]
fn bodies_do_not_overlap() {
    assert_issue(
        "x_m = -900, y_m = 200, z_m = 400",
        "x_m = -900, y_m = -199, z_m = 401",
        ("vehicles[1].start", 41, 9),
        "overlap",
        "2 m or more",
    );
    assert_issue(
        "x_m = 900, y_m = 200",
        "x_m = 900, y_m = -200",
        ("vehicles[1].goal", 42, 8),
        "overlap",
        "2 m or more",
    );
}

#[test]
fn the_separation_holds_at_both_ends() {
    assert_issue("separation_m = 100", "separation_m = 0", ("fleet.separation_m", 45, 16), "0", "greater than 0");
    assert_issue(
        "x_m = -900, y_m = 200",
        "x_m = -900, y_m = -101",
        ("vehicles[1].start", 41, 9),
        "99.000 m",
        "100 m or more",
    );
    assert_issue(
        "x_m = 900, y_m = 200",
        "x_m = 900, y_m = -101",
        ("vehicles[1].goal", 42, 8),
        "99.000 m",
        "100 m or more",
    );
    assert!(load_changed("x_m = -900, y_m = 200", "x_m = -900, y_m = -100").is_ok(), "exactly R is enough");
}

#[test]
fn options_of_the_planner_are_in_range() {
    assert_issue("intervals = 20", "intervals = 1", ("planner.intervals", 49, 13), "1", "from 2 to 1000");
    assert_issue("intervals = 20", "intervals = 1001", ("planner.intervals", 49, 13), "1001", "from 2 to 1000");
    assert_issue("margin_m = 1", "margin_m = -1", ("planner.margin_m", 50, 12), "-1", "0 or more");
    assert_issue("penalty = 1000", "penalty = 0", ("planner.penalty", 51, 11), "0", "greater than 0");
    for share in ["1", "-0.1"] {
        let release = format!("penalty = 1000\ntime_bound_release = {share}");
        assert_issue("penalty = 1000", &release, ("planner.time_bound_release", 52, 22), share, "from 0 to below 1");
    }
    let start = "penalty = 1000\nsolver_start = \"infeasible\"";
    assert_issue("penalty = 1000", start, ("planner.solver_start", 52, 16), "infeasible", "sparse-ldl");
    let with_method_1 = format!("{start}\nsolver = \"sparse-ldl\"");
    assert!(load_changed("penalty = 1000", &with_method_1).is_ok(), "the paper's methods have an infeasible start");
    for (key, column) in [("swap_threshold_s", 37), ("damped_change_s", 36), ("arrival_spread_s", 37)] {
        let threshold = format!("penalty = 1000\ncoordination = {{ {key} = -1 }}");
        let field = format!("planner.coordination.{key}");
        assert_issue("penalty = 1000", &threshold, (&field, 52, column), "-1", "0 or more");
    }
    let no_round = "penalty = 1000\ncoordination = { max_rounds = 0 }";
    assert_issue("penalty = 1000", no_round, ("planner.coordination.max_rounds", 52, 31), "0", "1 or more");
    assert_issue("max_iterations = 30", "max_iterations = 0", ("planner.max_iterations", 52, 18), "0", "1 or more");
    assert_issue(
        "shrink = 0.5",
        "shrink = 0",
        ("planner.trust_region.shrink", 53, 112),
        "0",
        "greater than 0 and at most 1",
    );
    assert_issue("shrink = 0.5", "shrink = 1.01", ("planner.trust_region.shrink", 53, 112), "1.01", "at most 1");
    assert_issue("1, shrink", "0, shrink", ("planner.trust_region.flight_path_deg", 53, 100), "0", "greater than 0");
    assert_issue(
        "convergence = { position_m = 1",
        "convergence = { position_m = 0",
        ("planner.convergence.position_m", 54, 30),
        "0",
        "greater than 0",
    );
    assert!(load_changed("shrink = 0.5", "shrink = 1").is_ok(), "1 keeps the trust region as it is");
}

#[test]
fn simulation_settings_are_in_range() {
    let positive = "greater than 0";
    assert_issue("step_s = 0.01", "step_s = 0", ("simulation.step_s", 57, 10), "0", positive);
    assert_issue("step_s = 0.01", "step_s = 0.2", ("simulation.step_s", 57, 10), "0.2", "at most 0.1");
    assert_issue("max_duration_s = 100", "max_duration_s = 0", ("simulation.max_duration_s", 58, 18), "0", positive);
    assert_issue("coast_s = 2", "coast_s = -1", ("simulation.coast_s", 59, 11), "-1", "0 or more");
    assert_issue("radps = 0.5", "radps = 0", ("simulation.tracker.natural_frequency_radps", 60, 39), "0", positive);
    assert_issue("damping_ratio = 1", "damping_ratio = 0", ("simulation.tracker.damping_ratio", 60, 60), "0", positive);
    assert_issue(
        "20ft_mps = 5",
        "20ft_mps = -5",
        ("simulation.wind.gusts.wind_at_20ft_mps", 61, 61),
        "-5",
        "0 or more",
    );
    assert_issue(
        "position_noise_m = 0.1",
        "position_noise_m = -0.1",
        ("simulation.sensors.position_noise_m", 62, 32),
        "-0.1",
        "0 or more",
    );
    assert_issue(
        "velocity_noise_mps = 0.1",
        "velocity_noise_mps = -0.1",
        ("simulation.sensors.velocity_noise_mps", 62, 58),
        "-0.1",
        "0 or more",
    );
    assert_issue("mass_ratio = 1.1", "mass_ratio = 0", ("simulation.mismatch.mass_ratio", 63, 27), "0", positive);
}

#[test]
fn aircraft_keep_their_bodies_off_obstacles_and_the_ground() {
    let map = "map = { x_m = [-1000, 1000], y_m = [-500, 500], z_m = [0, 600] }";
    let field = "models.fixed-wing.glider.planning_limits.altitude_m";
    assert_issue(map, &format!("{map}\nground_m = 299.1"), (field, 26, 14), "[300, 500]", "at least 300.1 m");
    assert!(load_changed(map, &format!("{map}\nground_m = 299")).is_ok());
    let start = "start = { x_m = -900, y_m = -200,";
    let issues = issues(start, "start = { x_m = -50.5, y_m = 0,");
    let [issue] = issues.as_slice() else { panic!("{issues:#?}") };
    assert_eq!(issue.issue.field, "vehicles[0].start", "{issue}");
    assert!(
        issue.issue.found.contains("0.500 m from `pillar`") && issue.issue.expected.contains("at least 1 m"),
        "{issue}"
    );
    assert!(load_changed(start, "start = { x_m = -51, y_m = 0,").is_ok());
}

#[test]
fn verdict_limits_are_positive_and_checks_are_known() {
    let positive = "greater than 0";
    assert_issue("tracking_max_m = 5", "tracking_max_m = 0", ("verdict.tracking_max_m", 66, 18), "0", positive);
    assert_issue("tracking_rms_m = 2", "tracking_rms_m = 0", ("verdict.tracking_rms_m", 67, 18), "0", positive);
    assert_issue("spread_s = 0.5", "spread_s = -1", ("verdict.arrival_spread_s", 68, 20), "-1", positive);
    assert_issue("\ngoal_m = 5", "\ngoal_m = 0", ("verdict.goal_m", 69, 10), "0", positive);
    for (name, column) in [("goal_heading_deg", 20), ("goal_flight_path_deg", 24), ("goal_speed_mps", 18)] {
        let field = format!("verdict.{name}");
        assert_issue("\ngoal_m = 5", &format!("\ngoal_m = 5\n{name} = 0"), (&field, 70, column), "0", positive);
    }
    assert_issue("dynamics_m = 1", "dynamics_m = 0", ("verdict.dynamics_m", 70, 14), "0", positive);
    assert_issue("rollout_m = 5", "rollout_m = 0", ("verdict.rollout_m", 71, 13), "0", positive);
    assert_issue("saturation = 0.05", "saturation = 1.5", ("verdict.saturation", 72, 14), "1.5", "from 0 to 1");
    assert_issue(
        "\"flight.tracking_rms\"",
        "\"flight.tracking\"",
        ("verdict.advisory[0]", 73, 13),
        "flight.tracking",
        "the full name of a check",
    );
    for decisive in ["flight.crash", "plan.finite", "flight.complete", "flight.conditions", "flight.dynamics"] {
        assert_issue(
            "\"flight.tracking_rms\"",
            &format!("\"{decisive}\""),
            ("verdict.advisory[0]", 73, 13),
            decisive,
            "a check that may be advisory",
        );
    }
    assert_issue(
        "\"flight.separation\"",
        "\"separation\"",
        ("verdict.required[0]", 74, 13),
        "separation",
        "the full name of a check",
    );
}

#[test]
fn geofences_are_simple_polygons_and_allow_start_and_goal() {
    let with = |fence: &str| format!("radius_m = 50\n\n[[world.geofences]]\nname = \"zone\"\n{fence}");
    let crossed = with("kind = \"keep-out\"\npolygon_m = [[0, 0], [9, 9], [9, 0], [0, 9]]");
    assert_issue("radius_m = 50", &crossed, ("world.geofences[0].polygon_m", 15, 13), "4 corners", "simple polygon");
    let square = "kind = \"keep-out\"\npolygon_m = [[0, 0], [9, 0], [9, 9], [0, 9]]\nrings_m = ";
    for ring in ["[[3, 3], [12, 3], [3, 6]]", "[[3, 3], [6, 3]]", "[[3, 3], [6, 6], [6, 3], [3, 6]]"] {
        let ring = with(&format!("{square}[{ring}]"));
        assert_issue("radius_m = 50", &ring, ("world.geofences[0].rings_m", 16, 11), "cross, touch", "polygon_m");
    }
    let floor = "kind = \"keep-out\"\npolygon_m = [[0, 0], [9, 0], [0, 9]]\nz_m = [300, 200]";
    assert_issue("radius_m = 50", &with(floor), ("world.geofences[0].z_m", 16, 7), "[300, 200]", "min below max");
    let start = with("kind = \"keep-out\"\npolygon_m = [[-950, -250], [-850, -250], [-850, -150], [-950, -150]]");
    let found = "50.000 m inside geofence `zone`";
    assert_issue("radius_m = 50", &start, ("vehicles[0].start", 40, 9), found, "a point outside it");
}

#[test]
fn a_start_whose_body_reaches_over_the_edge_of_the_map_or_a_geofence_is_refused() {
    let (axis, fence) = ("vehicles[0].start.x_m", "vehicles[0].start");
    let found = issues("x_m = [-1000, 1000]", "x_m = [-900.5, 1000]");
    let fields: Vec<&str> = found.iter().map(|issue| issue.issue.field.as_str()).collect();
    assert_eq!(fields, [axis, "vehicles[1].start.x_m"]);
    assert!(found[0].issue.expected.contains("at least 1 m, the body radius, from both ends"), "{}", found[0]);
    let with = "radius_m = 50\n\n[[world.geofences]]\nname = \"zone\"\nkind = \"keep-out\"\n\
                polygon_m = [[-950, -250], [-900.5, -250], [-900.5, -150], [-950, -150]]";
    assert_issue("radius_m = 50", with, (fence, 40, 9), "0.500 m from the boundary of geofence `zone`", "outside it");
    assert!(load_changed("radius_m = 50", &with.replace("-900.5", "-901")).is_ok());
}
