//! Plans of polynomial pieces and of positions alone.

#[path = "../../scenarios/tests/damage/mod.rs"]
mod damage;

use harness::plan_source::plan_import::complete;
use harness::verdict::{Check, Outcome, Status, Verdict, is_flyable, judge_imported};
use scenarios::Scenario;
use scenarios::plan_input::{parse_csv, parse_json};
use serde_json::json;

use crate::case;

/// One vehicle of the case, past the wall.
fn scenario() -> Scenario {
    let mut scenario = case::scenario();
    scenario.vehicles.truncate(1);
    scenario.fleet.separation_m = None;
    scenario
}

fn judged(text: &str, scenario: &Scenario) -> Option<Verdict> {
    let (header, tracks) = parse_csv("plan.csv", text, scenario).ok()?;
    let answer = complete(scenario, header, tracks, "theirs", 0);
    let flight = is_flyable(scenario, &answer.plan).is_ok().then(|| sim::fly(scenario, &answer.plan, 0, &mut |_| {}));
    Some(judge_imported(scenario, &answer.plan, &answer.provenance, flight.as_ref()))
}

#[track_caller]
fn check(text: &str, name: &str) -> Check {
    let verdict = judged(text, &scenario()).expect("a plan");
    verdict.checks.into_iter().find(|check| check.name == name).expect("a check of this name")
}

/// The minimum-snap motion from rest to rest over 6 m in `duration_s`, x = 6 (35 u⁴ - 84 u⁵ + 70 u⁶ - 20 u⁷), and a bulge of
/// y = `bulge_m` · 256 u⁴ (1 - u)⁴.
fn septic(duration_s: f64, bulge_m: f64) -> String {
    let scaled =
        |c: [f64; 9]| -> String { (0..9).map(|k| format!(",{:.17e}", c[k] / duration_s.powi(k as i32))).collect() };
    let x = scaled([0.0, 0.0, 0.0, 0.0, 210.0, -504.0, 420.0, -120.0, 0.0]);
    let y = scaled([0.0, 0.0, 0.0, 0.0, 1.0, -4.0, 6.0, -4.0, 1.0].map(|c| 256.0 * bulge_m * c));
    let header: String = ["x", "y"].iter().flat_map(|axis| (0..9).map(move |k| format!(",{axis}^{k}"))).collect();
    format!("duration{header},z^0\n{duration_s}{x}{y},2\n")
}

#[test]
fn a_polynomial_of_degree_8_passes() {
    let verdict = judged(&septic(7.0, 0.0), &scenario()).expect("a plan");
    let failed = verdict.failed_checks();
    assert_eq!(verdict.outcome, Outcome::Pass, "{failed:?}");
}

/// The wall is 1.5 m beside the line between start and goal, the body 0.35 m in radius: the bulge reaches up to it.
#[test]
fn a_bulge_into_the_wall_is_found() {
    for (bulge_m, status) in [(-1.149_8, Status::Pass), (-1.150_2, Status::Fail)] {
        assert_eq!(check(&septic(9.0, bulge_m), "plan.clearance").status, status, "{bulge_m}");
    }
}

/// The largest acceleration of the motion is 6 · 7.5132 m / T².
#[test]
fn the_acceleration_is_that_of_the_polynomial() {
    let worst = |duration_s: f64| check(&septic(duration_s, 0.0), "plan.control_limits");
    let exact_mps2 = |duration_s: f64| 6.0 * 7.513_188 / (duration_s * duration_s);
    let found = worst(7.0);
    assert!((found.value.unwrap() - exact_mps2(7.0)).abs() < 1e-3, "{found:?}");
    let at_limit_s = (6.0 * 7.513_188_f64 / 3.0).sqrt();
    assert_eq!(worst(at_limit_s * 1.001).status, Status::Pass);
    assert_eq!(worst(at_limit_s * 0.999).status, Status::Fail);
}

/// Two pieces at constant velocity from rest need an infinite acceleration where they begin to move.
#[test]
fn a_jump_between_pieces_fails() {
    let jump = check("duration,x^0,x^1,x^2,y^0,z^0\n2,0,0,0.5,0,2\n2,2,1,-0.25,0,2\n", "plan.control_limits");
    assert_eq!(jump.status, Status::Fail);
    assert!(jump.reason.unwrap().contains("it jumps by 0.000 m and 1.000 m/s"), "told");
}

/// The motion of the case by its positions, a row every `step_s`.
fn positions(step_s: f64) -> String {
    let x_m = |t_s: f64| match t_s {
        t_s if t_s < 2.0 => t_s * t_s / 2.0,
        t_s if t_s < 3.0 => 2.0 + 2.0 * (t_s - 2.0),
        _ => 6.0 - (5.0 - t_s).powi(2) / 2.0,
    };
    let count = (5.0 / step_s).round() as usize;
    let rows = (0..=count).map(|k| k as f64 * 5.0 / count as f64).map(|t_s| format!("{t_s:?},{:?},0,2\n", x_m(t_s)));
    "t,x,y,z\n".to_owned() + &rows.collect::<String>()
}

#[test]
fn dense_positions_pass_and_say_what_they_leave_open() {
    let verdict = judged(&positions(0.05), &scenario()).expect("a plan");
    assert_eq!(verdict.outcome, Outcome::Pass, "{:?}", verdict.failed_checks());
    assert_eq!(verdict.check("nodes.control_limits").unwrap().status, Status::Skip);
    let clearance_m = |step_s: f64| check(&positions(step_s), "plan.clearance").value.unwrap();
    // The whole body passes 1.15 m from the wall; a T²/8 less is certain.
    for step_s in [0.05, 0.5, 1.0] {
        let least_m = 1.15 - 3.0 * step_s * step_s / 8.0;
        let found_m = clearance_m(step_s);
        assert!(
            found_m <= least_m + 1e-3 && found_m > least_m - 0.4 * step_s,
            "{found_m} m, {least_m} m at {step_s} s"
        );
    }
}

#[test]
fn sparse_positions_leave_clearance_speed_and_rest_undecided() {
    for name in ["plan.clearance", "plan.state_limits", "plan.rest", "flight.clearance", "flight.rest"] {
        assert_eq!(check(&positions(2.5), name).status, Status::Undecided, "{name}");
    }
}

/// 1 cm to either side from row to row, written with three decimals: rows of rounded numbers are left out only where the
/// vehicle can have been at all of them.
#[test]
fn a_zigzag_of_rounded_positions_fails() {
    let zigzag = |aside_m: f64| {
        let rows = (0..=500).map(|k| {
            let (t_s, aside_m) =
                (f64::from(k) / 100.0, if (20..480).contains(&k) && k % 2 == 0 { aside_m } else { 0.0 });
            let u = t_s / 5.0;
            format!("{t_s:.2},{:.3},{aside_m:.3},2.000\n", 6.0 * u * u * u * (10.0 - 15.0 * u + 6.0 * u * u))
        });
        "t,x,y,z\n".to_owned() + &rows.collect::<String>()
    };
    assert_eq!(check(&zigzag(0.0), "plan.control_limits").status, Status::Pass);
    assert_eq!(check(&zigzag(0.01), "plan.control_limits").status, Status::Fail);
}

/// The first vehicle gives positions; the second one velocities too, that ask for 2 m/s² and end in motion.
#[test]
fn a_plan_without_velocities_does_not_hide_those_of_another() {
    let scenario = case::scenario();
    let verdict = |end_mps: f64, slow_s: f64| {
        let count = 100;
        let rows =
            |row: &dyn Fn(f64) -> f64| (0..=count).map(|k| row(5.0 * f64::from(k) / 100.0)).collect::<Vec<f64>>();
        let x_m = |t_s: f64| 6.0 * (t_s / 5.0).powi(3) * (10.0 - 3.0 * t_s + 6.0 * (t_s / 5.0).powi(2));
        let first = json!({"vehicle": "uav-1", "t_s": rows(&|t_s| t_s), "x_m": rows(&x_m), "y_m": rows(&|_| 0.0),
            "z_m": rows(&|_| 2.0)});
        let (t_s, x_m) = ([0.0, slow_s, 5.0], [0.0, 3.0, 6.0]);
        let second = json!({"vehicle": "uav-2", "t_s": t_s, "x_m": x_m, "y_m": [3.0, 3.0, 3.0], "z_m": [2.0, 2.0, 2.0],
            "vx_mps": [0.0, 2.0, end_mps], "vy_mps": [0.0, 0.0, 0.0], "vz_mps": [0.0, 0.0, 0.0]});
        let text = json!({ "trajectories": [first, second] }).to_string();
        let (header, tracks) = parse_json("plan.json", &text, &scenario).expect("a plan");
        let answer = complete(&scenario, header, tracks, "theirs", 0);
        let flight = sim::fly(&scenario, &answer.plan, 0, &mut |_| {});
        judge_imported(&scenario, &answer.plan, &answer.provenance, Some(&flight))
    };
    let good = verdict(0.0, 2.5);
    for name in ["nodes.state_limits", "nodes.control_limits", "plan.rest"] {
        let check = good.check(name).unwrap();
        assert_eq!(check.status, Status::Pass, "{check:?}");
    }
    let bad = verdict(1.0, 2.5);
    let rest = bad.check("plan.rest").unwrap();
    assert_eq!((rest.status, &rest.between[..]), (Status::Fail, &["uav-2".to_owned()][..]), "{rest:?}");
    let hard = verdict(0.0, 1.5);
    let accelerations = hard.check("nodes.control_limits").unwrap();
    assert_eq!((accelerations.status, &accelerations.between[..]), (Status::Fail, &["uav-2".to_owned()][..]));
}

/// A row 0.2 m off the line cannot be reached within the limit: that is certain, however the vehicle flies between the rows.
#[test]
fn positions_that_need_more_acceleration_than_there_is_fail() {
    let text = positions(0.1).replacen(",0,2\n2.6", ",0.2,2\n2.6", 1);
    assert_ne!(text, positions(0.1));
    assert_eq!(check(&text, "plan.control_limits").status, Status::Fail);
}

#[test]
fn damaged_plans_that_pass_still_lead_to_the_goal() {
    let scenario = scenario();
    let six = "duration,x^0,x^1,x^2,x^3,y^0,z^0\n2,0,0,0.5,0,0,2\n1,2,2,0,0,0,2\n2,4,2,-0.5,0,0,2\n";
    let (mut judged_count, mut passed) = (0, 0);
    for original in [six.to_owned(), positions(0.05)] {
        for text in damage::copies_of(&original, 400) {
            let Some(verdict) = judged(&text, &scenario) else { continue };
            judged_count += 1;
            if verdict.outcome == Outcome::Pass {
                passed += 1;
                let (_, tracks) = parse_csv("plan.csv", &text, &scenario).unwrap();
                let first_m = tracks[0].first_position_m();
                assert!((first_m[0].hypot(first_m[1])) < 0.02, "begins elsewhere, and passes:\n{text}");
            }
        }
    }
    assert!(judged_count > 5 && passed > 2 && passed < judged_count, "{judged_count} judged, {passed} passed");
}

#[test]
fn a_start_that_the_scenario_draws_is_no_incomplete_flight() {
    let mut case = case::Case::good();
    case.scenario.simulation.mismatch.start_radius_m = 3.0;
    case.fly();
    let start_m = case.scenario.vehicles[0].start.position_m();
    let first_m = case.samples(0)[0].position_m;
    let off_m = (first_m[0] - start_m[0]).hypot(first_m[1] - start_m[1]);
    assert!(off_m > case.scenario.limits().tracking_max_m, "the draw is too near to show anything: {off_m}");
    assert_eq!(case.status("flight.complete"), Status::Pass);
    case.samples(0)[0].position_m[0] += 3.1 + off_m;
    assert_eq!(case.status("flight.complete"), Status::Fail);
}

/// Rows every 0.1 s, and 8 s at a door between two rows.
#[test]
fn a_hover_may_be_two_rows() {
    let scenario = scenario();
    let mut text = "t_s,x_m,y_m,z_m,vx_mps,vy_mps,vz_mps\n".to_owned();
    let half = |from_m: f64, begin_s: f64| {
        let row = move |k: u32| {
            let u = f64::from(k) / 40.0;
            let (x_m, mps) = (from_m + 3.0 * u * u * (3.0 - 2.0 * u), 18.0 * u * (1.0 - u) / 4.0);
            format!("{},{x_m},0,2,{mps},0,0\n", begin_s + 4.0 * u)
        };
        (0..=40).map(row).collect::<String>()
    };
    text.push_str(&half(0.0, 0.0));
    text.push_str(&half(3.0, 12.0));
    let verdict = judged(&text, &scenario).expect("a hover is no gap");
    assert_eq!(
        verdict.outcome,
        Outcome::Pass,
        "{:#?}",
        verdict.checks.iter().filter(|it| it.is_bad()).collect::<Vec<_>>()
    );
    // At another place after the gap, rows are missing.
    let lost = text.replace("12,3,0,2", "12,3.5,0,2");
    assert!(parse_csv("plan.csv", &lost, &scenario).is_err());
}
