//! Rows of the Euler angles: thrusts to torques (eq. 5) to angular accelerations, with derivatives.

use super::attitude::{Angular, angular};
use super::jet::Jet;
use super::model::{EULER, Model, ROTORS};
use super::problem::Body;
use crate::pseudospectral::{NodeDerivatives, NodeWeights};

/// Writes (ψ'', θ'', φ'').
pub fn values(model: &Model, node: &[f64], acceleration: &mut [f64]) {
    let turning: Angular<0> = turning(model, node, arguments_at(model).map(|index| Jet::constant(node[index])));
    for (to, jet) in acceleration[EULER..EULER + 3].iter_mut().zip(turning.acceleration) {
        *to = jet.value;
    }
}

/// Writes their derivatives, and adds the weighted Hessian.
#[inline(always)]
pub fn differentiate(model: &Model, node: &[f64], weights: &NodeWeights, derivatives: &mut NodeDerivatives) {
    let (at, width, rotors) = (arguments_at(model), model.width(), model.thrusts());
    let turning: Angular<5> = turning(model, node, Jet::variables(at.map(|index| node[index])));
    let torques = torque_rows(&model.problem.body);
    let mut sum = Jet::<5>::constant(0.0);
    for (k, acceleration) in turning.acceleration.into_iter().enumerate() {
        let weight = weights.acceleration[EULER + k];
        sum = sum + acceleration * weight;
        let row = &mut derivatives.acceleration[(EULER + k) * width..][..width];
        for (&index, slope) in at.iter().zip(acceleration.gradient) {
            row[index] = slope;
        }
        for (rotor, u) in rotors.clone().enumerate() {
            for (inverse, torque) in turning.inverse[k].iter().zip(&torques) {
                row[u] += inverse.value * torque[rotor];
                // W^-1 depends on the first two arguments only, pitch and roll
                for (&index, slope) in at.iter().zip(inverse.gradient).take(2) {
                    let mixed = weight * slope * torque[rotor];
                    derivatives.hessian[index * width + u] += mixed;
                    derivatives.hessian[u * width + index] += mixed;
                }
            }
        }
    }
    sum.scatter(derivatives.hessian, width, at, 5, 1.0);
}

/// Where (θ, φ, ψ', θ', φ') stand.
fn arguments_at(model: &Model) -> [usize; 5] {
    let rate = model.coordinates + EULER;
    [EULER + 1, EULER + 2, rate, rate + 1, rate + 2]
}

#[inline(always)]
fn turning<const N: usize>(model: &Model, node: &[f64], arguments: [Jet<N>; 5]) -> Angular<N> {
    let body = &model.problem.body;
    let thrusts = &node[model.thrusts()];
    let torque = torque_rows(body).map(|row| row.iter().zip(thrusts).map(|(gain, thrust)| gain * thrust).sum());
    angular(arguments, body.inertia_kgm2, torque)
}

/// Rows of `I^-1 E` for roll, pitch, yaw.
#[inline(always)]
fn torque_rows(body: &Body) -> [[f64; ROTORS]; 3] {
    let (arm, yaw) = (body.arm_m, body.yaw_m);
    let [i_x, i_y, i_z] = body.inertia_kgm2;
    [
        [-arm, arm, arm, -arm].map(|gain| gain / i_x),
        [-arm, -arm, arm, arm].map(|gain| gain / i_y),
        [yaw, -yaw, yaw, -yaw].map(|gain| gain / i_z),
    ]
}
