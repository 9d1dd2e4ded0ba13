use scenarios::Scenario;
use scenarios::fixed_wing::{Control, State};
use sim::{Event, EventKind, Flight, fly};

use crate::arena::{self, BODY_RADIUS_M};

fn crashes(flight: &Flight) -> Vec<&Event> {
    flight.events.iter().filter(|event| matches!(event.kind, EventKind::Crash { .. })).collect()
}

/// The log ends with the first step at or after the crash.
fn assert_log_ends_at(flight: &Flight, vehicle: usize, t_s: f64) {
    let last_s = flight.vehicles[vehicle].samples.last().unwrap().t_s;
    assert!(last_s >= t_s && last_s < t_s + flight.step_s + 1e-9, "log ends at {last_s} s, crash at {t_s} s");
}

fn with_cylinder() -> Scenario {
    let mut scenario = arena::scenario(2);
    scenario.world.cylinders =
        vec![arena::cylinder("elsewhere", 0.0, -5000.0, 400.0), arena::cylinder("tower", 500.0, 30.0, 50.0)];
    scenario
}

#[test]
fn a_collision_with_a_cylinder_ends_the_log_at_the_first_contact() {
    let tracks = [0.0, 3000.0].map(|y_m| arena::straight(arena::level(0.0, y_m, 35.0, 0.0), 30.0));
    let flight = fly(&with_cylinder(), &arena::plan(tracks.to_vec()), 0, &mut arena::silent);
    let reach_m = 50.0 + BODY_RADIUS_M;
    let touch_s = (500.0 - (reach_m.powi(2) - 30.0_f64.powi(2)).sqrt()) / 35.0;
    let [crash] = crashes(&flight)[..] else { panic!("{:?}", flight.events) };
    assert!((crash.t_s - touch_s).abs() < 1e-6, "{} s, expected {touch_s} s", crash.t_s);
    assert_eq!(crash.kind, EventKind::Crash { obstacle: Some("tower".into()) });
    assert_eq!(crash.vehicles, ["uav-1"]);
    assert_log_ends_at(&flight, 0, touch_s);
    assert_eq!(flight.vehicles[1].samples.len(), 3201);
}

#[test]
fn passing_a_cylinder_by_a_millimetre_is_no_crash() {
    for (gap_m, expected) in [(1e-3, 0), (-1e-3, 1)] {
        let y_m = 30.0 - 50.0 - BODY_RADIUS_M - gap_m;
        let tracks = [y_m, 3000.0].map(|y_m| arena::straight(arena::level(0.0, y_m, 35.0, 0.0), 30.0));
        let flight = fly(&with_cylinder(), &arena::plan(tracks.to_vec()), 0, &mut arena::silent);
        assert_eq!(crashes(&flight).len(), expected, "gap of {gap_m} m");
    }
}

#[test]
fn a_mid_air_collision_removes_both_and_leaves_the_third() {
    let tracks = vec![
        arena::straight(arena::level(0.0, 0.0, 35.0, 0.0), 30.0),
        arena::straight(arena::level(0.0, 200.0, 40.0, 0.0), 30.0),
        arena::straight(arena::level(700.0, 1.0, 31.0, 180.0), 30.0),
    ];
    let flight = fly(&arena::scenario(3), &arena::plan(tracks), 0, &mut arena::silent);
    let along_m = ((2.0 * BODY_RADIUS_M).powi(2) - 1.0).sqrt();
    let touch_s = (700.0 - along_m) / (35.0 + 31.0);
    let [crash] = crashes(&flight)[..] else { panic!("{:?}", flight.events) };
    assert!((crash.t_s - touch_s).abs() < 1e-6, "{} s, expected {touch_s} s", crash.t_s);
    assert_eq!(crash.kind, EventKind::Crash { obstacle: None });
    assert_eq!(crash.vehicles, ["uav-1", "uav-3"]);
    assert_log_ends_at(&flight, 0, touch_s);
    assert_log_ends_at(&flight, 2, touch_s);
    assert_eq!(flight.vehicles[1].samples.len(), 3201);
}

/// Two small aircraft approach each other at 80 m/s, by 3.2 m in each step of 40 ms, and overlap for 10 ms.
#[test]
fn collisions_between_two_steps_are_detected() {
    let mut scenario = arena::scenario(2);
    scenario.simulation.step_s = 0.04;
    scenario.models.fixed_wing.get_mut("plane").unwrap().body_radius_m = 0.2;
    for start_m in [600.0, 600.7, 601.4, 602.1, 602.8] {
        let tracks = vec![
            arena::straight(arena::level(0.0, 0.0, 40.0, 0.0), 15.0),
            arena::straight(arena::level(start_m, 0.0, 40.0, 180.0), 15.0),
        ];
        let flight = fly(&scenario, &arena::plan(tracks), 0, &mut arena::silent);
        let [crash] = crashes(&flight)[..] else { panic!("no crash from {start_m} m") };
        assert!((crash.t_s - (start_m - 0.4) / 80.0).abs() < 1e-6, "{} s", crash.t_s);
    }
}

#[test]
fn an_aircraft_that_starts_inside_a_cylinder_crashes_at_once() {
    let mut scenario = with_cylinder();
    scenario.world.cylinders.push(arena::cylinder("at-the-start", 10.0, 0.0, 20.0));
    let tracks = [0.0, 3000.0].map(|y_m| arena::straight(arena::level(0.0, y_m, 35.0, 0.0), 30.0));
    let flight = fly(&scenario, &arena::plan(tracks.to_vec()), 0, &mut arena::silent);
    assert_eq!(crashes(&flight)[0].t_s, 0.0);
}

#[test]
fn an_aircraft_that_descends_to_the_ground_crashes_when_its_body_touches_it() {
    let mut scenario = arena::scenario(1);
    scenario.world.ground_m = Some(100.0);
    let start = State { flight_path_rad: -0.1, ..arena::level(0.0, 0.0, 35.0, 0.0) };
    let controls = Control { n_x: start.flight_path_rad.sin(), n_y: 0.0, n_z: start.flight_path_rad.cos() };
    let mut descent = arena::straight(start, 120.0);
    let sink_mps = -start.velocity_mps()[2];
    for (state, t_s) in descent.states.iter_mut().zip(&descent.times_s) {
        *state = State { x_m: start.velocity_mps()[0] * t_s, z_m: start.z_m - sink_mps * t_s, ..start };
    }
    descent.controls.fill(controls);
    let flight = fly(&scenario, &arena::plan(vec![descent]), 0, &mut arena::silent);
    let [crash] = crashes(&flight)[..] else { panic!("{:?}", flight.events) };
    let touch_s = (start.z_m - BODY_RADIUS_M - 100.0) / sink_mps;
    assert!((crash.t_s - touch_s).abs() < 1e-3, "{} s, expected {touch_s} s", crash.t_s);
    assert_eq!(crash.kind, EventKind::Crash { obstacle: Some("ground".into()) });
    assert_log_ends_at(&flight, 0, crash.t_s);
}
