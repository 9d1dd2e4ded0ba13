//! Linearisation of the nonlinear program, segment by segment.

use super::dense_kernels::add_scaled;
use super::multiphase_system::{NodeDerivatives, NodeWeights, TerminalDerivatives, TerminalWeights};
use super::transcription::Transcription;

/// A point and the multipliers of the Lagrangian `f + y^T c - v^T d`.
#[derive(Clone, Copy)]
pub(super) struct Point<'a> {
    pub x: &'a [f64],
    pub y: &'a [f64],
    pub v: &'a [f64],
}

impl Transcription<'_> {
    /// Linearises the nodes of a segment, and adds its part of the objective's gradient.
    pub(super) fn linearise_segment(&mut self, (index, k): (usize, usize), at: Point, gradient: &mut [f64]) {
        let phase = &self.layout.phases[index];
        let (first, order, count) = (phase.segments[k].first_node, phase.segments[k].order, phase.path_constraints);
        let η = self.half_length(phase, k, at.x);
        let (width, nq) = (self.layout.width(), self.layout.coordinates);
        let mut cost = 0.0;
        for i in 0..order {
            let phase = &self.layout.phases[index];
            let node = phase.first_node + first + i;
            let w = &at.x[self.layout.node_at(phase, first + i)..][..width];
            let acceleration = &mut self.point.accelerations[node * nq..][..nq];
            let running = self.system.evaluate(index, w, acceleration, &mut self.work.path_constraints[..count]);
            let weight = self.rules[order].weights[i];
            cost += weight * running;
            self.linearise_node((index, first + i), (η, weight), at, gradient);
        }
        let fraction = self.layout.phases[index].segments[k].fraction;
        let coefficients = &self.layout.phases[index].duration.coefficients;
        for (gradient, coefficient) in gradient[self.layout.parameters_at..].iter_mut().zip(coefficients) {
            *gradient += fraction * coefficient * (0.5 * cost + self.system.time_cost());
        }
    }

    /// Linearises a node of quadrature weight `weight` in a segment of half-length η.
    fn linearise_node(
        &mut self,
        (index, node): (usize, usize),
        (η, weight): (f64, f64),
        Point { x, y, v }: Point,
        gradient: &mut [f64],
    ) {
        let (nq, n, width) = (self.layout.coordinates, self.layout.states(), self.layout.width());
        let phase = &self.layout.phases[index];
        let at = self.layout.node_at(phase, node);
        let k = phase.first_node + node;
        let y = &y[self.layout.defect_at(phase, node)..][..n];
        let (constraints_at, count) =
            (phase.path_constraints_at + node * phase.path_constraints, phase.path_constraints);
        let (point, work) = (&mut self.point, &mut self.work);
        for (weight, y) in work.acceleration_weights.iter_mut().zip(&y[nq..]) {
            *weight = -η * y;
        }
        for (weight, v) in work.inequality_weights.iter_mut().zip(&v[constraints_at..][..count]) {
            *weight = -v;
        }
        let weights = NodeWeights {
            cost: η * weight,
            acceleration: &work.acceleration_weights,
            path_constraints: &work.inequality_weights[..count],
        };
        let derivatives = NodeDerivatives {
            acceleration: &mut point.jacobians[k * nq * width..][..nq * width],
            cost: &mut work.cost_gradient,
            path_constraints: &mut point.path_constraints[constraints_at * width..][..count * width],
            hessian: &mut point.hessians[k * width * width..][..width * width],
        };
        derivatives.acceleration.fill(0.0);
        derivatives.cost.fill(0.0);
        derivatives.path_constraints.fill(0.0);
        derivatives.hessian.fill(0.0);
        self.system.differentiate(index, &x[at..at + width], weights, derivatives);
        add_scaled(&mut gradient[at..at + width], η * weight, &work.cost_gradient);
        if self.layout.parameters > 0 {
            // ∂/∂η of the gradient of the Lagrangian: w_k ∇l - y^T ∇f
            let cross = &mut point.cross[k * width..][..width];
            cross.fill(0.0);
            add_scaled(cross, weight, &work.cost_gradient);
            add_scaled(&mut cross[nq..n], -1.0, &y[..nq]);
            for (jacobian, y) in point.jacobians[k * nq * width..][..nq * width].chunks_exact(width).zip(&y[nq..]) {
                add_scaled(cross, -y, jacobian);
            }
        }
    }

    /// Linearises the terminal constraints and the linkage of a phase.
    pub(super) fn linearise_end(&mut self, index: usize, Point { x, y, v }: Point) {
        let n = self.layout.states();
        let phase = &self.layout.phases[index];
        let (end, work) = (&mut self.point.ends[index], &mut self.work);
        let (inequalities, linkages) = (phase.terminal_inequalities, end.next_state.len() / n);
        for (weight, v) in work.inequality_weights.iter_mut().zip(&v[phase.terminal_inequalities_at..][..inequalities])
        {
            *weight = -v;
        }
        for (weight, y) in work.linkage_weights.iter_mut().zip(&y[phase.linkage_at..][..linkages]) {
            *weight = -y;
        }
        let weights = TerminalWeights {
            equalities: &y[phase.terminal_equalities_at..][..phase.terminal_equalities],
            inequalities: &work.inequality_weights[..inequalities],
            next_state: &work.linkage_weights[..linkages],
        };
        for values in [&mut end.equalities, &mut end.inequalities, &mut end.next_state, &mut end.hessian] {
            values.fill(0.0);
        }
        let derivatives = TerminalDerivatives {
            equalities: &mut end.equalities,
            inequalities: &mut end.inequalities,
            next_state: &mut end.next_state,
            hessian: &mut end.hessian,
        };
        let state = &x[self.layout.node_at(phase, phase.nodes)..][..n];
        self.system.differentiate_terminal(index, state, weights, derivatives);
    }

    /// Adds the barrier's terms to the Hessians, node by node:
    ///
    /// ```text
    /// W + diag(diagonal) + J_d^T diag(weights) J_d
    /// ```
    pub(super) fn add_barrier_terms(&mut self, diagonal: &[f64], weights: &[f64]) {
        let (n, width) = (self.layout.states(), self.layout.width());
        let point = &mut self.point;
        point.barrier_hessians.copy_from_slice(&point.hessians);
        for (index, phase) in self.layout.phases.iter().enumerate() {
            for node in 0..phase.nodes {
                let at = self.layout.node_at(phase, node);
                let hessian = &mut point.barrier_hessians[(phase.first_node + node) * width * width..][..width * width];
                let first = phase.path_constraints_at + node * phase.path_constraints;
                let jacobian = &point.path_constraints[first * width..][..phase.path_constraints * width];
                add_weighted(hessian, width, &diagonal[at..at + width], jacobian, &weights[first..]);
            }
            let at = self.layout.node_at(phase, phase.nodes);
            let end = &mut point.ends[index];
            end.barrier_hessian.copy_from_slice(&end.hessian);
            let weights = &weights[phase.terminal_inequalities_at..];
            add_weighted(&mut end.barrier_hessian, n, &diagonal[at..at + n], &end.inequalities, weights);
        }
        point.parameter_diagonal.copy_from_slice(&diagonal[self.layout.parameters_at..]);
    }
}

/// `hessian += diag(diagonal) + Σ_j weights_j r_j^T r_j` with r_j the rows of `jacobian`, which are sparse.
fn add_weighted(hessian: &mut [f64], width: usize, diagonal: &[f64], jacobian: &[f64], weights: &[f64]) {
    for (a, diagonal) in diagonal.iter().enumerate() {
        hessian[a * width + a] += diagonal;
    }
    for (row, &weight) in jacobian.chunks_exact(width).zip(weights) {
        for a in (0..width).filter(|&a| row[a] != 0.0) {
            add_scaled(&mut hessian[a * width..(a + 1) * width], weight * row[a], row);
        }
    }
}
