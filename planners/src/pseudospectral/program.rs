//! The transcription as a nonlinear program that solves its own Newton systems.

use super::dense_kernels::{add_scaled, dot};
use super::differentiation::Point;
use super::layout::Layout;
use super::linearisation::Linearisation;
use super::riccati_recursion::RiccatiRecursion;
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

    fn evaluate(&mut self, x: &[f64], c: &mut [f64], d: &mut [f64]) -> f64 {
        let n = self.layout.states();
        for (c, (x, initial)) in c[..n].iter_mut().zip(x.iter().zip(self.system.initial_state())) {
            *c = x - initial;
        }
        let mut cost = 0.0;
        for index in 0..self.layout.phases.len() {
            for segment in 0..self.layout.phases[index].segments.len() {
                cost += self.evaluate_segment((index, segment), x, c, d);
            }
            self.evaluate_end(index, x, c, d);
            cost += self.system.time_cost() * self.duration_s(index, x);
        }
        cost
    }

    fn linearise(&mut self, x: &[f64], y: &[f64], v: &[f64], gradient: &mut [f64]) {
        let point = Point { x, y, v };
        self.point.variables.copy_from_slice(x);
        gradient.fill(0.0);
        for index in 0..self.layout.phases.len() {
            for segment in 0..self.layout.phases[index].segments.len() {
                self.linearise_segment((index, segment), point, gradient);
            }
            self.linearise_end(index, point);
        }
    }

    fn add_jacobian_transposed(&self, y: &[f64], v: &[f64], out: &mut [f64]) {
        let n = self.layout.states();
        add_scaled(&mut out[..n], 1.0, &y[..n]);
        for (index, phase) in self.layout.phases.iter().enumerate() {
            for segment in 0..phase.segments.len() {
                self.add_defects_transposed(index, segment, y, out);
            }
            if !v.is_empty() {
                self.add_path_constraints_transposed(phase, v, out);
            }
            self.add_end_transposed(index, y, v, out);
        }
    }

    fn jacobian_times(&self, dx: &[f64], c: &mut [f64], d: &mut [f64]) {
        let n = self.layout.states();
        c[..n].copy_from_slice(&dx[..n]);
        for (index, phase) in self.layout.phases.iter().enumerate() {
            for segment in 0..phase.segments.len() {
                self.defects_times(index, segment, dx, c);
            }
            self.path_constraints_times(phase, dx, d);
            self.end_times(index, dx, c, d);
        }
    }

    fn factor(&mut self, diagonal: &[f64], weights: &[f64]) -> bool {
        self.add_barrier_terms(diagonal, weights);
        let factor = Factor { recursion: &mut self.recursion, layout: &self.layout, point: &self.point };
        pulp::Arch::new().dispatch(factor)
    }

    fn hessian_times(&self, dx: &[f64], out: &mut [f64]) {
        let (n, parameters_at) = (self.layout.states(), self.layout.parameters_at);
        out[parameters_at..].fill(0.0);
        for (index, phase) in self.layout.phases.iter().enumerate() {
            self.node_hessians_times(phase, dx, out);
            let from = self.layout.node_at(phase, phase.nodes);
            for (a, hessian) in self.point.ends[index].barrier_hessian.chunks_exact(n).enumerate() {
                out[from + a] = dot(hessian, &dx[from..from + n]);
            }
        }
        let diagonal = self.point.parameter_diagonal.iter().zip(&dx[parameters_at..]);
        for (out, (diagonal, p)) in out[parameters_at..].iter_mut().zip(diagonal) {
            *out += diagonal * p;
        }
    }

    fn solve(&mut self, x: &mut [f64], y: &mut [f64]) {
        let solve = Solve { recursion: &mut self.recursion, layout: &self.layout, point: &self.point, x, y };
        pulp::Arch::new().dispatch(solve);
    }
}

/// The factorisation, compiled for several vector instruction sets and dispatched to the widest at run time.
struct Factor<'a> {
    recursion: &'a mut RiccatiRecursion,
    layout: &'a Layout,
    point: &'a Linearisation,
}

impl pulp::WithSimd for Factor<'_> {
    type Output = bool;

    #[inline(always)]
    fn with_simd<S: pulp::Simd>(self, _: S) -> bool {
        self.recursion.factor(self.layout, self.point)
    }
}

/// The solution with the factors, dispatched likewise.
struct Solve<'a> {
    recursion: &'a mut RiccatiRecursion,
    layout: &'a Layout,
    point: &'a Linearisation,
    x: &'a mut [f64],
    y: &'a mut [f64],
}

impl pulp::WithSimd for Solve<'_> {
    type Output = ();

    #[inline(always)]
    fn with_simd<S: pulp::Simd>(self, _: S) {
        self.recursion.solve(self.layout, self.point, self.x, self.y);
    }
}
