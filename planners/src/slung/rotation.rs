//! Angular accelerations of the Euler angles: thrusts to torques to accelerations, with derivatives.

use super::attitude::{EulerAcceleration, euler_acceleration};
use super::jet::Jet;
use super::problem::VehicleParameters;
use super::system::{EULER, ROTORS, SlungLoadSystem};
use crate::pseudospectral::{NodeDerivatives, NodeWeights};

/// Writes (ψ'', θ'', φ'').
pub fn evaluate(system: &SlungLoadSystem, node: &[f64], acceleration: &mut [f64]) {
    let arguments = argument_indices(system).map(|index| Jet::constant(node[index]));
    let rotation: EulerAcceleration<0> = rotation(system, node, arguments);
    for (to, jet) in acceleration[EULER..EULER + 3].iter_mut().zip(rotation.acceleration) {
        *to = jet.value;
    }
}

/// Writes the first derivatives, and adds the weighted Hessian.
#[inline(always)]
pub fn differentiate(system: &SlungLoadSystem, node: &[f64], weights: &NodeWeights, derivatives: &mut NodeDerivatives) {
    let (at, width, rotors) = (argument_indices(system), system.width(), system.thrusts());
    let rotation: EulerAcceleration<5> = rotation(system, node, Jet::variables(at.map(|index| node[index])));
    let torques = torque_map(&system.problem.vehicle);
    let mut sum = Jet::<5>::constant(0.0);
    for (k, acceleration) in rotation.acceleration.into_iter().enumerate() {
        let weight = weights.acceleration[EULER + k];
        sum = sum + acceleration * weight;
        let row = &mut derivatives.acceleration[(EULER + k) * width..][..width];
        for (&index, slope) in at.iter().zip(acceleration.gradient) {
            row[index] = slope;
        }
        for (rotor, u) in rotors.clone().enumerate() {
            for (inverse, torque) in rotation.inverse[k].iter().zip(&torques) {
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

/// Indices of (θ, φ, ψ', θ', φ') in a node vector.
fn argument_indices(system: &SlungLoadSystem) -> [usize; 5] {
    let rate = system.coordinates + EULER;
    [EULER + 1, EULER + 2, rate, rate + 1, rate + 2]
}

#[inline(always)]
fn rotation<const N: usize>(system: &SlungLoadSystem, node: &[f64], arguments: [Jet<N>; 5]) -> EulerAcceleration<N> {
    let vehicle = &system.problem.vehicle;
    let thrusts = &node[system.thrusts()];
    let torque = torque_map(vehicle).map(|row| row.iter().zip(thrusts).map(|(gain, thrust)| gain * thrust).sum());
    euler_acceleration(arguments, vehicle.inertia_kgm2, torque)
}

/// Rows of `I^-1 E` for roll, pitch and yaw (Kang, Huang, Wen 2020, eq. 5), rad/s^2 per N.
#[inline(always)]
fn torque_map(vehicle: &VehicleParameters) -> [[f64; ROTORS]; 3] {
    let (arm, yaw) = (vehicle.arm_m, vehicle.yaw_m);
    let [i_x, i_y, i_z] = vehicle.inertia_kgm2;
    [
        [-arm, arm, arm, -arm].map(|gain| gain / i_x),
        [-arm, -arm, arm, arm].map(|gain| gain / i_y),
        [yaw, -yaw, yaw, -yaw].map(|gain| gain / i_z),
    ]
}
