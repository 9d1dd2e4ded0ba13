//! The trapezoid rule (Wang, Xu, Long 2020, eq. 5).
//!
//! ```text
//! s_{k+1} - s_k - (dt/2) (f_k + f_{k+1}) = 0
//! ```
//!
//! A_{k+1} = I - (dt/2) F_{k+1},  A_k = -I - (dt/2) F_k,  B = -(dt/2) G,  C_k + C_{k+1} = -(f_k + f_{k+1})/2

use super::dynamics::{self, State, StateJacobian};
use super::interval::{Defect, Interval};

/// The defect of one interval, in the units of the state.
pub fn defect(interval: &Interval) -> State {
    let [f_0, f_1] = [0, 1].map(|end| dynamics::derivative(&interval.states[end], &interval.controls[end]));
    interval.states[1] - interval.states[0] - (f_0 + f_1) * (0.5 * interval.dt_s)
}

/// The defect of one interval with its derivatives.
pub fn linearise(interval: &Interval) -> Defect {
    let [s_0, s_1] = interval.states;
    let half = 0.5 * interval.dt_s;
    let (f_0, df_ds_0, df_du_0) = dynamics::linearise(&s_0, &interval.controls[0]);
    let (f_1, df_ds_1, df_du_1) = dynamics::linearise(&s_1, &interval.controls[1]);
    Defect {
        value: s_1 - s_0 - (f_0 + f_1) * half,
        by_states: [-StateJacobian::identity() - df_ds_0 * half, StateJacobian::identity() - df_ds_1 * half],
        by_controls: [-df_du_0 * half, -df_du_1 * half],
        by_dt: -(f_0 + f_1) * 0.5,
    }
}
