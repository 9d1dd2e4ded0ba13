//! A minimal scenario that uses every table, and assertions about changed copies of it.

use scenarios::{LoadError, LocatedIssue, Scenario};

/// A valid scenario. Lines are counted from 1.
pub const TEXT: &str = r#"name = "minimal"
description = "Two gliders pass one pillar."

[world]
map = { x_m = [-1000, 1000], y_m = [-500, 500], z_m = [0, 600] }

[[world.cylinders]]
name = "pillar"
center_m = [0, 0]
radius_m = 50

[models.fixed-wing.glider]
mass_kg = 10
body_radius_m = 1

[models.fixed-wing.glider.limits]
altitude_m = [200, 600]
speed_mps = [20, 50]
flight_path_deg = [-10, 10]
n_x = [-0.4, 0.4]
n_y = [-0.4, 0.4]
n_z = [0.6, 1.4]

[models.fixed-wing.glider.planning_limits]
altitude_m = [300, 500]
speed_mps = [30, 40]
flight_path_deg = [-5, 5]
n_x = [-0.2, 0.2]
n_y = [-0.2, 0.2]
n_z = [0.8, 1.2]

[[vehicles]]
name = "uav-1"
model = "glider"
start = { x_m = -900, y_m = -200, z_m = 400, speed_mps = 35 }
goal = { x_m = 900, y_m = -200, z_m = 400, speed_mps = 35 }

[[vehicles]]
name = "uav-2"
model = "glider"
start = { x_m = -900, y_m = 200, z_m = 400, speed_mps = 35 }
goal = { x_m = 900, y_m = 200, z_m = 400, speed_mps = 35 }

[fleet]
separation_m = 100

[planner]
name = "any"
intervals = 20
margin_m = 1
penalty = 1000
max_iterations = 30
trust_region = { position_m = 1, altitude_m = 1, speed_mps = 1, heading_deg = 1, flight_path_deg = 1, shrink = 0.5 }
convergence = { position_m = 1, altitude_m = 1, speed_mps = 1, heading_deg = 1, flight_path_deg = 1 }

[simulation]
step_s = 0.01
max_duration_s = 100
coast_s = 2
tracker = { natural_frequency_radps = 0.5, damping_ratio = 1 }
wind = { mean_mps = [1, 0, 0], gusts = { wind_at_20ft_mps = 5, sigma_aloft_mps = 1 } }
sensors = { position_noise_m = 0.1, velocity_noise_mps = 0.1 }
mismatch = { mass_ratio = 1.1 }

[verdict]
tracking_max_m = 5
tracking_rms_m = 2
arrival_spread_s = 0.5
goal_m = 5
dynamics_m = 1
rollout_m = 5
saturation = 0.05
advisory = ["flight.tracking_rms"]
required = ["flight.separation"]
"#;

/// Loads the scenario with every occurrence of `old` replaced by `new`.
pub fn load_changed(old: &str, new: &str) -> Result<Scenario, LoadError> {
    assert!(TEXT.contains(old), "the minimal scenario has no `{old}`");
    scenarios::parse("minimal.toml", &TEXT.replace(old, new))
}

/// The issues of the changed scenario.
pub fn issues(old: &str, new: &str) -> Vec<LocatedIssue> {
    load_changed(old, new).expect_err("the change should have been refused").issues().to_vec()
}

/// Asserts that the changed scenario has a single issue, at this field, line and column, whose `found` and `expected`
/// contain these words.
#[track_caller]
pub fn assert_issue(old: &str, new: &str, (field, line, column): (&str, usize, usize), found: &str, expected: &str) {
    let issues = issues(old, new);
    let [issue] = issues.as_slice() else { panic!("expected one issue, found {issues:#?}") };
    assert_eq!((issue.issue.field.as_str(), issue.line, issue.column), (field, line, column), "{issue}");
    assert!(issue.issue.found.contains(found), "{issue}");
    assert!(issue.issue.expected.contains(expected), "{issue}");
}
