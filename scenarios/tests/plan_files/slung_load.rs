//! Slung-load plans, which must be complete.

use std::path::Path;

use scenarios::plan_input::{ImportedTrajectory, parse_csv, parse_json};
use scenarios::{Interpolation, Plan, Scenario, slung_load};

use super::assert_rejected;

/// A slung-load plan in which two nodes share the time at which the cable becomes taut.
fn slung_plan() -> (Scenario, Plan) {
    let path = Path::new(env!("CARGO_MANIFEST_DIR")).join("slung/rectangle.toml");
    let scenario = scenarios::load(&path).expect("a shipped scenario");
    let vehicle = &scenario.vehicles[0];
    let start = slung_load::State::at(&vehicle.start, scenario.slung_load_model(vehicle).cable_length_m);
    let moved = |by: f64| slung_load::State::from_array(start.to_array().map(|value| value + by));
    let trajectory = slung_load::Trajectory {
        vehicle: vehicle.name.clone(),
        interpolation: Interpolation::FirstOrderHold,
        times_s: vec![0.0, 0.1 + 0.2, 0.1 + 0.2, 1.0],
        states: [0.0, 0.1, 0.2, 1.0 / 3.0].map(moved).to_vec(),
        controls: [1.0, 2.0, 2.5, 3.0].map(|f| slung_load::Control { thrust_n: [f, f, 2.0 * f, f / 3.0] }).to_vec(),
        cable: vec![
            slung_load::Cable::Slack,
            slung_load::Cable::Slack,
            slung_load::Cable::Taut,
            slung_load::Cable::Taut,
        ],
        planner_nodes: vec![0, 3],
    };
    let plan = Plan { objective: Some(3.0), ..Plan::new(&scenario.name, "by-hand", 0, vec![trajectory.into()]) };
    (scenario, plan)
}

#[test]
fn a_slung_load_plan_is_read_back_unchanged() {
    let (scenario, plan) = slung_plan();
    let (mut json, mut csv) = (Vec::new(), Vec::new());
    plan.write_json(&mut json).unwrap();
    plan.write_csv(&mut csv).unwrap();
    let [json, csv] = [json, csv].map(|bytes| String::from_utf8(bytes).unwrap());
    let whole = plan.trajectories[0].slung_load().clone();
    let (_, trajectories) = parse_json("plan.json", &json, &scenario).unwrap();
    assert_eq!(trajectories, [ImportedTrajectory::Complete(whole.clone().into())]);
    let (_, trajectories) = parse_csv("plan.csv", &csv, &scenario).unwrap();
    assert_eq!(trajectories, [ImportedTrajectory::Complete(whole.clone().into())]);
    // Without the column every row is a node.
    let (_, trajectories) = parse_csv("plan.csv", &without_columns_from(&csv, "at_node"), &scenario).unwrap();
    assert_eq!(
        trajectories,
        [ImportedTrajectory::Complete(slung_load::Trajectory { planner_nodes: Vec::new(), ..whole }.into())]
    );
}

#[test]
fn a_slung_load_plan_must_be_complete() {
    let (scenario, plan) = slung_plan();
    let mut csv = Vec::new();
    plan.write_csv(&mut csv).unwrap();
    let csv = String::from_utf8(csv).unwrap();
    let misspelt = csv.replacen("slack", "loose", 1);
    let result = parse_csv("plan.csv", &misspelt, &scenario);
    assert_rejected(result, &["plan.csv:2: cable: found \"loose\", expected `slack` or `taut`"]);
    let without_cable = without_columns_from(&csv, "cable");
    let result = parse_csv("plan.csv", &without_cable, &scenario);
    assert_rejected(result, &["cable of", "found nothing, expected a column of this name"]);
}

/// The table without the column `name` and those after it.
fn without_columns_from(csv: &str, name: &str) -> String {
    let kept = csv.lines().next().unwrap().split(',').position(|column| column == name).expect("a column of this name");
    csv.lines().map(|line| line.split(',').take(kept).collect::<Vec<_>>().join(",") + "\n").collect()
}
