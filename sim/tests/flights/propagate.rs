use nalgebra::Vector3;
use scenarios::fixed_wing::{Control, State};
use sim::fixed_wing::{propagate, rollout};

use crate::{arena, polar};

const CLIMBING_TURN: State =
    State { x_m: 100.0, y_m: -50.0, z_m: 400.0, speed_mps: 33.0, heading_rad: 2.8, flight_path_rad: -0.08 };
const CONTROLS: [Control; 2] = [Control { n_x: 0.2, n_y: 0.4, n_z: 1.3 }, Control { n_x: -0.1, n_y: 0.3, n_z: 0.8 }];

/// Distance between the ends of the propagated motion and of that by the polar equations, m.
fn error_m(max_step_s: f64) -> f64 {
    let expected = polar::integrate(&CLIMBING_TURN, CONTROLS, 8.0);
    let knots = propagate(&CLIMBING_TURN, CONTROLS, 10.0, 8.0, max_step_s);
    (knots[knots.len() - 1].position_m - Vector3::from(expected.position_m())).norm()
}

#[test]
fn propagation_agrees_with_the_polar_equations_at_every_knot() {
    let knots = propagate(&CLIMBING_TURN, CONTROLS, 10.0, 8.0, 0.3);
    let at_share = |share: f64| {
        let [first, last] = CONTROLS.map(Control::to_array);
        Control::from_array(std::array::from_fn(|i| first[i] + (last[i] - first[i]) * share))
    };
    for knot in &knots[1..] {
        let t_s = knot.t_s - 10.0;
        let expected = polar::integrate(&CLIMBING_TURN, [CONTROLS[0], at_share(t_s / 8.0)], t_s);
        assert!((knot.position_m - Vector3::from(expected.position_m())).norm() < 1e-7);
        assert!((knot.velocity_mps - Vector3::from(expected.velocity_mps())).norm() < 1e-7);
    }
}

#[test]
fn knots_include_both_ends_at_equal_distances_within_the_bound() {
    let knots = propagate(&CLIMBING_TURN, CONTROLS, 10.0, 1.0, 0.3);
    let times: Vec<f64> = knots.iter().map(|knot| knot.t_s).collect();
    assert_eq!(times, [10.0, 10.25, 10.5, 10.75, 11.0]);
    assert_eq!(knots[0].position_m, Vector3::from(CLIMBING_TURN.position_m()));
    assert_eq!(knots[0].velocity_mps, Vector3::from(CLIMBING_TURN.velocity_mps()));
}

#[test]
fn propagation_is_of_order_six() {
    let ratio = error_m(2.0) / error_m(1.0);
    assert!((48.0..96.0).contains(&ratio), "halving the step divides the error by {ratio}, not by 64");
}

#[test]
fn rollout_of_a_consistent_plan_ends_at_its_last_node() {
    let trajectory = arena::manoeuvres();
    let knots = rollout(&trajectory, 0.25);
    let last = trajectory.states[trajectory.states.len() - 1];
    let end = knots[knots.len() - 1];
    assert_eq!(end.t_s, 230.0);
    assert!((end.position_m - Vector3::from(last.position_m())).norm() < 1e-6);
    for t_s in &trajectory.times_s {
        assert!(knots.iter().any(|knot| knot.t_s == *t_s), "no knot at the node at {t_s} s");
    }
}

#[test]
fn rollout_carries_an_error_on_where_propagation_restarts() {
    let mut trajectory = arena::straight(arena::level(0.0, 0.0, 35.0, 0.0), 20.0);
    // The controls decelerate from 35 to 30.095 m/s, but the states do not.
    trajectory.controls[0].n_x = -0.2;
    let end = rollout(&trajectory, 0.25).pop().unwrap();
    let lost_mps = 9.81 * 0.2 * 5.0 / 2.0;
    assert!((end.velocity_mps.x - (35.0 - lost_mps)).abs() < 1e-9);
    assert!((end.position_m.x - (700.0 - 9.81 * 0.2 * 25.0 / 3.0 - lost_mps * 15.0)).abs() < 1e-9);
}
