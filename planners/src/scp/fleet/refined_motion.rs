//! The motion that the controls of a plan lead to, integrated in small steps from every node of the plan and once
//! without a restart from start to goal.

use nalgebra::Vector3;

use super::super::dynamics::State;
use super::super::iterate::Iterate;
use super::super::shooting::{self, SUBSTEPS};
use super::motion::VehicleMotion;

/// Largest integration step, s.
const MAX_STEP_S: f64 = 0.1;

/// The motion of one vehicle in small steps.
#[derive(Clone, Debug)]
pub struct RefinedMotion {
    /// The motion, on more and shorter intervals than those of the trajectory.
    pub motion: VehicleMotion,
    /// Largest defect of the plan.
    pub defect: NodeDefect,
    /// Distance of the goal from the end of the integration without a restart, m.
    pub rollout_error_m: f64,
    /// Where the integration without a restart ends.
    pub open_loop_end: State,
}

/// Difference between a node of the plan and the state to which the controls lead from the node before it.
#[derive(Clone, Copy, Debug)]
pub struct NodeDefect {
    /// The larger of the difference of position, and the difference of velocity times the time between the nodes, m.
    pub amount_m: f64,
    /// Time of the node, s.
    pub at_s: f64,
}

impl RefinedMotion {
    /// The motion of `trajectory`. The plan has a node at the end of every control ramp too.
    pub fn new(trajectory: &Iterate) -> Self {
        // a whole number of pieces for ramps of a quarter of an interval
        let pieces = 4 * (trajectory.dt_s / (4.0 * SUBSTEPS as f64 * MAX_STEP_S)).ceil().max(1.0) as usize;
        let ramp_pieces = (trajectory.ramp * pieces as f64).round() as usize;
        let count = pieces * trajectory.intervals();
        let (mut intervals, mut rates) = (Vec::with_capacity(count), Vec::with_capacity(count));
        let mut defect = NodeDefect { amount_m: 0.0, at_s: 0.0 };
        let mut open_loop = trajectory.states[0];
        for k in 0..trajectory.intervals() {
            let interval = trajectory.interval(k);
            let (mut state, mut since) = (interval.states[0], 0);
            for piece in 1..=pieces {
                let part = [piece - 1, piece].map(|end| end as f64 / pieces as f64);
                let knots = shooting::flow_within(&interval, state, part);
                intervals.push(knots);
                rates.push(shooting::rates_within(&interval, &knots, part));
                state = knots[SUBSTEPS];
                open_loop = shooting::flow_within(&interval, open_loop, part)[SUBSTEPS];
                if piece == ramp_pieces || piece == pieces {
                    let node = if piece == pieces { interval.states[1] } else { shooting::ramp_end(&interval) };
                    let duration_s = trajectory.dt_s * (piece - since) as f64 / pieces as f64;
                    defect.consider(&state, &node, duration_s, trajectory.dt_s * (k as f64 + part[1]));
                    (state, since) = (node, piece);
                }
            }
        }
        let end = trajectory.states[trajectory.intervals()];
        let rollout_error_m = (end - open_loop).fixed_rows::<3>(0).norm();
        let dt_s = trajectory.dt_s / pieces as f64;
        Self { motion: VehicleMotion { intervals, rates, dt_s }, defect, rollout_error_m, open_loop_end: open_loop }
    }
}

impl NodeDefect {
    fn consider(&mut self, reached: &State, node: &State, duration_s: f64, at_s: f64) {
        let position_m = (reached - node).fixed_rows::<3>(0).norm();
        let velocity_m = (velocity_mps(reached) - velocity_mps(node)).norm() * duration_s;
        let is_nan = position_m.is_nan() || velocity_m.is_nan();
        let amount_m = if is_nan { f64::NAN } else { position_m.max(velocity_m) };
        // NaN is the worst
        if is_nan || amount_m > self.amount_m {
            *self = Self { amount_m, at_s };
        }
    }
}

/// Velocity in the world frame, m/s.
pub fn velocity_mps(state: &State) -> Vector3<f64> {
    let [_, _, _, v, χ, γ] = (*state).into();
    let horizontal = v * γ.cos();
    Vector3::new(horizontal * χ.cos(), horizontal * χ.sin(), v * γ.sin())
}

#[cfg(test)]
mod tests {
    use super::super::super::dynamics::Control;
    use super::*;

    /// A turn with a climb, each node where the flow in a few large steps ends.
    fn turn(dt_s: f64) -> Iterate {
        let controls: Vec<Control> =
            (0..5).map(|k| Control::new(0.05, 0.3, if k % 2 == 0 { 1.15 } else { 0.95 })).collect();
        let states = vec![State::new(0.0, 0.0, 400.0, 10.0, 0.3, 0.0); 5];
        let mut turn = Iterate { states, controls, dt_s, ramp: 0.25 };
        for k in 0..4 {
            turn.states[k + 1] = shooting::flow(&turn.interval(k))[SUBSTEPS];
        }
        turn
    }

    #[test]
    fn short_intervals_have_no_defect_and_long_ones_do() {
        let short = RefinedMotion::new(&turn(1.0));
        assert!(short.defect.amount_m < 1e-5 && short.rollout_error_m < 1e-4, "{:?}", short.defect);
        assert!((short.motion.end_s() - 4.0).abs() < 1e-12);
        let long = RefinedMotion::new(&turn(12.0));
        assert!(long.defect.amount_m > 10.0 * short.defect.amount_m, "{:?} and {:?}", long.defect, short.defect);
    }

    #[test]
    fn a_difference_of_velocity_is_a_defect() {
        let mut moved = turn(1.0);
        moved.states[4][3] += 0.5;
        let defect = RefinedMotion::new(&moved).defect;
        assert!((defect.amount_m - 0.75 * 0.5).abs() < 1e-3 && defect.at_s == 4.0, "{defect:?}");
        moved.states[2][4] = f64::NAN;
        assert!(RefinedMotion::new(&moved).defect.amount_m.is_nan());
    }
}
