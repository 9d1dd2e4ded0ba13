//! All backends find the same direction.

use std::sync::Mutex;

use faer::fx128;
use pulp::Scalar256b;

use super::{Backend, NewtonSystem};
use crate::convex::Program;
use crate::convex::batch::Batch;
use crate::convex::boxed::Boxed;
use crate::convex::iterate::Iterate;
use crate::convex::lanes::{Lanes, WIDTH};
use crate::convex::newton::Newton;
use crate::convex::program::{LINK, STAGE};
use crate::convex::ties::tie;
use crate::scp::parallel::plan_and_inspect;

/// Relative gap down to which directions are compared.
const LEAST_GAP: f64 = 1e-4;

/// Largest relative difference of directions that agree, in dz and in dy.
const AGREEMENT: f64 = 1e-6;

/// The same for directions that are exact.
const EXACT: f64 = 1e-7;

/// Share of the directions that agree, at least.
const MOST: f64 = 0.9;

/// A few subproblems of a real run, from the first iteration to the last.
fn subproblems(scenario: &str, intervals: usize) -> Vec<Program> {
    let path = std::path::Path::new(env!("CARGO_MANIFEST_DIR")).join("..").join(scenario);
    let mut scenario = scenarios::load(&path).expect("shipped scenario");
    scenario.planner.intervals = Some(intervals);
    let programs = Mutex::new(Vec::new());
    let inspect = |program: &Program, _: &_| programs.lock().unwrap().push(program.clone());
    // on one thread, so that they come in the same order every time
    let alone = rayon::ThreadPoolBuilder::new().num_threads(1).build().expect("a thread pool");
    alone.install(|| plan_and_inspect(&scenario, 0, &mut |_| {}, &inspect));
    let programs = programs.into_inner().unwrap();
    let stride = programs.len().div_ceil(5);
    programs.into_iter().step_by(stride).collect()
}

/// An iterate of one programme, in every lane, with the Newton system of one backend.
struct Path {
    batch: Batch<Scalar256b>,
    at: Iterate<Scalar256b>,
    newton: Newton<Scalar256b>,
    system: NewtonSystem<Scalar256b>,
}

impl Path {
    fn new(program: &Program, backend: Backend) -> Self {
        let mut batch = Batch::new(Scalar256b);
        batch.set([program; WIDTH]);
        let mut newton = Newton::new(Scalar256b);
        newton.fit(&batch);
        let mut system = NewtonSystem::new(Scalar256b, backend);
        system.begin(&batch, program);
        let mut at = Iterate::new();
        at.start(&batch, 1.0);
        Self { batch, at, newton, system }
    }

    /// Direction to a tenth of the mean product, from `at`.
    fn centred_direction(&mut self, at: &Iterate<Scalar256b>) -> [Vec<f64>; 2] {
        self.at = at.clone();
        let products = tie(&self.batch, &mut self.at).products;
        self.newton.weigh(&self.batch, &mut self.at);
        self.system.factor(&self.batch, &self.at, &self.newton.weights);
        self.system.solve_first(&self.batch, &self.at, &mut self.newton);
        self.newton.centre(&self.batch, &mut self.at, (products * products.like(0.1)).over(self.batch.pairs));
        self.system.solve(&self.batch, &self.at, &mut self.newton);
        let everywhere = products.is_above(products.like(0.0));
        self.system.refine(&self.batch, &self.at, &mut self.newton, everywhere);
        let step = &self.newton.step;
        [&step.z, &step.y].map(|column| column.iter().map(|value| value[0].lane(0)).collect())
    }
}

/// Largest difference relative to the largest value.
fn difference(a: &[f64], b: &[f64]) -> f64 {
    let (mut largest, mut value) = (0.0_f64, 0.0_f64);
    for (a, b) in a.iter().zip(b) {
        assert!(a.is_finite() && b.is_finite());
        (largest, value) = (largest.max((a - b).abs()), value.max(a.abs()));
    }
    largest / value
}

/// Follows the path of the block backend to a gap of [`LEAST_GAP`] and calls `compare` with its direction at each iterate.
fn follow(program: &Program, compare: &mut dyn FnMut(&Path, &[Vec<f64>; 2])) {
    let mut block = Path::new(program, Backend::Block);
    for _ in 0..60 {
        let measures = tie(&block.batch, &mut block.at);
        if measures.products.lane(0) / measures.objective.lane(0).abs().max(1.0) < LEAST_GAP {
            return;
        }
        let direction = block.centred_direction(&block.at.clone());
        compare(&block, &direction);
        let losses = block.newton.losses(&block.batch, &block.at);
        let (one, share) = (losses.primal.like(1.0), losses.primal.like(0.99));
        let [α_p, α_d] = [losses.primal, losses.dual].map(|loss| share.over(loss).min(one));
        block.newton.advance(&block.batch, &mut block.at, α_p, α_d);
    }
    panic!("the path did not come down to a gap of {LEAST_GAP}");
}

/// Largest relative differences in dz and dy.
fn differences(a: &[Vec<f64>; 2], b: &[Vec<f64>; 2]) -> f64 {
    difference(&a[0], &b[0]).max(difference(&a[1], &b[1]))
}

/// The direction at `at` in twice the digits, by elimination in the whole of [H, E^T; E, -Ω].
fn exact_direction(program: &Program, at: &Iterate<Scalar256b>) -> [Vec<f64>; 2] {
    let number = |value: f64| fx128::from(value);
    let lane = |value: Lanes<Scalar256b>| number(value.lane(0));
    let weight = |b: &Boxed<_>| lane(b.force_above) / lane(b.above) + lane(b.force_below) / lane(b.below);
    let ρ = |b: &Boxed<_>| {
        let [r_c, r_d] = b.targets().map(lane);
        r_c / lane(b.above) - r_d / lane(b.below)
    };
    let (n_z, n_y) = (program.len(), LINK * program.intervals());
    let mut matrix = vec![vec![number(0.0); n_z + n_y]; n_z + n_y];
    let mut rhs = vec![number(0.0); n_z + n_y];
    let mut add_row = |terms: &[(usize, f64)], boxed: &Boxed<_>| {
        let weight = number(1.0) / weight(boxed);
        for &(i, a) in terms {
            rhs[i] += number(a) * ρ(boxed) * weight;
            for &(j, b) in terms {
                matrix[i][j] += number(a) * number(b) * weight;
            }
        }
    };
    for (i, variable) in at.variables.iter().enumerate() {
        add_row(&[(i, 1.0)], &variable.upper);
        add_row(&[(i, -1.0)], &variable.lower);
    }
    for (pin, boxed) in program.pins.iter().zip(&at.pins) {
        add_row(&[(pin.index, 1.0)], boxed);
    }
    for (plane, boxed) in program.planes.iter().zip(&at.planes) {
        add_row(&plane.terms().collect::<Vec<_>>(), boxed);
    }
    for (i, variable) in at.variables.iter().enumerate() {
        matrix[i][i] += weight(&variable.trust);
        rhs[i] -= ρ(&variable.trust);
    }
    for (row, boxed) in at.links.as_flattened().iter().enumerate() {
        let (k, i) = (row / LINK, row % LINK);
        let link = &program.links[k];
        let left = (0..STAGE).map(|j| (STAGE * k + j, link.left[(i, j)]));
        let right = (0..STAGE).map(|j| (STAGE * (k + 1) + j, link.right[(i, j)]));
        for (column, value) in left.chain(right).chain([(n_z - 1, link.theta[i])]) {
            matrix[n_z + row][column] = number(value);
            matrix[column][n_z + row] = number(value);
        }
        matrix[n_z + row][n_z + row] = -weight(boxed);
        rhs[n_z + row] = ρ(boxed);
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
fn block_directions_are_those_of_twice_the_digits() {
    for (scenario, intervals) in [("scenarios/fixed-wing/rendezvous-7.toml", 4), ("tests/scenarios/pair.toml", 8)] {
        for program in subproblems(scenario, intervals) {
            follow(&program, &mut |block, direction| {
                let difference = differences(&exact_direction(&program, &block.at), direction);
                assert!(difference < EXACT, "{scenario}: {difference:.1e}");
            });
        }
    }
}

/// Share of the directions of `backend` that agree with the block's.
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

/// Forming A^T (S^-1 Λ) A costs the reduced systems half of their digits: a few directions differ in load factors that
/// hardly matter, while the block's stay exact (see above).
#[test]
fn the_papers_directions_are_those_of_the_block_sweep() {
    for (scenario, intervals) in [("scenarios/fixed-wing/rendezvous-7.toml", 4), ("tests/scenarios/pair.toml", 8)] {
        let programs = subproblems(scenario, intervals);
        for backend in [Backend::SparseLdl, Backend::DenseReduced] {
            let share = agreement(&programs, backend);
            assert!(share > MOST, "{scenario}, {backend:?}: {share}");
        }
        assert_eq!(agreement(&subproblems(scenario, 4)[..1], Backend::DenseKkt), 1.0, "{scenario}");
    }
    let share = agreement(&subproblems("scenarios/fixed-wing/rendezvous-7.toml", 40), Backend::SparseLdl);
    assert!(share > MOST, "at full size: {share}");
}
