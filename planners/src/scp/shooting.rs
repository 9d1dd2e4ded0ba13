//! Multiple shooting: the flow Φ of the equations of motion under controls that run linearly from node to node.
//!
//! ```text
//! s_{k+1} - Φ(s_k, u_k, u_{k+1}, dt) = 0
//! ```
//!
//! Φ by the classical Runge-Kutta method of order 4 in [`SUBSTEPS`] equal steps, its derivatives by differentiating the
//! method itself, so that they are exact for the Φ that is used.

use nalgebra::SMatrix;

use super::dynamics::{self, Control, State, StateJacobian};
use super::interval::{Defect, Interval};

/// Runge-Kutta steps per interval. Four keep the error of a 6 s interval far below a centimetre.
const SUBSTEPS: usize = 8;

/// Parameters of Φ in the order s_k (6), u_k (3), u_{k+1} (3), dt (1).
const PARAMETERS: usize = 13;

type Sensitivity = SMatrix<f64, 6, PARAMETERS>;

/// The defect of one interval, in the units of the state.
pub fn defect(interval: &Interval) -> State {
    interval.states[1] - flow(interval)
}

/// The defect of one interval with its derivatives.
pub fn linearise(interval: &Interval) -> Defect {
    let (end, sensitivity) = flow_with_sensitivity(interval);
    Defect {
        value: interval.states[1] - end,
        by_states: [-sensitivity.fixed_columns::<6>(0), StateJacobian::identity()],
        by_controls: [-sensitivity.fixed_columns::<3>(6), -sensitivity.fixed_columns::<3>(9)],
        by_dt: -sensitivity.column(12),
    }
}

/// Φ.
fn flow(interval: &Interval) -> State {
    let h = interval.dt_s / SUBSTEPS as f64;
    let mut s = interval.states[0];
    for step in 0..SUBSTEPS {
        let control = |within: f64| control_at(interval, (step as f64 + within) / SUBSTEPS as f64);
        let (u_0, u_half, u_1) = (control(0.0), control(0.5), control(1.0));
        let k_1 = dynamics::derivative(&s, &u_0);
        let k_2 = dynamics::derivative(&(s + k_1 * (0.5 * h)), &u_half);
        let k_3 = dynamics::derivative(&(s + k_2 * (0.5 * h)), &u_half);
        let k_4 = dynamics::derivative(&(s + k_3 * h), &u_1);
        s += (k_1 + (k_2 + k_3) * 2.0 + k_4) * (h / 6.0);
    }
    s
}

/// Φ and ∂Φ/∂(s_k, u_k, u_{k+1}, dt).
fn flow_with_sensitivity(interval: &Interval) -> (State, Sensitivity) {
    let h = interval.dt_s / SUBSTEPS as f64;
    let mut s = interval.states[0];
    let mut ds = Sensitivity::zeros();
    ds.fixed_columns_mut::<6>(0).fill_with_identity();
    for step in 0..SUBSTEPS {
        let at = |within: f64| (step as f64 + within) / SUBSTEPS as f64;
        let slope = |s: &State, ds: &Sensitivity, share: f64| slope(interval, s, ds, share);
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

/// Derivative of `s + h k`, h being a fixed share of dt.
fn advance(ds: &Sensitivity, k: &State, dk: &Sensitivity, h: f64, interval: &Interval) -> Sensitivity {
    let mut sum = ds + dk * h;
    let mut by_dt = sum.column_mut(12);
    by_dt += k * (h / interval.dt_s);
    sum
}

/// k = f(s, u(share)) and its derivative, given that of s.
fn slope(interval: &Interval, s: &State, ds: &Sensitivity, share: f64) -> (State, Sensitivity) {
    let (k, df_ds, df_du) = dynamics::linearise(s, &control_at(interval, share));
    let mut dk = df_ds * ds;
    let mut by_u_0 = dk.fixed_columns_mut::<3>(6);
    by_u_0 += df_du * (1.0 - share);
    let mut by_u_1 = dk.fixed_columns_mut::<3>(9);
    by_u_1 += df_du * share;
    (k, dk)
}

/// First-order hold.
fn control_at(interval: &Interval, share: f64) -> Control {
    interval.controls[0] * (1.0 - share) + interval.controls[1] * share
}
