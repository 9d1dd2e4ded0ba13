//! Requirements in the user's own words: each goes red, near misses pass, and the page of examples holds.

use harness::verdict::{Check, FlownMotions, Status, judge, robustness_over_time};
use scenarios::in_loop::Node;
use scenarios::multirotor::Trajectory;
use scenarios::requirement::{AppliesTo, Requirement, SIGNALS};
use scenarios::{Cylinder, Geofence, GeofenceKind, Plan, Scenario, Sphere};

use crate::fleet::{Case, check, factors};
use crate::solids::terrain;

const HOVERER: &str = include_str!("../scenarios/hoverer.toml");
const PAGE: &str = include_str!("../../docs/requirements.md");

pub fn requirement(formula: &str) -> Requirement {
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
    scenario.world.geofences.push(Geofence {
        name: "site".into(),
        kind: GeofenceKind::StayIn,
        polygon_m,
        rings_m: Vec::new(),
        z_m: None,
    });
}

/// A formula about a log that nothing was flown for, and one about a plan that was made in the loop.
#[test]
fn a_requirement_that_nothing_answers_fails() {
    let mut case = Case::good();
    case.scenario.requirements.push(Requirement { applies_to: AppliesTo::Plan, ..requirement("always bank < 40 deg") });
    let verdict = case.judge();
    let unanswered = check(&verdict, "plan.requirement.r");
    assert_eq!(unanswered.status, Status::Fail);
    let reason = unanswered.reason.unwrap();
    assert!(reason.contains("nothing answers this requirement") && reason.contains("bank"), "{reason}");
    // The flight answers what the plan does not.
    case.scenario.requirements[0].applies_to = AppliesTo::Both;
    let verdict = case.judge();
    assert_eq!(check(&verdict, "plan.requirement.r").status, Status::Skip);
    assert_eq!(check(&verdict, "flight.requirement.r").status, Status::Pass);
    case.scenario.vehicles.truncate(1);
    case.scenario.requirements[0].formula = "for all pairs a, b: always distance(a, b) > 1 m".into();
    let issues = scenarios::validate(&case.scenario);
    assert!(issues.iter().any(|issue| issue.found == "a quantifier over 2 different vehicles"), "{issues:?}");
    case.scenario.requirements[0] =
        Requirement { applies_to: AppliesTo::Plan, ..requirement("always tracking_error < 40 m") };
    let issues = scenarios::validate(&case.scenario);
    assert!(issues.iter().any(|issue| issue.field == "requirements[0].applies_to"), "{issues:?}");
}

/// From rest to rest straight ahead: at rest the direction is unknown, so that only what holds of every direction is certain.
#[test]
fn angles_stay_in_their_range_and_are_unknown_at_rest() {
    let mut scenario = scenarios::parse("hoverer.toml", HOVERER).expect("the smallest multirotor");
    let name = scenario.vehicles[0].name.clone();
    let start_m = scenario.vehicles[0].start.position_m();
    let goal_m = [start_m[0] + 4.0, start_m[1], start_m[2]];
    let nodes = [Node::at_rest(0.0, start_m), Node::at_rest(4.0, goal_m)];
    let plan = Plan::new("hoverer", "by-hand", 0, vec![Trajectory::through(&name, &nodes).into()]);
    let flight = sim::fly(&scenario, &plan, 0, &mut |_| {});
    let statuses = |scenario: &mut Scenario, formula: &str| {
        scenario.requirements = vec![requirement(formula)];
        let verdict = judge(scenario, &plan, Some(&flight));
        ["plan.requirement.r", "flight.requirement.r"].map(|name| check(&verdict, name))
    };
    for tautology in ["always flight_path > -91 deg", "always heading_from(0 deg) < 181 deg"] {
        for check in statuses(&mut scenario, tautology) {
            assert_eq!(check.status, Status::Pass, "{tautology}: {check:?}");
        }
    }
    for check in statuses(&mut scenario, "always heading_from(0 deg) < 10 deg") {
        assert_eq!(check.status, Status::Undecided, "{check:?}");
        assert!(check.value.unwrap() >= -171.0, "{check:?}");
    }
    for check in statuses(&mut scenario, "always (speed > 0.5 m/s implies heading_from(0 deg) < 10 deg)") {
        assert_eq!(check.status, Status::Pass, "{check:?}");
    }
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

/// The first path crosses a ridge along y, 300 m high at x = 300 m, whose feet are 100 m away.
#[test]
fn heights_are_above_the_terrain_below() {
    let mut case = Case::good();
    case.scenario.world.terrain = Some(terrain(|x, _| if x == 300.0 { 300.0 } else { 0.0 }));
    case.scenario.requirements.push(requirement("always height > 99 m"));
    for (least_m, robustness) in [("99 m", 1.0), ("101 m", -1.0)] {
        case.scenario.requirements[0].formula = format!("always height > {least_m}");
        let verdict = case.judge();
        for name in ["plan.requirement.r", "flight.requirement.r"] {
            let check = check(&verdict, name);
            assert!((check.value.unwrap() - robustness).abs() < 1e-4, "{check:?}");
            assert_eq!(check.status, if robustness > 0.0 { Status::Pass } else { Status::Fail }, "{check:?}");
            assert!((check.at_s.unwrap() - 300.0 / 35.0).abs() < 1e-2, "{check:?}");
        }
    }
    case.scenario.world.terrain = None;
    case.scenario.world.ground_m = None;
    let error = case.scenario.requirements[0].formula(&case.scenario).expect_err("no ground");
    assert!(error.expected.contains("world.terrain"), "{error}");
}

/// A ball 50 m beside the first path.
#[test]
fn obstacles_of_any_shape_have_names() {
    let mut case = Case::good();
    case.scenario.world.spheres.push(Sphere {
        name: "balloon".into(),
        center_m: [300.0, -60.0, 400.0],
        radius_m: 10.0,
    });
    for (least, status) in [("49 m", Status::Pass), ("51 m", Status::Fail)] {
        case.scenario.requirements = vec![requirement(&format!("always distance(uav-1, balloon) > {least}"))];
        let verdict = case.judge();
        assert_eq!(check(&verdict, "plan.requirement.r").status, status);
        assert_eq!(check(&verdict, "flight.requirement.r").status, status);
    }
}

/// What is shown of `always A` is A, of what holds for all vehicles the worst one, of what holds for some the best.
#[test]
fn robustness_is_shown_over_time() {
    let mut case = Case::good();
    case.scenario.requirements = [
        "for all pairs a, b: always distance(a, b) > 150 m",
        "for some a: always distance(a, point(0 m, 0 m, 400 m)) < 800 m",
        "eventually [0 s, 5 s] altitude(uav-1) > 410 m",
        "for all a: for some b: always distance(a, b) > 1 m",
    ]
    .into_iter()
    .enumerate()
    .map(|(index, formula)| Requirement { name: format!("r{index}"), ..requirement(formula) })
    .collect();
    let flight = case.flight.clone().expect("a flight");
    let flown = FlownMotions::new(&case.scenario, &case.plan, &flight).expect("a flight of the plan");
    let curves = robustness_over_time(&case.scenario, &flown.motions, &flight);
    let names: Vec<&str> = curves.iter().map(|curve| curve.name.as_str()).collect();
    assert_eq!(names, ["r0", "r1", "r2"], "no vehicle is the worst of the last one");
    let expected: [fn(f64) -> f64; 3] = [|_| 50.0, |t_s| 800.0 - 35.0 * t_s, |_| -10.0];
    for (curve, expected) in curves.iter().zip(expected) {
        assert_eq!(curve.unit, "m");
        assert!(curve.points.len() > 300 && curve.points[0].0 == 0.0, "{}", curve.points.len());
        for (t_s, value) in &curve.points {
            // Each point holds for an interval of 0.05 s.
            assert!((value - expected(*t_s)).abs() < 4.0, "{}: {value} at {t_s} s", curve.name);
        }
    }
}

/// Straight and level: n_x is 0, n_z is 1.
#[test]
fn controls_that_acted_are_signals_of_the_family_that_has_them() {
    for (formula, robustness) in [
        ("always load_factor_z < 1.2", 0.2),
        ("always abs(load_factor_y) < 0.5", 0.5),
        ("always load_factor_x > 0.1", -0.1),
    ] {
        let [planned, flown] = checks(formula);
        assert_eq!(planned.status, Status::Skip);
        assert!((flown.value.unwrap() - robustness).abs() < 1e-3, "{formula}: {flown:?}");
        assert_eq!(flown.status, if robustness > 0.0 { Status::Pass } else { Status::Fail });
    }
    let fleet = Case::good().scenario;
    let error = requirement("always thrust < 5 N").formula(&fleet).expect_err("no rotors");
    assert!(error.expected.contains("rotors"), "{error}");
    let slung = scenarios::load("shipped:gate".as_ref()).expect("a shipped scenario");
    assert!(requirement("always thrust < 5 N").formula(&slung).is_ok());
    assert!(requirement("always load_factor_z < 2").formula(&slung).is_err());
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

/// 400 m high at 35 m/s: the one that is nearer to keeping the formula decides.
#[test]
fn a_failed_implication_says_what_is_demanded() {
    let [planned, _] = checks("always (altitude(uav-1) > 399 m implies speed(uav-1) < 30 m/s)");
    let why = planned.reason.expect("a reason");
    assert!(why.contains("`altitude(uav-1) > 399 m` holds by 1"), "{why}");
    assert!(why.contains("and there `speed(uav-1) < 30 m/s` is demanded"), "{why}");
    let [planned, _] = checks("always (altitude(uav-1) > 390 m implies speed(uav-1) < 30 m/s)");
    assert!(planned.reason.expect("a reason").contains("`speed(uav-1) < 30 m/s` decides, short by 5"));
}

#[test]
fn signals_of_the_log_are_checked_in_flight_only() {
    let [planned, flown] = checks("always airspeed < 34 m/s");
    assert_eq!((planned.status, flown.status), (Status::Skip, Status::Fail));
    assert!((flown.value.unwrap() + 1.0).abs() < 1e-9, "{flown:?}");
    let [_, flown] = checks("always (bank < 1 deg and tracking_error < 0.1 m and wind_speed < 0.1 m/s)");
    assert_eq!(flown.status, Status::Pass, "{flown:?}");
}

/// A load factor of one sample: the report names its instant and its value.
#[test]
fn the_worst_sample_is_named() {
    let mut case = Case::good();
    factors(&mut case.samples(1)[1234]).control.n_y = 0.3;
    case.scenario.requirements.push(requirement("always abs(load_factor_y) < 0.1"));
    let flown = check(&case.judge(), "flight.requirement.r");
    assert!((flown.value.unwrap() + 0.2).abs() < 1e-9 && (flown.at_s.unwrap() - 12.345).abs() < 0.006, "{flown:?}");
    let why = flown.reason.expect("a reason");
    assert!(why.contains("abs(load_factor_y) is 0.3"), "{why}");
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
