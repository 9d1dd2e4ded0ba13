//! Equations of motion of the fixed-wing point mass, with derivatives (Wang, Xu, Long 2020, eq. 2).

use nalgebra::{SMatrix, SVector};
use scenarios::fixed_wing::GRAVITY_MPS2 as G;

/// State (x, y, h, V, χ, γ): m, m, m, m/s, rad, rad.
pub type State = SVector<f64, 6>;

/// Control (n_x, n_y, n_z): load factors, -.
pub type Control = SVector<f64, 3>;

/// ∂f/∂s, 6 x 6.
pub type StateJacobian = SMatrix<f64, 6, 6>;

/// ∂f/∂u, 6 x 3.
pub type ControlJacobian = SMatrix<f64, 6, 3>;

/// f(s, u) = s', per second.
pub fn derivative(s: &State, u: &Control) -> State {
    let [_, _, _, v, χ, γ] = (*s).into();
    let ((sin_χ, cos_χ), (sin_γ, cos_γ)) = (χ.sin_cos(), γ.sin_cos());
    State::new(
        v * cos_γ * cos_χ,
        v * cos_γ * sin_χ,
        v * sin_γ,
        G * (u[0] - sin_γ),
        G * u[1] / (v * cos_γ),
        G * (u[2] - cos_γ) / v,
    )
}

/// f with its Jacobians F = ∂f/∂s and G = ∂f/∂u.
pub fn linearise(s: &State, u: &Control) -> (State, StateJacobian, ControlJacobian) {
    let [_, _, _, v, χ, γ] = (*s).into();
    let ((sin_χ, cos_χ), (sin_γ, cos_γ)) = (χ.sin_cos(), γ.sin_cos());
    let f = derivative(s, u);

    let mut df_ds = StateJacobian::zeros();
    df_ds[(0, 3)] = cos_γ * cos_χ;
    df_ds[(0, 4)] = -v * cos_γ * sin_χ;
    df_ds[(0, 5)] = -v * sin_γ * cos_χ;
    df_ds[(1, 3)] = cos_γ * sin_χ;
    df_ds[(1, 4)] = v * cos_γ * cos_χ;
    df_ds[(1, 5)] = -v * sin_γ * sin_χ;
    df_ds[(2, 3)] = sin_γ;
    df_ds[(2, 5)] = v * cos_γ;
    df_ds[(3, 5)] = -G * cos_γ;
    df_ds[(4, 3)] = -f[4] / v;
    df_ds[(4, 5)] = f[4] * sin_γ / cos_γ;
    df_ds[(5, 3)] = -f[5] / v;
    df_ds[(5, 5)] = G * sin_γ / v;

    let mut df_du = ControlJacobian::zeros();
    df_du[(3, 0)] = G;
    df_du[(4, 1)] = G / (v * cos_γ);
    df_du[(5, 2)] = G / v;
    (f, df_ds, df_du)
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn jacobians_agree_with_differences() {
        let s = State::new(120.0, -40.0, 410.0, 34.0, 0.7, -0.06);
        let u = Control::new(0.11, -0.17, 1.08);
        let (_, df_ds, df_du) = linearise(&s, &u);
        for j in 0..6 {
            let mut e = State::zeros();
            e[j] = 1e-5;
            let difference = (derivative(&(s + e), &u) - derivative(&(s - e), &u)) / 2e-5;
            assert!((difference - df_ds.column(j)).amax() < 1e-8, "column {j} of df/ds");
        }
        for j in 0..3 {
            let mut e = Control::zeros();
            e[j] = 1e-5;
            let difference = (derivative(&s, &(u + e)) - derivative(&s, &(u - e))) / 2e-5;
            assert!((difference - df_du.column(j)).amax() < 1e-8, "column {j} of df/du");
        }
    }
}
