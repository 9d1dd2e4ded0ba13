//! Requirements in the user's own words: each goes red, near misses pass, and the page of examples holds.

use harness::verdict::{Check, Status, judge};
use scenarios::requirement::{AppliesTo, Requirement, SIGNALS};
use scenarios::{Cylinder, Geofence, GeofenceKind, Scenario};

use crate::fleet::{Case, check};

const PAGE: &str = include_str!("../../docs/requirements.md");

fn requirement(formula: &str) -> Requirement {
    Requirement {
        name: "r".into(),
        formula: formula.into(),
        description: String::new(),
        advisory: false,
        applies_to: AppliesTo::Both,
    }
}

/// Planned and flown check of a formula about the fleet abreast.
fn checks(formula: &str) -> [Check; 2] {
    let mut case = Case::good();
    add_places(&mut case.scenario);
    case.scenario.requirements.push(requirement(formula));
    let verdict = case.judge();
    ["plan.requirement.r", "flight.requirement.r"].map(|name| check(&verdict, name))
}

fn add_places(scenario: &mut Scenario) {
    let threat = Cylinder { name: "threat-3".into(), center_m: [2000.0, 3000.0], radius_m: 100.0 };
    let polygon_m = vec![[-100.0, -50.0], [850.0, -50.0], [850.0, 450.0], [-100.0, 450.0]];
    scenario.world.cylinders.push(threat);
    scenario.world.geofences.push(Geofence { name: "site".into(), kind: GeofenceKind::StayIn, polygon_m, z_m: None });
}

#[test]
fn limits_are_kept_and_broken_by_what_geometry_says() {
    // At y = 0, 200 and 400 m, 400 m high, at 35 m/s to the east for 20 s.
    for (formula, robustness) in [
        ("always altitude > 390 m", 10.0),
        ("always altitude > 410 m", -10.0),
        ("for all pairs a, b: always distance(a, b) > 150 m", 50.0),
        ("for all pairs a, b: always distance(a, b) > 201 m", -1.0),
        ("always (time_left > 5 s implies eventually [0 s, 5 s] distance(uav-1, uav-2) > 200.5 m)", -0.5),
        ("always inside(site) > 45 m", 5.0),
        ("always inside(site) > 60 m", -10.0),
        ("always speed < 36 m/s", 1.0),
        ("always speed < 34 m/s", -1.0),
        ("always speed > 34 m/s", 1.0),
        ("eventually [5 s, 15 s] distance(uav-1, point(350 m, 3 m, 404 m)) < 6 m", 1.0),
        ("eventually [5 s, 15 s] distance(uav-1, point(350 m, 3 m, 404 m)) < 4 m", -1.0),
        ("always heading_from(90 deg) > 89 deg", 1.0),
        ("always horizontal_distance(uav-1, pillar) > 99 m", 1.0),
    ] {
        for check in checks(formula) {
            let status = if robustness > 0.0 { Status::Pass } else { Status::Fail };
            assert_eq!(check.status, status, "{formula}: {check:?}");
            let value = check.value.expect("a value");
            assert!((value - robustness).abs() < 1e-3, "{formula}: {value}, not {robustness}");
            assert!(check.lower <= check.upper && check.limit == Some(0.0), "{check:?}");
        }
    }
}

#[test]
fn a_dip_between_two_samples_is_found() {
    let mut case = Case::good();
    case.scenario.requirements.push(requirement("always altitude(uav-2) > 399.999 m"));
    // Two knots with opposite vertical velocities: 10 ms apart, the cubic between them dips by 10 ms · 1 m/s / 4.
    for (sample, climb_mps) in [(100, -1.0), (101, 1.0)] {
        case.samples(1)[sample].velocity_mps[2] = climb_mps;
    }
    let verdict = case.judge();
    assert_eq!(check(&verdict, "plan.requirement.r").status, Status::Pass);
    let flown = check(&verdict, "flight.requirement.r");
    assert!(flown.lower.unwrap() < -1e-3, "{flown:?}");
    assert_eq!(flown.between, ["uav-2"]);
    assert!((flown.at_s.unwrap() - 1.005).abs() < 0.011, "{flown:?}");
}

#[test]
fn a_failure_says_why() {
    let [planned, _] = checks("for all pairs a, b: always distance(a, b) > 201 m");
    let why = planned.reason.expect("a reason");
    for part in ["where a is uav-1 and b is uav-2", "distance(a, b) is 200", "short by 1"] {
        assert!(why.contains(part), "{part}: {why}");
    }
    assert_eq!(planned.between, ["uav-1", "uav-2"]);
    assert_eq!(planned.unit, "m");
}

#[test]
fn signals_of_the_log_are_checked_in_flight_only() {
    let [planned, flown] = checks("always airspeed < 34 m/s");
    assert_eq!((planned.status, flown.status), (Status::Skip, Status::Fail));
    assert!((flown.value.unwrap() + 1.0).abs() < 1e-9, "{flown:?}");
    let [_, flown] = checks("always (bank < 1 deg and tracking_error < 0.1 m and wind_speed < 0.1 m/s)");
    assert_eq!(flown.status, Status::Pass, "{flown:?}");
}

#[test]
fn an_interval_after_the_end_fails() {
    for formula in ["always [90 s, 99 s] altitude > 1 m", "eventually [90 s, 99 s] altitude > 1 m"] {
        for check in checks(formula) {
            assert_eq!((check.status, check.value), (Status::Fail, None), "{formula}: {check:?}");
        }
    }
}

#[test]
fn advisory_ones_do_not_decide_and_motions_can_be_chosen() {
    let mut case = Case::good();
    let failing = requirement("always altitude > 410 m");
    case.scenario.requirements = vec![Requirement { advisory: true, ..failing.clone() }];
    assert!(case.judge().failed_checks().is_empty());
    case.scenario.requirements = vec![Requirement { applies_to: AppliesTo::Flight, ..failing }];
    let verdict = case.judge();
    assert_eq!(verdict.failed_checks(), ["flight.requirement.r"]);
    assert!(verdict.check("plan.requirement.r").is_none());
}

#[test]
fn without_a_flight_the_planned_motion_alone_is_judged() {
    let mut case = Case::good();
    case.scenario.requirements.push(requirement("always altitude > 390 m"));
    let verdict = judge(&case.scenario, &case.plan, None);
    assert_eq!(check(&verdict, "plan.requirement.r").status, Status::Pass);
    assert_eq!(check(&verdict, "flight.requirement.r").status, Status::Fail);
}

#[test]
fn the_ten_examples_of_the_page_are_formulas() {
    let mut fleet = Case::good().scenario;
    add_places(&mut fleet);
    let slung = scenarios::load("shipped:gate".as_ref()).expect("a shipped scenario");
    let quadrotor = slung.vehicles[0].name.clone();
    let (_, examples) = PAGE.split_once("## Ten examples").expect("the section");
    let examples: Vec<&str> = examples.lines().filter_map(|line| line.strip_prefix("    ")).collect();
    assert_eq!(examples.len(), 10);
    for example in examples {
        let scenario = if example.contains("load") { &slung } else { &fleet };
        let example = example.replace("quad-1", &quadrotor);
        requirement(&example).formula(scenario).unwrap_or_else(|error| panic!("{example}: {error}"));
    }
}

#[test]
fn the_page_lists_every_signal() {
    for signal in SIGNALS {
        let row = format!("| `{}` | {} | {} |", signal.name, signal.unit(), signal.description);
        assert!(PAGE.contains(&row), "{row}");
    }
}
