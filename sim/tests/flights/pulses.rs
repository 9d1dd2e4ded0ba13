//! Single gusts at awkward instants, and gusts at a coarse step, against an independent integrator.

use std::f64::consts::TAU;

use nalgebra::{SVector, Vector3};
use scenarios::{GustPulse, Gusts, Wind};
use sim::fixed_wing::{AppliedControls, Knot, Replay};
use sim::{Flight, FlightOptions, LoggedAir, Sample, fly, fly_with};

use crate::arena::{self, G};
use crate::open_loop::OPEN_LOOP;

/// Step of the integrator, s.
const FINE_S: f64 = 1e-4;

fn wind_mps(pulses: &[GustPulse], t_s: f64) -> Vector3<f64> {
    let blowing = pulses.iter().filter(|it| (0.0..=1.0).contains(&((t_s - it.start_s) / it.duration_s)));
    let gust =
        |it: &GustPulse| Vector3::from(it.peak_mps) * (0.5 - 0.5 * (TAU * (t_s - it.start_s) / it.duration_s).cos());
    blowing.map(gust).sum()
}

/// Level cruise at 35 m/s, with load factors of 1 upwards and 0 else: lift perpendicular to the motion through the air.
fn rate(state: &SVector<f64, 7>, pulses: &[GustPulse]) -> SVector<f64, 7> {
    let velocity: Vector3<f64> = state.fixed_rows::<3>(3).into();
    let through_air = velocity - wind_mps(pulses, state[6]);
    let forward = through_air.normalize();
    let up = (Vector3::z() - forward * forward.z).normalize();
    let mut rate = SVector::<f64, 7>::zeros();
    rate.fixed_rows_mut::<3>(0).copy_from(&velocity);
    rate.fixed_rows_mut::<3>(3).copy_from(&((up - Vector3::z()) * G));
    rate[6] = 1.0;
    rate
}

fn rk4(state: &SVector<f64, 7>, pulses: &[GustPulse]) -> SVector<f64, 7> {
    let k1 = rate(state, pulses);
    let k2 = rate(&(state + k1 * (FINE_S / 2.0)), pulses);
    let k3 = rate(&(state + k2 * (FINE_S / 2.0)), pulses);
    let k4 = rate(&(state + k3 * FINE_S), pulses);
    state + (k1 + k2 * 2.0 + k3 * 2.0 + k4) * (FINE_S / 6.0)
}

fn cruise(step_s: f64, pulses: &[GustPulse], halvings: u32) -> Flight {
    let mut scenario = arena::scenario(1);
    scenario.simulation.step_s = step_s;
    scenario.simulation.coast_s = 0.0;
    scenario.simulation.wind = Some(Wind { mean_mps: [0.0; 3], gusts: None, pulses: pulses.to_vec() });
    let plan = arena::plan(vec![arena::straight(arena::level(0.0, 0.0, 35.0, 0.0), 2.0)]);
    fly_with(&scenario, &plan, 0, &FlightOptions { halvings, ..OPEN_LOOP }, &mut arena::silent)
}

fn error_m(flight: &Flight, pulses: &[GustPulse]) -> f64 {
    let mut state = SVector::<f64, 7>::from([0.0, 0.0, 400.0, 35.0, 0.0, 0.0, 0.0]);
    let mut largest_m = 0.0_f64;
    for sample in &flight.vehicles[0].samples {
        while state[6] < sample.t_s - 1e-9 {
            state = rk4(&state, pulses);
        }
        largest_m = largest_m.max((arena::position(sample) - state.fixed_rows::<3>(0)).norm());
    }
    largest_m
}

fn pulse(start_s: f64, duration_s: f64, peak_mps: [f64; 3]) -> GustPulse {
    GustPulse { start_s, duration_s, peak_mps }
}

#[test]
fn gusts_between_samples_move_an_aircraft_by_what_they_should() {
    for (step_s, pulses) in [
        (0.01, vec![pulse(0.4037, 0.0461, [0.0, 0.0, 12.0]), pulse(1.2, 0.01, [0.0, 15.0, 0.0])]),
        (0.1, vec![pulse(0.3333, 0.1, [0.0, 0.0, 12.0]), pulse(0.55, 0.41, [5.0, -9.0, 4.0])]),
        (0.1, (0..10).map(|k| pulse(0.2 + 0.1 * f64::from(k), 0.1, [0.0, 0.0, 8.0])).collect()),
    ] {
        let (flight, finer) = (cruise(step_s, &pulses, 0), cruise(step_s, &pulses, 1));
        let (still_m, error_m, finer_m) = (error_m(&flight, &[]), error_m(&flight, &pulses), error_m(&finer, &pulses));
        assert!(still_m > 0.01, "the gusts moved it by {still_m} m");
        assert!(error_m < 1e-4, "step {step_s} s: {error_m} m");
        assert!(finer_m < 0.5 * error_m + 1e-9, "step {step_s} s: {error_m} m, with half the steps {finer_m} m");
    }
}

/// The largest distance between a flight and its replay in windows of 2.5 s, m.
fn replay_error_m(flight: &Flight, wind: &Wind) -> f64 {
    let knot = |sample: &Sample| Knot {
        t_s: sample.t_s,
        position_m: arena::position(sample),
        velocity_mps: arena::velocity(sample),
    };
    let (samples, mut largest_m) = (&flight.vehicles[0].samples, 0.0_f64);
    for window in samples.chunks((2.5 / flight.step_s) as usize) {
        let mut motion = knot(&window[0]);
        for pair in window.windows(2) {
            let air = LoggedAir::new(Some(wind), [&pair[0], &pair[1]]);
            motion =
                Replay::new(1.0).advanced(&motion, &AppliedControls { control: pair[0].load_factors().control, air });
            largest_m = largest_m.max((motion.position_m - arena::position(&pair[1])).norm());
        }
    }
    largest_m
}

/// Severe turbulence, and the coarsest step that a scenario may have.
#[test]
fn the_log_of_a_gusty_flight_explains_its_motion_at_every_step() {
    for step_s in [0.1, 0.05, 0.01] {
        for wind_at_20ft_mps in [7.0, 15.0, 23.0] {
            let mut scenario = arena::scenario(1);
            scenario.simulation.step_s = step_s;
            let gusts = Gusts { wind_at_20ft_mps, sigma_aloft_mps: 3.0 };
            let wind =
                Wind { mean_mps: [0.0; 3], gusts: Some(gusts), pulses: vec![pulse(5.03, 0.47, [0.0, 5.0, 5.0])] };
            scenario.simulation.wind = Some(wind.clone());
            let plan = arena::plan(vec![arena::manoeuvres()]);
            let error_m = replay_error_m(&fly(&scenario, &plan, 3, &mut arena::silent), &wind);
            assert!(error_m < 5e-4, "step {step_s} s, W20 {wind_at_20ft_mps} m/s: {error_m} m");
        }
    }
}
