//! Load factors from states.

use nalgebra::{Matrix3, SMatrix, SVector, Vector3};
use scenarios::fixed_wing::{Control, GRAVITY_MPS2, State};
use sim::fixed_wing::{AirPath, Knot, gravity_mps2, propagate};

use crate::verdict::Reconstruction;

/// Longest step of the integration, s.
const STEP_S: f64 = 0.25;
/// Largest number of iterations. The fit is nearly linear and converges in three or four.
const MAX_ITERATIONS: usize = 8;
/// Change of a load factor below which the fit has converged.
const CONVERGENCE_TOLERANCE: f64 = 1e-10;
/// Step of the finite differences by load factors.
const FINITE_DIFFERENCE: f64 = 1e-5;

/// Residual of an interval: from its propagated end to the next node, as velocities (dp/h, dv), m/s.
type Residual = SVector<f64, 6>;
/// Jacobian of [`Residual`] by the load factors at one end of the interval.
type Jacobian = SMatrix<f64, 6, 3>;

/// Load factors at the nodes, linear between them, that lead from each state to the next in the least-squares sense.
///
/// ```text
/// min_n  Σ_k |dp_k / h_k|² + |dv_k|²        (dp, dv)_k = node k+1 - propagate(node k, n_k, n_{k+1}, h_k)
/// ```
///
/// by Gauss-Newton iterations from the flat-output guess. There are six equations per interval and three unknowns per node:
/// the fit is exact for a motion caused by load factors that are linear in time.
///
/// - `times_s`, `states`: of the nodes, at least two
///
/// Returns the load factors and their residual.
pub(super) fn fit(times_s: &[f64], states: &[State]) -> (Vec<Control>, Reconstruction) {
    let mut controls = flat_guess(times_s, states);
    for _ in 0..MAX_ITERATIONS {
        let step = newton_step(times_s, states, &controls);
        let largest = step.iter().map(Vector3::amax).fold(0.0, f64::max);
        if !largest.is_finite() {
            break;
        }
        controls = controls.iter().zip(&step).map(|(control, step)| moved(*control, step)).collect();
        if largest < CONVERGENCE_TOLERANCE {
            break;
        }
    }
    let residual = residual(times_s, states, &controls);
    (controls, residual)
}

/// Largest residuals of all intervals when `controls` lead from each state to the next.
pub(super) fn residual(times_s: &[f64], states: &[State], controls: &[Control]) -> Reconstruction {
    let mut largest = Reconstruction::default();
    // f64::max would drop NaN.
    let larger = |old: f64, new: f64| if new.is_nan() || new > old { new } else { old };
    for k in 0..times_s.len() - 1 {
        let h = times_s[k + 1] - times_s[k];
        let residual = interval_residual(times_s, states, k, [controls[k], controls[k + 1]]);
        let (dp, dv) = (residual.fixed_rows::<3>(0) * h, residual.fixed_rows::<3>(3).into_owned());
        // dv = h/2 (a_0 + a_1) and dp = h²/6 (2 a_0 + a_1), solved for the accelerations at both ends
        let a_0 = (dp * (3.0 / h) - dv) * (2.0 / h);
        let a_1 = dv * (2.0 / h) - a_0;
        largest.position_m = larger(largest.position_m, dp.norm());
        largest.velocity_mps = larger(largest.velocity_mps, dv.norm());
        largest.load_factor = larger(largest.load_factor, a_0.norm() / GRAVITY_MPS2);
        largest.load_factor = larger(largest.load_factor, a_1.norm() / GRAVITY_MPS2);
    }
    largest
}

/// Load factors from the second derivative of the flat outputs: at each node the mean over its intervals, each with the
/// cubic through positions and velocities.
fn flat_guess(times_s: &[f64], states: &[State]) -> Vec<Control> {
    let mut accelerations = vec![(Vector3::zeros(), 0.0); states.len()];
    for k in 0..states.len() - 1 {
        let h = times_s[k + 1] - times_s[k];
        let [p_0, p_1] = [states[k], states[k + 1]].map(|state| Vector3::from(state.position_m()));
        let [v_0, v_1] = [states[k], states[k + 1]].map(|state| Vector3::from(state.velocity_mps()));
        let mean = (p_1 - p_0) / h;
        for (node, acceleration) in
            [(k, (mean * 6.0 - v_0 * 4.0 - v_1 * 2.0) / h), (k + 1, (v_0 * 2.0 + v_1 * 4.0 - mean * 6.0) / h)]
        {
            accelerations[node].0 += acceleration;
            accelerations[node].1 += 1.0;
        }
    }
    let load_factors = |(state, (sum, count)): (&State, (Vector3<f64>, f64))| {
        AirPath::new(&Vector3::from(state.velocity_mps())).load_factors(&(sum / count - gravity_mps2()))
    };
    states.iter().zip(accelerations).map(load_factors).collect()
}

/// Solves the normal equations of the linearised problem, which are block tridiagonal, by block elimination.
fn newton_step(times_s: &[f64], states: &[State], controls: &[Control]) -> Vec<Vector3<f64>> {
    let nodes = states.len();
    let mut diagonal = vec![Matrix3::zeros(); nodes];
    let mut above = vec![Matrix3::zeros(); nodes];
    let mut right = vec![Vector3::zeros(); nodes];
    for k in 0..nodes - 1 {
        let (residual, [from_first, from_last]) = linearised(times_s, states, k, [controls[k], controls[k + 1]]);
        diagonal[k] += from_first.tr_mul(&from_first);
        diagonal[k + 1] += from_last.tr_mul(&from_last);
        above[k] = from_first.tr_mul(&from_last);
        right[k] -= from_first.tr_mul(&residual);
        right[k + 1] -= from_last.tr_mul(&residual);
    }
    let mut eliminated = Vec::with_capacity(nodes);
    for k in 0..nodes {
        if k > 0 {
            let lower: Matrix3<f64> = above[k - 1].transpose() * eliminated[k - 1];
            diagonal[k] -= lower * above[k - 1];
            let carried = lower * right[k - 1];
            right[k] -= carried;
        }
        eliminated.push(diagonal[k].try_inverse().unwrap_or_else(|| Matrix3::repeat(f64::NAN)));
    }
    let mut step = vec![Vector3::zeros(); nodes];
    for k in (0..nodes).rev() {
        let coupled = if k + 1 < nodes { above[k] * step[k + 1] } else { Vector3::zeros() };
        step[k] = eliminated[k] * (right[k] - coupled);
    }
    step
}

/// Residual of interval `k`, and its Jacobians by the load factors at both ends.
fn linearised(times_s: &[f64], states: &[State], k: usize, controls: [Control; 2]) -> (Residual, [Jacobian; 2]) {
    let here = interval_residual(times_s, states, k, controls);
    let jacobian = |end: usize| {
        let mut jacobian = Jacobian::zeros();
        for axis in 0..3 {
            let mut changed = controls;
            let mut by = Vector3::zeros();
            by[axis] = FINITE_DIFFERENCE;
            changed[end] = moved(changed[end], &by);
            jacobian.set_column(axis, &((interval_residual(times_s, states, k, changed) - here) / FINITE_DIFFERENCE));
        }
        jacobian
    };
    (here, [jacobian(0), jacobian(1)])
}

fn interval_residual(times_s: &[f64], states: &[State], k: usize, controls: [Control; 2]) -> Residual {
    let h = times_s[k + 1] - times_s[k];
    let flown = propagate(&states[k], controls, times_s[k], h, STEP_S);
    let (end, next) = (flown[flown.len() - 1], Knot::new(&states[k + 1], times_s[k + 1]));
    let (dp, dv) = ((next.position_m - end.position_m) / h, next.velocity_mps - end.velocity_mps);
    Residual::new(dp.x, dp.y, dp.z, dv.x, dv.y, dv.z)
}

fn moved(control: Control, by: &Vector3<f64>) -> Control {
    let [n_x, n_y, n_z] = control.to_array();
    Control { n_x: n_x + by.x, n_y: n_y + by.y, n_z: n_z + by.z }
}
