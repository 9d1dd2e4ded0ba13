//! Positions that the controls do not lead to: neither dense rows nor a way back hides them.

use harness::plan_source::plan_import::complete;
use harness::verdict::{Status, Verdict, judge_imported};
use scenarios::Scenario;
use scenarios::plan_input::parse_csv;

const PAIR: &str = include_str!("../scenarios/pair.toml");
const SPEED_MPS: f64 = 35.0;

/// Both aircraft straight ahead by their velocities and controls, rows `step_s` apart; the second one's positions are moved
/// sideways.
///
/// - `aside_m`: at a time, s
fn verdict(step_s: f64, aside_m: impl Fn(f64) -> f64) -> Verdict {
    let scenario: Scenario = scenarios::parse("pair.toml", PAIR).expect("the smallest fleet");
    let count = (1000.0 / SPEED_MPS / step_s).round() as usize;
    let row = |name: &str, y_m: f64, t_s: f64| format!("{name},{t_s},{},{y_m},400,35,0,0,0,0,1\n", t_s * SPEED_MPS);
    let times_s: Vec<f64> = (0..=count).map(|k| 1000.0 / SPEED_MPS * k as f64 / count as f64).collect();
    let first = times_s.iter().map(|&t_s| row("uav-1", -100.0, t_s));
    let second = times_s.iter().map(|&t_s| row("uav-2", 100.0 + aside_m(t_s), t_s));
    let header = "vehicle,t_s,x_m,y_m,z_m,speed_mps,heading_deg,flight_path_deg,n_x,n_y,n_z\n";
    let text = header.to_owned() + &first.chain(second).collect::<String>();
    let (header, tracks) = parse_csv("plan.csv", &text, &scenario).expect("a table");
    let completed = complete(&scenario, header, tracks, "theirs", 0);
    let flight = sim::fly(&scenario, &completed.plan, 0, &mut |_| {});
    judge_imported(&scenario, &completed.plan, &completed.provenance, Some(&flight))
}

/// 4 m to the side and back within a second.
fn bump_m(t_s: f64) -> f64 {
    if (10.0..11.0).contains(&t_s) { 2.0 - 2.0 * (std::f64::consts::TAU * (t_s - 10.0)).cos() } else { 0.0 }
}

#[test]
fn defects_do_not_depend_on_the_spacing_of_the_rows() {
    for step_s in [0.01, 0.02, 0.1, 0.5] {
        let verdict = verdict(step_s, bump_m);
        let dynamics = verdict.check("plan.dynamics").expect("a declared check");
        assert_eq!(dynamics.status, Status::Fail, "rows {step_s} s apart: {dynamics:#?}");
        assert!(dynamics.value.expect("a distance") > 3.0, "rows {step_s} s apart: {dynamics:#?}");
    }
}

/// 0.9 m/s to the side, which no window of a second shows, to 12 m and back.
#[test]
fn the_rollout_is_compared_all_along_the_horizon() {
    let verdict = verdict(0.5, |t_s| 0.9 * t_s.min(1000.0 / SPEED_MPS - t_s));
    let rollout = verdict.check("plan.rollout").expect("a declared check");
    assert_eq!(rollout.status, Status::Fail, "{rollout:#?}");
    let (value_m, at_s) = (rollout.value.expect("a distance"), rollout.at_s.expect("a time"));
    assert!((value_m - 12.8).abs() < 0.5 && (at_s - 14.3).abs() < 0.5, "{rollout:#?}");
}

#[test]
fn a_plan_whose_controls_lead_to_its_positions_has_no_defect_at_any_spacing() {
    for step_s in [0.01, 0.1, 0.5, 2.0] {
        for check in ["plan.dynamics", "plan.rollout"].map(|name| verdict(step_s, |_| 0.0).check(name).cloned()) {
            let check = check.expect("a declared check");
            assert!(check.status == Status::Pass && check.value.is_some_and(|value_m| value_m < 1e-6), "{check:#?}");
        }
    }
}
