//! How long the judge takes; to be run by hand:
//!
//!     cargo test --release -p harness --no-default-features --test judge -- --ignored --nocapture

use std::time::Instant;

use crate::fleet::{Case, sample};

/// A roundabout: `count` aircraft on a circle, side by side at the fleet's distance, for `steps` steps.
fn roundabout(count: usize, steps: usize) -> Case {
    let norths_m: Vec<f64> = (0..count).map(|index| 101.0 * index as f64).collect();
    let mut case = Case::straight(&norths_m, 0.01);
    let radius_m = 101.0 * count as f64 / std::f64::consts::TAU;
    for vehicle in 0..count {
        let phase = std::f64::consts::TAU * vehicle as f64 / count as f64;
        let log = (0..steps).map(|step| {
            let t_s = step as f64 * 0.01;
            let (sin, cos) = (phase + 35.0 / radius_m * t_s).sin_cos();
            sample(t_s, [radius_m * cos, radius_m * sin, 400.0], [-35.0 * sin, 35.0 * cos, 0.0])
        });
        *case.samples(vehicle) = log.collect();
        case.trajectory(vehicle).times_s[10] = (steps - 200) as f64 * 0.01;
    }
    case.scenario.simulation.max_duration_s = 600.0;
    case
}

#[test]
#[ignore = "measures, asserts nothing: run by hand"]
fn seven_aircraft_for_230_s_and_a_hundred_for_150_s() {
    for (count, steps) in [(7, 23_000), (100, 15_000)] {
        let case = roundabout(count, steps);
        let began = Instant::now();
        let verdict = case.judge();
        println!("{count} x {steps}: {:.3} s, {:?}", began.elapsed().as_secs_f64(), verdict.outcome);
    }
}
