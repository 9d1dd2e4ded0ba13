//! A gate at the end of a phase: inequalities that hold quadrotor and load in their windows at that instant.

use super::cable::CableGeometry;
use super::jet::Jet;
use super::problem::Gate;
use super::system::{LENGTH, SlungLoadSystem};
use crate::pseudospectral::{TerminalDerivatives, TerminalWeights};

/// `sign (p - at_m) >= 0` for one coordinate of the quadrotor or of the load.
#[derive(Clone, Copy, Debug)]
struct Face {
    is_load: bool,
    axis: usize,
    sign: f64,
    at_m: f64,
}

/// The finite faces of the windows, the quadrotor's first.
fn faces(gate: &Gate) -> impl Iterator<Item = Face> {
    let windows = [(false, gate.quadrotor_m), (true, gate.load_m)];
    let all = windows.into_iter().flat_map(|(is_load, window)| {
        let axis_faces = move |(axis, [low, high]): (usize, [f64; 2])| {
            [(1.0, low), (-1.0, high)].map(|(sign, at_m)| Face { is_load, axis, sign, at_m })
        };
        window.into_iter().enumerate().flat_map(axis_faces)
    });
    all.filter(|face| face.at_m.is_finite())
}

/// Number of inequalities at the end of a phase: the faces, and the cable's length where it is a variable.
///
/// The states at the ends of phases have no bounds, so the length needs an inequality.
pub fn count(system: &SlungLoadSystem, phase: usize) -> usize {
    let length = usize::from(system.has_length(system.mode(phase)));
    system.problem.phases[phase].gate.map_or(0, |gate| faces(&gate).count() + length)
}

/// Writes the inequalities, m.
pub fn evaluate(system: &SlungLoadSystem, phase: usize, state: &[f64], inequalities: &mut [f64]) {
    let Some(gate) = system.problem.phases[phase].gate else { return };
    let mode = system.mode(phase);
    let arguments = system.cable_arguments(mode, state);
    let direction = CableGeometry::at(arguments).direction;
    for (inequality, face) in inequalities.iter_mut().zip(faces(&gate)) {
        let hanging_m = if face.is_load { arguments[2].value * direction[face.axis].value } else { 0.0 };
        *inequality = face.sign * (state[face.axis] + hanging_m - face.at_m);
    }
    if let (true, Some(last)) = (system.has_length(mode), inequalities.last_mut()) {
        *last = system.problem.vehicle.cable_m - state[LENGTH];
    }
}

/// Writes their Jacobian, and adds the weighted Hessian.
pub fn differentiate(
    system: &SlungLoadSystem,
    phase: usize,
    state: &[f64],
    weights: &TerminalWeights,
    derivatives: &mut TerminalDerivatives,
) {
    let Some(gate) = system.problem.phases[phase].gate else { return };
    let (mode, n) = (system.mode(phase), 2 * system.coordinates);
    let (count, at) = (system.cable_count(mode), system.cable_indices());
    let arguments = system.cable_arguments(mode, state);
    let hanging: [Jet<3>; 3] = CableGeometry::at(arguments).direction.map(|d| d * arguments[2]);
    let rows = derivatives.inequalities.chunks_exact_mut(n).zip(weights.inequalities);
    for ((row, weight), face) in rows.zip(faces(&gate)) {
        row[face.axis] = face.sign;
        if face.is_load {
            for (index, slope) in at.into_iter().zip(hanging[face.axis].gradient).take(count) {
                row[index] += face.sign * slope;
            }
            hanging[face.axis].scatter(derivatives.hessian, n, at, count, weight * face.sign);
        }
    }
    if let (true, Some(last)) = (system.has_length(mode), derivatives.inequalities.chunks_exact_mut(n).last()) {
        last[LENGTH] = -1.0;
    }
}
