//! The baseline: the program in the paper's form P4 (eq. 21, 22), solved by Clarabel, a general interior-point method.
//!
//! X = (z, α, β) with rows A X <= b in the order of [`InequalityForm`].

use clarabel::algebra::CscMatrix;
use clarabel::solver::{DefaultSettings, DefaultSolver, IPSolver, NonnegativeConeT, SolverStatus};

use super::program::Program;
use super::reference_methods::InequalityForm;
use super::solution::{Solution, Status};

/// With Clarabel's default of 1e-8, one in ten subproblems ends short of a tolerance of 1e-8; with this value all of
/// them reach it.
const STATIC_REGULARISATION: f64 = 1e-7;

/// Clarabel's settings for the relative gap and feasibility `tolerance`, without output.
pub fn settings(tolerance: f64) -> DefaultSettings<f64> {
    DefaultSettings {
        verbose: false,
        tol_gap_abs: tolerance,
        tol_gap_rel: tolerance,
        tol_feas: tolerance,
        static_regularization_constant: STATIC_REGULARISATION,
        ..DefaultSettings::default()
    }
}

/// Solves `program` with Clarabel to the relative gap and feasibility `tolerance`.
pub fn solve(program: &Program, tolerance: f64) -> Solution {
    let form = InequalityForm::new(program);
    let a = compressed(&form);
    let (n_z, n_x) = (program.len(), form.n_x());
    let quadratic = CscMatrix::zeros((n_x, n_x));
    let cones = [NonnegativeConeT(form.n_a())];
    let mut solver = match DefaultSolver::new(&quadratic, &form.cost, &a, &form.rhs, &cones, settings(tolerance)) {
        Ok(solver) => solver,
        Err(error) => unreachable!("Clarabel rejected the data: {error}"),
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

/// A in compressed columns, without explicit zeros.
fn compressed(form: &InequalityForm) -> CscMatrix<f64> {
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
