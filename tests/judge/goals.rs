//! The goal of an aircraft is a position and a velocity.

use harness::verdict::{Check, Outcome, Status};
use scenarios::Waypoint;

use crate::fleet::{Case, SPEED_MPS};

const CHECKS: [&str; 3] = ["nodes.goal", "plan.goal", "flight.goal"];

/// The checks of a fleet after a change to the goal of one vehicle.
fn checks(change: impl Fn(&mut Waypoint)) -> [Check; 3] {
    let mut case = Case::good();
    change(&mut case.scenario.vehicles[1].goal);
    let verdict = case.judge();
    CHECKS.map(|name| verdict.check(name).unwrap().clone())
}

#[test]
fn every_part_of_a_goal_is_held_against_its_tolerance() {
    type Change = fn(&mut Waypoint, f64);
    let parts: [(Change, f64, &str, &str); 4] = [
        (|goal, by| goal.z_m -= by, 5.0, "m", "it is the position"),
        (|goal, by| goal.heading_deg += by, 5.0, "deg", "it is the heading"),
        (|goal, by| goal.flight_path_deg -= by, 3.0, "deg", "it is the flight-path angle"),
        (|goal, by| goal.speed_mps -= by, 2.0, "m/s", "it is the speed"),
    ];
    for (change, tolerance, unit, reason) in parts {
        for (by, status) in [(tolerance + 1e-3, Status::Fail), (tolerance - 1e-3, Status::Pass)] {
            for check in checks(|goal| change(goal, by)) {
                assert_eq!((check.status, check.unit.as_str()), (status, unit), "{check:#?}");
                assert_eq!((check.reason.as_deref(), check.limit), (Some(reason), Some(tolerance)), "{check:#?}");
                assert!((check.value.unwrap() - by).abs() < 1e-6, "{check:#?}");
                assert_eq!(check.between, ["uav-2"]);
            }
        }
    }
}

#[test]
fn headings_are_compared_modulo_a_full_turn() {
    for turns_deg in [-720.0, -360.0, 360.0, 720.0] {
        for (by_deg, status) in [(4.9, Status::Pass), (-4.9, Status::Pass), (5.1, Status::Fail), (-5.1, Status::Fail)] {
            for check in checks(|goal| goal.heading_deg = turns_deg + by_deg) {
                assert_eq!(check.status, status, "{turns_deg} {by_deg}: {check:#?}");
            }
        }
    }
    for check in checks(|goal| goal.heading_deg = 180.0) {
        assert_eq!((check.status, check.value), (Status::Fail, Some(180.0)), "{check:#?}");
    }
}

#[test]
fn the_part_that_uses_most_of_its_tolerance_is_reported() {
    for check in checks(|goal| (goal.z_m, goal.heading_deg) = (goal.z_m + 4.0, 3.0)) {
        assert_eq!((check.unit.as_str(), check.value.map(f64::round)), ("m", Some(4.0)), "{check:#?}");
    }
    for check in checks(|goal| (goal.z_m, goal.heading_deg) = (goal.z_m + 3.0, 4.0)) {
        assert_eq!((check.unit.as_str(), check.value.map(f64::round)), ("deg", Some(4.0)), "{check:#?}");
    }
}

#[test]
fn tolerances_are_those_of_the_scenario() {
    let mut case = Case::good();
    case.scenario.vehicles[1].goal.heading_deg = 180.0;
    case.scenario.vehicles[2].goal.speed_mps = 49.0;
    case.scenario.verdict.goal_heading_deg = Some(180.0);
    case.scenario.verdict.goal_speed_mps = Some(14.1);
    case.scenario.verdict.goal_flight_path_deg = Some(1e-6);
    let verdict = case.judge();
    assert!(CHECKS.iter().all(|name| verdict.check(name).unwrap().status == Status::Pass));
}

/// The tracker steers an aircraft to the position of its goal, but in the wrong direction.
#[test]
fn the_velocity_in_flight_is_that_of_the_arrival() {
    let mut case = Case::good();
    let turned = |sample: &mut sim::Sample, deg: f64| {
        let (sin, cos) = deg.to_radians().sin_cos();
        sample.velocity_mps = [SPEED_MPS * cos, SPEED_MPS * sin, 0.0];
    };
    case.samples(0)[1900..1990].iter_mut().for_each(|sample| turned(sample, 6.0));
    assert_eq!(case.status("flight.goal"), Status::Pass);
    case.samples(0)[1990..].iter_mut().for_each(|sample| turned(sample, 6.0));
    let check = case.check("flight.goal");
    assert_eq!((check.status, check.unit.as_str()), (Status::Fail, "deg"), "{check:#?}");
}

/// The good fleet, with the goal of the first vehicle where its plan is after five of ten intervals. It flies on to the end.
fn passing() -> Case {
    let mut case = Case::good();
    case.scenario.fleet.simultaneous_arrival = false;
    case.scenario.vehicles[0].goal.x_m = SPEED_MPS * 10.0;
    case
}

#[test]
fn a_plan_may_go_on_beyond_its_goal() {
    let mut case = passing();
    let verdict = case.judge();
    assert_eq!(verdict.outcome, Outcome::Pass, "{:#?}", verdict.checks);
    case.scenario.fleet.simultaneous_arrival = true;
    let verdict = case.judge();
    for name in ["plan.arrival", "flight.arrival"] {
        let check = verdict.check(name).unwrap();
        assert_eq!(check.status, Status::Fail, "{check:#?}");
        assert!((check.value.unwrap() - 10.0).abs() < 0.01, "it arrives in the middle of the flight: {check:#?}");
    }
}

#[test]
fn a_plan_that_goes_on_must_have_met_every_part_of_its_goal() {
    type Change = fn(&mut Waypoint);
    let changes: [Change; 4] = [
        |goal| goal.z_m += 5.1,
        |goal| goal.heading_deg += 5.1,
        |goal| goal.flight_path_deg += 3.1,
        |goal| goal.speed_mps += 2.1,
    ];
    for change in changes {
        let mut case = passing();
        change(&mut case.scenario.vehicles[0].goal);
        let verdict = case.judge();
        for name in CHECKS {
            assert_eq!(verdict.check(name).unwrap().status, Status::Fail, "{name}");
        }
    }
}

#[test]
fn a_flight_must_pass_the_goal_beyond_which_its_plan_goes_on() {
    let mut case = passing();
    for sample in case.samples(0).iter_mut().filter(|sample| (8.0..12.0).contains(&sample.t_s)) {
        sample.position_m[2] += 5.5;
    }
    assert_eq!(case.status("flight.goal"), Status::Fail);
    assert_eq!(case.status("plan.goal"), Status::Pass);
}

#[test]
fn what_lies_beyond_the_goal_is_judged_too() {
    let mut case = passing();
    case.scenario.world.cylinders[0].center_m = [SPEED_MPS * 15.0, -300.0];
    for name in ["plan.clearance", "flight.clearance"] {
        assert_eq!(case.status(name), Status::Fail, "{name}");
    }
}
