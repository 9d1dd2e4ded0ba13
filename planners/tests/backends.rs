//! The paper's methods for the Newton direction lead to the same optimum as the block factorisation, on subproblems of
//! planner runs.

use std::path::Path;
use std::sync::Mutex;

use planners::convex::{Backend, InteriorPoint, Program, Settings, Start, Status};
use planners::scp::parallel::plan_and_inspect;

/// Largest relative difference of the objectives (relative to 1 s below 1 s): both are this close to the optimum.
const AGREEMENT: f64 = 1e-8;

/// Largest relative gap of a solve that has reached the solution.
const MAX_GAP: f64 = 1e-7;

/// Largest fraction of the subproblems on which a method of the paper may end short of that: the reduced matrices hold
/// the squares of the numbers in the square-root factorisation, and lose twice the digits.
const MAX_SHORT_FRACTION: f64 = 0.2;

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
        let block = InteriorPoint::new(Settings::default()).solve(program);
        let reference = InteriorPoint::with_backend(Settings::default(), backend).solve(program);
        assert_eq!(block.status, Status::Solved, "{i}: gap {:.1e}", block.gap);
        if reference.status == Status::Solved {
            let difference = (block.objective - reference.objective).abs() / block.objective.abs().max(1.0);
            assert!(difference < AGREEMENT, "{backend:?} {i}: {} against {}", block.objective, reference.objective);
        }
        short += usize::from(reference.gap.is_nan() || reference.gap > MAX_GAP);
    }
    assert!(short as f64 <= MAX_SHORT_FRACTION * programs.len() as f64, "{backend:?}: {short} of {}", programs.len());
}

/// The paper's loop: with rows of large weight it may not get far, and it is as close to the optimum as it says.
#[test]
fn infeasible_start_leads_to_the_optimum_or_says_how_far_it_is() {
    let mut close = 0;
    for program in subproblems("scenarios/fixed-wing/rendezvous-3.toml", 12).iter().step_by(4) {
        let block = InteriorPoint::new(Settings::default()).solve(program);
        let settings = Settings { start: Start::Infeasible, ..Settings::default() };
        let paper = InteriorPoint::with_backend(settings, Backend::SparseLdl).solve(program);
        let difference = (block.objective - paper.objective).abs() / block.objective.abs().max(1.0);
        let claimed = 10.0 * paper.gap.max(1e-6);
        assert!(difference < claimed, "{} against {} at {:.1e}", block.objective, paper.objective, paper.gap);
        close += usize::from(paper.gap < 1e-6);
    }
    assert!(close > 0, "no subproblem was solved");
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
fn dense_kkt_agrees_on_small_subproblems() {
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
        assert_eq!(fresh.objective.to_bits(), reused.objective.to_bits(), "a solve depends on earlier ones");
    }
}
