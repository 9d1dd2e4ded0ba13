//! All backends find the same direction.

use std::path::Path;
use std::sync::Mutex;

use super::{Backend, NewtonSystem};
use crate::convex::Program;
use crate::convex::point::Point;
use crate::scp::parallel::plan_and_inspect;

/// Relative gap down to which directions are compared.
const LEAST_GAP: f64 = 1e-4;

/// Largest relative difference, in z and in the multipliers.
const AGREEMENT: f64 = 1e-6;

/// A few subproblems of a real run, from the first iteration to the last.
fn subproblems(scenario: &str, intervals: usize) -> Vec<Program> {
    let path = Path::new(env!("CARGO_MANIFEST_DIR")).join("..").join(scenario);
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

/// Centred direction of `system` at `point`, towards a tenth of its mean product.
fn direction(system: &mut NewtonSystem, program: &Program, point: &Point) -> Point {
    let aim = 0.1 * point.complementarity() / point.len() as f64;
    let (mut step, mut correction) = (Point::zero(program), Point::zero(program));
    system.residuals(program, point);
    for (target, at) in system.target.pairs_mut().into_iter().zip(point.pairs()) {
        for (r, (s, v)) in target.slack.iter_mut().zip(at.slack.iter().zip(&at.dual)) {
            *r = aim - s * v;
        }
    }
    system.factor(program, point);
    system.direction(program, point, &mut step);
    system.refine(program, point, &mut step, &mut correction);
    step
}

/// Largest difference relative to the largest value.
fn difference<'a>(a: impl IntoIterator<Item = &'a f64>, b: impl IntoIterator<Item = &'a f64>) -> f64 {
    let (mut largest, mut value) = (0.0_f64, 0.0_f64);
    for (a, b) in a.into_iter().zip(b) {
        assert!(a.is_finite() && b.is_finite());
        (largest, value) = (largest.max((a - b).abs()), value.max(a.abs()));
    }
    largest / value
}

fn duals(step: &Point) -> impl Iterator<Item = &f64> {
    step.pairs().into_iter().flat_map(|pairs| &pairs.dual)
}

/// Follows the path of the block backend and compares the others' directions at each of its iterates.
fn assert_directions_agree(program: &Program, backends: &[Backend]) {
    let mut block = NewtonSystem::new(program, Backend::Block);
    let mut others: Vec<_> = backends.iter().map(|&backend| (backend, NewtonSystem::new(program, backend))).collect();
    let mut point = Point::zero(program);
    point.start(program, program.penalty);
    for _ in 0..60 {
        let gap = point.complementarity() / point.z[program.len() - 1].abs().max(1.0);
        if gap < LEAST_GAP {
            return;
        }
        let reference = direction(&mut block, program, &point);
        for (backend, other) in &mut others {
            let step = direction(other, program, &point);
            let (dz, dv) = (difference(&reference.z, &step.z), difference(duals(&reference), duals(&step)));
            assert!(dz < AGREEMENT && dv < AGREEMENT, "{backend:?} at a gap of {gap:.1e}: dz {dz:.1e}, duals {dv:.1e}");
        }
        let (α_p, α_d) = Point::step_lengths(&block.inverse, &reference, 0.99);
        point.advance(program, &reference, α_p, α_d);
    }
    panic!("the path did not come down to a gap of {LEAST_GAP}");
}

#[test]
fn dense_and_sparse_directions_are_those_of_the_block_sweep() {
    for (scenario, intervals) in [("scenarios/fixed-wing/rendezvous-7.toml", 4), ("tests/scenarios/pair.toml", 8)] {
        for program in subproblems(scenario, intervals) {
            assert_directions_agree(&program, &[Backend::SparseLdl, Backend::DenseReduced]);
        }
        let first = &subproblems(scenario, 4)[0];
        assert_directions_agree(first, &[Backend::DenseKkt]);
    }
}

#[test]
fn sparse_directions_are_those_of_the_block_sweep_at_full_size() {
    for program in subproblems("scenarios/fixed-wing/rendezvous-7.toml", 40) {
        assert_directions_agree(&program, &[Backend::SparseLdl]);
    }
}
