//! The planned horizontal motion of one vehicle, sampled on time slices.

use nalgebra::Vector2;

use super::super::dynamics::State;
use super::super::iterate::Iterate;
use super::super::shooting::{self, Knots, SUBSTEPS};

/// Horizontal position and velocity at one instant, in the world frame.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct MotionSample {
    /// Position, m.
    pub position_m: Vector2<f64>,
    /// Velocity, m/s.
    pub velocity_mps: Vector2<f64>,
}

/// The motion during one time slice at [`SUBSTEPS`] + 1 equidistant instants, with cubic Hermite interpolation between
/// them.
pub type TimeSlice = [MotionSample; SUBSTEPS + 1];

/// The flow of one vehicle's trajectory, restarted at every node.
#[derive(Clone, Debug)]
pub struct VehicleMotion {
    /// States within every interval.
    pub intervals: Vec<Knots>,
    /// Length of an interval, s.
    pub dt_s: f64,
    /// Step at whose beginning the controls have a kink.
    pub kink: Option<usize>,
}

impl VehicleMotion {
    /// The flow of `trajectory`.
    pub fn new(trajectory: &Iterate) -> Self {
        let flow = |k: usize| shooting::flow(&trajectory.interval(k));
        Self {
            intervals: (0..trajectory.intervals()).map(flow).collect(),
            dt_s: trajectory.dt_s,
            kink: shooting::kink(trajectory.ramp),
        }
    }

    /// Time of arrival, s.
    pub fn end_s(&self) -> f64 {
        self.dt_s * self.intervals.len() as f64
    }

    /// The motion on time slices of `width_s`; one per interval if `width_s` is the length of an interval. A vehicle
    /// that arrives within a slice continues in a straight line to its end.
    pub fn slices(&self, width_s: f64) -> Vec<TimeSlice> {
        let own: Vec<TimeSlice> = self.intervals.iter().map(|knots| knots.map(|state| sample(&state))).collect();
        if width_s == self.dt_s {
            return own;
        }
        let end_s = self.end_s();
        let count = (end_s / width_s).ceil() as usize;
        let step_s = width_s / SUBSTEPS as f64;
        let slice =
            |slice: usize| std::array::from_fn(|m| at(&own, self.dt_s, slice as f64 * width_s + m as f64 * step_s));
        (0..count).map(slice).collect()
    }
}

/// The interval at a time, and the fraction of it that has passed.
pub fn locate(t_s: f64, dt_s: f64, intervals: usize) -> (usize, f64) {
    let k = ((t_s / dt_s) as usize).min(intervals - 1);
    (k, (t_s / dt_s - k as f64).clamp(0.0, 1.0))
}

/// The horizontal part of a state.
pub fn sample(state: &State) -> MotionSample {
    let [x, y, _, v, χ, γ] = (*state).into();
    let (sin, cos) = χ.sin_cos();
    let horizontal = v * γ.cos();
    MotionSample { position_m: Vector2::new(x, y), velocity_mps: Vector2::new(horizontal * cos, horizontal * sin) }
}

/// The motion of successive slices of `dt_s` each at any time, in a straight line beyond the end.
pub fn at(slices: &[TimeSlice], dt_s: f64, t_s: f64) -> MotionSample {
    let end_s = dt_s * slices.len() as f64;
    if t_s >= end_s {
        let last = slices[slices.len() - 1][SUBSTEPS];
        return MotionSample { position_m: last.position_m + last.velocity_mps * (t_s - end_s), ..last };
    }
    let (k, fraction) = locate(t_s, dt_s, slices.len());
    let step = ((fraction * SUBSTEPS as f64) as usize).min(SUBSTEPS - 1);
    let within_step = fraction * SUBSTEPS as f64 - step as f64;
    interpolate(&slices[k][step], &slices[k][step + 1], within_step, dt_s / SUBSTEPS as f64)
}

/// The cubic Hermite interpolant from `a` to `b`, `step_s` later, at a `fraction` of the step.
pub fn interpolate(a: &MotionSample, b: &MotionSample, fraction: f64, step_s: f64) -> MotionSample {
    let (u, w) = (fraction, 1.0 - fraction);
    let (p_0, p_1) = (a.position_m, b.position_m);
    let (v_0, v_1) = (a.velocity_mps * step_s, b.velocity_mps * step_s);
    let position_m = (p_0 * (1.0 + 2.0 * u) + v_0 * u) * (w * w) + (p_1 * (1.0 + 2.0 * w) - v_1 * w) * (u * u);
    let per_step = (p_1 - p_0) * (6.0 * u * w) + v_0 * (w * (1.0 - 3.0 * u)) - v_1 * (u * (2.0 - 3.0 * u));
    MotionSample { position_m, velocity_mps: per_step / step_s }
}
