//! Every subproblem that the shipped scenarios lead to, solved a second time by Clarabel: the objectives must agree.

use std::path::Path;
use std::sync::Mutex;

use planners::convex::{self, Program, Solution, Status};
use planners::scp::parallel::plan_and_inspect;

/// Largest difference of the objectives (step length plus penalties, s) relative to themselves.
const AGREEMENT: f64 = 1e-6;

#[test]
fn block_and_clarabel_agree_on_every_subproblem_of_the_shipped_scenarios() {
    let folder = Path::new(env!("CARGO_MANIFEST_DIR")).join("../scenarios/fixed-wing");
    let paths = scenarios::find(&[folder]).expect("shipped scenarios");
    assert!(paths.len() >= 14, "only {} scenarios found", paths.len());
    for path in paths {
        let scenario = scenarios::load(&path).expect("shipped scenario");
        if scenario.simulation.wind.is_some() {
            continue; // the planner does not see the wind: the same subproblems once more
        }
        let disagreements = Mutex::new(Vec::new());
        let compare = |program: &Program, block: &Solution| {
            let clarabel = convex::solve_with_clarabel(program, 1e-8);
            let difference = (block.objective - clarabel.objective).abs() / clarabel.objective.abs().max(1.0);
            let solved = block.status == Status::Solved;
            if !solved || difference.is_nan() || difference > AGREEMENT {
                let line = format!("{:?} {} against {}", block.status, block.objective, clarabel.objective);
                disagreements.lock().expect("no panic while it was held").push(line);
            }
        };
        let plan = plan_and_inspect(&scenario, 0, &mut |_| {}, &compare);
        assert!(plan.history.len() > 1);
        let disagreements = disagreements.into_inner().expect("no panic while it was held");
        assert!(disagreements.is_empty(), "{}: {disagreements:#?}", scenario.name);
    }
}
