//! Every check on both sides of its limit.

use harness::verdict::{Status, Verdict};
use scenarios::Family;
use sim::{Event, EventKind};

use crate::edge_table::{Edge, PassingCase, assert_both_sides, assert_complete, assert_passes, edge};
use crate::fleet::{Case, SPEED_MPS, check, factors};

impl PassingCase for Case {
    fn good() -> Self {
        Self::good()
    }

    fn judge(&self) -> Verdict {
        self.judge()
    }
}

/// Distances 1 mm from their limits where the check measures in metres.
const EDGES: &[Edge<Case>] = &[
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

/// Vehicles that arrive 0.3 s late, and a limit on the duration.
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

#[test]
fn the_good_fleet_passes() {
    assert_passes(&Case::good().judge(), Family::FixedWing);
}

#[test]
fn every_check_fails_just_beyond_its_limit_and_passes_just_inside() {
    assert_both_sides(EDGES);
}

/// Checks of the cable: no vehicle carries a load.
const SKIPPED: [&str; 3] = ["flight.tension", "flight.slack", "flight.swing"];

#[test]
fn every_check_has_a_row_in_the_table() {
    assert_complete(EDGES, Family::FixedWing, &SKIPPED);
    for name in SKIPPED {
        assert_eq!(Case::good().check(name).reason.as_deref(), Some("no vehicle carries a load"));
    }
}

#[test]
fn margins_are_in_the_unit_of_the_check() {
    for (name, amount, margin) in
        [("flight.separation", 99.999, 0.001), ("flight.clearance", 99.001, -0.001), ("flight.goal", 4.999, 0.001)]
    {
        let edge = EDGES.iter().find(|edge| edge.check == name).unwrap();
        let measured = check(&edge.verdict(amount), name).margin.unwrap();
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

/// A velocity jump at the last node moves no position: it counts by itself, times the 2 s of the interval.
#[test]
fn a_jump_of_velocity_breaks_the_dynamics() {
    for (jump_mps, status) in [(0.501, Status::Fail), (0.499, Status::Pass)] {
        let mut case = Case::good();
        case.trajectory(0).states[10].speed_mps += jump_mps;
        assert_eq!(case.status("plan.dynamics"), status);
    }
}
