//! Rows along the path, each to be >= 0: the tension or the complementarity of slack and taut, the floor, and the
//! envelope's circle off the obstacles.
//!
//! The circle's radius is the largest of r_2 and `√2 ρ |cos α sin β|`, `√2 ρ |sin α|` (eq. 19, 20). As a row each, instead
//! of R-functions of them all, these say the same and are smooth.

use super::cable::Cable;
use super::jet::Jet;
use super::model::{LENGTH, Model};
use super::problem::Mode;
use super::translation::has_ceiling;
use crate::pseudospectral::NodeDerivatives;

/// Rows per obstacle.
const ENVELOPE: usize = 5;

/// Rows of the mode, and of the floor.
fn counts(model: &Model, mode: Mode) -> [usize; 2] {
    let of_mode = match mode {
        Mode::Taut => 1 + usize::from(has_ceiling(model)),
        Mode::Either { .. } => 1,
        Mode::Slack | Mode::Parked => 0,
    };
    [of_mode, usize::from(model.problem.limits.floor_m.is_some() && mode != Mode::Parked)]
}

/// Number of rows.
pub fn count(model: &Model, mode: Mode) -> usize {
    counts(model, mode).iter().sum::<usize>() + ENVELOPE * model.problem.obstacles.len()
}

/// `√2 ρ d_x`, `√2 ρ d_y`: either sign of them must fit between quadrotor and obstacle.
#[inline(always)]
fn reaches<const N: usize>(cable: &Cable<N>, length: Jet<N>) -> [Jet<N>; 2] {
    [cable.direction[0], cable.direction[1]].map(|d| d * length * std::f64::consts::SQRT_2)
}

/// Writes the rows.
pub fn values(model: &Model, mode: Mode, node: &[f64], cable: &Cable<0>, tension_n: f64, rows: &mut [f64]) {
    let (limits, body) = (&model.problem.limits, &model.problem.body);
    let length_m = model.length_m(mode, node);
    let [of_mode, of_floor] = counts(model, mode);
    match mode {
        Mode::Taut => {
            rows[0] = tension_n;
            if of_mode > 1 {
                rows[1] = limits.tension_n - tension_n;
            }
        }
        Mode::Either { epsilon } => rows[0] = epsilon - tension_n * (body.cable_m - length_m),
        Mode::Slack | Mode::Parked => {}
    }
    if let (Some(floor_m), 1) = (limits.floor_m, of_floor) {
        rows[of_mode] = node[2] + length_m * cable.direction[2].value - floor_m;
    }
    let reaches = reaches(cable, Jet::constant(length_m)).map(|reach| reach.value);
    let obstacles = rows[of_mode + of_floor..].chunks_exact_mut(ENVELOPE).zip(&model.problem.obstacles);
    for (rows, obstacle) in obstacles {
        let gap_m = obstacle.distance([node[0], node[1]]).value - limits.clearance_m;
        rows[0] = gap_m - body.radius_m;
        for (rows, reach) in rows[1..].chunks_exact_mut(2).zip(reaches) {
            (rows[0], rows[1]) = (gap_m - reach, gap_m + reach);
        }
    }
}

/// Writes first derivatives, and adds the weighted Hessian; those of the taut cable's tension are not from here.
#[inline(always)]
pub fn differentiate(model: &Model, mode: Mode, node: &[f64], weights: &[f64], derivatives: &mut NodeDerivatives) {
    let width = model.width();
    let arguments = model.cable_arguments(mode, node);
    let cable = Cable::at(arguments);
    let [of_mode, of_floor] = counts(model, mode);
    if let Mode::Either { .. } = mode {
        differentiate_complementarity(model, node, weights[0], derivatives);
    }
    let (count, cable_at) = (model.cable_count(mode), model.cable_at());
    if of_floor > 0 {
        let height = cable.direction[2] * arguments[2];
        let row = &mut derivatives.rows[of_mode * width..][..width];
        row[2] = 1.0;
        for (index, slope) in cable_at.into_iter().zip(height.gradient).take(count) {
            row[index] = slope;
        }
        height.scatter(derivatives.hessian, width, cable_at, count, weights[of_mode]);
    }
    let reaches = reaches(&cable, arguments[2]);
    let mut reach_weights = [0.0; 2];
    let first = of_mode + of_floor;
    let rows = derivatives.rows[first * width..].chunks_exact_mut(ENVELOPE * width);
    for ((rows, weights), obstacle) in rows.zip(weights[first..].chunks_exact(ENVELOPE)).zip(&model.problem.obstacles) {
        let distance = obstacle.distance([node[0], node[1]]);
        for row in rows.chunks_exact_mut(width) {
            row[..2].copy_from_slice(&distance.gradient);
        }
        for (k, reach) in reaches.iter().enumerate() {
            for (index, slope) in cable_at.into_iter().zip(reach.gradient).take(count) {
                rows[(1 + 2 * k) * width + index] = -slope;
                rows[(2 + 2 * k) * width + index] = slope;
            }
            reach_weights[k] += weights[2 + 2 * k] - weights[1 + 2 * k];
        }
        let weight: f64 = weights.iter().sum();
        let [xx, xy, yy] = distance.hessian;
        for (at, value) in [(0, xx), (1, xy), (width, xy), (width + 1, yy)] {
            derivatives.hessian[at] += weight * value;
        }
    }
    for (reach, weight) in reaches.iter().zip(reach_weights) {
        reach.scatter(derivatives.hessian, width, cable_at, count, weight);
    }
}

/// Of `ε - λ (l_0 - ρ)`.
#[inline(always)]
fn differentiate_complementarity(model: &Model, node: &[f64], weight: f64, derivatives: &mut NodeDerivatives) {
    let (width, tension) = (model.width(), model.tension());
    derivatives.rows[tension] = node[LENGTH] - model.problem.body.cable_m;
    derivatives.rows[LENGTH] = node[tension];
    derivatives.hessian[tension * width + LENGTH] += weight;
    derivatives.hessian[LENGTH * width + tension] += weight;
}
