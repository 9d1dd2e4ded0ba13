//! The transcription as a nonlinear programme that solves its own Newton systems.

use super::layout::Layout;
use super::small::{add_scaled, dot};
use super::sweep::{Linearisation, Sweep};
use super::transcription::Transcription;
use crate::nlp::{Program, Sizes};

impl Program for Transcription<'_> {
    fn sizes(&self) -> Sizes {
        Sizes {
            variables: self.layout.variables(),
            equalities: self.layout.equalities,
            inequalities: self.layout.inequalities,
        }
    }

    fn bounds(&self) -> (&[f64], &[f64]) {
        (&self.lower, &self.upper)
    }

    fn values(&mut self, x: &[f64], c: &mut [f64], d: &mut [f64]) -> f64 {
        let n = self.layout.states();
        for (c, (x, start)) in c[..n].iter_mut().zip(x.iter().zip(self.motion.start())) {
            *c = x - start;
        }
        let mut cost = 0.0;
        let mut accelerations = std::mem::take(&mut self.accelerations);
        for index in 0..self.layout.phases.len() {
            for segment in 0..self.layout.phases[index].segments.len() {
                let η = self.half_length(&self.layout.phases[index], segment, x);
                cost += η * self.segment_values((index, segment), x, &mut accelerations, d);
                self.defects(&self.layout.phases[index], segment, x, &accelerations, c);
            }
            self.end_evaluate(index, x, c, d);
            cost += self.motion.time_cost() * self.duration_s(index, x);
        }
        self.accelerations = accelerations;
        cost
    }

    fn linearise(&mut self, x: &[f64], y: &[f64], v: &[f64], gradient: &mut [f64]) {
        self.point.variables.copy_from_slice(x);
        gradient.fill(0.0);
        for index in 0..self.layout.phases.len() {
            for segment in 0..self.layout.phases[index].segments.len() {
                self.segment_linearise((index, segment), x, y, v, gradient);
            }
            self.end_linearise(index, x, y, v);
        }
    }

    fn add_transposed(&self, y: &[f64], v: &[f64], out: &mut [f64]) {
        let n = self.layout.states();
        add_scaled(&mut out[..n], 1.0, &y[..n]);
        for (index, phase) in self.layout.phases.iter().enumerate() {
            for segment in 0..phase.segments.len() {
                self.add_defects_transposed(index, segment, y, out);
            }
            if !v.is_empty() {
                self.add_rows_transposed(phase, v, out);
            }
            self.add_end_transposed(index, y, v, out);
        }
    }

    fn rows_times(&self, dx: &[f64], c: &mut [f64], d: &mut [f64]) {
        let n = self.layout.states();
        c[..n].copy_from_slice(&dx[..n]);
        for (index, phase) in self.layout.phases.iter().enumerate() {
            for segment in 0..phase.segments.len() {
                self.defects_times(index, segment, dx, c);
            }
            let width = self.layout.width();
            for row in 0..phase.nodes * phase.rows {
                let at = self.layout.node_at(phase, row / phase.rows);
                let jacobian = &self.point.rows[(phase.rows_at + row) * width..][..width];
                d[phase.rows_at + row] = dot(jacobian, &dx[at..at + width]);
            }
            self.end_times(index, dx, c, d);
        }
    }

    fn factor(&mut self, diagonal: &[f64], weights: &[f64]) -> bool {
        self.weigh(diagonal, weights);
        let factor = Factor { sweep: &mut self.sweep, layout: &self.layout, point: &self.point };
        pulp::Arch::new().dispatch(factor)
    }

    fn hessian_times(&self, dx: &[f64], out: &mut [f64]) {
        let (n, width, at) = (self.layout.states(), self.layout.width(), self.layout.parameters_at);
        let parameters = &dx[at..];
        out[at..].fill(0.0);
        for (index, phase) in self.layout.phases.iter().enumerate() {
            for segment in &phase.segments {
                for node in segment.first..segment.first + segment.order {
                    let from = self.layout.node_at(phase, node);
                    let k = phase.first_node + node;
                    let z = &dx[from..from + width];
                    let cross = &self.point.cross[k * width..][..width];
                    let gain = |gain: &f64| 0.5 * segment.share * gain;
                    let half_length: f64 = phase.duration.gains.iter().zip(parameters).map(|(g, p)| gain(g) * p).sum();
                    for (a, hessian) in
                        self.point.weighted[k * width * width..].chunks_exact(width).take(width).enumerate()
                    {
                        out[from + a] = dot(hessian, z) + half_length * cross[a];
                    }
                    for (out, g) in out[at..].iter_mut().zip(&phase.duration.gains) {
                        *out += gain(g) * dot(cross, z);
                    }
                }
            }
            let from = self.layout.node_at(phase, phase.nodes);
            for (a, hessian) in self.point.ends[index].weighted.chunks_exact(n).enumerate() {
                out[from + a] = dot(hessian, &dx[from..from + n]);
            }
        }
        for (out, (diagonal, p)) in out[at..].iter_mut().zip(self.point.parameter_diagonal.iter().zip(parameters)) {
            *out += diagonal * p;
        }
    }

    fn solve(&mut self, x: &mut [f64], y: &mut [f64]) {
        let solve = Solve { sweep: &mut self.sweep, layout: &self.layout, point: &self.point, x, y };
        pulp::Arch::new().dispatch(solve);
    }
}

/// The factorisation, to be compiled for the widest vector registers that the processor turns out to have.
struct Factor<'a> {
    sweep: &'a mut Sweep,
    layout: &'a Layout,
    point: &'a Linearisation,
}

impl pulp::WithSimd for Factor<'_> {
    type Output = bool;

    #[inline(always)]
    fn with_simd<S: pulp::Simd>(self, _: S) -> bool {
        self.sweep.factor(self.layout, self.point)
    }
}

/// The solution with the factors, likewise.
struct Solve<'a> {
    sweep: &'a mut Sweep,
    layout: &'a Layout,
    point: &'a Linearisation,
    x: &'a mut [f64],
    y: &'a mut [f64],
}

impl pulp::WithSimd for Solve<'_> {
    type Output = ();

    #[inline(always)]
    fn with_simd<S: pulp::Simd>(self, _: S) {
        self.sweep.solve(self.layout, self.point, self.x, self.y);
    }
}

impl Transcription<'_> {
    fn segment_linearise(&mut self, (index, k): (usize, usize), x: &[f64], y: &[f64], v: &[f64], gradient: &mut [f64]) {
        let phase = &self.layout.phases[index];
        let (first, order) = (phase.segments[k].first, phase.segments[k].order);
        let η = self.half_length(phase, k, x);
        let (width, nq, rows) = (self.layout.width(), self.layout.coordinates, phase.rows);
        let mut cost = 0.0;
        for i in 0..order {
            let phase = &self.layout.phases[index];
            let at = self.layout.node_at(phase, first + i);
            let node = phase.first_node + first + i;
            let mut scratch = [0.0; 64];
            let acceleration = &mut self.point.accelerations[node * nq..][..nq];
            let running = self.motion.values(index, &x[at..at + width], acceleration, &mut scratch[..rows]);
            let weight = self.rules[order].weights[i];
            cost += weight * running;
            self.node_linearise(index, first + i, (η, weight), x, y, v, gradient);
        }
        let share = self.layout.phases[index].segments[k].share;
        let gains = &self.layout.phases[index].duration.gains;
        for (gradient, gain) in gradient[self.layout.parameters_at..].iter_mut().zip(gains) {
            *gradient += share * gain * (0.5 * cost + self.motion.time_cost());
        }
    }

    /// `weighted = W + diagonal + rows^T weights rows`, node by node.
    fn weigh(&mut self, diagonal: &[f64], weights: &[f64]) {
        let (n, width) = (self.layout.states(), self.layout.width());
        let point = &mut self.point;
        point.weighted.copy_from_slice(&point.hessians);
        for (index, phase) in self.layout.phases.iter().enumerate() {
            for node in 0..phase.nodes {
                let at = self.layout.node_at(phase, node);
                let hessian = &mut point.weighted[(phase.first_node + node) * width * width..][..width * width];
                let first_row = phase.rows_at + node * phase.rows;
                let rows = &point.rows[first_row * width..][..phase.rows * width];
                add_weighted(hessian, width, &diagonal[at..at + width], rows, &weights[first_row..]);
            }
            let at = self.layout.node_at(phase, phase.nodes);
            let end = &mut point.ends[index];
            end.weighted.copy_from_slice(&end.hessian);
            add_weighted(&mut end.weighted, n, &diagonal[at..at + n], &end.rows, &weights[phase.end_rows_at..]);
        }
        point.parameter_diagonal.copy_from_slice(&diagonal[self.layout.parameters_at..]);
    }
}

/// `hessian += diag + Σ_j w_j r_j^T r_j`; the rows are sparse.
fn add_weighted(hessian: &mut [f64], width: usize, diagonal: &[f64], rows: &[f64], weights: &[f64]) {
    for (a, diagonal) in diagonal.iter().enumerate() {
        hessian[a * width + a] += diagonal;
    }
    for (row, &weight) in rows.chunks_exact(width).zip(weights) {
        for a in (0..width).filter(|&a| row[a] != 0.0) {
            add_scaled(&mut hessian[a * width..(a + 1) * width], weight * row[a], row);
        }
    }
}
