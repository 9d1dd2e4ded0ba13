//! Values of the nonlinear program, segment by segment.

use super::dense_kernels::add_scaled;
use super::transcription::Transcription;

impl Transcription<'_> {
    /// Writes defects and path constraints of a segment; returns its part of the objective,
    ///
    /// ```text
    /// η Σ_k w_k l(X_k, U_k)
    /// ```
    pub(super) fn evaluate_segment(
        &mut self,
        (index, k): (usize, usize),
        x: &[f64],
        c: &mut [f64],
        d: &mut [f64],
    ) -> f64 {
        let mut accelerations = std::mem::take(&mut self.work.accelerations);
        let η = self.half_length(&self.layout.phases[index], k, x);
        let cost = η * self.evaluate_nodes((index, k), x, &mut accelerations, d);
        self.defects((index, k), x, &accelerations, c);
        self.work.accelerations = accelerations;
        cost
    }

    /// Writes accelerations and path constraints at the nodes of a segment; returns `Σ_k w_k l(X_k, U_k)`.
    fn evaluate_nodes(&self, (index, k): (usize, usize), x: &[f64], accelerations: &mut [f64], d: &mut [f64]) -> f64 {
        let (nq, width) = (self.layout.coordinates, self.layout.width());
        let phase = &self.layout.phases[index];
        let (first, order) = (phase.segments[k].first_node, phase.segments[k].order);
        let count = phase.path_constraints;
        let mut cost = 0.0;
        for i in 0..order {
            let node = &x[self.layout.node_at(phase, first + i)..][..width];
            let path_constraints = &mut d[phase.path_constraints_at + (first + i) * count..][..count];
            let acceleration = &mut accelerations[i * nq..(i + 1) * nq];
            cost += self.rules[order].weights[i] * self.system.evaluate(index, node, acceleration, path_constraints);
        }
        cost
    }

    /// Writes the defects of a segment, given the accelerations at its nodes:
    ///
    /// ```text
    /// Σ_i D_ki X_i - η f(X_k, U_k),   f = (q', a)                            [Kang, Huang, Wen 2020, eq. 25 to 27]
    /// ```
    fn defects(&self, (index, k): (usize, usize), x: &[f64], accelerations: &[f64], c: &mut [f64]) {
        let (nq, n, width) = (self.layout.coordinates, self.layout.states(), self.layout.width());
        let phase = &self.layout.phases[index];
        let (first, order) = (phase.segments[k].first_node, phase.segments[k].order);
        let η = self.half_length(phase, k, x);
        let x = &x[self.layout.node_at(phase, first)..];
        let c = &mut c[self.layout.defect_at(phase, first)..][..order * n];
        c.fill(0.0);
        let differentiation = &self.rules[order].differentiation;
        for (k, c) in c.chunks_exact_mut(n).enumerate() {
            for i in 0..=order {
                add_scaled(c, differentiation[(k, i)], &x[i * width..i * width + n]);
            }
            add_scaled(&mut c[..nq], -η, &x[k * width + nq..k * width + n]);
            add_scaled(&mut c[nq..], -η, &accelerations[k * nq..(k + 1) * nq]);
        }
    }

    /// Writes the terminal constraints and the linkage of a phase.
    pub(super) fn evaluate_end(&mut self, index: usize, x: &[f64], c: &mut [f64], d: &mut [f64]) {
        let n = self.layout.states();
        let phase = &self.layout.phases[index];
        let is_last = index + 1 == self.layout.phases.len();
        let end = &mut self.work.end;
        end.equalities.resize(phase.terminal_equalities, 0.0);
        end.inequalities.resize(phase.terminal_inequalities, 0.0);
        end.next_state.resize(if is_last { 0 } else { n }, 0.0);
        let state = &x[self.layout.node_at(phase, phase.nodes)..][..n];
        self.system.evaluate_terminal(index, state, end);
        c[phase.terminal_equalities_at..][..phase.terminal_equalities].copy_from_slice(&end.equalities);
        d[phase.terminal_inequalities_at..][..phase.terminal_inequalities].copy_from_slice(&end.inequalities);
        if !is_last {
            let first = &x[self.layout.phases[index + 1].variables_at..][..n];
            for (c, (first, next)) in c[phase.linkage_at..][..n].iter_mut().zip(first.iter().zip(&end.next_state)) {
                *c = first - next;
            }
        }
    }
}
