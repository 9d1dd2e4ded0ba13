//! Multiple shooting: the flow Φ of the equations of motion under piecewise linear controls.
//!
//! ```text
//! s_{k+1} - Φ(s_k, u_k, u_{k+1}, dt) = 0
//! ```
//!
//! Φ is computed by the classical Runge-Kutta method of order 4 in [`SUBSTEPS`] equal steps. Its derivatives are those
//! of the method itself, so that they are exact for this Φ.

use nalgebra::SMatrix;

use super::dynamics::{self, State, StateJacobian};
use super::interval::{Defect, Interval};

/// Runge-Kutta steps per interval. Four are enough for the position after one interval of 5 s (a millimetre), but the
/// error of the flight-path angle accumulates: integrated open loop over 40 intervals, such a plan ends metres from its
/// goal.
pub const SUBSTEPS: usize = 8;

/// Number of parts of an interval that are each integrated in [`SUBSTEPS`] steps for an accurate end: the error of Φ is
/// divided by 256.
const ACCURATE_PARTS: usize = 4;

/// Number of parameters of Φ: V_k, χ_k, γ_k, u_k (3), u_{k+1} (3), dt. The position is left out: Φ is affine in it.
const PARAMETERS: usize = 10;

/// Column of dt.
const DT_COLUMN: usize = 9;

type Sensitivity = SMatrix<f64, 6, PARAMETERS>;

/// States at the beginning of the interval and at the end of each Runge-Kutta step.
pub type Knots = [State; SUBSTEPS + 1];

/// The defect of one interval, in the units of the state.
pub fn defect(interval: &Interval) -> State {
    interval.states[1] - flow(interval)[SUBSTEPS]
}

/// The defect of one interval with its derivatives.
pub fn linearise(interval: &Interval) -> Defect {
    let (end, sensitivity) = flow_with_sensitivity(interval);
    let mut by_start = -StateJacobian::identity();
    by_start.fixed_columns_mut::<3>(3).copy_from(&-sensitivity.fixed_columns::<3>(0));
    Defect {
        value: interval.states[1] - end,
        by_states: [by_start, StateJacobian::identity()],
        by_controls: [-sensitivity.fixed_columns::<3>(3), -sensitivity.fixed_columns::<3>(6)],
        by_dt: -sensitivity.column(DT_COLUMN),
    }
}

/// Φ with all intermediate states.
pub fn flow(interval: &Interval) -> Knots {
    flow_within(interval, interval.states[0], [0.0, 1.0])
}

/// The flow from `start` during a part of the interval, given by the fractions at its beginning and end, in
/// [`SUBSTEPS`] equal steps.
pub fn flow_within(interval: &Interval, start: State, [begin, end]: [f64; 2]) -> Knots {
    let h = interval.dt_s * (end - begin) / SUBSTEPS as f64;
    let mut knots = [start; SUBSTEPS + 1];
    for step in 0..SUBSTEPS {
        let s = knots[step];
        let control =
            |within: f64| interval.control_at(begin + (end - begin) * ((step as f64 + within) / SUBSTEPS as f64));
        let (u_0, u_half, u_1) = (control(0.0), control(0.5), control(1.0));
        let k_1 = dynamics::derivative(&s, &u_0);
        let k_2 = dynamics::derivative(&(s + k_1 * (0.5 * h)), &u_half);
        let k_3 = dynamics::derivative(&(s + k_2 * (0.5 * h)), &u_half);
        let k_4 = dynamics::derivative(&(s + k_3 * h), &u_1);
        knots[step + 1] = s + (k_1 + (k_2 + k_3) * 2.0 + k_4) * (h / 6.0);
    }
    knots
}

/// Time derivatives of the states of the [flow within](flow_within) a part of the interval, per second.
pub fn rates_within(interval: &Interval, knots: &Knots, [begin, end]: [f64; 2]) -> Knots {
    let fraction = |knot: usize| begin + (end - begin) * (knot as f64 / SUBSTEPS as f64);
    std::array::from_fn(|knot| dynamics::derivative(&knots[knot], &interval.control_at(fraction(knot))))
}

/// The end of the flow in small steps: far more accurate than Φ, without derivatives.
pub fn accurate_end(interval: &Interval) -> State {
    let parts = ACCURATE_PARTS;
    (0..parts).fold(interval.states[0], |state, part| {
        let ends = [part, part + 1].map(|end| end as f64 / parts as f64);
        flow_within(interval, state, ends)[SUBSTEPS]
    })
}

/// The state at the end of the control ramp, a whole number of steps from the beginning of the interval.
pub fn ramp_end(interval: &Interval) -> State {
    flow(interval)[(interval.ramp.min(1.0) * SUBSTEPS as f64).round() as usize]
}

/// Φ and its derivatives with respect to the parameters.
fn flow_with_sensitivity(interval: &Interval) -> (State, Sensitivity) {
    let h = interval.dt_s / SUBSTEPS as f64;
    let mut s = interval.states[0];
    let mut ds = Sensitivity::zeros();
    ds.fixed_view_mut::<3, 3>(3, 0).fill_with_identity();
    for step in 0..SUBSTEPS {
        let at = |within: f64| (step as f64 + within) / SUBSTEPS as f64;
        let slope = |s: &State, ds: &Sensitivity, fraction: f64| slope(interval, s, ds, fraction);
        let (k_1, dk_1) = slope(&s, &ds, at(0.0));
        let (k_2, dk_2) = slope(&(s + k_1 * (0.5 * h)), &advance(&ds, &k_1, &dk_1, 0.5 * h, interval), at(0.5));
        let (k_3, dk_3) = slope(&(s + k_2 * (0.5 * h)), &advance(&ds, &k_2, &dk_2, 0.5 * h, interval), at(0.5));
        let (k_4, dk_4) = slope(&(s + k_3 * h), &advance(&ds, &k_3, &dk_3, h, interval), at(1.0));
        let mean = (k_1 + (k_2 + k_3) * 2.0 + k_4) / 6.0;
        s += mean * h;
        ds = advance(&ds, &mean, &((dk_1 + (dk_2 + dk_3) * 2.0 + dk_4) / 6.0), h, interval);
    }
    (s, ds)
}

/// Derivative of `s + h k`, where h is a fixed fraction of dt.
fn advance(ds: &Sensitivity, k: &State, dk: &Sensitivity, h: f64, interval: &Interval) -> Sensitivity {
    let mut sum = ds + dk * h;
    let mut by_dt = sum.column_mut(DT_COLUMN);
    by_dt += k * (h / interval.dt_s);
    sum
}

/// k = f(s, u(fraction)) and its derivative, given that of s. Nothing depends on the position: its three columns of
/// ∂f/∂s are zero.
fn slope(interval: &Interval, s: &State, ds: &Sensitivity, fraction: f64) -> (State, Sensitivity) {
    let (k, df_ds, df_du) = dynamics::linearise(s, &interval.control_at(fraction));
    let mut dk = df_ds.fixed_columns::<3>(3) * ds.fixed_rows::<3>(3);
    let progress = (fraction / interval.ramp).min(1.0);
    for i in 0..3 {
        // ∂f/∂u is diagonal: each load factor drives one of V, χ, γ
        let by_u = df_du[(3 + i, i)];
        dk[(3 + i, 3 + i)] += by_u * (1.0 - progress);
        dk[(3 + i, 6 + i)] += by_u * progress;
    }
    (k, dk)
}
