//! A gate at the end of a phase: rows, each to be >= 0, that hold quadrotor and load in their windows at that instant.

use super::cable::Cable;
use super::jet::Jet;
use super::model::{LENGTH, Model};
use super::problem::Gate;
use crate::pseudospectral::{EndDerivatives, EndWeights};

/// `sign (p - at_m) >= 0` for one coordinate of the quadrotor or of the load.
#[derive(Clone, Copy, Debug)]
struct Face {
    is_load: bool,
    axis: usize,
    sign: f64,
    at_m: f64,
}

/// Those that there are, the quadrotor's first.
fn faces(gate: &Gate) -> impl Iterator<Item = Face> {
    let windows = [(false, gate.quadrotor_m), (true, gate.load_m)];
    let all = windows.into_iter().flat_map(|(is_load, window)| {
        let of_axis = move |(axis, [low, high]): (usize, [f64; 2])| {
            [(1.0, low), (-1.0, high)].map(|(sign, at_m)| Face { is_load, axis, sign, at_m })
        };
        window.into_iter().enumerate().flat_map(of_axis)
    });
    all.filter(|face| face.at_m.is_finite())
}

/// Number of rows at the end of a phase: the faces, and the cable's length where it is a variable.
///
/// At the ends of phases the states have no bounds, so that the length needs a row.
pub fn count(model: &Model, phase: usize) -> usize {
    let length = usize::from(model.has_length(model.mode(phase)));
    model.problem.stages[phase].gate.map_or(0, |gate| faces(&gate).count() + length)
}

/// Writes the rows.
pub fn values(model: &Model, phase: usize, state: &[f64], rows: &mut [f64]) {
    let Some(gate) = model.problem.stages[phase].gate else { return };
    let mode = model.mode(phase);
    let arguments = model.cable_arguments(mode, state);
    let direction = Cable::at(arguments).direction;
    for (row, face) in rows.iter_mut().zip(faces(&gate)) {
        let hanging_m = if face.is_load { arguments[2].value * direction[face.axis].value } else { 0.0 };
        *row = face.sign * (state[face.axis] + hanging_m - face.at_m);
    }
    if let (true, Some(last)) = (model.has_length(mode), rows.last_mut()) {
        *last = model.problem.body.cable_m - state[LENGTH];
    }
}

/// Writes their derivatives, and adds the weighted Hessian.
pub fn differentiate(
    model: &Model,
    phase: usize,
    state: &[f64],
    weights: &EndWeights,
    derivatives: &mut EndDerivatives,
) {
    let Some(gate) = model.problem.stages[phase].gate else { return };
    let (mode, n) = (model.mode(phase), 2 * model.coordinates);
    let (count, at) = (model.cable_count(mode), model.cable_at());
    let arguments = model.cable_arguments(mode, state);
    let hanging: [Jet<3>; 3] = Cable::at(arguments).direction.map(|d| d * arguments[2]);
    let rows = derivatives.rows.chunks_exact_mut(n).zip(weights.rows);
    for ((row, weight), face) in rows.zip(faces(&gate)) {
        row[face.axis] = face.sign;
        if face.is_load {
            for (index, slope) in at.into_iter().zip(hanging[face.axis].gradient).take(count) {
                row[index] += face.sign * slope;
            }
            hanging[face.axis].scatter(derivatives.hessian, n, at, count, weight * face.sign);
        }
    }
    if let (true, Some(last)) = (model.has_length(mode), derivatives.rows.chunks_exact_mut(n).last()) {
        last[LENGTH] = -1.0;
    }
}
