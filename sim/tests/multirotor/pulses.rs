//! Single gusts at awkward instants, against an independent integrator with steps of 50 microseconds; and the same flight
//! with finer steps.

use std::f64::consts::TAU;

use nalgebra::{SVector, Vector3};
use scenarios::in_loop::Node;
use scenarios::{GustPulse, Gusts, Scenario, Wind};
use sim::{ControlMode, Flight, FlightOptions, fly_with};

use crate::arena::{nodes, plan, scenario};
use crate::plant::rk4;

const MASS_KG: f64 = 1.5;
const DRAG_AREA_M2: f64 = 0.05;
const MEAN_MPS: [f64; 3] = [2.0, -1.0, 0.5];

/// Hover over the start for a second, in a mean wind with these single gusts.
fn hover(step_s: f64, pulses: &[GustPulse], halvings: u32) -> Flight {
    let mut scenario = scenario("point-mass");
    scenario.simulation.step_s = step_s;
    scenario.simulation.coast_s = 0.0;
    scenario.simulation.wind = Some(Wind { mean_mps: MEAN_MPS, gusts: None, pulses: pulses.to_vec() });
    let hovering = [0.0, 1.0].map(|t_s| Node::at_rest(t_s, [0.0, 0.0, 5.0]));
    let options = FlightOptions { control_mode: ControlMode::OpenLoop, ..FlightOptions::finer(halvings) };
    fly_with(&scenario, &plan(&scenario, &hovering), 0, &options, &mut |_| {})
}

fn wind_mps(pulses: &[GustPulse], t_s: f64) -> Vector3<f64> {
    let blowing = pulses.iter().filter(|it| (0.0..=1.0).contains(&((t_s - it.start_s) / it.duration_s)));
    let gust =
        |it: &GustPulse| Vector3::from(it.peak_mps) * (0.5 - 0.5 * (TAU * (t_s - it.start_s) / it.duration_s).cos());
    Vector3::from(MEAN_MPS) + blowing.map(gust).sum::<Vector3<f64>>()
}

/// Largest distance of a flight from the drift of a body that carries its own weight, m.
fn error_m(flight: &Flight, pulses: &[GustPulse]) -> f64 {
    let (mut state, mut t_s, mut largest_m) = (SVector::<f64, 7>::zeros(), 0.0, 0.0_f64);
    state[2] = 5.0;
    for sample in &flight.vehicles[0].samples {
        while t_s < sample.t_s - 1e-9 {
            state = rk4(state, 5e-5, |state| {
                let velocity: Vector3<f64> = state.fixed_rows::<3>(3).into();
                let relative = wind_mps(pulses, state[6]) - velocity;
                let mut rate = SVector::<f64, 7>::zeros();
                rate.fixed_rows_mut::<3>(0).copy_from(&velocity);
                let drag = relative * (relative.norm() * 0.5 * 1.225 * DRAG_AREA_M2 / MASS_KG);
                rate.fixed_rows_mut::<3>(3).copy_from(&drag);
                rate[6] = 1.0;
                rate
            });
            t_s += 5e-5;
        }
        let position_m: Vector3<f64> = state.fixed_rows::<3>(0).into();
        largest_m = largest_m.max((Vector3::from(sample.position_m) - position_m).norm());
    }
    largest_m
}

fn pulse(start_s: f64, duration_s: f64, peak_mps: [f64; 3]) -> GustPulse {
    GustPulse { start_s, duration_s, peak_mps }
}

/// The gusts begin and end between samples, some within one step; each pushes the body by some centimetres per second.
#[test]
fn gusts_between_samples_move_a_vehicle_by_what_they_should() {
    for (step_s, pulses) in [
        (0.01, vec![pulse(0.1237, 0.0431, [0.0, 30.0, 0.0]), pulse(0.503, 0.0049, [0.0, 60.0, 10.0])]),
        (0.01, (0..20).map(|k| pulse(0.2 + 0.01 * f64::from(k), 0.01, [0.0, 60.0, 0.0])).collect()),
        (0.1, vec![pulse(0.3333, 0.05, [40.0, 0.0, 0.0]), pulse(0.35, 0.41, [0.0, 0.0, -20.0])]),
        (0.002, vec![pulse(0.1, 0.0085, [30.0, 30.0, 0.0])]),
    ] {
        let (flight, finer) = (hover(step_s, &pulses, 0), hover(step_s, &pulses, 1));
        let (still_m, error_m, finer_m) = (error_m(&flight, &[]), error_m(&flight, &pulses), error_m(&finer, &pulses));
        assert!(still_m > 0.01, "the gusts moved it by {still_m} m");
        assert!(error_m < 5e-5 * still_m.max(0.5), "step {step_s} s: {error_m} m of {still_m} m");
        assert!(finer_m < 0.5 * error_m + 1e-9, "step {step_s} s: {error_m} m, with half the steps {finer_m} m");
    }
}

fn gusty(plant: &str) -> Scenario {
    let mut scenario = scenario(plant);
    let gusts = Gusts { wind_at_20ft_mps: 7.0, sigma_aloft_mps: 1.0 };
    let pulses = vec![pulse(2.0037, 0.3, [0.0, 8.0, 0.0])];
    scenario.simulation.wind = Some(Wind { mean_mps: MEAN_MPS, gusts: Some(gusts), pulses });
    scenario
}

fn apart_m(scenario: &Scenario, halvings: [u32; 2]) -> f64 {
    let fly = |halvings| fly_with(scenario, &plan(scenario, &nodes()), 3, &FlightOptions::finer(halvings), &mut |_| {});
    let [one, other] = halvings.map(fly);
    let pairs = one.vehicles[0].samples.iter().zip(&other.vehicles[0].samples);
    pairs.map(|(a, b)| (Vector3::from(a.position_m) - Vector3::from(b.position_m)).norm()).fold(0.0, f64::max)
}

/// Second order: h²(1 - 1/16) against h²(1/4 - 1/16), which is 5.
#[test]
fn finer_steps_converge_with_second_order_in_wind_without_turbulence() {
    for plant in ["point-mass", "quadrotor"] {
        let mut scenario = gusty(plant);
        scenario.simulation.wind.as_mut().unwrap().gusts = None;
        let (coarse_m, fine_m) = (apart_m(&scenario, [0, 2]), apart_m(&scenario, [1, 2]));
        assert!(coarse_m > 1e-9 && coarse_m < 1e-3, "{plant}: {coarse_m} m");
        assert!((4.0..6.5).contains(&(coarse_m / fine_m)), "{plant}: {coarse_m} m, {fine_m} m");
    }
}

#[test]
fn finer_flights_sample_the_turbulence_more_often() {
    let fly = |halvings| {
        let scenario = gusty("point-mass");
        fly_with(&scenario, &plan(&scenario, &nodes()), 3, &FlightOptions::finer(halvings), &mut |_| {})
    };
    let [one, other] = [0, 2].map(fly);
    let pairs = one.vehicles[0].samples.iter().zip(&other.vehicles[0].samples);
    let largest_mps =
        pairs.map(|(a, b)| (Vector3::from(a.wind_mps) - Vector3::from(b.wind_mps)).norm()).fold(0.0, f64::max);
    assert!(largest_mps < 1e-3, "the same gusts at the samples, but {largest_mps} m/s apart");
    let apart_m = apart_m(&gusty("point-mass"), [0, 2]);
    assert!(apart_m > 1e-6 && apart_m < 5e-3, "{apart_m} m");
}
