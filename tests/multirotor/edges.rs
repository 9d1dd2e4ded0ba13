//! Every check on multirotors, on both sides of its limit.

use harness::verdict::{Status, Verdict};
use scenarios::Family;
use sim::{Event, EventKind};

use crate::case::{Case, acceleration};
use crate::edge_table::{Edge, PassingCase, assert_both_sides, assert_complete, assert_passes, edge};

impl PassingCase for Case {
    fn good() -> Self {
        Self::good()
    }

    fn judge(&self) -> Verdict {
        self.judge()
    }
}

const EDGES: &[Edge<Case>] = &[
    edge("nodes.separation", |case, m| case.trajectory(1).states[1].position_m[1] = m, 0.999, 1.001),
    edge("nodes.clearance", grow_wall, -0.001, 0.001),
    edge("nodes.state_limits", |case, mps| case.trajectory(0).states[1].velocity_mps[0] = mps, 2.501, 2.499),
    edge("nodes.control_limits", |case, a| case.model().planning_limits.acceleration_mps2 = a, 0.999, 1.001),
    edge("nodes.goal", |case, m| case.scenario.vehicles[0].goal.x_m = 6.0 + m, 0.501, 0.499),
    edge("plan.finite", |case, value| case.plan.objective = Some(value), f64::NAN, 0.0),
    edge("plan.complete", |case, m| case.trajectory(0).states[0].position_m[1] = m, 0.011, 0.009),
    edge("plan.separation", between_nodes, 0.999, 1.001),
    edge("plan.clearance", dip_between_nodes, -0.001, 0.001),
    edge("plan.state_limits", |case, mps| case.model().limits.speed_mps = mps, 1.999, 2.001),
    edge("plan.control_limits", |case, a| case.model().limits.acceleration_mps2 = a, 0.999, 1.001),
    edge("plan.goal", |case, m| case.trajectory(1).states[3].position_m[2] += m, 0.501, 0.499),
    edge("plan.rest", |case, mps| case.trajectory(1).states[3].velocity_mps[1] = mps, 0.201, 0.199),
    edge("plan.arrival", |case, s| case.trajectory(1).times_s[3] += s, 0.501, 0.499),
    edge("plan.duration", |case, s| case.scenario.simulation.max_duration_s = s, 4.999, 5.001),
    edge("flight.finite", |case, value| case.samples(0)[77].measured_position_m[2] = value, f64::INFINITY, 0.0),
    edge("flight.complete", |case, steps| case.samples(0).truncate(steps as usize), 499.0, 601.0),
    edge("flight.crash", crash, 1.0, 0.0),
    edge("flight.conditions", |case, mps| case.samples(0)[123].wind_mps[1] = mps, 1e-3, 0.0),
    edge("flight.separation", |case, m| fly_at(case, 1, m), 0.999, 1.001),
    edge("flight.clearance", |case, m| fly_at(case, 0, -1.15 + m), -0.001, 0.001),
    edge("flight.state_limits", |case, mps| case.samples(1)[250].wind_mps[1] = mps, 2.2371, 2.2350),
    edge("flight.control_limits", |case, a| acceleration(&mut case.samples(0)[100]).control[2] = a, 3.001, 2.82),
    edge("flight.dynamics", |case, m| case.samples(0)[250].position_m[2] += m, 1.5e-3, 0.5e-3),
    edge("flight.goal", |case, m| case.scenario.vehicles[1].goal.z_m = 2.0 + m, 0.501, 0.499),
    edge("flight.rest", |case, mps| case.samples(0)[500].velocity_mps[2] = mps, 0.201, 0.199),
    edge("flight.arrival", |case, s| case.trajectory(1).times_s[3] += s, 0.501, 0.499),
    edge("flight.duration", |case, s| case.scenario.simulation.max_duration_s = s, 4.999, 5.001),
    edge(
        "flight.tracking_rms",
        |case, m| case.samples(0).iter_mut().for_each(|sample| sample.reference_position_m[1] += m),
        0.2001,
        0.1999,
    ),
    edge("flight.tracking_max", |case, m| case.samples(1)[123].reference_position_m[2] += m, 0.5001, 0.4999),
    edge("flight.saturation", saturate, 26.0, 25.0),
];

/// Moves a whole flight to this y: a single displaced sample would leave the motion beside it unknown.
fn fly_at(case: &mut Case, vehicle: usize, y_m: f64) {
    case.samples(vehicle).iter_mut().for_each(|sample| sample.position_m[1] = y_m);
}

/// Grows the wall to the north, to this distance from the first vehicle's surface.
fn grow_wall(case: &mut Case, clearance_m: f64) {
    case.scenario.world.boxes[0].size_m[1] = 2.0 * (2.0 - 0.35 - clearance_m);
}

/// Two cubics that approach each other only between their nodes.
fn between_nodes(case: &mut Case, distance_m: f64) {
    // Velocities ±v at both ends of the second interval, 1 s long: the cubic dips by v/4 in its middle.
    let states = &mut case.trajectory(1).states;
    states[1].velocity_mps[1] = -4.0 * (3.0 - distance_m);
    states[2].velocity_mps[1] = 4.0 * (3.0 - distance_m);
}

/// The first vehicle dips towards the wall between its nodes only; there it is 1.15 m away.
fn dip_between_nodes(case: &mut Case, clearance_m: f64) {
    let states = &mut case.trajectory(0).states;
    states[1].velocity_mps[1] = -4.0 * (1.15 - clearance_m);
    states[2].velocity_mps[1] = 4.0 * (1.15 - clearance_m);
}

fn crash(case: &mut Case, crashes: f64) {
    let kind = EventKind::Crash { obstacle: Some("wall".to_owned()) };
    let event = Event { t_s: 3.0, kind, vehicles: vec!["uav-1".to_owned()] };
    case.flight().events = vec![event; crashes as usize];
}

/// Cuts off the command during `steps` of the 501 steps of the plan: 5 % are 25.05.
fn saturate(case: &mut Case, steps: f64) {
    for sample in &mut case.samples(0)[100..100 + steps as usize] {
        acceleration(sample).command[0] = 7.7;
    }
}

#[test]
fn the_good_flight_passes() {
    assert_passes(&Case::good().judge(), Family::Multirotor);
}

#[test]
fn every_check_fails_just_beyond_its_limit_and_passes_just_inside() {
    assert_both_sides(EDGES);
}

/// Checks that do not apply: a plan of positions and velocities has no defects, and open loop says nothing without
/// feedback. `flight.planner` is made of flights that are planned in the loop: see `in_loop`.
const SKIPPED: [&str; 3] = ["plan.dynamics", "plan.rollout", "flight.planner"];

#[test]
fn every_check_has_a_row_in_the_table() {
    assert_complete(EDGES, Family::Multirotor, &SKIPPED);
}

/// Two overlapping bodies, without a separation rule and without an event in the log.
#[test]
fn overlapping_bodies_have_crashed_whatever_the_log_says() {
    for (apart_m, status) in [(0.698, Status::Fail), (0.702, Status::Pass)] {
        let mut case = Case::good();
        case.scenario.fleet.separation_m = None;
        fly_at(&mut case, 1, apart_m);
        assert_eq!(case.status("flight.separation"), Status::Skip);
        let check = case.check("flight.crash");
        assert_eq!(check.status, status, "{check:#?}");
    }
}

/// A reference that follows the vehicle would make tracking perfect.
#[test]
fn a_reference_other_than_the_plan_s_is_detected() {
    for (off_m, status) in [(1e-5, Status::Fail), (1e-7, Status::Pass)] {
        let mut case = Case::good();
        case.samples(1)[321].reference_position_m[0] += off_m;
        assert_eq!(case.status("flight.complete"), status, "{off_m} m");
    }
}

/// Delayed measurements repeat the first one until the delay has passed, and are compared with the noise even if it never
/// passes.
#[test]
fn delayed_measurements_are_checked_from_the_first_one() {
    for (delay_s, tampered) in [(0.05, 2), (0.05, 50), (100.0, 0), (100.0, 300)] {
        let mut case = Case::good();
        let sensors = &mut case.scenario.simulation.sensors;
        (sensors.position_noise_m, sensors.delay_s) = (0.01, delay_s);
        case.flight = Some(sim::fly(&case.scenario, &case.plan, 0, &mut |_| {}));
        assert_eq!(case.status("flight.conditions"), Status::Pass, "{:#?}", case.check("flight.conditions"));
        // All of the repeated measurements, or a single one; later, only an error far beyond the noise can be detected.
        let off_m = if tampered == 50 { 10.0 } else { 1.0 };
        let end = if tampered == 0 { usize::MAX } else { tampered + 1 };
        for sample in case.samples(0).iter_mut().take(end).skip(tampered) {
            sample.measured_position_m[1] += off_m;
        }
        assert_eq!(case.status("flight.conditions"), Status::Fail, "{delay_s} s, sample {tampered}");
    }
}

/// The more a velocity changes from sample to sample, the less certain is the motion between them.
#[test]
fn uncertainty_between_samples_widens_the_bounds_of_the_clearance() {
    let width_m = |shake_mps: f64| {
        let mut case = Case::good();
        for (index, sample) in case.samples(0).iter_mut().enumerate() {
            sample.velocity_mps[1] += if index % 4 < 2 { shake_mps } else { -shake_mps };
        }
        let check = case.check("flight.clearance");
        check.upper.unwrap() - check.lower.unwrap()
    };
    assert!(width_m(0.0) < 2e-4, "{} m", width_m(0.0));
    assert!(width_m(2.0) > 1e-3, "{} m", width_m(2.0));
}

#[test]
fn clearance_includes_hidden_and_moving_obstacles_and_the_map_frame() {
    let concerned = |change: fn(&mut Case)| {
        let mut case = Case::good();
        change(&mut case);
        let check = case.check("flight.clearance");
        (check.status, check.between)
    };
    let (status, between) = concerned(|case| {
        grow_wall(case, -0.2);
        case.scenario.world.hidden = vec!["*".into()];
    });
    assert_eq!((status, between[1].as_str()), (Status::Fail, "wall"));
    let (status, between) = concerned(|case| case.scenario.world.moving[0].path_m = vec![[6.0, 3.0], [0.0, 3.0]]);
    assert_eq!((status, between), (Status::Fail, vec!["uav-2".to_owned(), "cart".to_owned()]));
    let (status, between) = concerned(|case| case.scenario.world.map.z_m.max = 2.3);
    assert_eq!((status, between[1].as_str()), (Status::Fail, "map frame"));
}
