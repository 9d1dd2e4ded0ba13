//! Every check on both sides of its limit.

use std::collections::BTreeSet;

use harness::verdict::{Outcome, Status};
use scenarios::{Family, check_names};
use sim::{Event, EventKind};

use crate::fleet::{Case, SPEED_MPS, factors};

/// A check, a way to break it by a given amount, and amounts just beyond and just inside its limit.
struct Edge {
    check: &'static str,
    apply: fn(&mut Case, f64),
    fails: f64,
    passes: f64,
}

const fn edge(check: &'static str, apply: fn(&mut Case, f64), fails: f64, passes: f64) -> Edge {
    Edge { check, apply, fails, passes }
}

/// Distances 1 mm from their limits where the check measures in metres.
const EDGES: &[Edge] = &[
    edge("nodes.separation", |case, y_m| case.trajectory(0).states[5].y_m = y_m, 100.001, 99.999),
    edge("nodes.clearance", |case, y_m| case.trajectory(0).states[5].y_m = y_m, -99.001, -98.999),
    edge("nodes.state_limits", |case, speed| case.trajectory(1).states[3].speed_mps = speed, 40.001, 39.999),
    edge("nodes.control_limits", |case, n_y| case.trajectory(1).controls[3].n_y = n_y, -0.2001, -0.1999),
    edge("nodes.goal", |case, x_m| case.trajectory(2).states[10].x_m += x_m, 5.001, 4.999),
    edge("plan.finite", |case, value| case.plan.objective = Some(value), f64::NAN, 0.0),
    edge("plan.complete", |case, t_s| case.trajectory(0).times_s[4] = t_s, 6.0, 6.001),
    edge("plan.separation", |case, y_m| case.trajectory(0).states[5].y_m = y_m, 100.001, 99.999),
    edge("plan.clearance", |case, y_m| case.trajectory(0).states[5].y_m = y_m, -99.001, -98.999),
    edge("plan.state_limits", |case, speed| case.trajectory(1).states[3].speed_mps = speed, 45.001, 44.999),
    edge("plan.control_limits", |case, n_z| case.trajectory(1).controls[3].n_z = n_z, 1.4001, 1.3999),
    edge("plan.dynamics", |case, x_m| case.trajectory(2).states[6].x_m += x_m, 1.001, 0.999),
    edge("plan.rollout", |case, z_m| case.trajectory(2).states[10].z_m += z_m, 5.001, 4.999),
    edge("plan.goal", |case, y_m| case.trajectory(1).states[9].y_m += y_m, 5.001, 4.999),
    edge("plan.arrival", |case, t_s| case.trajectory(1).times_s[10] += t_s, 0.501, 0.499),
    edge("plan.duration", |case, t_s| case.scenario.simulation.max_duration_s = t_s, 19.999, 20.001),
    edge("flight.finite", |case, value| case.samples(1)[777].measured_position_m[2] = value, f64::INFINITY, 0.0),
    edge("flight.complete", |case, steps| case.samples(1).truncate(steps as usize), 1999.0, 2001.0),
    edge("flight.crash", crash, 1.0, 0.0),
    edge("flight.separation", |case, y_m| shift(case, 0, [0.0, y_m, 0.0]), 100.001, 99.999),
    edge("flight.clearance", |case, y_m| shift(case, 0, [0.0, -y_m, 0.0]), 99.001, 98.999),
    edge("flight.state_limits", |case, wind| case.samples(2)[400].wind_mps[0] = -wind, 10.001, 9.999),
    edge("flight.control_limits", |case, n_x| factors(&mut case.samples(2)[400]).control.n_x = n_x, 0.4001, 0.3999),
    edge("flight.conditions", |case, mps| case.samples(2)[400].wind_mps[1] = mps, 1.1e-6, 0.9e-6),
    edge("flight.dynamics", |case, x_m| case.samples(1)[1234].position_m[0] += x_m, 0.00101, 0.00099),
    edge("flight.goal", |case, z_m| shift(case, 1, [0.0, 0.0, z_m]), 5.001, 4.999),
    edge("flight.arrival", |case, late_s| delay(case, 1, late_s), 0.501, 0.499),
    edge("flight.duration", end_of_time, 20.299, 20.301),
    edge(
        "flight.tracking_rms",
        |case, x_m| case.samples(1).iter_mut().for_each(|s| s.reference_position_m[0] += x_m),
        2.001,
        1.999,
    ),
    edge("flight.tracking_max", |case, z_m| case.samples(1)[1234].reference_position_m[2] += z_m, 5.001, 4.999),
    edge("flight.saturation", saturate, 101.0, 100.0),
];

fn shift(case: &mut Case, vehicle: usize, by_m: [f64; 3]) {
    for sample in case.samples(vehicle) {
        for (coordinate, by_m) in sample.position_m.iter_mut().zip(by_m) {
            *coordinate += by_m;
        }
    }
}

fn delay(case: &mut Case, vehicle: usize, late_s: f64) {
    shift(case, vehicle, [-SPEED_MPS * late_s, 0.0, 0.0]);
}

/// Vehicles that are 0.3 s late, and a limit on the duration.
fn end_of_time(case: &mut Case, max_duration_s: f64) {
    case.scenario.simulation.max_duration_s = max_duration_s;
    delay(case, 0, 0.3);
}

fn crash(case: &mut Case, crashes: f64) {
    let kind = EventKind::Crash { obstacle: Some("pillar".to_owned()) };
    let event = Event { t_s: 3.0, kind, vehicles: vec!["uav-2".to_owned()] };
    case.flight().events = vec![event; crashes as usize];
}

/// Cuts off the command during `steps` of the 2001 steps of the plan: 5 % are 100.05.
fn saturate(case: &mut Case, steps: f64) {
    for sample in &mut case.samples(0)[100..100 + steps as usize] {
        factors(sample).command.n_y = 0.7;
    }
}

fn broken(edge: &Edge, amount: f64) -> Case {
    let mut case = Case::good();
    (edge.apply)(&mut case, amount);
    case
}

#[test]
fn the_good_fleet_passes() {
    let verdict = Case::good().judge();
    let bad: Vec<_> =
        verdict.checks.iter().filter(|check| !matches!(check.status, Status::Pass | Status::Skip)).collect();
    assert!(bad.is_empty(), "{bad:#?}");
    assert_eq!((verdict.outcome, verdict.overclaimed), (Outcome::Pass, false));
}

#[test]
fn every_check_fails_just_beyond_its_limit_and_passes_just_inside() {
    for edge in EDGES {
        let check = broken(edge, edge.fails).check(edge.check);
        assert_eq!(check.status, Status::Fail, "beyond: {check:#?}");
        let check = broken(edge, edge.passes).check(edge.check);
        assert_eq!(check.status, Status::Pass, "inside: {check:#?}");
        assert!(check.margin.is_some_and(|margin| margin >= 0.0), "{check:#?}");
    }
}

#[test]
fn one_red_check_fails_the_verdict() {
    for edge in EDGES {
        assert_eq!(broken(edge, edge.fails).judge().outcome, Outcome::Fail, "{}", edge.check);
    }
}

/// Nobody carries a load here, so that three checks are never asked.
const NOT_ASKED: [&str; 3] = ["flight.tension", "flight.slack", "flight.swing"];

#[test]
fn there_is_a_red_test_for_every_check_of_a_verdict() {
    let verdict = Case::good().judge();
    let names: Vec<&str> = verdict.checks.iter().map(|check| check.name.as_str()).collect();
    let expected: Vec<&str> = check_names(Family::FixedWing).collect();
    assert_eq!(names, expected, "the judge answers every check, in the order of the list");
    let red: BTreeSet<&str> = EDGES.iter().map(|edge| edge.check).chain(NOT_ASKED).collect();
    assert_eq!(red, expected.into_iter().collect());
    for check in verdict.checks.iter().filter(|check| NOT_ASKED.contains(&check.name.as_str())) {
        assert_eq!((check.status, check.reason.as_deref()), (Status::Skip, Some("no vehicle carries a load")));
    }
}

#[test]
fn margins_are_in_the_unit_of_the_check() {
    for (name, amount, margin) in
        [("flight.separation", 99.999, 0.001), ("flight.clearance", 99.001, -0.001), ("flight.goal", 4.999, 0.001)]
    {
        let edge = EDGES.iter().find(|edge| edge.check == name).unwrap();
        let measured = broken(edge, amount).check(name).margin.unwrap();
        assert!((measured - margin).abs() < 1e-9, "{name}: {measured}");
    }
}

#[test]
fn the_worst_place_is_named() {
    let mut case = Case::good();
    shift(&mut case, 0, [0.0, 150.0, 0.0]);
    let separation = case.check("flight.separation");
    assert_eq!(separation.between, ["uav-1", "uav-2"]);
    let clearance = Case::good().check("plan.clearance");
    assert_eq!(clearance.between, ["uav-1", "pillar"]);
    assert!((clearance.at_s.unwrap() - 10.0).abs() < 1e-3 && (clearance.value.unwrap() - 99.0).abs() < 1e-9);
    let mut case = Case::good();
    case.trajectory(1).states[3].speed_mps = 46.0;
    let limits = case.check("plan.state_limits");
    assert_eq!((limits.value, limits.limit, limits.unit.as_str()), (Some(46.0), Some(45.0), "m/s"));
    assert_eq!((limits.at_s, limits.between.as_slice()), (Some(6.0), ["uav-2".to_owned()].as_slice()));
}

/// At the last node a jump of velocity moves no position: it counts by itself, times the interval's 2 s.
#[test]
fn a_jump_of_velocity_breaks_the_dynamics() {
    for (jump_mps, status) in [(0.501, Status::Fail), (0.499, Status::Pass)] {
        let mut case = Case::good();
        case.trajectory(0).states[10].speed_mps += jump_mps;
        assert_eq!(case.status("plan.dynamics"), status);
    }
}
