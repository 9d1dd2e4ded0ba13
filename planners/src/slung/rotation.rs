//! Angular accelerations of the Euler angles: thrusts to torques to accelerations, with derivatives.

use super::attitude::{EulerAcceleration, euler_acceleration};
use super::jet::Jet;
use super::problem::{TorqueModel, VehicleParameters};
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
    let torques = torque_map(system);
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

/// Accelerations, and their derivatives with respect to the rows of [`torque_map`] times the thrusts.
#[inline(always)]
fn rotation<const N: usize>(system: &SlungLoadSystem, node: &[f64], arguments: [Jet<N>; 5]) -> EulerAcceleration<N> {
    let inertia = system.problem.vehicle.inertia_kgm2;
    let thrusts = &node[system.thrusts()];
    let torque = torque_map(system).map(|row| row.iter().zip(thrusts).map(|(gain, thrust)| gain * thrust).sum());
    match system.problem.torques {
        TorqueModel::Body => euler_acceleration(arguments, inertia, torque),
        TorqueModel::Generalised => by_generalised_torques(arguments, inertia, torque),
    }
}

/// Accelerations by generalised torques Q about (ψ, θ, φ): the body torques are `W^-T Q`, because both do the same work, so
/// that `W^-1 I^-1 W^-T` takes the place of `W^-1 I^-1`.
#[inline(always)]
fn by_generalised_torques<const N: usize>(
    arguments: [Jet<N>; 5],
    inertia: [f64; 3],
    torque: [f64; 3],
) -> EulerAcceleration<N> {
    let free = euler_acceleration(arguments, inertia, [0.0; 3]);
    let by_torque = |k: usize, i: usize| {
        let terms = (0..3).map(|j| free.inverse[k][j] * free.inverse[i][j] * (1.0 / inertia[j]));
        terms.fold(Jet::constant(0.0), |sum, term| sum + term)
    };
    let inverse: [[Jet<N>; 3]; 3] = std::array::from_fn(|k| std::array::from_fn(|i| by_torque(k, i)));
    let acceleration = std::array::from_fn(|k| {
        inverse[k].iter().zip(torque).fold(free.acceleration[k], |sum, (slope, torque)| sum + *slope * torque)
    });
    EulerAcceleration { acceleration, inverse }
}

/// Torques per thrust (Kang, Huang, Wen 2020, eq. 5): rows of `I^-1 E` for roll, pitch and yaw, rad/s^2 per N, of torques
/// about the body's axes; rows of E for yaw, pitch and roll, N m per N, of generalised torques.
#[inline(always)]
fn torque_map(system: &SlungLoadSystem) -> [[f64; ROTORS]; 3] {
    let VehicleParameters { arm_m: arm, yaw_m: yaw, inertia_kgm2: [i_x, i_y, i_z], .. } = system.problem.vehicle;
    let (roll, pitch, yaw) = ([-arm, arm, arm, -arm], [-arm, -arm, arm, arm], [yaw, -yaw, yaw, -yaw]);
    match system.problem.torques {
        TorqueModel::Body => [roll.map(|gain| gain / i_x), pitch.map(|gain| gain / i_y), yaw.map(|gain| gain / i_z)],
        TorqueModel::Generalised => [yaw, pitch, roll],
    }
}
