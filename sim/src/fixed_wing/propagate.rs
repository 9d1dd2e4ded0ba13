use nalgebra::Vector3;
use scenarios::Interpolation;
use scenarios::fixed_wing::{Control, State, Trajectory};

use super::air_path::acceleration_mps2;
use crate::kinematics::PointState;
use crate::runge_kutta;

/// A point of a motion, world frame.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Knot {
    /// Time, s.
    pub t_s: f64,
    /// Position, m.
    pub position_m: Vector3<f64>,
    /// Velocity, m/s.
    pub velocity_mps: Vector3<f64>,
}

impl Knot {
    /// A planned state at its time.
    pub fn new(state: &State, t_s: f64) -> Self {
        Self { t_s, position_m: state.position_m().into(), velocity_mps: state.velocity_mps().into() }
    }

    pub(super) fn point_state(&self) -> PointState {
        PointState { position_m: self.position_m, velocity_mps: self.velocity_mps }
    }
}

/// Integrates the equations of motion over one interval, in air at rest.
///
/// - `start`: state at `t0_s`
/// - `controls`: at the two ends of the interval, linear in time between them (first-order hold)
/// - `duration_s`: length of the interval, s, > 0
/// - `max_step_s`: maximum distance between two knots, which are equidistant, s, > 0
///
/// Newton's law for (position, velocity) is integrated by a Runge-Kutta method of order 6, one step per knot: with
/// steps of 0.25 s the error over a flight of 230 s of an ordinary aircraft is below 1e-8 m.
///
/// Returns the knots from `t0_s` to `t0_s + duration_s`, both ends included.
pub fn propagate(start: &State, controls: [Control; 2], t0_s: f64, duration_s: f64, max_step_s: f64) -> Vec<Knot> {
    let mut knots = vec![Knot::new(start, t0_s)];
    extend(&mut knots, controls, t0_s + duration_s, max_step_s);
    knots
}

/// Integrates the equations of motion over a whole trajectory from its first node, open loop, in air at rest.
///
/// `max_step_s`: maximum distance between two knots, s, > 0. There is a knot at the time of every node.
///
/// Returns the knots from the first node's time to the last one's.
///
/// # Panics
///
/// If the trajectory has no node.
pub fn rollout(trajectory: &Trajectory, max_step_s: f64) -> Vec<Knot> {
    let Interpolation::FirstOrderHold = trajectory.interpolation;
    let mut knots = vec![Knot::new(&trajectory.states[0], trajectory.times_s[0])];
    for (end_s, controls) in trajectory.times_s[1..].iter().zip(trajectory.controls.windows(2)) {
        extend(&mut knots, [controls[0], controls[1]], *end_s, max_step_s);
    }
    knots
}

/// Continues a motion from its last knot to `end_s` under controls that are linear in time.
fn extend(knots: &mut Vec<Knot>, controls: [Control; 2], end_s: f64, max_step_s: f64) {
    let start = knots[knots.len() - 1];
    let duration_s = end_s - start.t_s;
    let steps = (duration_s / max_step_s).ceil().max(1.0);
    let step_s = duration_s / steps;
    let mut state = start.point_state();
    knots.reserve(steps as usize);
    for step in 0..steps as usize {
        let control = |fraction: f64| first_order_hold(controls, (step as f64 + fraction) / steps);
        state = runge_kutta::advanced_point(&state, step_s, &[0.0, 1.0], |velocity_mps, fraction| {
            acceleration_mps2(velocity_mps, control(fraction))
        });
        let PointState { position_m, velocity_mps } = state;
        let t_s = if step + 1 == steps as usize { end_s } else { start.t_s + (step + 1) as f64 * step_s };
        knots.push(Knot { t_s, position_m, velocity_mps });
    }
}

/// Controls at a fraction of an interval, in [0, 1].
pub(super) fn first_order_hold([first, last]: [Control; 2], fraction: f64) -> Control {
    let [first, last] = [first.to_array(), last.to_array()];
    Control::from_array(std::array::from_fn(|axis| first[axis] + (last[axis] - first[axis]) * fraction))
}
