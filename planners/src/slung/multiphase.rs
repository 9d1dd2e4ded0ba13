//! [`SlungLoadSystem`] as a [`MultiphaseSystem`]: its dynamics, cost and constraints put together.

use super::problem::CableMode;
use super::system::{EULER, SlungLoadSystem};
use super::translation::Translation;
use super::{cost, path_constraints, rotation, terminal_constraints};
use crate::pseudospectral::{
    Duration, MultiphaseSystem, NodeDerivatives, NodeWeights, TerminalDerivatives, TerminalValues, TerminalWeights,
};

impl MultiphaseSystem for SlungLoadSystem<'_> {
    fn coordinates(&self) -> usize {
        self.coordinates
    }

    /// The position.
    fn ignorable(&self) -> usize {
        EULER
    }

    fn controls(&self) -> usize {
        self.controls
    }

    fn durations(&self) -> &[Duration] {
        &self.durations
    }

    fn time_cost(&self) -> f64 {
        self.problem.weights.time
    }

    fn initial_state(&self) -> &[f64] {
        &self.initial_state
    }

    fn bounds(&self, phase: usize) -> (&[f64], &[f64]) {
        let [lower, upper] = &self.bounds[phase];
        (lower, upper)
    }

    fn path_constraint_count(&self, phase: usize) -> usize {
        path_constraints::count(self, self.mode(phase))
    }

    fn terminal_constraint_counts(&self, phase: usize) -> (usize, usize) {
        terminal_constraints::counts(self, phase)
    }

    fn evaluate(&self, phase: usize, node: &[f64], acceleration: &mut [f64], path_constraints: &mut [f64]) -> f64 {
        let mode = self.mode(phase);
        let (cable, rates) = self.cable_values(mode, node);
        let tension_n = Translation::evaluate(self, mode, node, &cable, &rates, acceleration);
        rotation::evaluate(self, node, acceleration);
        path_constraints::evaluate(self, mode, node, &cable, tension_n, path_constraints);
        cost::evaluate(self, node)
    }

    fn differentiate(&self, phase: usize, node: &[f64], weights: NodeWeights, derivatives: NodeDerivatives) {
        let mode = self.mode(phase);
        pulp::Arch::new().dispatch(Differentiate { system: self, mode, node, weights, derivatives });
    }

    fn evaluate_terminal(&self, phase: usize, state: &[f64], values: &mut TerminalValues) {
        terminal_constraints::evaluate(self, phase, state, values);
    }

    fn differentiate_terminal(
        &self,
        phase: usize,
        state: &[f64],
        weights: TerminalWeights,
        mut derivatives: TerminalDerivatives,
    ) {
        terminal_constraints::differentiate(self, phase, state, &weights, &mut derivatives);
    }
}

/// All derivatives at a node, compiled for several vector instruction sets and dispatched to the widest at run time.
struct Differentiate<'a> {
    system: &'a SlungLoadSystem<'a>,
    mode: CableMode,
    node: &'a [f64],
    weights: NodeWeights<'a>,
    derivatives: NodeDerivatives<'a>,
}

impl pulp::WithSimd for Differentiate<'_> {
    type Output = ();

    #[inline(always)]
    fn with_simd<S: pulp::Simd>(self, _: S) {
        let Self { system, mode, node, weights, mut derivatives } = self;
        Translation::at(system, mode, node, &weights).differentiate(&mut derivatives);
        rotation::differentiate(system, node, &weights, &mut derivatives);
        cost::differentiate(system, node, weights.cost, &mut derivatives);
        path_constraints::differentiate(system, mode, node, weights.path_constraints, &mut derivatives);
    }
}
