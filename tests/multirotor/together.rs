//! Separation of multirotors: in space, while they hover too, and until the end of the mission.

use harness::verdict::{Outcome, Status};
use scenarios::SeparationShape;
use scenarios::in_loop::Node;
use scenarios::multirotor::Trajectory;
use sim::{Event, EventKind};

use crate::case::Case;

/// The second vehicle flies the same path as the first one, this far above it.
fn above(case: &mut Case, height_m: f64) {
    let mut above = case.trajectory(0).clone();
    above.vehicle = "uav-2".to_owned();
    above.states.iter_mut().for_each(|state| state.position_m[2] += height_m);
    *case.trajectory(1) = above;
    let [first, second] = [0, 1].map(|index| case.scenario.vehicles[index].clone());
    let vehicle = &mut case.scenario.vehicles[1];
    (vehicle.start, vehicle.goal) = (first.start, first.goal);
    vehicle.start.z_m += height_m;
    vehicle.goal.z_m += height_m;
    vehicle.name = second.name;
    case.fly();
}

#[test]
fn separation_is_a_distance_in_space() {
    let mut case = Case::good();
    above(&mut case, 1.5);
    for name in ["nodes.separation", "plan.separation", "flight.separation"] {
        let check = case.check(name);
        assert_eq!(check.status, Status::Pass, "{check:?}");
        assert!((check.value.unwrap() - 1.5).abs() < 0.05, "{check:?}");
    }
    case.scenario.fleet.separation_m = Some(1.6);
    assert_eq!(case.status("plan.separation"), Status::Fail);
}

/// One vehicle 1.5 m above the other, all the time.
#[test]
fn separation_has_the_shape_that_the_scenario_states() {
    use SeparationShape::{Cylinder, Ellipsoid, Horizontal, Sphere};
    let mut case = Case::good();
    above(&mut case, 1.5);
    let mut judged = |shape, radius_m, height_m| {
        let fleet = &mut case.scenario.fleet;
        (fleet.separation_shape, fleet.separation_height_m) = (Some(shape), height_m);
        fleet.separation_m = Some(radius_m);
        ["nodes.separation", "plan.separation", "flight.separation"].map(|name| {
            let check = case.check(name);
            let margin_m = check.margin.expect("a margin");
            assert_eq!(check.status, if margin_m < 0.0 { Status::Fail } else { Status::Pass }, "{shape:?} {check:?}");
            margin_m
        })
    };
    for (shape, radius_m, height_m, expected_m) in [
        (Sphere, 1.0, None, 0.5),
        (Horizontal, 1.0, None, -1.0),
        // Far enough above each other, and not so.
        (Cylinder, 5.0, Some(1.4), 0.1),
        (Cylinder, 5.0, Some(1.7), -0.2),
        // Downwash: 1.5 of 2 m in height, and of 1.2 m.
        (Ellipsoid, 0.8, Some(2.0), 0.8 * (1.5 / 2.0 - 1.0)),
        (Ellipsoid, 0.8, Some(1.2), 0.8 * (1.5 / 1.2 - 1.0)),
    ] {
        let margins_m = judged(shape, radius_m, height_m);
        assert!(margins_m[..2].iter().all(|it| (it - expected_m).abs() < 1e-6), "{shape:?} {margins_m:?}");
        assert!((margins_m[2] - expected_m).abs() < 0.05, "{shape:?} {margins_m:?}");
    }
}

#[test]
fn a_vehicle_that_has_arrived_still_counts() {
    // The first vehicle arrives halfway and hovers there; the second one passes it at 0.8 m, later.
    let mut case = Case::good();
    let stop = |t_s: f64, x_m: f64, y_m: f64| Node::at_rest(t_s, [x_m, y_m, 2.0]);
    let path = |vehicle: &str, nodes: &[Node]| Trajectory::through(vehicle, nodes);
    *case.trajectory(0) = path("uav-1", &[stop(0.0, 0.0, 0.0), stop(4.0, 2.0, 0.0)]);
    *case.trajectory(1) = path("uav-2", &[stop(0.0, 0.0, 3.0), stop(6.0, 2.0, 0.8), stop(12.0, 6.0, 3.0)]);
    case.scenario.vehicles[0].goal.x_m = 2.0;
    case.scenario.fleet.simultaneous_arrival = false;
    case.fly();
    for name in ["plan.separation", "flight.separation"] {
        let check = case.check(name);
        assert_eq!(check.status, Status::Fail, "{check:?}");
        assert!((check.value.unwrap() - 0.8).abs() < 0.05 && check.at_s.unwrap() > 5.0, "{check:?}");
    }
}

#[test]
fn a_jump_needs_an_infinite_acceleration() {
    let mut case = Case::good();
    let middle = case.trajectory(0).times_s.len() / 2;
    let trajectory = case.trajectory(0);
    let (t_s, mut state) = (trajectory.times_s[middle], trajectory.states[middle]);
    state.position_m[0] += 0.02;
    trajectory.times_s.insert(middle + 1, t_s);
    trajectory.states.insert(middle + 1, state);
    for name in ["nodes.control_limits", "plan.control_limits"] {
        let check = case.check(name);
        assert_eq!((check.status, check.at_s), (Status::Fail, Some(t_s)), "{check:?}");
    }
}

#[test]
fn a_crash_after_the_mission_is_told_and_does_not_decide() {
    let mut case = Case::good();
    let end_s = case.plan.flight_time_s().unwrap();
    let crash = |t_s: f64| Event {
        t_s,
        kind: EventKind::Crash { obstacle: Some("wall".to_owned()) },
        vehicles: vec!["uav-1".to_owned()],
    };
    case.flight().events.push(crash(end_s + 0.5));
    let check = case.check("flight.crash");
    assert_eq!(check.status, Status::Pass, "{check:?}");
    assert!(check.reason.unwrap().contains("wall"));
    assert_eq!(case.judge().outcome, Outcome::Pass);
    case.flight().events.push(crash(end_s - 0.5));
    assert_eq!(case.status("flight.crash"), Status::Fail);
}

/// The first vehicle is at its goal after 5 s, and its plan goes on there until the second one has arrived.
#[test]
fn a_vehicle_that_waits_at_its_goal_has_arrived_before() {
    let mut case = Case::good();
    let stop = |t_s: f64, x_m: f64, y_m: f64| Node::at_rest(t_s, [x_m, y_m, 2.0]);
    *case.trajectory(0) =
        Trajectory::through("uav-1", &[stop(0.0, 0.0, 0.0), stop(5.0, 6.0, 0.0), stop(9.0, 6.0, 0.0)]);
    *case.trajectory(1) = Trajectory::through("uav-2", &[stop(0.0, 0.0, 3.0), stop(9.0, 6.0, 3.0)]);
    case.fly();
    for name in ["plan.arrival", "flight.arrival"] {
        let check = case.check(name);
        assert_eq!((check.status, &check.between[..]), (Status::Fail, &["uav-1".into(), "uav-2".into()][..]));
        assert!((check.value.unwrap() - 4.0).abs() < 1e-6, "{check:?}");
    }
}
