use nalgebra::Vector3;
use scenarios::fixed_wing::Control;
use scenarios::fixed_wing::Trajectory;
use sim::fixed_wing::{Reference, rollout};

use crate::arena;

/// A plan in which every node differs from the end of the propagated interval before it, by metres and by m/s.
fn inconsistent() -> Trajectory {
    let mut trajectory = arena::manoeuvres();
    for (node, state) in trajectory.states.iter_mut().enumerate().skip(1) {
        let sign = if node % 2 == 0 { 1.0 } else { -0.7 };
        state.y_m += 3.0 * sign;
        state.z_m -= 1.0 * sign;
        state.heading_rad += 0.02 * sign;
    }
    trajectory
}

#[test]
fn a_consistent_plan_is_not_changed() {
    let trajectory = arena::manoeuvres();
    let reference = Reference::new(&trajectory);
    for knot in rollout(&trajectory, 0.13) {
        let point = reference.at(knot.t_s);
        assert!((point.position_m - knot.position_m).norm() < 1e-6);
        assert!((point.velocity_mps - knot.velocity_mps).norm() < 1e-6);
    }
}

#[test]
fn the_reference_interpolates_every_node_and_is_continuous() {
    let trajectory = inconsistent();
    let reference = Reference::new(&trajectory);
    for (t_s, state) in trajectory.times_s.iter().zip(&trajectory.states) {
        for t_s in [t_s - 1e-9, *t_s, t_s + 1e-9] {
            let point = reference.at(t_s);
            assert!((point.position_m - Vector3::from(state.position_m())).norm() < 1e-6);
            assert!((point.velocity_mps - Vector3::from(state.velocity_mps())).norm() < 1e-6);
        }
    }
}

#[test]
fn velocity_and_acceleration_are_the_derivatives() {
    let reference = Reference::new(&inconsistent());
    let δ = 1e-4;
    for step in 1..2000 {
        let t_s = 0.1153 * f64::from(step);
        let [before, here, after] = [t_s - δ, t_s, t_s + δ].map(|t_s| reference.at(t_s));
        let slope = (after.position_m - before.position_m) / (2.0 * δ);
        assert!((slope - here.velocity_mps).norm() < 1e-6);
        let slope = (after.velocity_mps - before.velocity_mps) / (2.0 * δ);
        assert!((slope - here.acceleration_mps2).norm() < 1e-3);
    }
}

#[test]
fn after_the_end_it_continues_straight() {
    let reference = Reference::new(&arena::straight(arena::level(10.0, 20.0, 35.0, 90.0), 30.0));
    let point = reference.at(32.0);
    assert_eq!(reference.end_s(), 30.0);
    assert!((point.position_m - Vector3::new(10.0, 20.0 + 32.0 * 35.0, 400.0)).norm() < 1e-9);
    assert_eq!(point.acceleration_mps2, Vector3::zeros());
    assert_eq!(point.control, Control::CRUISE);
}

#[test]
fn controls_are_held_to_first_order() {
    let mut trajectory = arena::straight(arena::level(0.0, 0.0, 35.0, 0.0), 10.0);
    trajectory.controls[1].n_y = 0.2;
    let n_y = [1.0, 5.0, 7.5].map(|t_s| Reference::new(&trajectory).at(t_s).control.n_y);
    for (found, expected) in n_y.into_iter().zip([0.04, 0.2, 0.1]) {
        assert!((found - expected).abs() < 1e-14);
    }
}
