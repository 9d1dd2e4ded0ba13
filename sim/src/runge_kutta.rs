//! Butcher's method of order 6 with 7 stages.        [Butcher 1964, On Runge-Kutta processes of high order, J. Aust. Math. Soc. 4]

use nalgebra::{SVector, Vector3, Vector6};

use crate::kinematics::PointState;

const STAGES: usize = 7;
const NODES: [f64; STAGES] = [0.0, 1.0 / 3.0, 2.0 / 3.0, 1.0 / 3.0, 1.0 / 2.0, 1.0 / 2.0, 1.0];
const WEIGHTS: [f64; STAGES] = [11.0 / 120.0, 0.0, 27.0 / 40.0, 27.0 / 40.0, -4.0 / 15.0, -4.0 / 15.0, 11.0 / 120.0];
const COUPLING: [&[f64]; STAGES] = [
    &[],
    &[1.0 / 3.0],
    &[0.0, 2.0 / 3.0],
    &[1.0 / 12.0, 1.0 / 3.0, -1.0 / 12.0],
    &[-1.0 / 16.0, 9.0 / 8.0, -3.0 / 16.0, -3.0 / 8.0],
    &[0.0, 9.0 / 8.0, -3.0 / 8.0, -3.0 / 4.0, 1.0 / 2.0],
    &[9.0 / 44.0, -9.0 / 11.0, 63.0 / 44.0, 18.0 / 11.0, 0.0, -16.0 / 11.0],
];

/// The state after a step of `step_s`, s.
///
/// - `rate`: time derivative of a state, at a fraction of the step in [0, 1]
pub(crate) fn advanced<const N: usize>(
    state: &SVector<f64, N>,
    step_s: f64,
    rate: impl Fn(&SVector<f64, N>, f64) -> SVector<f64, N>,
) -> SVector<f64, N> {
    let mut rates = [SVector::zeros(); STAGES];
    for stage in 0..STAGES {
        let increment = weighted_sum(COUPLING[stage], &rates);
        rates[stage] = rate(&(state + increment * step_s), NODES[stage]);
    }
    state + weighted_sum(&WEIGHTS, &rates) * step_s
}

/// The state after a step of `step_s`, s, that is made up of intervals in which the rate is smooth.
///
/// - `intervals`: their ends, as ascending fractions of the step, from 0 to 1
/// - `rate`: as for [`advanced`]
pub(crate) fn advanced_over_intervals<const N: usize>(
    state: &SVector<f64, N>,
    step_s: f64,
    intervals: &[f64],
    rate: impl Fn(&SVector<f64, N>, f64) -> SVector<f64, N>,
) -> SVector<f64, N> {
    intervals.windows(2).fold(*state, |state, ends| {
        let length = ends[1] - ends[0];
        advanced(&state, step_s * length, |state, fraction| rate(state, ends[0] + length * fraction))
    })
}

/// The state of a point after a step of `step_s`, s.
///
/// - `intervals`: in which the acceleration is smooth, as for [`advanced_over_intervals`]
/// - `acceleration`: at a velocity, m/s, and a fraction of the step in [0, 1]; m/s²
pub(crate) fn advanced_point(
    start: &PointState,
    step_s: f64,
    intervals: &[f64],
    acceleration: impl Fn(&Vector3<f64>, f64) -> Vector3<f64>,
) -> PointState {
    let stack = stacked(&start.position_m, &start.velocity_mps);
    let end = advanced_over_intervals(&stack, step_s, intervals, |state, fraction| {
        let velocity_mps = state.fixed_rows::<3>(3).into_owned();
        stacked(&velocity_mps, &acceleration(&velocity_mps, fraction))
    });
    PointState { position_m: end.fixed_rows::<3>(0).into_owned(), velocity_mps: end.fixed_rows::<3>(3).into_owned() }
}

fn stacked(upper: &Vector3<f64>, lower: &Vector3<f64>) -> Vector6<f64> {
    Vector6::new(upper.x, upper.y, upper.z, lower.x, lower.y, lower.z)
}

fn weighted_sum<const N: usize>(weights: &[f64], rates: &[SVector<f64, N>; STAGES]) -> SVector<f64, N> {
    weights.iter().zip(rates).fold(SVector::zeros(), |sum, (weight, rate)| sum + rate * *weight)
}
