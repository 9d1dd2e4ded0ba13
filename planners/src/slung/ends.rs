//! Where phases end: the goal, a gate, or a switch. A slack cable that becomes taut does so in an inelastic impact: with m the
//! reduced mass the impulse Λ = m ρ' takes out the stretching, and the quadrotor's velocity changes by Λ d/m_Q.

use super::cable::Cable;
use super::gate;
use super::jet::Jet;
use super::model::{ALPHA, BETA, LENGTH, Model};
use super::problem::Mode;
use crate::pseudospectral::{EndDerivatives, EndValues, EndWeights};

/// Number of events and of inequality rows.
pub fn counts(model: &Model, phase: usize) -> (usize, usize) {
    if is_last(model, phase) {
        (goal_indices(model).count(), 0)
    } else if becomes_taut(model, phase) {
        (1, 1 + usize::from(model.problem.stages[phase].impulse_ns.is_some()))
    } else {
        (0, gate::count(model, phase))
    }
}

fn is_last(model: &Model, phase: usize) -> bool {
    phase + 1 == model.problem.stages.len()
}

/// Whether the cable goes taut at the end of a phase.
fn becomes_taut(model: &Model, phase: usize) -> bool {
    model.mode(phase) != Mode::Taut && model.mode(phase + 1) == Mode::Taut
}

/// States that the goal fixes: all, but for a length that stays what it is.
fn goal_indices(model: &Model) -> impl Iterator<Item = usize> {
    let (nq, last) = (model.coordinates, model.problem.stages.len() - 1);
    let is_given = nq > LENGTH && model.mode(last) == Mode::Taut;
    (0..2 * nq).filter(move |index| !(is_given && index % nq == LENGTH))
}

fn goal(model: &Model, index: usize) -> f64 {
    match index {
        0..3 => model.problem.goal_m[index],
        LENGTH if model.coordinates > LENGTH => model.problem.body.cable_m,
        _ => 0.0,
    }
}

/// Events, rows and the next phase's first state.
pub fn values(model: &Model, phase: usize, state: &[f64], values: &mut EndValues) {
    if is_last(model, phase) {
        for (event, index) in values.events.iter_mut().zip(goal_indices(model)) {
            *event = state[index] - goal(model, index);
        }
        return;
    }
    values.next.copy_from_slice(state);
    if !becomes_taut(model, phase) {
        gate::values(model, phase, state, &mut values.rows);
        return;
    }
    let (body, nq) = (&model.problem.body, model.coordinates);
    let stretching = state[nq + LENGTH];
    let impulse_ns = model.reduced_kg() * stretching;
    let cable = Cable::at([state[ALPHA], state[BETA], body.cable_m].map(Jet::<0>::constant));
    for (v, d) in values.next[nq..].iter_mut().zip(cable.direction) {
        *v += impulse_ns / body.quadrotor_kg * d.value;
    }
    values.next[LENGTH] = body.cable_m;
    values.next[nq + LENGTH] = 0.0;
    values.events[0] = state[LENGTH] - body.cable_m;
    values.rows[0] = stretching;
    if let Some(most_ns) = model.problem.stages[phase].impulse_ns {
        values.rows[1] = most_ns - impulse_ns;
    }
}

/// Their derivatives.
pub fn differentiate(
    model: &Model,
    phase: usize,
    state: &[f64],
    weights: &EndWeights,
    derivatives: &mut EndDerivatives,
) {
    let n = 2 * model.coordinates;
    if is_last(model, phase) {
        for (event, index) in goal_indices(model).enumerate() {
            derivatives.events[event * n + index] = 1.0;
        }
        return;
    }
    for r in 0..n {
        derivatives.next[r * n + r] = 1.0;
    }
    if becomes_taut(model, phase) {
        differentiate_impact(model, phase, state, weights, derivatives);
    } else {
        gate::differentiate(model, phase, state, weights, derivatives);
    }
}

fn differentiate_impact(
    model: &Model,
    phase: usize,
    state: &[f64],
    weights: &EndWeights,
    derivatives: &mut EndDerivatives,
) {
    let (nq, n) = (model.coordinates, 2 * model.coordinates);
    let rate = nq + LENGTH;
    let share = model.reduced_kg() / model.problem.body.quadrotor_kg;
    let [alpha, beta] = Jet::<2>::variables([state[ALPHA], state[BETA]]);
    let cable = Cable::at([alpha, beta, Jet::constant(model.problem.body.cable_m)]);
    for (k, d) in cable.direction.into_iter().enumerate() {
        let row = &mut derivatives.next[(nq + k) * n..][..n];
        let weight = share * weights.next[nq + k];
        row[rate] = share * d.value;
        for (index, slope) in [ALPHA, BETA].into_iter().zip(d.gradient) {
            row[index] = share * state[rate] * slope;
            derivatives.hessian[index * n + rate] += weight * slope;
            derivatives.hessian[rate * n + index] += weight * slope;
        }
        d.scatter(derivatives.hessian, n, [ALPHA, BETA], 2, weight * state[rate]);
    }
    derivatives.next[LENGTH * n + LENGTH] = 0.0;
    derivatives.next[rate * n + rate] = 0.0;
    derivatives.events[LENGTH] = 1.0;
    derivatives.rows[rate] = 1.0;
    if model.problem.stages[phase].impulse_ns.is_some() {
        derivatives.rows[n + rate] = -model.reduced_kg();
    }
}
