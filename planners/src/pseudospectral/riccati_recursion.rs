//! Newton systems of the whole horizon by a Riccati recursion over the segments: a backward pass to factor, a backward
//! and a forward pass to solve.

use super::condensed_segment::{CondensedSegment, CostToGo, Nodes, costate};
use super::condensing::Dimensions;
use super::dense_kernels::{add_scaled, congruence, dot, eliminate, padded};
use super::layout::{Layout, PhaseLayout};
use super::linearisation::{Linearisation, TerminalLinearisation};
use super::multiphase_system::MultiphaseSystem;
use super::radau::Radau;
use super::workspace::Workspace;

/// Penalty weight 1/δ_c of the terminal equalities in the factors: they hold after iterative refinement.
const EQUALITY_WEIGHT: f64 = 1e8;

/// The condensed segments with their factors.
#[derive(Clone, Debug)]
pub struct RiccatiRecursion {
    segments: Vec<Vec<CondensedSegment>>,
    /// Gradients of the segments' half-lengths with respect to the parameters.
    half_length_gradients: Vec<Vec<Vec<f64>>>,
    /// Costs-to-go at the first state of every phase.
    phase_costs: Vec<CostToGo>,
    /// Cholesky factor of the parameters' block.
    parameter_factor: Vec<f64>,
    work: Workspace,
    states: usize,
    parameters: usize,
}

impl RiccatiRecursion {
    /// Work arrays for `system` on a mesh.
    pub fn new(system: &dyn MultiphaseSystem, layout: &Layout, rules: &[Radau]) -> Self {
        let segment = |order: usize| {
            let dimensions = Dimensions {
                coordinates: layout.coordinates,
                ignorable: system.ignorable(),
                controls: layout.controls,
                parameters: layout.parameters,
                order,
            };
            CondensedSegment::new(dimensions, &rules[order])
        };
        let phase = |phase: &PhaseLayout| phase.segments.iter().map(|s| segment(s.order)).collect();
        let gradients = |phase: &PhaseLayout| {
            let gradient = |fraction: f64| phase.duration.coefficients.iter().map(|c| 0.5 * fraction * c).collect();
            phase.segments.iter().map(|segment| gradient(segment.fraction)).collect()
        };
        let size = layout.states() + layout.parameters;
        Self {
            segments: layout.phases.iter().map(phase).collect(),
            half_length_gradients: layout.phases.iter().map(gradients).collect(),
            phase_costs: vec![CostToGo::zero(size); layout.phases.len()],
            parameter_factor: vec![0.0; padded(layout.parameters).pow(2)],
            work: Workspace::new(layout.states(), layout.parameters, layout.variables()),
            states: layout.states(),
            parameters: layout.parameters,
        }
    }

    /// Factors; false if the Hessian is not positive definite on the null space of the equalities.
    #[inline(always)]
    pub fn factor(&mut self, layout: &Layout, point: &Linearisation) -> bool {
        let mut work = std::mem::take(&mut self.work);
        let is_convex = self.factor_phases(layout, point, &mut work);
        self.work = work;
        is_convex && self.factor_parameters(point)
    }

    #[inline(always)]
    fn factor_phases(&mut self, layout: &Layout, point: &Linearisation, work: &mut Workspace) -> bool {
        for (index, phase) in layout.phases.iter().enumerate().rev() {
            self.end_matrix(phase.terminal_equalities, &point.ends[index], work);
            std::mem::swap(&mut work.after, &mut work.before);
            for k in (0..phase.segments.len()).rev() {
                let nodes = nodes(layout, index, k, point, &self.half_length_gradients[index][k]);
                let segment = &mut self.segments[index][k];
                segment.next.matrix.copy_from_slice(&work.after);
                if !segment.factor(&nodes, &mut work.before) {
                    return false;
                }
                std::mem::swap(&mut work.after, &mut work.before);
            }
            self.phase_costs[index].matrix.copy_from_slice(&work.after);
        }
        true
    }

    /// Cost-to-go at the final state of a phase: that of the next phase through the linkage, the Hessian of the end,
    /// and the penalty of the terminal equalities.
    fn end_matrix(&self, terminal_equalities: usize, end: &TerminalLinearisation, work: &mut Workspace) {
        let (n, size) = (self.states, self.states + self.parameters);
        let Workspace { after, before, half, .. } = work;
        before.fill(0.0);
        if !end.next_state.is_empty() {
            congruence(&end.next_state, after, n, size, half, before);
        }
        for r in 0..n {
            add_scaled(&mut before[r * size..r * size + n], 1.0, &end.barrier_hessian[r * n..(r + 1) * n]);
        }
        for row in end.equalities.chunks_exact(n).take(terminal_equalities) {
            for r in (0..n).filter(|&r| row[r] != 0.0) {
                add_scaled(&mut before[r * size..r * size + n], EQUALITY_WEIGHT * row[r], row);
            }
        }
    }

    /// Factors the parameters' block, given the cost-to-go at the initial state.
    fn factor_parameters(&mut self, point: &Linearisation) -> bool {
        let (n, count, size) = (self.states, self.parameters, self.states + self.parameters);
        let width = padded(count);
        for i in 0..count {
            for j in 0..count {
                self.parameter_factor[i * width + j] = self.phase_costs[0].matrix[(n + i) * size + n + j];
            }
            self.parameter_factor[i * width + i] += point.parameter_diagonal[i];
        }
        eliminate(&mut self.parameter_factor, count, count, width, 0.0)
    }

    /// Solves in place: `x` from the right-hand side of the variables to their step, `y` from that of the equalities to
    /// the step of their multipliers.
    #[inline(always)]
    pub fn solve(&mut self, layout: &Layout, point: &Linearisation, x: &mut [f64], y: &mut [f64]) {
        let mut work = std::mem::take(&mut self.work);
        for (gradient, value) in work.gradient.iter_mut().zip(&*x) {
            *gradient = -value;
        }
        self.backward(layout, point, y, &mut work);
        self.forward(layout, point, x, y, &mut work);
        self.work = work;
    }

    #[inline(always)]
    fn backward(&mut self, layout: &Layout, point: &Linearisation, y: &[f64], work: &mut Workspace) {
        let n = self.states;
        let Workspace { after_vector: after, before_vector: before, gradient, .. } = work;
        for (index, phase) in layout.phases.iter().enumerate().rev() {
            let end_at = layout.node_at(phase, phase.nodes);
            self.end_vector(layout, point, index, y, after, before);
            add_scaled(&mut before[..n], 1.0, &gradient[end_at..end_at + n]);
            std::mem::swap(after, before);
            for k in (0..phase.segments.len()).rev() {
                let (first, order) = (phase.segments[k].first_node, phase.segments[k].order);
                let nodes = nodes(layout, index, k, point, &self.half_length_gradients[index][k]);
                let segment = &mut self.segments[index][k];
                segment.next.vector.copy_from_slice(after);
                let gradient = &gradient[layout.node_at(phase, first)..][..order * layout.width()];
                let residuals = &y[layout.defect_at(phase, first)..][..order * n];
                segment.backward(&nodes, gradient, residuals, before);
                std::mem::swap(after, before);
            }
            self.phase_costs[index].vector.copy_from_slice(after);
        }
    }

    /// Gradient of the cost-to-go at the final state of a phase.
    #[inline(always)]
    fn end_vector(
        &self,
        layout: &Layout,
        point: &Linearisation,
        index: usize,
        y: &[f64],
        after: &[f64],
        before: &mut [f64],
    ) {
        let (n, size) = (self.states, self.states + self.parameters);
        let (phase, end) = (&layout.phases[index], &point.ends[index]);
        before.fill(0.0);
        if !end.next_state.is_empty() {
            let residual = &y[phase.linkage_at..][..n];
            let matrix = &self.phase_costs[index + 1].matrix;
            for r in 0..size {
                let value = after[r] + dot(&matrix[r * size..][..n], residual);
                if r < n {
                    add_scaled(&mut before[..n], value, &end.next_state[r * n..(r + 1) * n]);
                } else {
                    before[r] += value;
                }
            }
        }
        for (row, residual) in
            end.equalities.chunks_exact(n).zip(&y[phase.terminal_equalities_at..][..phase.terminal_equalities])
        {
            add_scaled(&mut before[..n], -EQUALITY_WEIGHT * residual, row);
        }
    }

    #[inline(always)]
    fn forward(&mut self, layout: &Layout, point: &Linearisation, x: &mut [f64], y: &mut [f64], work: &mut Workspace) {
        let (n, width) = (self.states, layout.width());
        work.state.copy_from_slice(&y[..n]);
        self.solve_parameters(layout.parameters_at, work);
        x[layout.parameters_at..].copy_from_slice(&work.parameters);
        costate(&self.phase_costs[0], &work.state, &work.parameters, &mut y[..n]);
        for (index, phase) in layout.phases.iter().enumerate() {
            for (k, segment) in phase.segments.iter().enumerate() {
                let at = layout.node_at(phase, segment.first_node);
                let solution = &mut x[at..at + segment.order * width + n];
                solution[..n].copy_from_slice(&work.state);
                let nodes = nodes(layout, index, k, point, &self.half_length_gradients[index][k]);
                let multipliers = &mut y[layout.defect_at(phase, segment.first_node)..][..segment.order * n];
                let gradient = &work.gradient[at..at + segment.order * width];
                self.segments[index][k].forward(&nodes, gradient, &work.parameters, solution, multipliers);
                work.state.copy_from_slice(&solution[segment.order * width..]);
            }
            self.end_forward(phase, &point.ends[index], index, y, work);
        }
    }

    /// Solves for the step of the parameters, given that of the initial state.
    fn solve_parameters(&self, at: usize, work: &mut Workspace) {
        let (n, count, size) = (self.states, self.parameters, self.states + self.parameters);
        let width = padded(count);
        let cost = &self.phase_costs[0];
        let Workspace { gradient, state, parameters: p, .. } = work;
        for (i, p) in p.iter_mut().enumerate() {
            *p = -(gradient[at + i] + cost.vector[n + i] + dot(&cost.matrix[(n + i) * size..][..n], state));
        }
        for i in 0..count {
            let known: f64 = (0..i).map(|k| self.parameter_factor[k * width + i] * p[k]).sum();
            p[i] = (p[i] - known) / self.parameter_factor[i * width + i];
        }
        for i in (0..count).rev() {
            let known: f64 = (i + 1..count).map(|k| self.parameter_factor[i * width + k] * p[k]).sum();
            p[i] = (p[i] - known) / self.parameter_factor[i * width + i];
        }
    }

    /// Multipliers of the terminal equalities and of the linkage; `work.state` becomes the first state of the next
    /// phase.
    #[inline(always)]
    fn end_forward(
        &self,
        phase: &PhaseLayout,
        end: &TerminalLinearisation,
        index: usize,
        y: &mut [f64],
        work: &mut Workspace,
    ) {
        let n = self.states;
        let Workspace { state, next, parameters, .. } = work;
        for (row, y) in
            end.equalities.chunks_exact(n).zip(&mut y[phase.terminal_equalities_at..][..phase.terminal_equalities])
        {
            *y = EQUALITY_WEIGHT * (dot(row, state) - *y);
        }
        if end.next_state.is_empty() {
            return;
        }
        let residual = &mut y[phase.linkage_at..][..n];
        for (r, (next, residual)) in next.iter_mut().zip(&*residual).enumerate() {
            *next = residual + dot(&end.next_state[r * n..(r + 1) * n], state);
        }
        costate(&self.phase_costs[index + 1], next, parameters, residual);
        std::mem::swap(state, next);
    }
}

/// The part of a linearisation that belongs to a segment.
fn nodes<'a>(
    layout: &Layout,
    phase: usize,
    segment: usize,
    point: &'a Linearisation,
    half_length_gradient: &'a [f64],
) -> Nodes<'a> {
    let phase = &layout.phases[phase];
    let segment = &phase.segments[segment];
    let (width, nq) = (layout.width(), layout.coordinates);
    let (node, count) = (phase.first_node + segment.first_node, segment.order);
    let parameters = &point.variables[layout.parameters_at..];
    Nodes {
        half_length: 0.5 * segment.fraction * phase.duration.at(parameters),
        half_length_gradient,
        hessians: &point.barrier_hessians[node * width * width..][..count * width * width],
        jacobians: &point.jacobians[node * nq * width..][..count * nq * width],
        accelerations: &point.accelerations[node * nq..][..count * nq],
        variables: &point.variables[layout.node_at(phase, segment.first_node)..][..count * width],
        cross: &point.cross[node * width..][..count * width],
    }
}
