//! The paper's ways to the Newton direction lead to the same optimum as ours, on subproblems of real runs.

use std::path::Path;
use std::sync::Mutex;

use planners::convex::{Backend, InteriorPoint, Program, Settings, Status};
use planners::scp::parallel::plan_and_inspect;

/// Largest relative difference of the objectives (relative to 1 s below 1 s): both are this near to the optimum.
const AGREEMENT: f64 = 1e-8;

/// Relative gap from which a solve counts as having reached the solution.
const NEAR: f64 = 1e-7;

/// Share of the subproblems on which a method of the paper may end short of that: they work with squares of the numbers
/// that the block sweep works with, and lose twice the digits.
const MOST_SHORT: f64 = 0.2;

/// Every subproblem of a run with `intervals`, in an order that does not depend on the threads.
fn subproblems(scenario: &str, intervals: usize) -> Vec<Program> {
    let path = Path::new(env!("CARGO_MANIFEST_DIR")).join("..").join(scenario);
    let mut scenario = scenarios::load(&path).expect("shipped scenario");
    scenario.planner.intervals = Some(intervals);
    let programs = Mutex::new(Vec::new());
    plan_and_inspect(&scenario, 0, &mut |_| {}, &|program, solution| {
        programs.lock().unwrap().push((solution.objective, program.clone()));
    });
    let mut programs = programs.into_inner().unwrap();
    programs.sort_by(|a, b| a.0.total_cmp(&b.0));
    programs.into_iter().map(|(_, program)| program).collect()
}

fn assert_same_optimum(programs: &[Program], backend: Backend) {
    assert!(programs.len() > 1);
    let mut short = 0;
    for (i, program) in programs.iter().enumerate() {
        let ours = InteriorPoint::new(Settings::default()).solve(program);
        let theirs = InteriorPoint::with_backend(Settings::default(), backend).solve(program);
        assert_eq!(ours.status, Status::Solved, "{i}: gap {:.1e}", ours.gap);
        if theirs.status == Status::Solved {
            let difference = (ours.objective - theirs.objective).abs() / ours.objective.abs().max(1.0);
            assert!(difference < AGREEMENT, "{backend:?} {i}: {} against {}", ours.objective, theirs.objective);
        }
        short += usize::from(theirs.gap.is_nan() || theirs.gap > NEAR);
    }
    assert!(short as f64 <= MOST_SHORT * programs.len() as f64, "{backend:?}: {short} of {}", programs.len());
}

#[test]
fn sparse_ldl_agrees_at_full_size() {
    let programs = subproblems("scenarios/fixed-wing/rendezvous-7.toml", 40);
    assert_same_optimum(&programs, Backend::SparseLdl);
}

#[test]
fn sparse_and_dense_reduced_agree_on_small_subproblems() {
    for (scenario, intervals) in [("scenarios/fixed-wing/rendezvous-3.toml", 12), ("tests/scenarios/pair.toml", 8)] {
        let programs = subproblems(scenario, intervals);
        assert_same_optimum(&programs, Backend::SparseLdl);
        let stride = programs.len().div_ceil(10);
        let some: Vec<Program> = programs.into_iter().step_by(stride).collect();
        assert_same_optimum(&some, Backend::DenseReduced);
    }
}

#[test]
fn the_whole_kkt_matrix_agrees_on_small_subproblems() {
    let programs = subproblems("tests/scenarios/pair.toml", 4);
    let stride = programs.len().div_ceil(4);
    let some: Vec<Program> = programs.into_iter().step_by(stride).collect();
    assert_same_optimum(&some, Backend::DenseKkt);
}

#[test]
fn one_solver_serves_programmes_one_after_the_other() {
    let programs = subproblems("tests/scenarios/pair.toml", 8);
    let mut solver = InteriorPoint::with_backend(Settings::default(), Backend::SparseLdl);
    let same_shape = programs.iter().filter(|program| program.halfspaces.len() == programs[0].halfspaces.len());
    for program in same_shape {
        let fresh = InteriorPoint::with_backend(Settings::default(), Backend::SparseLdl).solve(program);
        let reused = solver.solve(program);
        assert_eq!(fresh.objective.to_bits(), reused.objective.to_bits(), "the past leaves no trace");
    }
}
