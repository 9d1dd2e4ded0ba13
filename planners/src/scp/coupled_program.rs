//! The programs of all vehicles, with rows between pairs of vehicles, as one sparse linear program.
//!
//! ```text
//! min  Σ q θ + μ (Σ |E z - d| + Σ max(F z - g, 0) + Σ max(n · (w_j - w_i) - slack, 0))     s.t.  lo <= z <= hi
//! ```
//!
//! In Clarabel's form the elastic equalities are E z - p + n = d with p, n >= 0, the inequalities F z - β <= g with
//! β >= 0. Elastic bounds outside the trust region never bind and are omitted.

use clarabel::algebra::CscMatrix;
use clarabel::solver::{DefaultSolver, IPSolver, NonnegativeConeT, SolverStatus, ZeroConeT};

use crate::convex::{DYNAMICS_ROWS, Program, STAGE_LEN, clarabel_settings};

/// One program over a fleet.
pub struct CoupledProgram {
    /// The programs of the single vehicles.
    pub vehicles: Vec<Program>,
    /// Rows between two vehicles.
    pub pairs: Vec<PairConstraint>,
    /// Do all vehicles have the same step length?
    pub shared_time: bool,
}

/// The row `normal · (w_i - w_j) >= -slack` in the first two variables of one stage of both vehicles.
#[derive(Clone, Debug)]
pub struct PairConstraint {
    /// i and j.
    pub vehicles: [usize; 2],
    /// Stage.
    pub stage: usize,
    /// Coefficients.
    pub normal: [f64; 2],
    /// Scaled slack at the last trajectory; negative if the row is violated there.
    pub slack: f64,
}

/// Result of a solve.
pub struct CoupledSolution {
    /// Variables of every vehicle, in the form of its own program.
    pub z: Vec<Vec<f64>>,
    /// Largest remaining violation.
    pub slack: f64,
    /// Number of iterations.
    pub iterations: usize,
    /// Did the solver reach its tolerance?
    pub is_solved: bool,
}

impl CoupledProgram {
    /// Solves to the relative gap and feasibility `tolerance`.
    pub fn solve(&self, tolerance: f64) -> CoupledSolution {
        let rows = self.rows();
        let matrix = CscMatrix::new_from_triplets(
            rows.rhs.len(),
            rows.cost.len(),
            rows.indices.iter().map(|index| index.0).collect(),
            rows.indices.iter().map(|index| index.1).collect(),
            rows.values.clone(),
        );
        let cones = [ZeroConeT(rows.equalities), NonnegativeConeT(rows.rhs.len() - rows.equalities)];
        let settings = clarabel_settings(tolerance);
        let quadratic = CscMatrix::zeros((rows.cost.len(), rows.cost.len()));
        let mut solver = match DefaultSolver::new(&quadratic, &rows.cost, &matrix, &rows.rhs, &cones, settings) {
            Ok(solver) => solver,
            Err(error) => unreachable!("Clarabel rejected the data: {error}"),
        };
        solver.solve();
        let z: Vec<Vec<f64>> = (0..self.vehicles.len()).map(|i| self.variables(i, &solver.solution.x)).collect();
        CoupledSolution {
            slack: self.max_violation(&z),
            z,
            iterations: solver.solution.iterations as usize,
            is_solved: solver.solution.status == SolverStatus::Solved,
        }
    }

    /// First column of the stages of a vehicle.
    fn offset(&self, i: usize) -> usize {
        let stages = |program: &Program| program.len() - 1;
        self.vehicles[..i].iter().map(stages).sum()
    }

    /// Column of a variable of a vehicle.
    fn column(&self, i: usize, index: usize) -> usize {
        if index + 1 < self.vehicles[i].len() {
            return self.offset(i) + index;
        }
        self.offset(self.vehicles.len()) + if self.shared_time { 0 } else { i }
    }

    fn variables(&self, i: usize, x: &[f64]) -> Vec<f64> {
        (0..self.vehicles[i].len()).map(|index| x[self.column(i, index)]).collect()
    }

    fn max_violation(&self, z: &[Vec<f64>]) -> f64 {
        let own = self.vehicles.iter().zip(z).map(|(program, z)| program.max_violation(z));
        let pairs = self.pairs.iter().map(|pair| {
            let [i, j] = pair.vehicles;
            let difference = |axis: usize| z[i][STAGE_LEN * pair.stage + axis] - z[j][STAGE_LEN * pair.stage + axis];
            -pair.slack - pair.normal[0] * difference(0) - pair.normal[1] * difference(1)
        });
        own.chain(pairs).fold(0.0, f64::max)
    }

    fn rows(&self) -> Rows {
        let times = if self.shared_time { 1 } else { self.vehicles.len() };
        let mut rows = Rows { cost: vec![0.0; self.offset(self.vehicles.len()) + times], ..Rows::default() };
        for (i, program) in self.vehicles.iter().enumerate() {
            rows.cost[self.column(i, program.len() - 1)] = program.theta_cost;
            self.append_equalities(i, &mut rows);
        }
        rows.equalities = rows.rhs.len();
        for slack in std::mem::take(&mut rows.slacks) {
            rows.append([(slack, -1.0)], 0.0);
        }
        for i in 0..self.vehicles.len() {
            self.append_bounds(i, &mut rows);
            self.append_halfspaces(i, &mut rows);
        }
        for pair in &self.pairs {
            let [i, j] = pair.vehicles.map(|vehicle| self.column(vehicle, STAGE_LEN * pair.stage));
            let [x, y] = pair.normal;
            rows.append_elastic([(i, -x), (i + 1, -y), (j, x), (j + 1, y)], pair.slack, self.penalty(0));
        }
        rows
    }

    /// Penalty of the rows in variable `index` of a vehicle.
    fn penalty(&self, index: usize) -> f64 {
        self.vehicles[0].penalty * self.vehicles[0].unit(index)
    }

    fn append_equalities(&self, i: usize, rows: &mut Rows) {
        let program = &self.vehicles[i];
        for (k, constraint) in program.dynamics.iter().enumerate() {
            for row in 0..DYNAMICS_ROWS {
                let left = (0..STAGE_LEN).map(|c| (self.column(i, STAGE_LEN * k + c), constraint.left[(row, c)]));
                let right =
                    (0..STAGE_LEN).map(|c| (self.column(i, STAGE_LEN * (k + 1) + c), constraint.right[(row, c)]));
                let time = std::iter::once((self.column(i, program.len() - 1), constraint.theta[row]));
                rows.append_elastic_equality(left.chain(right).chain(time), constraint.rhs[row], self.penalty(row));
            }
        }
        for fixed in &program.fixed_variables {
            rows.append_elastic_equality([(self.column(i, fixed.index), 1.0)], fixed.value, self.penalty(fixed.index));
        }
    }

    fn append_bounds(&self, i: usize, rows: &mut Rows) {
        let program = &self.vehicles[i];
        for index in 0..program.len() {
            let column = self.column(i, index);
            rows.append([(column, 1.0)], program.box_upper[index]);
            rows.append([(column, -1.0)], -program.box_lower[index]);
            if program.soft_upper[index] < program.box_upper[index] {
                rows.append_elastic([(column, 1.0)], program.soft_upper[index], self.penalty(index));
            }
            if program.soft_lower[index] > program.box_lower[index] {
                rows.append_elastic([(column, -1.0)], -program.soft_lower[index], self.penalty(index));
            }
        }
    }

    fn append_halfspaces(&self, i: usize, rows: &mut Rows) {
        for halfspace in &self.vehicles[i].halfspaces {
            let here = self.column(i, STAGE_LEN * halfspace.stage);
            rows.append_elastic(
                [(here, halfspace.current[0]), (here + 1, halfspace.current[1])],
                halfspace.bound,
                self.penalty(0),
            );
        }
    }
}

/// Rows A x <= b, equalities first.
#[derive(Default)]
struct Rows {
    cost: Vec<f64>,
    /// Row and column of every entry.
    indices: Vec<(usize, usize)>,
    values: Vec<f64>,
    rhs: Vec<f64>,
    equalities: usize,
    /// Slacks of the equalities, whose bounds are not yet appended.
    slacks: Vec<usize>,
}

impl Rows {
    fn append(&mut self, terms: impl IntoIterator<Item = (usize, f64)>, rhs: f64) {
        for (column, value) in terms.into_iter().filter(|(_, value)| *value != 0.0) {
            self.indices.push((self.rhs.len(), column));
            self.values.push(value);
        }
        self.rhs.push(rhs);
    }

    /// Appends `terms <= rhs`, with a penalty on the violation.
    fn append_elastic(&mut self, terms: impl IntoIterator<Item = (usize, f64)>, rhs: f64, penalty: f64) {
        let slack = self.new_slack(penalty);
        self.append(terms.into_iter().chain([(slack, -1.0)]), rhs);
        self.append([(slack, -1.0)], 0.0);
    }

    /// Appends `terms = rhs`, with a penalty on the difference.
    fn append_elastic_equality(&mut self, terms: impl IntoIterator<Item = (usize, f64)>, rhs: f64, penalty: f64) {
        let [above, below] = [self.new_slack(penalty), self.new_slack(penalty)];
        self.append(terms.into_iter().chain([(above, -1.0), (below, 1.0)]), rhs);
        self.slacks.extend([above, below]);
    }

    fn new_slack(&mut self, penalty: f64) -> usize {
        self.cost.push(penalty);
        self.cost.len() - 1
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::convex::{InteriorPoint, Settings};
    use crate::scp::decoupled::{Avoidance, FleetProblem};

    /// The first subproblems of two vehicles.
    fn programs() -> Vec<Program> {
        let path = std::path::Path::new(env!("CARGO_MANIFEST_DIR")).join("../scenarios/fixed-wing/rendezvous-2.toml");
        let scenario = scenarios::load(&path).expect("a shipped scenario");
        let fleet = FleetProblem::new(&scenario, 0);
        let lines = fleet.straight_lines();
        let trust_region = fleet.options.trust_region;
        let alone = Avoidance { avoids: &|_, _| false, obstacles: true };
        let program =
            |i| fleet.program(i, &lines, fleet.halfspaces(i, &lines, alone, trust_region[0]), trust_region, 0.0);
        (0..2).map(program).collect()
    }

    fn objectives(vehicles: &[Program], z: &[Vec<f64>]) -> f64 {
        vehicles.iter().zip(z).map(|(program, z)| program.objective(z)).sum()
    }

    #[test]
    fn without_pair_rows_the_optimum_is_that_of_the_single_programs() {
        let vehicles = programs();
        let alone = vehicles.iter().map(|program| InteriorPoint::new(Settings::default()).solve(program).objective);
        let alone: f64 = alone.sum();
        let coupled = CoupledProgram { vehicles, pairs: Vec::new(), shared_time: false };
        let solution = coupled.solve(1e-8);
        let together = objectives(&coupled.vehicles, &solution.z);
        assert!(solution.is_solved && (together - alone).abs() < 1e-5 * alone, "{together} against {alone}");
    }

    #[test]
    fn pair_rows_are_kept() {
        let vehicles = programs();
        let free = CoupledProgram { vehicles: vehicles.clone(), pairs: Vec::new(), shared_time: true }.solve(1e-8);
        let stage = 20;
        let apart = |z: &[Vec<f64>]| z[0][STAGE_LEN * stage + 1] - z[1][STAGE_LEN * stage + 1];
        // 300 m farther apart in y than without the row
        let pair = PairConstraint { vehicles: [0, 1], stage, normal: [0.0, 1.0], slack: -apart(&free.z) - 0.3 };
        let coupled = CoupledProgram { vehicles, pairs: vec![pair], shared_time: true };
        let held = coupled.solve(1e-8);
        assert!(held.is_solved && apart(&held.z) > apart(&free.z) + 0.3 - 1e-6);
        assert!(objectives(&coupled.vehicles, &held.z) > objectives(&coupled.vehicles, &free.z) - 1e-6);
        let [first, second] = [0, 1].map(|i| held.z[i][held.z[i].len() - 1]);
        assert_eq!(first, second);
    }
}
