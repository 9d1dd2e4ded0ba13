//! Four subproblems in one batch: each solution is bit-identical to that of the subproblem alone, on every processor.

use std::path::Path;
use std::sync::Mutex;

use planners::convex::{BatchSolver, InteriorPoint, Program, Settings, Solution, Status};
use planners::scp::parallel::plan_and_inspect;

fn subproblems() -> Vec<Program> {
    let path = Path::new(env!("CARGO_MANIFEST_DIR")).join("../scenarios/fixed-wing/rendezvous-7.toml");
    let scenario = scenarios::load(&path).expect("shipped scenario");
    let programs = Mutex::new(Vec::new());
    plan_and_inspect(&scenario, 0, &mut |_| {}, &|program, _| programs.lock().unwrap().push(program.clone()));
    let programs = programs.into_inner().unwrap();
    programs.into_iter().step_by(9).collect()
}

fn bits(solution: &Solution) -> (Status, usize, Vec<u64>) {
    (solution.status, solution.iterations, solution.z.iter().map(|value| value.to_bits()).collect())
}

#[test]
fn solutions_do_not_depend_on_the_batch() {
    let mut programs = subproblems();
    let alone: Vec<_> =
        programs.iter().map(|program| bits(&InteriorPoint::new(Settings::default()).solve(program))).collect();
    let solvers = BatchSolver::new(Settings::default());
    let together: Vec<_> = solvers.solve_all(&programs).iter().map(bits).collect();
    assert!(alone == together);
    // other batches, and solvers that have been used before
    programs.rotate_left(2);
    let mut rotated: Vec<_> = solvers.solve_all(&programs).iter().map(bits).collect();
    rotated.rotate_right(2);
    assert!(alone == rotated);
}

#[test]
fn a_refused_programme_does_not_touch_its_neighbours() {
    let programs = subproblems();
    let mut mutated = programs.clone();
    mutated[1].halfspaces[0].bound = f64::NAN;
    let solvers = BatchSolver::new(Settings::default());
    let (original, others) = (solvers.solve_all(&programs), solvers.solve_all(&mutated));
    assert_eq!(others[1].status, Status::Refused);
    for (i, (original, other)) in original.iter().zip(&others).enumerate() {
        assert!(i == 1 || bits(original) == bits(other), "{i}");
    }
}

#[test]
fn vector_instructions_change_no_bit() {
    for program in &subproblems()[..4] {
        let fast = InteriorPoint::new(Settings::default()).solve(program);
        let portable = InteriorPoint::portable(Settings::default()).solve(program);
        assert!(bits(&fast) == bits(&portable));
    }
}
