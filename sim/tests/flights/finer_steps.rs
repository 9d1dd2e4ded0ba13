//! The same flight with finer steps, and replayed by another integrator.

use scenarios::{Scenario, Sensors, Wind};
use sim::fixed_wing::{AppliedControls, Knot, Replay};
use sim::{Flight, FlightOptions, LoggedAir, fly_with};

use crate::arena;

fn disturbed() -> Scenario {
    let mut scenario = arena::scenario(1);
    scenario.simulation.wind = Some(Wind { mean_mps: [3.0, -2.0, 0.0], gusts: None, pulses: vec![] });
    scenario.simulation.sensors = Sensors { position_noise_m: 0.3, ..Sensors::default() };
    scenario.simulation.mismatch.mass_ratio = 1.05;
    scenario
}

fn flown(scenario: &Scenario, halvings: u32) -> Flight {
    fly_with(scenario, &arena::plan(vec![arena::manoeuvres()]), 5, &FlightOptions::finer(halvings), &mut arena::silent)
}

fn apart_m(one: &Flight, other: &Flight) -> f64 {
    let (one, other) = (&one.vehicles[0].samples, &other.vehicles[0].samples);
    assert_eq!(one.len(), other.len());
    one.iter().zip(other).map(|(a, b)| (arena::position(a) - arena::position(b)).norm()).fold(0.0, f64::max)
}

/// Second order: h²(1 - 1/16) against h²(1/4 - 1/16), which is 5. The noise is the same in all three.
#[test]
fn flights_with_finer_steps_converge_with_second_order() {
    let [whole, half, quarter] = [0, 1, 2].map(|halvings| flown(&disturbed(), halvings));
    let (coarse_m, fine_m) = (apart_m(&whole, &quarter), apart_m(&half, &quarter));
    assert!(coarse_m < 1e-4, "{coarse_m} m");
    let ratio = coarse_m / fine_m;
    assert!((4.5..5.5).contains(&ratio), "{coarse_m} m, {fine_m} m: ratio {ratio}");
}

/// From the log's controls and air, with the true mass, over 2.5 s.
#[test]
fn a_replay_agrees_with_the_flight_and_detects_a_wrong_mass() {
    let scenario = disturbed();
    let flight = flown(&scenario, 0);
    let samples = &flight.vehicles[0].samples;
    let error_m = |mass_ratio: f64| {
        let replay = Replay::new(mass_ratio);
        let knot = |index: usize| Knot {
            t_s: samples[index].t_s,
            position_m: arena::position(&samples[index]),
            velocity_mps: arena::velocity(&samples[index]),
        };
        let follow = |motion: Knot, index: usize| {
            let air = LoggedAir::new(scenario.simulation.wind.as_ref(), [&samples[index], &samples[index + 1]]);
            replay.advanced(&motion, &AppliedControls { control: samples[index].load_factors().control, air })
        };
        ((4000..4250).fold(knot(4000), follow).position_m - knot(4250).position_m).norm()
    };
    assert!(error_m(1.05) < 1e-4, "{} m", error_m(1.05));
    assert!(error_m(1.0) > 0.01, "{} m", error_m(1.0));
}
