//! The iterations of the interior-point methods do not allocate.

use std::path::Path;
use std::sync::Mutex;

use planners::convex::{InteriorPoint, Program, Settings, Status};
use planners::nlp;
use planners::pseudospectral::{Mesh, MultiphaseSystem, Transcription};
use planners::scp::parallel::plan_and_inspect;
use planners::slung;

/// Number of allocations in a second solve of the same program with `max_iterations`.
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

/// The nonlinear method on a multiphase problem: free durations, an impact, terminal constraints.
#[test]
fn iterations_of_the_nonlinear_method_allocate_nothing() {
    let path = Path::new(env!("CARGO_MANIFEST_DIR")).join("../scenarios/slung/gate.toml");
    let problem = slung::problem(&scenarios::load(&path).expect("shipped scenario"));
    let system = slung::SlungLoadSystem::new(&problem);
    let route = &slung::candidate_routes(&problem)[0];
    let guess = slung::Guess::new(&problem, route, system.coordinates());
    let phases: Vec<(usize, usize)> = problem.phases.iter().map(|_| (4, 3)).collect();
    let mut program = Transcription::new(&system, Mesh::uniform(&phases));
    let start = nlp::Start::Cold(program.variables_from(&|phase, share, node| guess.write(phase, share, node)));
    let mut count = |max_iterations: usize| {
        let settings = nlp::Settings { max_iterations, ..nlp::Settings::default() };
        let mut method = nlp::InteriorPoint::new(&program, settings);
        let mut solve = || assert_eq!(method.solve(&mut program, &start).status, nlp::Status::IterationLimit);
        solve();
        allocation_counter::measure(solve).count_total
    };
    let few = count(1);
    assert!(few > 0, "nothing was counted");
    assert_eq!(few, count(9));
}
