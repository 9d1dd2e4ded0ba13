use scenarios::{Gusts, Plan, Scenario, Sensors, Wind};
use sim::{Flight, fly};

use crate::arena;

fn disturbed() -> (Scenario, Plan) {
    let mut scenario = arena::scenario(3);
    let gusts = Gusts { wind_at_20ft_mps: 7.7, sigma_aloft_mps: 0.8 };
    scenario.simulation.wind = Some(Wind { mean_mps: [3.0, 1.0, 0.0], gusts: Some(gusts), pulses: vec![] });
    scenario.simulation.sensors = Sensors { position_noise_m: 0.5, velocity_noise_mps: 0.1, ..Sensors::default() };
    scenario.world.cylinders = vec![arena::cylinder("tower", 700.0, 600.0, 80.0)];
    let start = |y_m| arena::straight(arena::level(0.0, y_m, 35.0, 0.0), 40.0);
    (scenario, arena::plan(vec![start(0.0), start(300.0), start(600.0)]))
}

/// The flight without its wall time.
fn flown(seed: u64) -> Flight {
    let (scenario, plan) = disturbed();
    Flight { wall_s: 0.0, ..fly(&scenario, &plan, seed, &mut arena::silent) }
}

#[test]
fn the_same_seed_gives_the_same_flight_to_the_bit() {
    assert_eq!(flown(1), flown(1));
}

#[test]
fn another_seed_gives_another_flight() {
    let [first, second] = [flown(1), flown(2)].map(|flight| flight.vehicles[0].samples[2000].position_m);
    assert_ne!(first, second);
}

/// Every vehicle has its own streams of random numbers: a crash of one has no effect on the others.
#[test]
fn the_flight_of_one_vehicle_does_not_depend_on_the_others() {
    let (mut scenario, plan) = disturbed();
    let with_crash = fly(&scenario, &plan, 1, &mut arena::silent);
    assert!(with_crash.vehicles[2].samples.len() < with_crash.vehicles[0].samples.len());
    scenario.world.cylinders.clear();
    let without = fly(&scenario, &plan, 1, &mut arena::silent);
    assert_eq!(with_crash.vehicles[0], without.vehicles[0]);
}
