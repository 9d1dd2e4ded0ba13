//! The planned horizontal motion of one vehicle, sampled on time slices.

use nalgebra::Vector2;
use scenarios::Range;

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
    /// Time derivatives of these states, per second.
    pub rates: Vec<Knots>,
    /// Length of an interval, s.
    pub dt_s: f64,
}

impl VehicleMotion {
    /// The flow of `trajectory`.
    pub fn new(trajectory: &Iterate) -> Self {
        let flow = |k: usize| {
            let interval = trajectory.interval(k);
            let knots = shooting::flow(&interval);
            (knots, shooting::rates_within(&interval, &knots, [0.0, 1.0]))
        };
        let (intervals, rates) = (0..trajectory.intervals()).map(flow).unzip();
        Self { intervals, rates, dt_s: trajectory.dt_s }
    }

    /// Smallest and largest value of a component of the state over interval `k`, by the cubics through the values and the
    /// derivatives at the ends of every step.
    pub fn extremes(&self, k: usize, component: usize) -> Range {
        let (states, rates) = (&self.intervals[k], &self.rates[k]);
        let step_s = self.dt_s / SUBSTEPS as f64;
        let mut found = Range::new(f64::INFINITY, f64::NEG_INFINITY);
        let mut consider = |value: f64| found = Range::new(found.min.min(value), found.max.max(value));
        states.iter().for_each(|state| consider(state[component]));
        for step in 0..SUBSTEPS {
            let values = [step, step + 1].map(|knot| states[knot][component]);
            let slopes = [step, step + 1].map(|knot| step_s * rates[knot][component]);
            turning_values(values, slopes).into_iter().flatten().for_each(&mut consider);
        }
        found
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

/// Values at which the cubic with the given `values` and `slopes` at 0 and 1 turns in between.
fn turning_values([a, b]: [f64; 2], [slope_a, slope_b]: [f64; 2]) -> [Option<f64>; 2] {
    // a + slope_a u + c u² + d u³
    let c = 3.0 * (b - a) - 2.0 * slope_a - slope_b;
    let d = slope_a + slope_b - 2.0 * (b - a);
    // the zeros of slope_a + 2 c u + 3 d u², in the form without cancellation
    let q = -(c + c.signum() * (c * c - 3.0 * d * slope_a).sqrt());
    [q / (3.0 * d), slope_a / q].map(|u| (0.0 < u && u < 1.0).then_some(a + u * (slope_a + u * (c + u * d))))
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

#[cfg(test)]
mod tests {
    use super::super::super::dynamics::Control;
    use super::*;

    #[test]
    fn cubics_turn_where_their_derivatives_vanish() {
        // u (1 - u): one turn; u³ - 1.5 u² + 0.5 u: two; a straight line and a constant: none
        assert_eq!(turning_values([0.0, 0.0], [1.0, -1.0]).into_iter().flatten().collect::<Vec<_>>(), [0.25]);
        let mut two: Vec<f64> = turning_values([0.0, 0.0], [0.5, 0.5]).into_iter().flatten().collect();
        two.sort_by(f64::total_cmp);
        assert_eq!(two.len(), 2);
        assert!((two[0] + two[1]).abs() < 1e-15 && (two[1] - 3f64.sqrt() / 36.0).abs() < 1e-15, "{two:?}");
        assert_eq!(turning_values([0.0, 1.0], [1.0, 1.0]), [None; 2]);
        assert_eq!(turning_values([2.0, 2.0], [0.0, 0.0]), [None; 2]);
    }

    /// A speed that dips within the ramp of the controls, during which the flight-path angle changes quickly, too.
    #[test]
    fn extremes_between_the_samples_are_those_of_a_fine_integration() {
        let controls = vec![Control::new(-0.05, 0.1, 1.1), Control::new(0.03, -0.1, 0.95)];
        let states = vec![State::new(0.0, 0.0, 400.0, 30.0, 0.0, -0.03); 2];
        let trajectory = Iterate { states, controls, dt_s: 4.0, ramp: 0.25 };
        let motion = VehicleMotion::new(&trajectory);
        let interval = trajectory.interval(0);
        let parts = 200;
        let mut state = interval.states[0];
        let mut dense = vec![state];
        for part in 0..parts {
            let ends = [part, part + 1].map(|end| f64::from(end) / f64::from(parts));
            let knots = shooting::flow_within(&interval, state, ends);
            dense.extend(&knots[1..]);
            state = knots[SUBSTEPS];
        }
        for (component, tolerance) in [(2, 1e-3), (3, 1e-4), (5, 1e-6)] {
            let found = motion.extremes(0, component);
            let values = || dense.iter().map(|state| state[component]);
            let (min, max) = (values().fold(f64::MAX, f64::min), values().fold(f64::MIN, f64::max));
            assert!(
                (found.min - min).abs() < tolerance && (found.max - max).abs() < tolerance,
                "{component}: {found:?}"
            );
        }
        assert!(motion.extremes(0, 3).min < 29.98, "it dips");
    }
}
