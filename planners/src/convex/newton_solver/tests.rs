//! All backends compute the same direction.

use std::sync::Mutex;

use faer::fx128;
use pulp::Scalar256b;

use super::{Backend, NewtonSolver};
use crate::convex::Program;
use crate::convex::batch::Batch;
use crate::convex::complementarity::ComplementarityPair;
use crate::convex::feasibility::restore_feasibility;
use crate::convex::iterate::Iterate;
use crate::convex::newton::NewtonSystem;
use crate::convex::program::{DYNAMICS_ROWS, STAGE_LEN};
use crate::scp::parallel::plan_and_inspect;
use crate::simd::{Lanes, WIDTH};

/// Relative gap down to which directions are compared.
const MIN_GAP: f64 = 1e-4;

/// Largest relative difference of directions that agree, in dz and in dy.
const AGREEMENT: f64 = 1e-6;

/// The same for the block factorisation against extended precision.
const EXACT_AGREEMENT: f64 = 1e-7;

/// Smallest fraction of directions that agree. Rows of weight 1e6 cost the reduced systems digits.
const MIN_AGREEING: f64 = 0.75;

/// A few subproblems of a planner run, from the first iteration to the last.
fn subproblems(scenario: &str, intervals: usize) -> Vec<Program> {
    let path = std::path::Path::new(env!("CARGO_MANIFEST_DIR")).join("..").join(scenario);
    let mut scenario = scenarios::load(&path).expect("shipped scenario");
    scenario.planner.intervals = Some(intervals);
    let programs = Mutex::new(Vec::new());
    let inspect = |program: &Program, _: &_| programs.lock().unwrap().push(program.clone());
    // on one thread, which fixes their order
    let pool = rayon::ThreadPoolBuilder::new().num_threads(1).build().expect("a thread pool");
    pool.install(|| plan_and_inspect(&scenario, 0, &mut |_| {}, &inspect));
    let programs = programs.into_inner().unwrap();
    let stride = programs.len().div_ceil(5);
    programs.into_iter().step_by(stride).collect()
}

/// An iterate of one program, in every lane, with the Newton system and one backend.
struct Path {
    batch: Batch<Scalar256b>,
    at: Iterate<Scalar256b>,
    newton: NewtonSystem<Scalar256b>,
    solver: NewtonSolver<Scalar256b>,
}

impl Path {
    fn new(program: &Program, backend: Backend) -> Self {
        let mut batch = Batch::new(Scalar256b);
        batch.set([program; WIDTH]);
        let mut newton = NewtonSystem::new(Scalar256b);
        newton.resize(&batch);
        let mut solver = NewtonSolver::new(Scalar256b, backend);
        solver.begin(&batch, program);
        let mut at = Iterate::new();
        at.start(&batch, 1.0);
        Self { batch, at, newton, solver }
    }

    /// Centred direction from `at`, to a tenth of the mean product.
    fn centred_direction(&mut self, at: &Iterate<Scalar256b>) -> [Vec<f64>; 2] {
        self.at = at.clone();
        let products = restore_feasibility(&self.batch, &mut self.at).products;
        self.newton.compute_weights(&self.batch, &mut self.at);
        self.solver.factor(&self.batch, &self.at, &self.newton.weights);
        self.solver.solve_first(&self.batch, &self.at, &mut self.newton);
        self.newton.set_centred_rhs(&self.batch, &mut self.at, (products * products.like(0.1)).over(self.batch.pairs));
        self.solver.solve(&self.batch, &self.at, &mut self.newton);
        let everywhere = products.is_above(products.like(0.0));
        // as often as the solver refines programs with rows of large weight
        for _ in 0..3 {
            self.solver.refine(&self.batch, &self.at, &mut self.newton, everywhere);
        }
        let step = &self.newton.step;
        [&step.z, &step.y].map(|column| column.iter().map(|value| value[0].lane(0)).collect())
    }
}

/// Largest difference relative to the largest value.
fn difference(a: &[f64], b: &[f64]) -> f64 {
    let (mut max, mut value) = (0.0_f64, 0.0_f64);
    for (a, b) in a.iter().zip(b) {
        assert!(a.is_finite() && b.is_finite());
        (max, value) = (max.max((a - b).abs()), value.max(a.abs()));
    }
    max / value
}

/// Iterates with the block backend to a gap of [`MIN_GAP`] and calls `compare` with its direction at each iterate.
fn follow(program: &Program, compare: &mut dyn FnMut(&Path, &[Vec<f64>; 2])) {
    let mut block = Path::new(program, Backend::Block);
    for _ in 0..60 {
        let measures = restore_feasibility(&block.batch, &mut block.at);
        if measures.products.lane(0) / measures.objective.lane(0).abs().max(1.0) < MIN_GAP {
            return;
        }
        let direction = block.centred_direction(&block.at.clone());
        compare(&block, &direction);
        let decrease = block.newton.max_decrease(&block.batch, &block.at);
        let (one, τ) = (decrease.primal.like(1.0), decrease.primal.like(0.99));
        let [α_p, α_d] = [decrease.primal, decrease.dual].map(|decrease| τ.over(decrease).min(one));
        block.newton.advance(&block.batch, &mut block.at, α_p, α_d);
    }
    panic!("no gap below {MIN_GAP}");
}

/// Largest relative differences in dz and dy.
fn differences(a: &[Vec<f64>; 2], b: &[Vec<f64>; 2]) -> f64 {
    difference(&a[0], &b[0]).max(difference(&a[1], &b[1]))
}

/// The direction at `at` in extended precision, by elimination in [H, E^T; E, -Ω].
fn exact_direction(program: &Program, at: &Iterate<Scalar256b>) -> [Vec<f64>; 2] {
    let number = |value: f64| fx128::from(value);
    let lane = |value: Lanes<Scalar256b>| number(value.lane(0));
    let weight = |b: &ComplementarityPair<_>| {
        lane(b.dual_upper) / lane(b.slack_upper) + lane(b.dual_lower) / lane(b.slack_lower)
    };
    let ρ = |b: &ComplementarityPair<_>| {
        let [r_c, r_d] = b.targets().map(lane);
        r_c / lane(b.slack_upper) - r_d / lane(b.slack_lower)
    };
    let (n_z, n_y) = (program.len(), DYNAMICS_ROWS * program.intervals());
    let mut matrix = vec![vec![number(0.0); n_z + n_y]; n_z + n_y];
    let mut rhs = vec![number(0.0); n_z + n_y];
    let mut add_row = |terms: &[(usize, f64)], pair: &ComplementarityPair<_>| {
        let weight = number(1.0) / weight(pair);
        for &(i, a) in terms {
            rhs[i] += number(a) * ρ(pair) * weight;
            for &(j, b) in terms {
                matrix[i][j] += number(a) * number(b) * weight;
            }
        }
    };
    for (i, variable) in at.variables.iter().enumerate() {
        add_row(&[(i, 1.0)], &variable.upper);
        add_row(&[(i, -1.0)], &variable.lower);
    }
    for (fixed, pair) in program.fixed_variables.iter().zip(&at.fixed_variables) {
        add_row(&[(fixed.index, 1.0)], pair);
    }
    for (halfspace, pair) in program.halfspaces.iter().zip(&at.halfspaces) {
        add_row(&halfspace.terms().collect::<Vec<_>>(), pair);
    }
    for (i, variable) in at.variables.iter().enumerate() {
        matrix[i][i] += weight(&variable.trust_region);
        rhs[i] -= ρ(&variable.trust_region);
    }
    for (row, pair) in at.dynamics.as_flattened().iter().enumerate() {
        let (k, i) = (row / DYNAMICS_ROWS, row % DYNAMICS_ROWS);
        let constraint = &program.dynamics[k];
        let left = (0..STAGE_LEN).map(|j| (STAGE_LEN * k + j, constraint.left[(i, j)]));
        let right = (0..STAGE_LEN).map(|j| (STAGE_LEN * (k + 1) + j, constraint.right[(i, j)]));
        for (column, value) in left.chain(right).chain([(n_z - 1, constraint.theta[i])]) {
            matrix[n_z + row][column] = number(value);
            matrix[column][n_z + row] = number(value);
        }
        matrix[n_z + row][n_z + row] = -weight(pair);
        rhs[n_z + row] = ρ(pair);
    }
    let values: Vec<f64> = solve(matrix, rhs).into_iter().map(|value| value.0).collect();
    [values[..n_z].to_vec(), values[n_z..].to_vec()]
}

/// Gaussian elimination with partial pivoting.
fn solve(mut matrix: Vec<Vec<fx128>>, mut rhs: Vec<fx128>) -> Vec<fx128> {
    let n = rhs.len();
    for column in 0..n {
        let size = |row: &usize| matrix[*row][column].0.abs();
        let pivot = (column..n).max_by(|a, b| size(a).total_cmp(&size(b))).expect("rows are left");
        matrix.swap(column, pivot);
        rhs.swap(column, pivot);
        for row in column + 1..n {
            let factor = matrix[row][column] / matrix[column][column];
            let above = matrix[column].clone();
            for (value, above) in matrix[row].iter_mut().zip(above).skip(column) {
                *value -= factor * above;
            }
            let above = rhs[column];
            rhs[row] -= factor * above;
        }
    }
    for row in (0..n).rev() {
        let known = (row + 1..n).fold(fx128::from(0.0), |sum, k| sum + matrix[row][k] * rhs[k]);
        rhs[row] = (rhs[row] - known) / matrix[row][row];
    }
    rhs
}

#[test]
fn block_directions_agree_with_extended_precision() {
    for (scenario, intervals) in [("scenarios/fixed-wing/rendezvous-7.toml", 4), ("tests/scenarios/pair.toml", 8)] {
        for program in subproblems(scenario, intervals) {
            follow(&program, &mut |block, direction| {
                let difference = differences(&exact_direction(&program, &block.at), direction);
                assert!(difference < EXACT_AGREEMENT, "{scenario}: {difference:.1e}");
            });
        }
    }
}

/// Fraction of the directions of `backend` that agree with those of the block factorisation.
fn agreement(programs: &[Program], backend: Backend) -> f64 {
    let (mut all, mut agreeing) = (0, 0);
    for program in programs {
        let mut other = Path::new(program, backend);
        follow(program, &mut |block, direction| {
            let difference = differences(&other.centred_direction(&block.at), direction);
            (all, agreeing) = (all + 1, agreeing + usize::from(difference < AGREEMENT));
        });
    }
    f64::from(agreeing as u32) / f64::from(all as u32)
}

/// Forming A^T (S^-1 Λ) A costs the reduced systems half of the digits: a few directions differ in load factors with
/// almost no effect on the objective, where those of the block factorisation stay accurate (see above).
#[test]
fn directions_of_the_reference_methods_agree_with_the_block_factorisation() {
    for (scenario, intervals) in [("scenarios/fixed-wing/rendezvous-7.toml", 4), ("tests/scenarios/pair.toml", 8)] {
        let programs = subproblems(scenario, intervals);
        for backend in [Backend::SparseLdl, Backend::DenseReduced] {
            let fraction = agreement(&programs, backend);
            assert!(fraction > MIN_AGREEING, "{scenario}, {backend:?}: {fraction}");
        }
        assert_eq!(agreement(&subproblems(scenario, 4)[..1], Backend::DenseKkt), 1.0, "{scenario}");
    }
    let fraction = agreement(&subproblems("scenarios/fixed-wing/rendezvous-7.toml", 40), Backend::SparseLdl);
    assert!(fraction > MIN_AGREEING, "at full size: {fraction}");
}
