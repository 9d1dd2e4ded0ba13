//! Flights that were flown elsewhere, by their logs: good ones pass, and everything that a log can lack or show fails, is undecided
//! or is refused.

use std::path::Path;

use harness::plan_source::plan_import::complete_flight;
use harness::verdict::recorded::RecordedFlight;
use harness::verdict::{Check, Outcome, Status, Verdict, judge_recorded};
use scenarios::plan_input::parse_flight_csv;
use scenarios::{Scenario, check_names};

use crate::damage;

const PAIR: &str = include_str!("../scenarios/pair.toml");
const HOVERER: &str = include_str!("../scenarios/hoverer.toml");
const ROUNDS: usize = 3000;

fn hoverer() -> Scenario {
    scenarios::parse("hoverer.toml", HOVERER).expect("a good scenario")
}

fn pair() -> Scenario {
    scenarios::parse("pair.toml", PAIR).expect("the smallest fleet")
}

/// The verdict on the log in a table, or why it is refused.
fn judged(text: &str, scenario: &Scenario) -> Result<Verdict, String> {
    let rows = parse_flight_csv(Path::new("log.csv"), text, scenario).map_err(|error| error.lines().join("\n"))?;
    let (log, setpoints) = complete_flight(scenario, rows, "theirs");
    let (rows, provenance) = (&log.plan, &log.provenance);
    Ok(judge_recorded(&RecordedFlight { scenario, rows, provenance, setpoints: &setpoints }))
}

fn verdict(text: &str, scenario: &Scenario) -> Verdict {
    judged(text, scenario).unwrap_or_else(|reason| panic!("refused: {reason}"))
}

fn check<'v>(verdict: &'v Verdict, name: &str) -> &'v Check {
    verdict.check(name).unwrap_or_else(|| panic!("no check {name}"))
}

/// A sample of the multirotor: time, s; position, m; velocity, m/s; setpoint, m.
#[derive(Clone, Copy)]
struct Sample {
    t_s: f64,
    x: [f64; 3],
    v: [f64; 3],
    r: [f64; 3],
}

/// 6 m along x in 6 s, from rest to rest, then 1 s at the goal: x = 6 (10 u³ - 15 u⁴ + 6 u⁵).
fn samples(every_s: f64) -> Vec<Sample> {
    let count = (7.0 / every_s).round() as usize;
    let sample = |k: usize| {
        let t_s = k as f64 * every_s;
        let u = (t_s / 6.0).min(1.0);
        let x_m = 6.0 * u.powi(3) * (10.0 - 15.0 * u + 6.0 * u * u);
        let v_mps = 30.0 * u * u * (1.0 - u).powi(2);
        Sample { t_s, x: [x_m, 0.0, 2.0], v: [v_mps, 0.0, 0.0], r: [x_m, 0.01, 2.0] }
    };
    (0..=count).map(sample).collect()
}

fn table(samples: &[Sample]) -> String {
    let header = "t_s,x_m,y_m,z_m,vx_mps,vy_mps,vz_mps,reference_x_m,reference_y_m,reference_z_m\n".to_owned();
    let row = |Sample { t_s, x, v, r }: &Sample| {
        let cells = [*t_s].into_iter().chain(*x).chain(*v).chain(*r).map(|value| format!("{value:?}"));
        cells.collect::<Vec<_>>().join(",") + "\n"
    };
    header + &samples.iter().map(row).collect::<String>()
}

/// The good log with each sample changed.
fn changed(change: impl Fn(&mut Sample)) -> String {
    let mut samples = samples(0.02);
    samples.iter_mut().for_each(change);
    table(&samples)
}

#[test]
fn a_good_log_of_a_multirotor_passes_and_every_check_is_answered() {
    let scenario = hoverer();
    let found = verdict(&table(&samples(0.02)), &scenario);
    assert_eq!(found.outcome, Outcome::Pass, "{:#?}", found.checks);
    let names: Vec<&str> = found.checks.iter().map(|check| check.name.as_str()).collect();
    assert_eq!(names, check_names(scenario.family()).collect::<Vec<_>>());
    let skipped = |check: &&Check| check.status == Status::Skip;
    assert!(found.checks.iter().filter(skipped).all(|check| check.reason.as_ref().is_some_and(|it| !it.is_empty())));
    for name in ["nodes.goal", "plan.finite", "flight.conditions", "flight.dynamics", "flight.saturation"] {
        assert_eq!(check(&found, name).status, Status::Skip, "{name}");
    }
    for name in ["flight.complete", "flight.clearance", "flight.goal", "flight.rest", "flight.tracking_max"] {
        assert_eq!(check(&found, name).status, Status::Pass, "{name}");
    }
}

#[test]
fn the_arrival_is_where_it_stays_at_its_goal() {
    let found = verdict(&table(&samples(0.02)), &hoverer());
    let duration_s = check(&found, "flight.duration").value.expect("a value");
    assert!((4.0..6.0).contains(&duration_s), "{duration_s} s");
}

#[test]
fn what_a_log_shows_fails_the_check_that_asks_for_it() {
    let scenario = hoverer();
    let bump = |t_s: f64, top: f64| {
        if t_s > 2.0 && t_s < 4.0 { top * (std::f64::consts::PI * (t_s - 2.0) / 2.0).sin().powi(2) } else { 0.0 }
    };
    let cases: [(&str, String); 7] = [
        ("flight.clearance", changed(|it| it.x[2] += 1.9 * bump(it.t_s, 1.0))),
        ("flight.complete", changed(|it| it.x[1] += 1.0)),
        ("flight.goal", table(&samples(0.02)[..200])),
        ("flight.rest", changed(|it| it.v = if it.t_s > 6.9 { [0.5, 0.0, 0.0] } else { it.v })),
        ("flight.tracking_max", changed(|it| it.r[1] += 0.6 * bump(it.t_s, 1.0))),
        ("flight.control_limits", changed(|it| it.x[0] += if it.t_s > 3.0 && it.t_s < 3.05 { 0.2 } else { 0.0 })),
        ("flight.state_limits", changed(|it| it.v[1] = if (3.0..3.5).contains(&it.t_s) { 3.5 } else { 0.0 })),
    ];
    for (name, text) in cases {
        let found = verdict(&text, &scenario);
        let failed = check(&found, name);
        assert_eq!((failed.status, found.outcome), (Status::Fail, Outcome::Fail), "{failed:#?}");
    }
}

#[test]
fn what_the_vehicle_may_have_done_between_sparse_samples_is_undecided() {
    let mut scenario = hoverer();
    scenario.world.map.y_m.min = -0.5;
    let status = |every_s: f64, name: &str| check(&verdict(&table(&samples(every_s)), &scenario), name).status;
    // 3 m/s² for 0.02 s and for 1 s: 75 micrometres and 0.19 m, with 0.15 m to the frame.
    assert_eq!(status(0.02, "flight.clearance"), Status::Pass);
    assert_eq!(status(1.0, "flight.clearance"), Status::Undecided);
    assert_eq!(verdict(&table(&samples(1.0)), &scenario).outcome, Outcome::Fail);
}

#[test]
fn positions_alone_are_judged_with_more_that_is_unknown() {
    let scenario = hoverer();
    let positions = |every_s: f64| {
        let row = |it: &Sample| format!("{:?},{:?},{:?},{:?}\n", it.t_s, it.x[0], it.x[1], it.x[2]);
        "t_s,x_m,y_m,z_m\n".to_owned() + &samples(every_s).iter().map(row).collect::<String>()
    };
    let found = verdict(&positions(0.02), &scenario);
    assert_eq!(found.outcome, Outcome::Pass, "{:#?}", found.checks);
    assert_eq!(check(&found, "flight.tracking_max").status, Status::Skip);
    assert_eq!(check(&verdict(&positions(1.0), &scenario), "flight.rest").status, Status::Undecided);
}

#[test]
fn a_log_that_is_not_one_is_refused_with_its_place() {
    let scenario = hoverer();
    let good = samples(0.02);
    let without = |range: std::ops::Range<usize>| {
        let mut samples = good.clone();
        drop(samples.drain(range));
        table(&samples)
    };
    let mut twice = good.clone();
    twice[100].t_s = twice[99].t_s;
    let mut late = good.clone();
    late.iter_mut().for_each(|it| it.t_s += 1.0);
    let mut lost = good.clone();
    lost[50].x[0] = f64::NAN;
    for (text, part) in [
        (without(100..130), "a gap from 1.98 s to 2.6 s"),
        // At rest before and after: of a plan that is a hover, of a log it is not known.
        (without(301..340), "a gap from 6"),
        (table(&twice), "each time once per vehicle"),
        (table(&late), "1 s in the first row, expected 0 s"),
        (table(&lost), "expected a finite number"),
        (table(&good[..1]), "2 or more"),
        (table(&good).replace("reference_z_m", "qw"), "reference_z_m of uav-1: found nothing"),
    ] {
        let refused = judged(&text, &scenario).expect_err(part);
        assert!(refused.contains(part), "{part}: {refused}");
    }
}

#[test]
fn tracking_of_setpoints_that_are_not_there_is_skipped_and_fails_where_it_is_required() {
    let mut scenario = hoverer();
    let text = table(&samples(0.02)).replace("reference_x_m,reference_y_m,reference_z_m", "qx,qy,qz");
    let found = verdict(&text, &scenario);
    assert_eq!((check(&found, "flight.tracking_max").status, found.outcome), (Status::Skip, Outcome::Pass));
    scenario.verdict.required.push("flight.tracking_max".into());
    let found = verdict(&text, &scenario);
    assert_eq!((check(&found, "flight.tracking_max").status, found.outcome), (Status::Fail, Outcome::Fail));
}

#[test]
fn speeds_through_moving_air_are_not_known_from_speeds_over_ground() {
    let mut scenario = hoverer();
    scenario.simulation.wind = Some(scenarios::Wind { mean_mps: [1.0, 0.0, 0.0], gusts: None, pulses: Vec::new() });
    let found = verdict(&table(&samples(0.02)), &scenario);
    assert_eq!((check(&found, "flight.state_limits").status, found.outcome), (Status::Undecided, Outcome::Fail));
}

/// A steady flight over ground, whose load factors depend on the air that it flies through.
#[test]
fn load_factors_in_moving_air_are_not_known_from_the_motion_over_ground() {
    let mut scenario = pair();
    let log = fleet(|_, _| [0.0; 3], [30.0, 30.0]);
    assert_eq!(check(&verdict(&log, &scenario), "flight.control_limits").status, Status::Pass);
    scenario.simulation.wind = Some(scenarios::Wind { mean_mps: [0.0, 8.0, 0.0], gusts: None, pulses: Vec::new() });
    let found = verdict(&log, &scenario);
    for name in ["flight.control_limits", "flight.state_limits"] {
        assert_eq!(check(&found, name).status, Status::Undecided, "{name}");
    }
    assert_eq!(found.outcome, Outcome::Fail);
}

#[test]
fn requirements_are_asked_of_the_flight_alone() {
    let text = |formula: &str, applies: &str| {
        format!("{HOVERER}\n[[requirements]]\nname = \"own\"\nformula = \"{formula}\"\napplies_to = \"{applies}\"\n")
    };
    let status = |formula: &str, applies: &str| {
        let scenario = scenarios::parse("hoverer.toml", &text(formula, applies)).expect("a good scenario");
        let found = verdict(&table(&samples(0.02)), &scenario);
        (found.check("flight.requirement.own").map(|check| check.status), found.outcome)
    };
    assert_eq!(status("always (altitude > 1.9 m)", "both"), (Some(Status::Pass), Outcome::Pass));
    assert_eq!(status("always (altitude > 2.1 m)", "both"), (Some(Status::Fail), Outcome::Fail));
    assert_eq!(status("always (tracking_error < 1 m)", "flight"), (Some(Status::Fail), Outcome::Fail));
    assert_eq!(status("always (altitude > 2.1 m)", "plan"), (None, Outcome::Pass));
}

/// Both aircraft straight ahead at constant speed and 50 m beyond their goals, ten samples per second.
fn fleet(change: impl Fn(&str, f64) -> [f64; 3], end_s: [f64; 2]) -> String {
    let row = |name: &str, y_m: f64, k: usize| {
        let t_s = k as f64 / 10.0;
        let [dx, dy, dz] = change(name, t_s);
        format!("{name},{t_s:?},{:?},{:?},{:?},35,0,0\n", 35.0 * t_s + dx, y_m + dy, 400.0 + dz)
    };
    let count = |end_s: f64| (end_s * 10.0).round() as usize;
    let vehicles = [("uav-1", -100.0, count(end_s[0])), ("uav-2", 100.0, count(end_s[1]))];
    let rows = vehicles.into_iter().flat_map(|(name, y, count)| (0..=count).map(move |k| (name, y, k)));
    "vehicle,t_s,x_m,y_m,z_m,vx_mps,vy_mps,vz_mps\n".to_owned()
        + &rows.map(|(name, y, k)| row(name, y, k)).collect::<String>()
}

#[test]
fn a_good_log_of_fixed_wings_passes_and_every_check_is_answered() {
    let scenario = pair();
    let found = verdict(&fleet(|_, _| [0.0; 3], [30.0, 30.0]), &scenario);
    assert_eq!(found.outcome, Outcome::Pass, "{:#?}", found.checks);
    let names: Vec<&str> = found.checks.iter().map(|check| check.name.as_str()).collect();
    assert_eq!(names, check_names(scenario.family()).collect::<Vec<_>>());
    let duration_s = check(&found, "flight.duration").value.expect("a value");
    assert!((duration_s - 1000.0 / 35.0).abs() < 1e-6, "{duration_s} s");
}

#[test]
fn what_a_log_of_fixed_wings_shows_fails_the_check_that_asks_for_it() {
    let scenario = pair();
    let drift = |name: &str, rate: f64, t_s: f64| if name == "uav-2" { rate * t_s } else { 0.0 };
    for (name, text) in [
        ("flight.complete", fleet(|_, _| [0.0; 3], [30.0, 20.0])),
        ("flight.complete", fleet(|_, _| [0.0, 6.0, 0.0], [30.0, 30.0])),
        ("flight.separation", fleet(|name, t_s| [0.0, -drift(name, 5.0, t_s), 0.0], [30.0, 30.0])),
        ("flight.goal", fleet(|name, t_s| [0.0, drift(name, 1.0, t_s), 0.0], [30.0, 30.0])),
        ("flight.arrival", fleet(|name, t_s| [-drift(name, 2.0, t_s), 0.0, 0.0], [34.0, 34.0])),
        ("flight.state_limits", fleet(|_, t_s| [0.0, 0.0, if t_s > 10.0 { 125.0 } else { 12.5 * t_s }], [30.0, 30.0])),
    ] {
        let found = verdict(&text, &scenario);
        let failed = check(&found, name);
        assert_eq!((failed.status, found.outcome), (Status::Fail, Outcome::Fail), "{failed:#?}");
    }
    // A jump by 20 m within 0.1 s needs a load factor that no margin covers.
    let jump = fleet(|_, t_s| [0.0, if t_s > 15.0 { 20.0 } else { 0.0 }, 0.0], [30.0, 30.0]);
    assert!(check(&verdict(&jump, &scenario), "flight.control_limits").is_bad());
}

#[test]
fn sparse_samples_of_fixed_wings_leave_their_separation_open() {
    let mut scenario = pair();
    scenario.fleet.separation_m = Some(199.0);
    let row = |name: &str, y_m: f64, k: usize| format!("{name},{},{},{y_m},400\n", 2 * k, 70 * k);
    let rows: String = [("uav-1", -100.0), ("uav-2", 100.0)]
        .into_iter()
        .flat_map(|(name, y_m)| (0..=15).map(move |k| row(name, y_m, k)))
        .collect();
    let found = verdict(&format!("vehicle,t_s,x_m,y_m,z_m\n{rows}"), &scenario);
    assert_eq!((check(&found, "flight.separation").status, found.outcome), (Status::Undecided, Outcome::Fail));
}

#[test]
fn damaged_logs_are_judged_without_a_panic_and_those_that_pass_still_end_at_the_goal() {
    let (hoverer, pair) = (hoverer(), pair());
    let inputs = [(table(&samples(0.1)), &hoverer), (fleet(|_, _| [0.0; 3], [30.0, 30.0]), &pair)];
    for (text, scenario) in inputs {
        let (mut passed, mut failed) = (0, 0);
        for damaged in damage::copies_of(&text, ROUNDS) {
            let Ok(found) = judged(&damaged, scenario) else { continue };
            match found.outcome {
                Outcome::Pass => passed += 1,
                Outcome::Fail | Outcome::NoPlan => failed += 1,
            }
            if found.outcome == Outcome::Pass {
                let off = check(&found, "flight.goal");
                assert!(off.upper.or(off.value) <= off.limit, "{off:#?}\n{damaged}");
                assert_eq!(check(&found, "flight.complete").value, Some(0.0), "{damaged}");
            }
        }
        assert!(passed + failed > 15 && failed > 5, "{passed} passed, {failed} failed");
    }
}
