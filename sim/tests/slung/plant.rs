//! The plant on rapier bodies, open loop, against closed forms and against the integrator of `reference_flight`.

use scenarios::slung_load::{Cable, GRAVITY_MPS2, State};
use sim::{ControlMode, EventKind, Flight, FlightOptions, LoadSample, Sample, fly_with};

use crate::arena::{plan, scenario, silent, trajectory};
use crate::reference_flight::{self, L_0, M_L, M_Q, Pair};

pub const OPEN_LOOP: FlightOptions = FlightOptions {
    control_mode: ControlMode::OpenLoop,
    start_offset_m: [0.0; 3],
    start_velocity_offset_mps: [0.0; 3],
    halvings: 0,
};

/// Step of the plant, s.
const PLANT_STEP_S: f64 = 5e-4;

/// Level flight of `duration_s` from `start`, with a total thrust that is linear in time, N.
fn flown(start: State, cable: Cable, total_n: [f64; 2], duration_s: f64) -> Flight {
    let thrusts = total_n.map(|total_n| [total_n / 4.0; 4]);
    let nodes = [(0.0, start, thrusts[0], cable), (duration_s, start, thrusts[1], cable)];
    let mut scenario = scenario();
    scenario.world.ground_m = None;
    scenario.simulation.coast_s = 0.0;
    fly_with(&scenario, &plan(trajectory(&nodes)), 0, &OPEN_LOOP, &mut silent)
}

fn state(
    position_m: [f64; 3],
    velocity_mps: [f64; 3],
    load_position_m: [f64; 3],
    load_velocity_mps: [f64; 3],
) -> State {
    State {
        position_m,
        velocity_mps,
        roll_pitch_yaw_rad: [0.0; 3],
        body_rate_radps: [0.0; 3],
        load_position_m,
        load_velocity_mps,
    }
}

fn log(flight: &Flight) -> impl Iterator<Item = (&Sample, &LoadSample)> {
    flight.vehicles[0].samples.iter().zip(&flight.vehicles[0].loads)
}

fn max_stretch_m(flight: &Flight) -> f64 {
    let length_m = |(s, l): (&Sample, &LoadSample)| distance_m(s.position_m, l.position_m);
    log(flight).map(length_m).fold(0.0, f64::max) - L_0
}

fn distance_m(a: [f64; 3], b: [f64; 3]) -> f64 {
    (0..3).map(|i| (a[i] - b[i]).powi(2)).sum::<f64>().sqrt()
}

/// Under a constant level thrust F the load swings like a pendulum in a gravity of F/m_Q:
/// β'' = -(F/m_Q)/l sin β, with the period 2π sqrt(l m_Q/F) / agm(1, cos(β_0/2)).
#[test]
fn a_free_pendulum_has_its_period_and_keeps_its_energy() {
    let total_n = (M_Q + M_L) * GRAVITY_MPS2;
    let swing: f64 = 60f64.to_radians();
    let load_m = [-L_0 * swing.sin(), 0.0, -L_0 * swing.cos()];
    let flight = flown(state([0.0; 3], [0.0; 3], load_m, [0.0; 3]), Cable::Taut, [total_n; 2], 20.0);
    let (mut a, mut g): (f64, f64) = (1.0, (swing / 2.0).cos());
    for _ in 0..10 {
        (a, g) = ((a + g) / 2.0, (a * g).sqrt());
    }
    let period_s = std::f64::consts::TAU * (L_0 * M_Q / total_n).sqrt() / a;

    // The load is at its left extreme at every whole period: compare the swing there with the first one.
    let samples: Vec<_> = log(&flight).collect();
    let swings = (20.0 / period_s) as usize;
    let index = (swings as f64 * period_s / 0.002).round() as usize;
    let relative = |i: usize| samples[i].1.position_m[0] - samples[i].0.position_m[0];
    let turning = (index - 40..index + 40).min_by(|a, b| relative(*a).total_cmp(&relative(*b))).unwrap();
    let late_s = turning as f64 * 0.002 - swings as f64 * period_s;
    let lost_m = relative(turning) - relative(0);
    println!(
        "after {swings} swings: late {late_s:.4} s, swing {lost_m:.2e} m less, stretch {:.2e} m",
        max_stretch_m(&flight)
    );
    assert!(late_s.abs() < 0.004, "{late_s} s");
    assert!(lost_m.abs() < 1e-3, "{lost_m} m");
    assert!(max_stretch_m(&flight) < 1e-5);
    assert!(flight.events.is_empty(), "{:?}", flight.events);
}

#[test]
fn a_dropped_load_is_caught_at_the_right_time_and_with_the_right_impulse() {
    let (total_n, drop_m) = (M_Q * GRAVITY_MPS2, 0.3);
    let load_m = [0.0, 0.0, -(L_0 - drop_m)];
    let flight = flown(state([0.0; 3], [0.0; 3], load_m, [0.0; 3]), Cable::Slack, [total_n; 2], 1.0);
    let fall_s = (2.0 * drop_m / GRAVITY_MPS2).sqrt();
    let impulse_ns = GRAVITY_MPS2 * fall_s * M_Q * M_L / (M_Q + M_L);
    let (t_s, flown_ns) = match flight.events.as_slice() {
        [event] => match event.kind {
            EventKind::CableTaut { impulse_ns } => (event.t_s, impulse_ns),
            _ => panic!("{event:?}"),
        },
        events => panic!("{events:?}"),
    };
    println!("caught {:.2e} s late, impulse {:.2e} N s too much", t_s - fall_s, flown_ns - impulse_ns);
    assert!((t_s - fall_s).abs() < 1e-3, "{t_s} instead of {fall_s} s");
    assert!((flown_ns - impulse_ns).abs() < 0.01 * impulse_ns, "{flown_ns} instead of {impulse_ns} N s");
    assert!(max_stretch_m(&flight) < 1e-3, "{}", max_stretch_m(&flight));
    // The forces of the cable are internal: the total momentum is that of the external forces.
    let (last, load) = log(&flight).last().unwrap();
    let momentum = M_Q * last.velocity_mps[2] + M_L * load.velocity_mps[2];
    let expected = (total_n - (M_Q + M_L) * GRAVITY_MPS2) * last.t_s;
    assert!((momentum - expected).abs() < 1e-9, "{momentum} {expected}");
}

/// The catch is at any time within a step of the plant, so that its impulse is distributed over one step or two. In
/// either case the ends of the cable do not separate afterwards.
#[test]
fn after_a_hard_catch_the_ends_of_the_cable_do_not_separate() {
    let total_n = M_Q * GRAVITY_MPS2;
    for shift in 0..12 {
        let drop_m = 0.5 + 5e-4 * f64::from(shift);
        let load_m = [0.0, 0.0, -(L_0 - drop_m)];
        let flight = flown(state([0.0; 3], [0.0; 3], load_m, [0.0; 3]), Cable::Slack, [total_n; 2], 0.4);
        let caught_s = (2.0 * drop_m / GRAVITY_MPS2).sqrt();
        let is_over = |t_s: f64| t_s > caught_s + PLANT_STEP_S + 1e-6;
        let after = log(&flight).filter(|(sample, _)| is_over(sample.t_s));
        let parting_mps = |(s, l): (&Sample, &LoadSample)| s.velocity_mps[2] - l.velocity_mps[2];
        let worst_mps = after.map(|both| parting_mps(both).abs()).fold(0.0, f64::max);
        assert!(worst_mps < 1e-3, "dropped by {drop_m} m they part with {worst_mps} m/s");
    }
}

#[test]
fn slack_and_taut_agree_with_an_independent_integrator() {
    // Thrown up and sideways, with several catches, and with a thrust that decreases and increases.
    let start = state([0.0; 3], [0.1, -0.2, 0.0], [0.1, 0.05, 0.2], [1.2, 0.4, 1.0]);
    let pair = Pair { p: [0.0; 3], v: [0.1, -0.2, 0.0], load_p: [0.1, 0.05, 0.2], load_v: [1.2, 0.4, 1.0] };
    let total = |t: f64| [0.0, 0.0, 16.0 - 2.0 * t];
    let (states, switches) = reference_flight::integrate(pair, false, &total, 2.0, 1e-5, 200);
    let flight = flown(start, Cable::Slack, [16.0, 12.0], 2.0);
    let mut worst_m: f64 = 0.0;
    for ((sample, load), wanted) in log(&flight).zip(&states) {
        worst_m = worst_m.max(distance_m(sample.position_m, wanted.p)).max(distance_m(load.position_m, wanted.load_p));
    }
    println!("maximum distance {worst_m:.2e} m, stretch {:.2e} m; switches {switches:?}", max_stretch_m(&flight));
    println!("events {:?}", flight.events);
    assert!(switches.iter().filter(|switch| switch.1.is_some()).count() >= 1);
    assert_eq!(flight.events.len(), switches.len(), "{:?} {switches:?}", flight.events);
    for (event, (t_s, impulse_ns)) in flight.events.iter().zip(&switches) {
        assert!((event.t_s - t_s).abs() < 2e-3, "{event:?} {t_s}");
        match (&event.kind, impulse_ns) {
            (EventKind::CableTaut { impulse_ns }, Some(wanted)) => {
                assert!((impulse_ns - wanted).abs() < 0.02 * wanted + 0.01, "{impulse_ns} {wanted}");
            }
            (EventKind::CableSlack, None) => {}
            other => panic!("{other:?}"),
        }
    }
    assert!(worst_m < 2e-3, "{worst_m} m");
}

#[test]
fn a_load_on_the_ground_stays_at_rest() {
    let (start, total_n) = (state([0.0, 0.0, 0.35], [0.0; 3], [0.0; 3], [0.0; 3]), M_Q * GRAVITY_MPS2);
    let nodes = [(0.0, start, [total_n / 4.0; 4], Cable::Slack), (3.0, start, [total_n / 4.0; 4], Cable::Slack)];
    let flight = fly_with(&scenario(), &plan(trajectory(&nodes)), 0, &OPEN_LOOP, &mut silent);
    let farthest_m = log(&flight).map(|(_, load)| distance_m(load.position_m, [0.0; 3])).fold(0.0, f64::max);
    let fastest = log(&flight).map(|(_, load)| distance_m(load.velocity_mps, [0.0; 3])).fold(0.0, f64::max);
    println!("moved {farthest_m:.2e} m, {fastest:.2e} m/s");
    assert!(farthest_m < 1e-4, "{farthest_m}");
    assert!(log(&flight).all(|(_, load)| load.cable == Cable::Slack && load.tension_n == 0.0));
}
