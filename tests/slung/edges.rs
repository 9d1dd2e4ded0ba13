//! Every check on slung loads, on both sides of its limit.

use harness::verdict::{Status, Verdict};
use scenarios::slung_load::Cable;
use scenarios::{Family, Gate, Range, Window};
use sim::{Event, EventKind};

use crate::case::{Case, thrusts};
use crate::edge_table::{Edge, PassingCase, assert_both_sides, assert_complete, assert_passes, edge};

impl PassingCase for Case {
    fn good() -> Self {
        Self::good()
    }

    fn judge(&self) -> Verdict {
        self.judge()
    }
}

/// Distances in flight stay farther from their limits than the difference between the integrators, 0.24 mm, within which
/// they are undecided.
/// Radius of the body, the arm's and a propeller's, m.
const BODY_M: f64 = 0.225 + 0.127;

const EDGES: &[Edge<Case>] = &[
    edge("nodes.clearance", |case, y_m| grow_wall(case, "nodes.clearance", y_m), -0.001, 0.001),
    edge("nodes.envelope", |case, y_m| grow_wall(case, "nodes.envelope", y_m), 0.049, 0.051),
    edge("nodes.rotor_clearance", |case, m| enlarge_load(case, "nodes.rotor_clearance", m), -0.001, 0.001),
    edge(
        "nodes.state_limits",
        |case, deg| case.trajectory().states[9].roll_pitch_yaw_rad[2] = deg.to_radians(),
        45.01,
        44.99,
    ),
    edge("nodes.control_limits", |case, n| case.trajectory().controls[9].thrust_n[2] = n, 0.999, 1.001),
    edge("nodes.goal", |case, z_m| case.scenario.vehicles[0].goal.z_m = 1.5 + z_m, 0.0501, 0.0499),
    edge("nodes.gates", |case, m| lower_gate(case, "nodes.gates", m), -0.001, 0.001),
    edge("plan.finite", |case, value| case.plan.objective = Some(value), f64::NAN, 0.0),
    edge("plan.complete", |case, rate| case.trajectory().states[0].body_rate_radps[1] = rate, 0.011, 0.009),
    edge("plan.clearance", |case, y_m| grow_wall(case, "plan.clearance", y_m), -0.001, 0.001),
    edge("plan.envelope", |case, y_m| grow_wall(case, "plan.envelope", y_m), 0.049, 0.051),
    edge("plan.rotor_clearance", |case, m| enlarge_load(case, "plan.rotor_clearance", m), -0.001, 0.001),
    edge("plan.state_limits", |case, x_m| case.scenario.world.map.x_m.max = 2.0 + BODY_M + x_m, -0.001, 0.001),
    edge("plan.control_limits", |case, n| case.trajectory().controls[9].thrust_n[1] = n, 0.199, 0.201),
    edge("plan.dynamics", |case, x_m| case.trajectory().states[300].load_position_m[0] += x_m, 0.0102, 0.0097),
    edge("plan.goal", |case, x_m| case.scenario.vehicles[0].goal.x_m = 2.0 + x_m, 0.0501, 0.0499),
    edge("plan.rest", |case, mps| case.scenario.vehicles[0].goal.speed_mps = mps, 0.1001, 0.0999),
    edge("plan.duration", |case, t_s| case.scenario.simulation.max_duration_s = t_s, 5.999, 6.001),
    edge(
        "plan.tension",
        |case, n| case.scenario.models.slung_load.get_mut("quad").unwrap().limits.tension_n = n,
        2.4,
        2.6,
    ),
    edge("plan.slack", lengthen, 0.0101, 0.0099),
    edge("plan.swing", |case, deg| limit_swing(case, "plan.swing", deg), -0.01, 0.01),
    edge("plan.gates", |case, m| lower_gate(case, "plan.gates", m), -0.001, 0.001),
    edge("flight.finite", |case, value| case.loads()[777].measured_position_m[2] = value, f64::INFINITY, 0.0),
    edge("flight.complete", |case, steps| case.samples().truncate(steps as usize), 2998.0, 4001.0),
    edge("flight.crash", crash, 1.0, 0.0),
    edge("flight.clearance", |case, y_m| shift_to(case, "flight.clearance", y_m), -0.001, 0.001),
    edge("flight.envelope", |case, y_m| shift_to(case, "flight.envelope", y_m), -0.001, 0.001),
    edge("flight.rotor_clearance", |case, m| enlarge_load(case, "flight.rotor_clearance", m), -0.001, 0.001),
    edge("flight.state_limits", |case, x_m| case.scenario.world.map.x_m.min = -2.0 - BODY_M - x_m, -0.001, 0.001),
    edge("flight.control_limits", |case, n| thrusts(&mut case.samples()[400]).control.thrust_n[3] = n, 7.001, 6.999),
    edge("flight.conditions", |case, mps| case.samples()[400].wind_mps[1] = mps, 1.1e-6, 0.9e-6),
    edge("flight.dynamics", |case, y_m| case.loads()[777].position_m[1] += y_m, 0.0011, 0.0009),
    edge("flight.goal", |case, z_m| case.loads()[3000].position_m[2] += z_m, 0.0505, 0.0495),
    edge("flight.rest", |case, mps| case.loads()[3000].velocity_mps[0] += mps, 0.1001, 0.0998),
    edge("flight.duration", |case, t_s| case.scenario.simulation.max_duration_s = t_s, 5.999, 6.001),
    edge(
        "flight.tracking_rms",
        |case, y_m| case.samples().iter_mut().for_each(|s| s.reference_position_m[1] += y_m),
        0.0305,
        0.0295,
    ),
    edge("flight.tracking_max", |case, z_m| case.samples()[1234].reference_position_m[2] += z_m, 0.0505, 0.0495),
    edge("flight.saturation", saturate, 151.0, 150.0),
    edge("flight.tension", |case, n| (1000..1010).for_each(|step| case.loads()[step].tension_n = n), 60.01, 59.99),
    edge("flight.slack", switch_late, 0.0201, 0.0199),
    edge("flight.swing", |case, deg| limit_swing(case, "flight.swing", deg), -0.01, 0.01),
    edge("flight.gates", |case, m| lower_gate(case, "flight.gates", m), -0.001, 0.001),
];

/// Moves the south end of the wall so that what the check measures becomes `y_m`.
fn grow_wall(case: &mut Case, check: &str, y_m: f64) {
    let now_m = case.check(check).value.unwrap();
    let wall = &mut case.scenario.world.boxes[0];
    wall.size_m[1] += now_m - y_m;
    wall.center_m[1] -= (now_m - y_m) / 2.0;
}

/// Adds a gate whose window the load enters to this depth at most, the quadrotor deeper.
fn lower_gate(case: &mut Case, check: &str, depth_m: f64) {
    let quadrotor = Window { x_m: Some(Range::new(-9.0, 9.0)), ..Window::default() };
    let load = Window { z_m: Some(Range::new(0.9, 2.0)), ..Window::default() };
    case.scenario.world.gates = vec![Gate { name: "gate".into(), quadrotor, load }];
    let now_m = case.check(check).value.unwrap();
    assert!(now_m < 0.0, "the load is below the window: {now_m}");
    case.scenario.world.gates[0].load.z_m = Some(Range::new(0.9 + now_m - depth_m, 2.0));
}

/// Enlarges the load until it is this far from the body.
fn enlarge_load(case: &mut Case, check: &str, distance_m: f64) {
    let set_radius_m = |case: &mut Case, radius_m: f64| {
        case.scenario.models.slung_load.get_mut("quad").unwrap().load_radius_m = radius_m;
    };
    let large_m = 0.6;
    set_radius_m(case, large_m);
    let now_m = case.check(check).value.unwrap();
    set_radius_m(case, large_m + now_m - distance_m);
}

/// Moves the flight to the north so that what the check measures becomes `y_m`.
fn shift_to(case: &mut Case, check: &str, y_m: f64) {
    let by_m = case.check(check).value.unwrap() - y_m;
    case.samples().iter_mut().for_each(|sample| sample.position_m[1] += by_m);
    case.loads().iter_mut().for_each(|load| load.position_m[1] += by_m);
}

/// Lengthens the planned cable at one node, without moving the quadrotor.
fn lengthen(case: &mut Case, by_m: f64) {
    case.trajectory().states[600].load_position_m[2] -= by_m;
}

/// Physical limits of the cable angles that leave the check this margin.
fn limit_swing(case: &mut Case, check: &str, margin_deg: f64) {
    let reached_deg = case.check(check).value.unwrap().abs();
    let limits = &mut case.scenario.models.slung_load.get_mut("quad").unwrap().limits;
    limits.cable_deg = scenarios::Range::new(-reached_deg - margin_deg, reached_deg + margin_deg);
}

fn crash(case: &mut Case, crashes: f64) {
    let kind = EventKind::Crash { obstacle: Some("wall".to_owned()) };
    let event = Event { t_s: 3.0, kind, vehicles: vec!["quad-1".to_owned()] };
    case.flight().events = vec![event; crashes as usize];
}

/// Cuts off the command during `steps` of the 3001 steps of the plan: 5 % are 150.05.
fn saturate(case: &mut Case, steps: f64) {
    for sample in &mut case.samples()[100..100 + steps as usize] {
        thrusts(sample).command.thrust_n[0] = 7.7;
    }
}

/// A slack phase from 3 s on in plan and flight, which ends later in flight by this much.
fn switch_late(case: &mut Case, late_s: f64) {
    case.trajectory().cable[300..350].fill(Cable::Slack);
    let event = |t_s, kind| Event { t_s, kind, vehicles: vec!["quad-1".to_owned()] };
    case.flight().events =
        vec![event(3.0, EventKind::CableSlack), event(3.5 + late_s, EventKind::CableTaut { impulse_ns: 0.1 })];
}

#[test]
fn the_good_flights_pass() {
    for case in [Case::good(), Case::caught()] {
        assert_passes(&case.judge(), Family::SlungLoad);
    }
}

#[test]
fn every_check_fails_just_beyond_its_limit_and_passes_just_inside() {
    assert_both_sides(EDGES);
}

/// Checks that do not apply: a single vehicle has no neighbour and nothing to arrive together with, and open loop says
/// nothing.
const SKIPPED: [&str; 6] =
    ["nodes.separation", "plan.separation", "plan.rollout", "plan.arrival", "flight.separation", "flight.arrival"];

#[test]
fn every_check_has_a_row_in_the_table() {
    assert_complete(EDGES, Family::SlungLoad, &SKIPPED);
}

/// The floor of the map is for the load, which hangs lowest, and of a geofence for both.
#[test]
fn the_load_counts_with_its_radius_on_the_map_and_at_geofences() {
    let case = Case::good();
    let flight = case.flight.as_ref().unwrap();
    let lowest_m = flight.vehicles[0].loads.iter().map(|load| load.position_m[2]).fold(f64::INFINITY, f64::min);
    let radius_m = case.scenario.models.slung_load["quad"].load_radius_m;
    for (above_m, status) in [(0.9 * radius_m, Status::Fail), (1.1 * radius_m, Status::Pass)] {
        let mut on_map = case.clone();
        on_map.scenario.world.map.z_m.min = lowest_m - above_m;
        let mut fenced = case.clone();
        let polygon_m = vec![[-50.0, -50.0], [50.0, -50.0], [50.0, 50.0], [-50.0, 50.0]];
        let z_m = Some(scenarios::Range::new(lowest_m - above_m, 50.0));
        let kind = scenarios::GeofenceKind::StayIn;
        fenced.scenario.world.geofences =
            vec![scenarios::Geofence { name: "site".into(), kind, polygon_m, rings_m: Vec::new(), z_m }];
        for case in [on_map, fenced] {
            assert_eq!(case.check("flight.state_limits").status, status, "{above_m}");
        }
    }
}

#[test]
fn a_planned_phase_that_is_too_short_to_be_detected_has_no_counterpart() {
    for rows in [1, 2] {
        let mut case = Case::good();
        case.trajectory().cable[300..300 + rows].fill(Cable::Slack);
        let check = case.check("flight.slack");
        assert_eq!(check.status, Status::Fail, "{rows}");
        assert!(check.reason.unwrap().contains("flown: no switch"));
    }
}
