use nalgebra::Vector3;
use sim::{ControlMode, FlightOptions, fly_with};

use crate::arena;

pub const OPEN_LOOP: FlightOptions = FlightOptions {
    control_mode: ControlMode::OpenLoop,
    start_offset_m: [0.0; 3],
    start_velocity_offset_mps: [0.0; 3],
    halvings: 0,
};

/// Maximum distance between the simulated flight and the polar equations at the nodes of 230 s of manoeuvres, m.
fn error_m(step_s: f64) -> f64 {
    let mut scenario = arena::scenario(1);
    scenario.simulation.step_s = step_s;
    let trajectory = arena::manoeuvres();
    let flight = fly_with(&scenario, &arena::plan(vec![trajectory.clone()]), 0, &OPEN_LOOP, &mut arena::silent);
    let nodes = trajectory.times_s.iter().zip(&trajectory.states);
    let distances = nodes.map(|(t_s, state)| {
        let sample = &flight.vehicles[0].samples[(t_s / step_s).round() as usize];
        assert!((sample.t_s - t_s).abs() < 1e-9);
        (arena::position(sample) - Vector3::from(state.position_m())).norm()
    });
    distances.fold(0.0, f64::max)
}

#[test]
fn the_flight_obeys_the_equations_to_a_millimetre() {
    let error = error_m(0.01);
    assert!(error < 1e-3, "{error} m");
}

#[test]
fn the_flight_is_of_second_order_in_the_step() {
    // Up to 10 ms the plant takes the whole step at once.
    let errors = [0.01, 0.005, 0.0025].map(error_m);
    for pair in errors.windows(2) {
        let ratio = pair[0] / pair[1];
        assert!((3.8..4.2).contains(&ratio), "halving the step divides the error by {ratio}, not by 4: {errors:?}");
    }
}

#[test]
fn the_log_holds_every_step_and_ends_after_the_coast() {
    let mut scenario = arena::scenario(1);
    scenario.simulation.coast_s = 1.5;
    let plan = arena::plan(vec![arena::straight(arena::level(0.0, 0.0, 35.0, 0.0), 7.3)]);
    let mut seconds = vec![];
    let flight = fly_with(&scenario, &plan, 0, &OPEN_LOOP, &mut |t_s| seconds.push(t_s));
    let samples = &flight.vehicles[0].samples;
    assert_eq!(samples.len(), 881);
    assert!(samples.iter().enumerate().all(|(step, sample)| (sample.t_s - 0.01 * step as f64).abs() < 1e-12));
    assert_eq!(flight.plan_end_s, 7.3);
    assert_eq!(seconds.len(), 9);
    assert!((seconds[7] - 8.0).abs() < 1e-12 && (seconds[8] - 8.8).abs() < 1e-12);
    scenario.simulation.max_duration_s = 5.0;
    let cut = fly_with(&scenario, &plan, 0, &OPEN_LOOP, &mut arena::silent);
    assert_eq!(cut.vehicles[0].samples.len(), 501);
}
