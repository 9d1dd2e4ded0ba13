//! Clearance is that of the body: from cylinders, from the ground, and after a crash.

use harness::verdict::Status;
use sim::{Event, EventKind};

use crate::fleet::Case;

const CHECKS: [&str; 3] = ["nodes.clearance", "plan.clearance", "flight.clearance"];

/// At 400 m, with a body of 1 m.
#[test]
fn the_ground_is_an_obstacle() {
    for (ground_m, status) in [(399.001, Status::Fail), (398.999, Status::Pass)] {
        let mut case = Case::good();
        case.scenario.world.cylinders.clear();
        case.scenario.world.ground_m = Some(ground_m);
        let verdict = case.judge();
        for name in CHECKS {
            let check = verdict.check(name).unwrap();
            assert_eq!(
                (check.status, check.between.last().map(String::as_str)),
                (status, Some("ground")),
                "{check:#?}"
            );
            assert!((check.value.unwrap() - (399.0 - ground_m)).abs() < 1e-6, "{check:#?}");
        }
    }
}

#[test]
fn the_closest_of_all_obstacles_is_named() {
    let mut case = Case::good();
    case.scenario.world.ground_m = Some(250.0);
    for name in CHECKS {
        let check = case.check(name);
        assert_eq!(check.between, ["uav-1", "pillar"]);
        assert!((check.value.unwrap() - 99.0).abs() < 1e-6, "{check:#?}");
    }
}

#[test]
fn a_body_in_the_ground_is_a_crash_that_the_log_does_not_tell() {
    let mut case = Case::good();
    case.scenario.world.ground_m = Some(399.5);
    let check = case.check("flight.crash");
    assert_eq!((check.status, check.between.last().map(String::as_str)), (Status::Fail, Some("ground")), "{check:#?}");
}

/// A log ends where the body touches an obstacle: the distance at its end is 0, which is not a clearance.
#[test]
fn a_flight_that_crashes_into_an_obstacle_has_no_clearance() {
    let crash = |t_s: f64, obstacle: Option<&str>| {
        let kind = EventKind::Crash { obstacle: obstacle.map(str::to_owned) };
        let mut case = Case::good();
        case.flight().events = vec![Event { t_s, kind, vehicles: vec!["uav-1".to_owned()] }];
        case.check("flight.clearance")
    };
    let check = crash(3.0, Some("pillar"));
    assert_eq!((check.status, check.margin, check.at_s), (Status::Fail, Some(0.0), Some(3.0)), "{check:#?}");
    assert_eq!(check.between, ["uav-1", "pillar"]);
    assert_eq!(crash(3.0, None).status, Status::Pass, "two vehicles that collide touch no obstacle");
    assert_eq!(crash(21.0, Some("pillar")).status, Status::Pass, "after the mission's end");
}
