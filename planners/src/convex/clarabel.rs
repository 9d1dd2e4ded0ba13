//! The baseline: the same subproblem as the paper's P4 (eq. 21, 22), solved by Clarabel, a general interior-point method.
//!
//! X = (z, α, β), rows A X <= b in the paper's order: box, equalities from both sides, inequalities, -β <= 0.

use clarabel::algebra::CscMatrix;
use clarabel::solver::{DefaultSettings, DefaultSolver, IPSolver, NonnegativeConeT, SolverStatus};

use super::program::{LINK, Program, STAGE};
use super::solution::{Solution, Status};

/// With Clarabel's own default of 1e-8 one in ten of our subproblems ends short of a tolerance of 1e-8; with this, all of
/// them reach it.
const STATIC_REGULARISATION: f64 = 1e-7;

/// Solves `program` with Clarabel to the relative gap and feasibility `tolerance`.
pub fn solve(program: &Program, tolerance: f64) -> Solution {
    let (a, b) = inequality_form(program);
    let (n_z, n_x) = (program.len(), a.n);
    let mut cost = vec![program.penalty; n_x];
    cost[..n_z].fill(0.0);
    cost[n_z - 1] = program.theta_cost;
    let settings = DefaultSettings {
        verbose: false,
        tol_gap_abs: tolerance,
        tol_gap_rel: tolerance,
        tol_feas: tolerance,
        static_regularization_constant: STATIC_REGULARISATION,
        ..DefaultSettings::default()
    };
    let quadratic = CscMatrix::zeros((n_x, n_x));
    let cones = [NonnegativeConeT(b.len())];
    let mut solver = match DefaultSolver::new(&quadratic, &cost, &a, &b, &cones, settings) {
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
        objective,
        gap,
        residual: solver.solution.r_prim.max(solver.solution.r_dual),
        iterations: solver.solution.iterations as usize,
    }
}

/// A and b of eq. 22.
fn inequality_form(program: &Program) -> (CscMatrix<f64>, Vec<f64>) {
    let (n_z, n_eq, n_in) = (program.len(), program.equalities(), program.inequalities());
    let mut rows = Rows::default();
    for (j, (lower, upper)) in program.box_lower.iter().zip(&program.box_upper).enumerate() {
        rows.push([(j, 1.0)], *upper);
        rows.push([(j, -1.0)], -lower);
    }
    for (i, (entries, d)) in equality_rows(program).into_iter().zip(program.equality_rhs()).enumerate() {
        for sign in [1.0, -1.0] {
            let signed = entries.iter().map(|&(j, value)| (j, sign * value));
            rows.push(signed.chain([(n_z + i, -1.0)]), sign * d);
        }
    }
    for (i, (entries, g)) in inequality_rows(program).into_iter().zip(program.inequality_rhs()).enumerate() {
        rows.push(entries.into_iter().chain([(n_z + n_eq + i, -1.0)]), g);
    }
    for i in 0..n_in {
        rows.push([(n_z + n_eq + i, -1.0)], 0.0);
    }
    let shape = (rows.rhs.len(), n_z + n_eq + n_in);
    (CscMatrix::new_from_triplets(shape.0, shape.1, rows.row, rows.column, rows.value), rows.rhs)
}

#[derive(Default)]
struct Rows {
    row: Vec<usize>,
    column: Vec<usize>,
    value: Vec<f64>,
    rhs: Vec<f64>,
}

impl Rows {
    fn push(&mut self, entries: impl IntoIterator<Item = (usize, f64)>, rhs: f64) {
        for (column, value) in entries.into_iter().filter(|(_, value)| *value != 0.0) {
            self.row.push(self.rhs.len());
            self.column.push(column);
            self.value.push(value);
        }
        self.rhs.push(rhs);
    }
}

fn equality_rows(program: &Program) -> Vec<Vec<(usize, f64)>> {
    let θ = program.len() - 1;
    let mut rows = Vec::with_capacity(program.equalities());
    for (k, link) in program.links.iter().enumerate() {
        for i in 0..LINK {
            let left = (0..STAGE).map(|j| (STAGE * k + j, link.left[(i, j)]));
            let right = (0..STAGE).map(|j| (STAGE * (k + 1) + j, link.right[(i, j)]));
            rows.push(left.chain(right).chain([(θ, link.theta[i])]).collect());
        }
    }
    rows.extend(program.pins.iter().map(|pin| vec![(pin.index, 1.0)]));
    rows
}

fn inequality_rows(program: &Program) -> Vec<Vec<(usize, f64)>> {
    let upper = (0..program.len()).map(|j| vec![(j, 1.0)]);
    let lower = (0..program.len()).map(|j| vec![(j, -1.0)]);
    let planes = program.planes.iter().map(|plane| {
        let first = STAGE * plane.stage;
        vec![(first, plane.normal[0]), (first + 1, plane.normal[1])]
    });
    upper.chain(lower).chain(planes).collect()
}
