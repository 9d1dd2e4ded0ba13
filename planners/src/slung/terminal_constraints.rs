//! Terminal constraints and linkages of the phases: the goal, a gate, or a switch of the cable's mode.
//!
//! A slack cable becomes taut in an inelastic impact. With the reduced mass m the impulse Λ removes the rate of the
//! length, and changes the quadrotor's velocity along the cable:
//!
//! ```text
//! Λ = m ρ',   v_Q+ = v_Q- + Λ d/m_Q,   ρ'+ = 0
//! ```

use super::cable::CableGeometry;
use super::gate;
use super::jet::Jet;
use super::problem::CableMode;
use super::system::{ALPHA, BETA, LENGTH, SlungLoadSystem};
use crate::pseudospectral::{TerminalDerivatives, TerminalValues, TerminalWeights};

/// Numbers of equalities and of inequalities.
pub fn counts(system: &SlungLoadSystem, phase: usize) -> (usize, usize) {
    if is_last(system, phase) {
        (goal_indices(system).count(), 0)
    } else if has_impact(system, phase) {
        (1, 1 + usize::from(system.problem.phases[phase].max_impulse_ns.is_some()))
    } else {
        (0, gate::count(system, phase))
    }
}

fn is_last(system: &SlungLoadSystem, phase: usize) -> bool {
    phase + 1 == system.problem.phases.len()
}

/// Whether the cable becomes taut at the end of a phase.
fn has_impact(system: &SlungLoadSystem, phase: usize) -> bool {
    system.mode(phase) != CableMode::Taut && system.mode(phase + 1) == CableMode::Taut
}

/// Indices of the states that the goal fixes: all, except a length that is constant in the last phase.
fn goal_indices(system: &SlungLoadSystem) -> impl Iterator<Item = usize> {
    let (nq, last) = (system.coordinates, system.problem.phases.len() - 1);
    let is_constant = nq > LENGTH && system.mode(last) == CableMode::Taut;
    (0..2 * nq).filter(move |index| !(is_constant && index % nq == LENGTH))
}

fn goal(system: &SlungLoadSystem, index: usize) -> f64 {
    match index {
        0..3 => system.problem.goal_m[index],
        LENGTH if system.coordinates > LENGTH => system.problem.vehicle.cable_m,
        _ => 0.0,
    }
}

/// Writes equalities, inequalities and the next phase's initial state.
pub fn evaluate(system: &SlungLoadSystem, phase: usize, state: &[f64], values: &mut TerminalValues) {
    if is_last(system, phase) {
        for (equality, index) in values.equalities.iter_mut().zip(goal_indices(system)) {
            *equality = state[index] - goal(system, index);
        }
        return;
    }
    values.next_state.copy_from_slice(state);
    if has_impact(system, phase) {
        evaluate_impact(system, phase, state, values);
    } else {
        gate::evaluate(system, phase, state, &mut values.inequalities);
    }
}

fn evaluate_impact(system: &SlungLoadSystem, phase: usize, state: &[f64], values: &mut TerminalValues) {
    let (vehicle, nq) = (&system.problem.vehicle, system.coordinates);
    let length_rate = state[nq + LENGTH];
    let impulse_ns = system.reduced_kg() * length_rate;
    let cable = CableGeometry::at([state[ALPHA], state[BETA], vehicle.cable_m].map(Jet::<0>::constant));
    for (v, d) in values.next_state[nq..].iter_mut().zip(cable.direction) {
        *v += impulse_ns / vehicle.quadrotor_kg * d.value;
    }
    values.next_state[LENGTH] = vehicle.cable_m;
    values.next_state[nq + LENGTH] = 0.0;
    values.equalities[0] = state[LENGTH] - vehicle.cable_m;
    values.inequalities[0] = length_rate;
    if let Some(max_impulse_ns) = system.problem.phases[phase].max_impulse_ns {
        values.inequalities[1] = max_impulse_ns - impulse_ns;
    }
}

/// Writes their Jacobians, and adds the weighted Hessian.
pub fn differentiate(
    system: &SlungLoadSystem,
    phase: usize,
    state: &[f64],
    weights: &TerminalWeights,
    derivatives: &mut TerminalDerivatives,
) {
    let n = 2 * system.coordinates;
    if is_last(system, phase) {
        for (equality, index) in goal_indices(system).enumerate() {
            derivatives.equalities[equality * n + index] = 1.0;
        }
        return;
    }
    for r in 0..n {
        derivatives.next_state[r * n + r] = 1.0;
    }
    if has_impact(system, phase) {
        differentiate_impact(system, phase, state, weights, derivatives);
    } else {
        gate::differentiate(system, phase, state, weights, derivatives);
    }
}

fn differentiate_impact(
    system: &SlungLoadSystem,
    phase: usize,
    state: &[f64],
    weights: &TerminalWeights,
    derivatives: &mut TerminalDerivatives,
) {
    let (nq, n) = (system.coordinates, 2 * system.coordinates);
    let rate = nq + LENGTH;
    let mass_ratio = system.reduced_kg() / system.problem.vehicle.quadrotor_kg;
    let [alpha, beta] = Jet::<2>::variables([state[ALPHA], state[BETA]]);
    let cable = CableGeometry::at([alpha, beta, Jet::constant(system.problem.vehicle.cable_m)]);
    for (k, d) in cable.direction.into_iter().enumerate() {
        let row = &mut derivatives.next_state[(nq + k) * n..][..n];
        let weight = mass_ratio * weights.next_state[nq + k];
        row[rate] = mass_ratio * d.value;
        for (index, slope) in [ALPHA, BETA].into_iter().zip(d.gradient) {
            row[index] = mass_ratio * state[rate] * slope;
            derivatives.hessian[index * n + rate] += weight * slope;
            derivatives.hessian[rate * n + index] += weight * slope;
        }
        d.scatter(derivatives.hessian, n, [ALPHA, BETA], 2, weight * state[rate]);
    }
    derivatives.next_state[LENGTH * n + LENGTH] = 0.0;
    derivatives.next_state[rate * n + rate] = 0.0;
    derivatives.equalities[LENGTH] = 1.0;
    derivatives.inequalities[rate] = 1.0;
    if system.problem.phases[phase].max_impulse_ns.is_some() {
        derivatives.inequalities[n + rate] = -system.reduced_kg();
    }
}
