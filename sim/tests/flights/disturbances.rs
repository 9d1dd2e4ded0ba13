use nalgebra::Vector3;
use scenarios::fixed_wing::Control;
use scenarios::{Gusts, Wind};
use sim::{Flight, FlightOptions, fly, fly_with};

use crate::arena::{self, G};
use crate::open_loop::OPEN_LOOP;

const WIND_MPS: [f64; 3] = [-6.0, 4.0, 0.5];

#[test]
fn in_steady_wind_the_flight_relative_to_the_air_is_the_windless_one() {
    let plan = arena::plan(vec![arena::manoeuvres()]);
    let mut scenario = arena::scenario(1);
    // The same velocity through the air: in wind, the start velocity over ground includes that of the air.
    let still = fly_with(&scenario, &plan, 0, &OPEN_LOOP, &mut arena::silent);
    scenario.simulation.wind = Some(Wind { mean_mps: WIND_MPS, gusts: None, pulses: vec![] });
    let options = FlightOptions { start_velocity_offset_mps: WIND_MPS, ..OPEN_LOOP };
    let windy = fly_with(&scenario, &plan, 0, &options, &mut arena::silent);
    for (still, windy) in still.vehicles[0].samples.iter().zip(&windy.vehicles[0].samples) {
        let drifted = arena::position(still) + Vector3::from(WIND_MPS) * still.t_s;
        assert!((arena::position(windy) - drifted).norm() < 1e-6);
        assert_eq!(windy.wind_mps, WIND_MPS);
        assert!((Vector3::from(windy.air_velocity_mps()) - arena::velocity(still)).norm() < 1e-9);
    }
}

/// Where the vehicles of a flight start, relative to their plans, m.
fn starts_m(radius_m: f64, seed: u64) -> Vec<Vector3<f64>> {
    let mut scenario = arena::scenario(2);
    scenario.simulation.mismatch.start_radius_m = radius_m;
    let starts = [arena::level(0.0, 0.0, 35.0, 0.0), arena::level(0.0, 500.0, 35.0, 0.0)];
    let plan = arena::plan(starts.iter().map(|start| arena::straight(*start, 1.0)).collect());
    let flight = fly(&scenario, &plan, seed, &mut arena::silent);
    let first = flight.vehicles.iter().map(|log| arena::position(&log.samples[0]));
    first.zip(&starts).map(|(position_m, start)| position_m - Vector3::from(start.position_m())).collect()
}

#[test]
fn starts_are_drawn_inside_their_disc_each_on_its_own() {
    let drawn_m: Vec<Vec<Vector3<f64>>> = (0..200).map(|seed| starts_m(20.0, seed)).collect();
    assert!(drawn_m.iter().flatten().all(|offset_m| offset_m.norm() <= 20.0 && offset_m.z == 0.0));
    assert!(drawn_m.iter().flatten().any(|offset_m| offset_m.norm() > 19.0));
    assert!((0..2).all(|axis| drawn_m.iter().any(|both| both[0][axis] < -10.0)));
    assert!(drawn_m.iter().all(|both| both[0] != both[1]));
    assert_eq!(starts_m(20.0, 3), drawn_m[3]);
    assert_eq!(starts_m(0.0, 3), [Vector3::zeros(); 2]);
}

/// With a mass of r times the nominal one, n_z = r carries the weight, and n_y turns on a circle of radius
/// r V² / (g n_y).
#[test]
fn a_heavier_aircraft_flies_the_wider_circle() {
    let (ratio, n_y, speed) = (1.2, 0.3, 35.0);
    let mut scenario = arena::scenario(1);
    scenario.simulation.mismatch.mass_ratio = ratio;
    let control = Control { n_x: 0.0, n_y, n_z: ratio };
    let turn = arena::constant_controls(arena::level(0.0, 0.0, speed, 0.0), control, 60.0);
    let flight = fly_with(&scenario, &arena::plan(vec![turn]), 0, &OPEN_LOOP, &mut arena::silent);
    let (radius, rate) = (ratio * speed * speed / (G * n_y), G * n_y / (ratio * speed));
    for sample in flight.vehicles[0].samples.iter().take_while(|sample| sample.t_s <= 60.0) {
        let angle = rate * sample.t_s;
        let circle = Vector3::new(radius * angle.sin(), radius * (1.0 - angle.cos()), 400.0);
        assert!((arena::position(sample) - circle).norm() < 1e-3, "{:?}", sample.position_m);
    }
}

/// The planned lift does not balance the excess weight: at first the aircraft falls with g (1 - 1/r).
#[test]
fn an_overweight_aircraft_sags_until_the_position_feedback_balances_it() {
    let ratio = 1.1;
    let mut scenario = arena::scenario(1);
    scenario.simulation.mismatch.mass_ratio = ratio;
    let plan = arena::plan(vec![arena::straight(arena::level(0.0, 0.0, 35.0, 0.0), 60.0)]);
    let open = fly_with(&scenario, &plan, 0, &OPEN_LOOP, &mut arena::silent);
    let fallen = 400.0 - open.vehicles[0].samples[20].position_m[2];
    assert!((fallen / (G * (1.0 - 1.0 / ratio) * 0.2_f64.powi(2) / 2.0) - 1.0).abs() < 1e-3);
    // Closed loop at rest: g + ω² e = r g, so the sag is e = (r - 1) g / ω².
    let closed = fly(&scenario, &plan, 0, &mut arena::silent);
    let sag = 400.0 - closed.vehicles[0].samples[5900].position_m[2];
    let ω = scenario.simulation.tracker.natural_frequency_radps;
    assert!((sag - (ratio - 1.0) * G / (ω * ω)).abs() < 1e-3, "{sag}");
}

fn gusty(seed: u64) -> Flight {
    let mut scenario = arena::scenario(2);
    let gusts = Gusts { wind_at_20ft_mps: 7.7, sigma_aloft_mps: 0.8 };
    scenario.simulation.wind = Some(Wind { mean_mps: [0.0, 5.0, 0.0], gusts: Some(gusts), pulses: vec![] });
    let start = |y_m| arena::straight(arena::level(0.0, y_m, 35.0, 0.0), 100.0);
    fly(&scenario, &arena::plan(vec![start(0.0), start(300.0)]), seed, &mut arena::silent)
}

#[test]
fn every_vehicle_has_gusts_of_its_own_about_the_mean_wind() {
    let flight = gusty(4);
    let [first, second] = [0, 1].map(|index| &flight.vehicles[index].samples);
    assert!(first.iter().zip(second).all(|(a, b)| a.wind_mps != b.wind_mps));
    let mean = first.iter().map(|sample| Vector3::from(sample.wind_mps)).sum::<Vector3<f64>>() / first.len() as f64;
    assert!((mean - Vector3::new(0.0, 5.0, 0.0)).norm() < 1.5, "{mean}");
}

#[test]
fn the_logged_load_factors_and_air_explain_the_acceleration() {
    let flight = gusty(4);
    for pair in flight.vehicles[0].samples.windows(2) {
        let mean_air = (Vector3::from(pair[0].air_velocity_mps()) + Vector3::from(pair[1].air_velocity_mps())) / 2.0;
        let felt = (arena::velocity(&pair[1]) - arena::velocity(&pair[0])) / 0.01 + Vector3::z() * G;
        let expected = felt.dot(&mean_air.normalize()) / G;
        assert!((expected - pair[0].load_factors().control.n_x).abs() < 1e-4, "at {} s", pair[0].t_s);
    }
}
