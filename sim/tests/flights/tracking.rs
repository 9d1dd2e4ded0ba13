use nalgebra::Vector3;
use scenarios::Tracker;
use sim::{EventKind, Flight, FlightOptions, fly, fly_with};

use crate::arena;

#[test]
fn an_undisturbed_flight_follows_a_consistent_plan_to_millimetres() {
    let flight = fly(&arena::scenario(1), &arena::plan(vec![arena::manoeuvres()]), 0, &mut arena::silent);
    let worst = flight.vehicles[0].samples.iter().map(arena::tracking_error_m).fold(0.0, f64::max);
    assert!(worst < 1e-3, "{worst} m");
    assert_eq!(flight.events, vec![]);
}

fn from_offset(natural_frequency_radps: f64, damping_ratio: f64, offset_m: [f64; 3]) -> Flight {
    let mut scenario = arena::scenario(1);
    scenario.simulation.tracker = Tracker { natural_frequency_radps, damping_ratio };
    let plan = arena::plan(vec![arena::manoeuvres()]);
    fly_with(
        &scenario,
        &plan,
        0,
        &FlightOptions { start_offset_m: offset_m, ..FlightOptions::default() },
        &mut arena::silent,
    )
}

/// e'' + 2 ζ ω e' + ω² e = 0 from e = 1, e' = 0.
fn decay(ω: f64, ζ: f64, t_s: f64) -> f64 {
    if ζ == 1.0 {
        return (1.0 + ω * t_s) * (-ω * t_s).exp();
    }
    let ω_d = ω * (1.0 - ζ * ζ).sqrt();
    (-ζ * ω * t_s).exp() * ((ω_d * t_s).cos() + ζ * ω / ω_d * (ω_d * t_s).sin())
}

/// The command is held over a step, unlike in the continuous-time law: the tolerance of 1 % of the offset is for that.
#[test]
fn an_offset_decays_at_the_rate_of_the_gains() {
    let offset = [2.0, -3.0, 1.5];
    for (ω, ζ) in [(0.5, 1.0), (0.8, 0.6)] {
        let flight = from_offset(ω, ζ, offset);
        for sample in &flight.vehicles[0].samples {
            let error = arena::position(sample) - Vector3::from(sample.reference_position_m);
            let expected = Vector3::from(offset) * decay(ω, ζ, sample.t_s);
            assert!((error - expected).norm() < 0.01 * Vector3::from(offset).norm(), "at {} s", sample.t_s);
        }
    }
}

#[test]
fn controls_stay_inside_the_limits_and_saturation_is_reported() {
    let scenario = arena::scenario(1);
    let flight = from_offset(0.5, 1.0, [0.0, 150.0, -40.0]);
    let limits = scenario.models.fixed_wing["plane"].limits.controls();
    let samples = &flight.vehicles[0].samples;
    for sample in samples {
        for (value, range) in sample.load_factors().control.to_array().into_iter().zip(limits) {
            assert!(range.contains(value), "{value} at {} s", sample.t_s);
        }
    }
    assert!(samples[0].is_saturated() && !samples[samples.len() - 1].is_saturated());
    assert_eq!((flight.events[0].t_s, &flight.events[0].kind), (0.0, &EventKind::SaturationBegan));
    let last_cut_s = samples.iter().rfind(|sample| sample.is_saturated()).unwrap().t_s;
    let end = flight.events.iter().rfind(|event| event.kind == EventKind::SaturationEnded).unwrap();
    assert!((end.t_s - last_cut_s - flight.step_s).abs() < 1e-9);
    assert!(arena::tracking_error_m(&samples[samples.len() - 1]) < 0.01);
}

#[test]
fn noise_affects_the_measurement_but_not_the_truth() {
    let mut scenario = arena::scenario(1);
    scenario.simulation.sensors =
        scenarios::Sensors { position_noise_m: 1.0, velocity_noise_mps: 0.1, ..Default::default() };
    let flight = fly(&scenario, &arena::plan(vec![arena::manoeuvres()]), 3, &mut arena::silent);
    let samples = &flight.vehicles[0].samples;
    let noise = samples.iter().map(|sample| sample.measured_position_m[0] - sample.position_m[0]);
    let variance = noise.map(|noise| noise * noise).sum::<f64>() / samples.len() as f64;
    assert!((variance - 1.0).abs() < 0.05, "{variance}");
    // The closed loop filters white noise of σ at each step: the path deviates by far less than σ.
    let worst = samples.iter().map(arena::tracking_error_m).fold(0.0, f64::max);
    assert!(worst > 0.005 && worst < 0.5, "{worst} m");
}

#[test]
fn the_attitude_is_along_the_air_path_and_banks_with_the_lift() {
    let flight = fly(&arena::scenario(1), &arena::plan(vec![arena::manoeuvres()]), 0, &mut arena::silent);
    for sample in flight.vehicles[0].samples.iter().step_by(100) {
        let attitude = nalgebra::UnitQuaternion::new_unchecked(sample.world_from_body.into());
        assert!((attitude.norm() - 1.0).abs() < 1e-12);
        let forward = attitude * Vector3::x();
        assert!((forward - Vector3::from(sample.air_velocity_mps()).normalize()).norm() < 1e-12);
        let bank = -attitude.euler_angles().0;
        assert!((bank.tan() - sample.load_factors().control.n_y / sample.load_factors().control.n_z).abs() < 1e-9);
    }
}
