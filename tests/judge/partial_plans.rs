//! Plans that give less of one vehicle than of another: each vehicle is asked for what it gives.

use harness::plan_source::plan_import::complete;
use harness::verdict::{Check, Status, Verdict, judge_imported};
use scenarios::plan_input::{parse_csv, parse_json};
use scenarios::{Scenario, Waypoint};
use serde_json::{Value, json};

const PAIR: &str = include_str!("../scenarios/pair.toml");
const SPEED_MPS: f64 = 35.0;

fn scenario() -> Scenario {
    scenarios::parse("pair.toml", PAIR).expect("the smallest fleet")
}

/// 1 km straight ahead at constant speed in steps of about `step_s`, with positions only.
fn positions(vehicle: &str, y_m: f64, step_s: f64) -> Value {
    let duration_s = 1000.0 / SPEED_MPS;
    let count = (duration_s / step_s).round() as usize;
    let times_s: Vec<f64> = (0..=count).map(|k| duration_s * k as f64 / count as f64).collect();
    json!({
        "vehicle": vehicle,
        "x_m": times_s.iter().map(|t_s| t_s * SPEED_MPS).collect::<Vec<_>>(),
        "y_m": vec![y_m; count + 1],
        "z_m": vec![400.0; count + 1],
        "t_s": times_s,
    })
}

/// The same, with velocities.
fn with_velocities(mut trajectory: Value, speed_mps: f64) -> Value {
    let count = trajectory["t_s"].as_array().expect("times").len();
    for (column, value) in [("speed_mps", speed_mps), ("heading_deg", 0.0), ("flight_path_deg", 0.0)] {
        trajectory[column] = json!(vec![value; count]);
    }
    trajectory
}

/// The same, with velocities and controls.
fn with_controls(trajectory: Value, n_x: f64) -> Value {
    let mut trajectory = with_velocities(trajectory, SPEED_MPS);
    let count = trajectory["t_s"].as_array().expect("times").len();
    for (column, value) in [("n_x", n_x), ("n_y", 0.0), ("n_z", 1.0)] {
        trajectory[column] = json!(vec![value; count]);
    }
    trajectory
}

fn verdict(scenario: &Scenario, trajectories: &[Value; 2]) -> Verdict {
    let text = json!({ "trajectories": trajectories }).to_string();
    let (header, tracks) = parse_json("plan.json", &text, scenario).expect("a plan");
    let completed = complete(scenario, header, tracks, "theirs", 0);
    let flight = sim::fly(scenario, &completed.plan, 0, &mut |_| {});
    judge_imported(scenario, &completed.plan, &completed.provenance, Some(&flight))
}

fn check<'a>(verdict: &'a Verdict, name: &str) -> &'a Check {
    verdict.check(name).expect("a declared check")
}

#[test]
fn a_plan_without_controls_does_not_hide_those_of_another() {
    // 0.3 is beyond the planning limit of 0.2, and leads elsewhere in open loop.
    let bad =
        verdict(&scenario(), &[positions("uav-1", -100.0, 0.25), with_controls(positions("uav-2", 100.0, 1.0), 0.3)]);
    for name in ["nodes.control_limits", "plan.rollout"] {
        let check = check(&bad, name);
        assert_eq!((check.status, &check.between[..]), (Status::Fail, &["uav-2".to_owned()][..]), "{check:#?}");
    }
    let good =
        verdict(&scenario(), &[positions("uav-1", -100.0, 0.25), with_controls(positions("uav-2", 100.0, 1.0), 0.0)]);
    for name in ["nodes.control_limits", "nodes.state_limits", "plan.rollout"] {
        assert_eq!(check(&good, name).status, Status::Pass, "{:#?}", check(&good, name));
    }
}

#[test]
fn a_plan_without_velocities_does_not_hide_those_of_another() {
    // 45 m/s is beyond the planning limit of 40 m/s.
    let fast = with_velocities(positions("uav-2", 100.0, 0.25), 45.0);
    let verdict = verdict(&scenario(), &[positions("uav-1", -100.0, 0.25), fast]);
    let states = check(&verdict, "nodes.state_limits");
    assert_eq!((states.status, &states.between[..]), (Status::Fail, &["uav-2".to_owned()][..]), "{states:#?}");
}

#[test]
fn what_no_vehicle_gives_is_skipped_with_the_reason() {
    let verdict = verdict(&scenario(), &[positions("uav-1", -100.0, 0.25), positions("uav-2", 100.0, 0.25)]);
    for (name, reason) in [
        ("nodes.control_limits", "the plan gives no controls"),
        ("nodes.state_limits", "the plan gives no velocities"),
        ("plan.rollout", "the plan gives no controls, and reconstructed ones say nothing open loop"),
    ] {
        let check = check(&verdict, name);
        assert_eq!((check.status, check.reason.as_deref()), (Status::Skip, Some(reason)), "{name}");
    }
}

/// 10 deg beside the course at every row, without ever moving to the side: by the law half a second turns by 2 m/s at most.
#[test]
fn velocities_that_contradict_the_positions_fail() {
    let with_heading = |heading_deg: f64| {
        let mut aside = with_velocities(positions("uav-2", 100.0, 0.5), SPEED_MPS);
        let count = aside["t_s"].as_array().expect("times").len();
        let heading = |row: usize| if row == 0 || row == count - 1 { 0.0 } else { heading_deg };
        aside["heading_deg"] = json!((0..count).map(heading).collect::<Vec<_>>());
        let verdict = verdict(&scenario(), &[with_velocities(positions("uav-1", -100.0, 0.5), SPEED_MPS), aside]);
        check(&verdict, "plan.dynamics").clone()
    };
    let dynamics = with_heading(10.0);
    assert_eq!((dynamics.status, &dynamics.between[..]), (Status::Fail, &["uav-2".to_owned()][..]), "{dynamics:#?}");
    assert_eq!(with_heading(1.0).status, Status::Pass);
}

/// Rows a second apart leave the direction at the end open by some 7 deg, of which the goal admits 3.
#[test]
fn a_goal_that_sparse_positions_leave_open_is_undecided_in_the_unit_of_its_part() {
    let goals = |step_s: f64, change: fn(&mut Waypoint)| {
        let mut scenario = scenario();
        change(&mut scenario.vehicles[1].goal);
        let verdict = verdict(&scenario, &[positions("uav-1", -100.0, step_s), positions("uav-2", 100.0, step_s)]);
        ["nodes.goal", "plan.goal", "flight.goal"].map(|name| check(&verdict, name).clone())
    };
    for goal in goals(0.25, |_| {}) {
        assert_eq!(goal.status, Status::Pass, "{goal:#?}");
    }
    for goal in goals(1.0, |_| {}) {
        assert_eq!((goal.status, goal.unit.as_str()), (Status::Undecided, "deg"), "{goal:#?}");
        assert!(goal.reason.as_ref().is_some_and(|reason| reason.contains(" deg: the limit lies")), "{goal:#?}");
    }
    // What certainly misses fails, whatever else is open.
    for goal in goals(1.0, |goal| goal.z_m += 30.0) {
        assert_eq!((goal.status, goal.unit.as_str()), (Status::Fail, "m"), "{goal:#?}");
    }
}

/// Rounded rows are thinned, but not those that the vehicle cannot have reached from their neighbours.
#[test]
fn a_row_far_off_in_a_rounded_table_does_not_pass() {
    let scenario = scenario();
    let table = |aside_m: &dyn Fn(i32) -> f64| {
        let row = |(name, y_m): (&str, f64), k: i32| {
            let t_s = f64::from(k) / 100.0;
            let y_m = if name == "uav-2" { y_m + aside_m(k) } else { y_m };
            format!("{name},{t_s:.2},{:.2},{y_m:.2},400.00\n", t_s * SPEED_MPS)
        };
        let vehicles = [("uav-1", -100.0), ("uav-2", 100.0)];
        let rows = vehicles.into_iter().flat_map(|vehicle| (0..=2857).map(move |k| row(vehicle, k)));
        let text = "vehicle,t_s,x_m,y_m,z_m\n".to_owned() + &rows.collect::<String>();
        let (header, tracks) = parse_csv("plan.csv", &text, &scenario).expect("a table");
        let completed = complete(&scenario, header, tracks, "theirs", 0);
        let flight = sim::fly(&scenario, &completed.plan, 0, &mut |_| {});
        judge_imported(&scenario, &completed.plan, &completed.provenance, Some(&flight))
    };
    let smooth = table(&|_| 0.0);
    assert_eq!(smooth.failed_checks(), Vec::<String>::new());
    for jump_m in [5.0, -60.0, 1000.0] {
        let jump = table(&|k| if k == 1411 { jump_m } else { 0.0 });
        assert!(!jump.failed_checks().is_empty(), "a row {jump_m} m off passes");
    }
    let zigzag = table(&|k| if (100..2700).contains(&k) { f64::from(k % 2) * 0.1 } else { 0.0 });
    assert!(!zigzag.failed_checks().is_empty(), "10 cm from row to row pass");
}
