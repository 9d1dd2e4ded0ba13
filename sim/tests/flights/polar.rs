//! The fixed-wing equations in polar form, and an adaptive integrator: an independent computation of the same motion.

use scenarios::fixed_wing::{Control, State};

use crate::arena::G;

type Vector = [f64; 6];

/// Wang, Xu, Long (2020), eq. 2.
fn rate(s: &Vector, u: Control) -> Vector {
    let [_, _, _, v, χ, γ] = *s;
    [
        v * γ.cos() * χ.cos(),
        v * γ.cos() * χ.sin(),
        v * γ.sin(),
        G * (u.n_x - γ.sin()),
        G * u.n_y / (v * γ.cos()),
        G * (u.n_z - γ.cos()) / v,
    ]
}

/// Dormand and Prince's pair of orders 5 and 4.
const C: [f64; 7] = [0.0, 1.0 / 5.0, 3.0 / 10.0, 4.0 / 5.0, 8.0 / 9.0, 1.0, 1.0];
const A: [&[f64]; 7] = [
    &[],
    &[1.0 / 5.0],
    &[3.0 / 40.0, 9.0 / 40.0],
    &[44.0 / 45.0, -56.0 / 15.0, 32.0 / 9.0],
    &[19372.0 / 6561.0, -25360.0 / 2187.0, 64448.0 / 6561.0, -212.0 / 729.0],
    &[9017.0 / 3168.0, -355.0 / 33.0, 46732.0 / 5247.0, 49.0 / 176.0, -5103.0 / 18656.0],
    &[35.0 / 384.0, 0.0, 500.0 / 1113.0, 125.0 / 192.0, -2187.0 / 6784.0, 11.0 / 84.0],
];
const B4: [f64; 7] =
    [5179.0 / 57600.0, 0.0, 7571.0 / 16695.0, 393.0 / 640.0, -92097.0 / 339200.0, 187.0 / 2100.0, 1.0 / 40.0];

/// Maximum error of a step, in units of the state: m, m/s, rad.
const TOLERANCE: f64 = 1e-10;

/// The state after `duration_s` under controls that are linear in time.
pub fn integrate(start: &State, controls: [Control; 2], duration_s: f64) -> State {
    let control = |t_s: f64| {
        let [first, last] = controls.map(Control::to_array);
        Control::from_array(std::array::from_fn(|i| first[i] + (last[i] - first[i]) * t_s / duration_s))
    };
    let (mut state, mut t_s, mut step_s) = (start.to_array(), 0.0, duration_s.min(0.1));
    while t_s < duration_s {
        assert!(step_s > 1e-9, "the equations become singular at {state:?}");
        step_s = step_s.min(duration_s - t_s);
        let (next, error) = step(&state, t_s, step_s, control);
        if error <= TOLERANCE {
            (state, t_s) = (next, if duration_s - t_s <= step_s { duration_s } else { t_s + step_s });
        }
        step_s *= (0.9 * (TOLERANCE / error.max(1e-300)).powf(0.2)).clamp(0.2, 3.0);
    }
    State::from_array(state)
}

/// One step, and the maximum difference between the two orders.
fn step(state: &Vector, t_s: f64, step_s: f64, control: impl Fn(f64) -> Control) -> (Vector, f64) {
    let mut rates = [[0.0; 6]; 7];
    let sum = |weights: &[f64], rates: &[Vector; 7]| -> Vector {
        std::array::from_fn(|i| state[i] + step_s * weights.iter().zip(rates).map(|(w, k)| w * k[i]).sum::<f64>())
    };
    for stage in 0..7 {
        rates[stage] = rate(&sum(A[stage], &rates), control(t_s + C[stage] * step_s));
    }
    let (fifth, fourth) = (sum(A[6], &rates), sum(&B4, &rates));
    (fifth, (0..6).map(|i| (fifth[i] - fourth[i]).abs()).fold(0.0, f64::max))
}
