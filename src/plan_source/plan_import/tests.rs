//! Removed velocities and controls are recovered, or their error is known.

use scenarios::fixed_wing::states_from_velocities;
use scenarios::fixed_wing::{Control, State};
use sim::fixed_wing::propagate;

use super::{controls, velocities};

/// States every `step_s` under load factors that are linear between the nodes.
fn flown(step_s: f64, control: impl Fn(f64) -> Control, count: usize) -> (Vec<f64>, Vec<State>, Vec<Control>) {
    let times_s: Vec<f64> = (0..=count).map(|k| k as f64 * step_s).collect();
    let controls: Vec<Control> = times_s.iter().map(|t| control(*t)).collect();
    let mut states = vec![State::from_array([0.0, 0.0, 400.0, 35.0, 0.3, 0.01])];
    for (k, pair) in controls.windows(2).enumerate() {
        let end = *propagate(&states[k], [pair[0], pair[1]], times_s[k], step_s, 0.1).last().expect("an end");
        states.extend(states_from_velocities(&[end.position_m.into()], &[end.velocity_mps.into()]));
    }
    (times_s, states, controls)
}

fn manoeuvre(t: f64) -> Control {
    Control { n_x: 0.1 * (0.3 * t).sin(), n_y: 0.2 * (0.2 * t).cos(), n_z: 1.0 + 0.05 * (0.5 * t).sin() }
}

fn largest_difference(a: &[Control], b: &[Control]) -> f64 {
    let pairs = a.iter().zip(b).flat_map(|(a, b)| a.to_array().into_iter().zip(b.to_array()));
    pairs.map(|(a, b)| (a - b).abs()).fold(0.0, f64::max)
}

#[test]
fn load_factors_that_are_linear_between_the_nodes_are_recovered_from_states() {
    for (step_s, count) in [(5.0, 20), (0.5, 60), (0.02, 300)] {
        let (times_s, states, controls) = flown(step_s, manoeuvre, count);
        let (found, residual) = controls::fit(&times_s, &states);
        let error = largest_difference(&found, &controls);
        assert!(error < 1e-6, "{error} at steps of {step_s} s");
        assert!(residual.position_m < 1e-6 && residual.load_factor < 1e-6, "{residual:?}");
    }
}

#[test]
fn a_complete_plan_has_no_residual() {
    let (times_s, states, controls) = flown(5.0, manoeuvre, 20);
    let residual = controls::residual(&times_s, &states, &controls);
    assert!(residual.position_m < 1e-8, "{residual:?}");
}

#[test]
fn dense_positions_are_sufficient() {
    let (times_s, states, controls) = flown(0.1, manoeuvre, 300);
    let positions_m: Vec<[f64; 3]> = states.iter().map(State::position_m).collect();
    let velocities_mps = velocities::of(&times_s, &positions_m, states[0].velocity_mps());
    let rebuilt = states_from_velocities(&positions_m, &velocities_mps);
    let off = rebuilt.iter().zip(&states).map(|(a, b)| (a.speed_mps - b.speed_mps).abs()).fold(0.0, f64::max);
    assert!(off < 1e-4, "{off} m/s");
    let (found, residual) = controls::fit(&times_s, &rebuilt);
    let error = largest_difference(&found, &controls);
    assert!(error < 2e-3 && residual.position_m < 1e-4, "{error}, {residual:?}");
}

/// A jump of 1 m between two nodes is not a motion of an aircraft: it must stay visible in the residual.
#[test]
fn a_jump_stays_in_the_residual() {
    let (times_s, mut states, _) = flown(0.5, manoeuvre, 60);
    for state in &mut states[30..] {
        state.z_m += 1.0;
    }
    let (found, residual) = controls::fit(&times_s, &states);
    assert!(residual.position_m > 0.3, "{residual:?}");
    assert!(residual.load_factor > 1.0 || found.iter().any(|control| (control.n_z - 1.0).abs() > 0.5), "{residual:?}");
}

/// Extreme numbers: no panic, and no small residual.
#[test]
fn extreme_states_have_a_large_or_nan_residual() {
    let extreme = [
        [State::from_array([0.0; 6]), State::from_array([1e9, 0.0, 0.0, 0.0, 0.0, 0.0])],
        [State::from_array([0.0, 0.0, 0.0, 1e300, 0.0, 0.0]), State::from_array([1e300, 0.0, 0.0, 1e300, 3.0, 1.5])],
    ];
    for states in extreme {
        let (_, residual) = controls::fit(&[0.0, 1.0], &states);
        assert!(!(residual.position_m < 1e3 && residual.load_factor < 1.0), "{residual:?}");
    }
}

/// Of two rows 2 s apart with two decimals: a T/2, and the rounding of both ends of the chord.
#[test]
fn the_last_velocity_is_known_up_to_acceleration_and_rounding() {
    let found = super::end_velocity(&[0.0, 2.0], &[[0.25, 0.0, 0.0], [70.25, 0.0, 0.0]], 8.0).expect("two rows");
    assert_eq!(found.velocity_mps, [35.0, 0.0, 0.0]);
    let rounding_mps = 2.0 * 3.0_f64.sqrt() * 0.005 / 2.0;
    assert!((found.error_mps - (8.0 + rounding_mps)).abs() < 1e-9, "{found:?}");
}

/// Straight and level at 35 m/s for 2 s, under controls that accelerate by 0.1 g: off by 0.1 g t²/2 and 0.1 g t.
#[test]
fn the_residual_is_the_acceleration_that_is_missing() {
    let states = [0.0, 70.0].map(|x_m| State::from_array([x_m, 0.0, 400.0, 35.0, 0.0, 0.0]));
    let control = Control { n_x: 0.1, n_y: 0.0, n_z: 1.0 };
    let found = controls::residual(&[0.0, 2.0], &states, &[control; 2]);
    let off = [found.position_m - 0.2 * 9.81, found.velocity_mps - 0.2 * 9.81, found.load_factor - 0.1];
    assert!(off.iter().all(|off| off.abs() < 2e-3), "{found:?}");
}
