//! The baseline: the same subproblem as the paper's P4 (eq. 21, 22), solved by Clarabel, a general interior-point method.
//!
//! X = (z, α, β), rows A X <= b in the paper's order: box, equalities from both sides, inequalities, -β <= 0.

use clarabel::algebra::CscMatrix;
use clarabel::solver::{DefaultSettings, DefaultSolver, IPSolver, NonnegativeConeT, SolverStatus};

use super::paper::PaperForm;
use super::program::Program;
use super::solution::{Solution, Status};

/// With Clarabel's own default of 1e-8 one in ten of our subproblems ends short of a tolerance of 1e-8; with this, all of
/// them reach it.
const STATIC_REGULARISATION: f64 = 1e-7;

/// Solves `program` with Clarabel to the relative gap and feasibility `tolerance`.
pub fn solve(program: &Program, tolerance: f64) -> Solution {
    let form = PaperForm::new(program);
    let a = compressed(&form);
    let (n_z, n_x) = (program.len(), form.n_x());
    let settings = DefaultSettings {
        verbose: false,
        tol_gap_abs: tolerance,
        tol_gap_rel: tolerance,
        tol_feas: tolerance,
        static_regularization_constant: STATIC_REGULARISATION,
        ..DefaultSettings::default()
    };
    let quadratic = CscMatrix::zeros((n_x, n_x));
    let cones = [NonnegativeConeT(form.n_a())];
    let mut solver = match DefaultSolver::new(&quadratic, &form.cost, &a, &form.rhs, &cones, settings) {
        Ok(solver) => solver,
        Err(error) => unreachable!("the baseline refused a well-posed programme: {error}"),
    };
    solver.solve();
    let objective = solver.solution.obj_val;
    let gap = (objective - solver.solution.obj_val_dual).abs() / objective.abs().max(1.0);
    Solution {
        status: match solver.solution.status {
            SolverStatus::Solved => Status::Solved,
            SolverStatus::MaxIterations | SolverStatus::MaxTime => Status::IterationLimit,
            _ => Status::Stalled,
        },
        z: solver.solution.x[..n_z].to_vec(),
        objective: objective + program.offset,
        gap: gap.max(solver.solution.r_prim).max(solver.solution.r_dual),
        iterations: solver.solution.iterations as usize,
    }
}

/// A in the form that Clarabel takes, without the entries that are zero.
fn compressed(form: &PaperForm) -> CscMatrix<f64> {
    let (mut rows, mut columns, mut values) = (Vec::new(), Vec::new(), Vec::new());
    for row in 0..form.n_a() {
        for (column, value) in form.row(row).filter(|(_, value)| *value != 0.0) {
            rows.push(row);
            columns.push(column);
            values.push(value);
        }
    }
    CscMatrix::new_from_triplets(form.n_a(), form.n_x(), rows, columns, values)
}
