use nalgebra::{SMatrix, SVector, Vector3};

use super::dynamics::Plant;
use super::linear::{ErrorRates, InputRates, linearised};
use super::reference::{Reference, ReferencePoint};

/// Gain from the errors to a correction of the quadrotor's acceleration, m/s².
pub(super) type Gain = SMatrix<f64, 3, 15>;

/// Step of the Riccati recursion, s.
const STEP_S: f64 = 0.01;
/// Duration of hover after the end of the plan over which the recursion starts, s: long enough for it to converge.
const HOVER_S: f64 = 10.0;

/// Weights of the squared errors, per second: ∫e, e, e', load position, load velocity. The weight of a squared
/// acceleration, (m/s²)², is 1. The quadrotor alone would have a natural frequency of about 600^(1/4) = 5 rad/s; the
/// load's weights damp its swing.
const WEIGHTS: [f64; 5] = [400.0, 600.0, 20.0, 60.0, 20.0];

/// Time-varying linear-quadratic regulator about a reference.
///
/// ```text
/// P_k = Q h + A_kᵀ P_{k+1} A_k - A_kᵀ P_{k+1} B_k K_k,   K_k = (R h + B_kᵀ P_{k+1} B_k)⁻¹ B_kᵀ P_{k+1} A_k
/// ```
///
/// The recursion runs backwards in time through taut and slack phases. At an impact the two velocity errors along the
/// cable become equal; the shift of its time is neglected.
#[derive(Clone, Debug)]
pub(super) struct Gains {
    /// One per step of the recursion, in the order of time.
    gains: Vec<Gain>,
}

impl Gains {
    pub fn about(reference: &Reference, plant: &Plant) -> Self {
        let hover = (HOVER_S / STEP_S) as usize;
        let steps = (reference.end_s() / STEP_S).ceil() as usize;
        let (q, r) = (weights() * STEP_S, SMatrix::<f64, 3, 3>::identity() * STEP_S);
        let mut p = q;
        let mut gains = Vec::with_capacity(steps + 1);
        let mut later = reference.at((steps + hover) as f64 * STEP_S);
        for step in (0..steps + hover).rev() {
            let here = reference.at(step as f64 * STEP_S);
            p = before_jump(plant, &here, &later, &p);
            let (a, b) = discretised(plant, &here);
            let (pa, pb) = (p * a, p * b);
            let inverse = (r + b.transpose() * pb).try_inverse().expect("a positive definite matrix has an inverse");
            let gain = inverse * (b.transpose() * pa);
            p = q + a.transpose() * pa - a.transpose() * pb * gain;
            p = (p + p.transpose()) * 0.5;
            if step <= steps {
                gains.push(gain);
            }
            later = here;
        }
        gains.reverse();
        Self { gains }
    }

    /// The gain at `t_s`, s; after the end of the plan that of hover.
    pub fn at(&self, t_s: f64) -> &Gain {
        let step = (t_s / STEP_S) as usize;
        &self.gains[step.min(self.gains.len() - 1)]
    }
}

fn weights() -> ErrorRates {
    ErrorRates::from_diagonal(&SVector::from_fn(|row, _| WEIGHTS[row / 3]))
}

/// The linearised equations discretised over one step, to second order.
fn discretised(plant: &Plant, point: &ReferencePoint) -> (ErrorRates, InputRates) {
    let state = &point.state;
    let [acceleration, _] = plant.accelerations_mps2(state, point.thrust_n.sum(), point.cable);
    let (a, b) = linearised(point.cable, &state.cable_m(), &state.load_relative_mps(), &acceleration);
    let half = ErrorRates::identity() + a * (STEP_S / 2.0);
    (ErrorRates::identity() + half * a * STEP_S, half * b * STEP_S)
}

/// The cost-to-go before an impact between two points of the reference, if there is one.
fn before_jump(plant: &Plant, before: &ReferencePoint, after: &ReferencePoint, p: &ErrorRates) -> ErrorRates {
    use scenarios::slung_load::Cable::{Slack, Taut};
    if (before.cable, after.cable) != (Slack, Taut) {
        return *p;
    }
    let d: Vector3<f64> = after.state.cable_m().normalize();
    let along = d * d.transpose() * plant.reduced_mass_kg();
    let mut jump = ErrorRates::identity();
    for (row, mass_kg, sign) in [(6, plant.mass_kg, 1.0), (12, plant.load_mass_kg, -1.0)] {
        for (column, other_sign) in [(12, 1.0), (6, -1.0)] {
            let mut block = jump.fixed_view_mut::<3, 3>(row, column);
            block += along * (sign * other_sign / mass_kg);
        }
    }
    jump.transpose() * p * jump
}
