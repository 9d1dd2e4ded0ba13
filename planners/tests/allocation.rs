//! The iteration of the interior-point method works in memory that it has had before.

use std::path::Path;
use std::sync::Mutex;

use planners::convex::{InteriorPoint, Program, Settings, Status};
use planners::scp::parallel::plan_and_inspect;

/// Allocations of a second solve of the same programme that ends after `max_iterations`.
fn allocations(program: &Program, max_iterations: usize) -> u64 {
    let mut solver = InteriorPoint::new(Settings { max_iterations, ..Settings::default() });
    solver.solve(program);
    let counted = allocation_counter::measure(|| assert_eq!(solver.solve(program).status, Status::IterationLimit));
    counted.count_total
}

#[test]
fn iterations_allocate_nothing() {
    let path = Path::new(env!("CARGO_MANIFEST_DIR")).join("../scenarios/fixed-wing/rendezvous-1.toml");
    let mut scenario = scenarios::load(&path).expect("shipped scenario");
    scenario.planner.max_iterations = Some(1);
    let program = Mutex::new(None);
    plan_and_inspect(&scenario, 0, &mut |_| {}, &|first, _| *program.lock().unwrap() = Some(first.clone()));
    let program = program.into_inner().unwrap().expect("one subproblem");
    let few = allocations(&program, 1);
    assert!(few > 0, "nothing was counted");
    assert_eq!(few, allocations(&program, 6));
}
