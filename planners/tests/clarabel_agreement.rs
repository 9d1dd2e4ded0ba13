//! Every subproblem that the shipped scenarios lead to, solved a second time by Clarabel: the objectives must agree.

use std::path::Path;
use std::sync::Mutex;
use std::sync::atomic::{AtomicUsize, Ordering};

use planners::convex::{self, Program, Solution, Status};
use planners::scp::parallel::plan_and_inspect;

/// Largest difference of the objectives (step length plus penalties, s) relative to themselves.
const AGREEMENT: f64 = 1e-6;

/// Largest share of subproblems on which Clarabel may stall.
const MOST_STALLS: f64 = 0.02;

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
        let (disagreements, stalls) = (Mutex::new(Vec::new()), AtomicUsize::new(0));
        let compare = |program: &Program, block: &Solution| {
            let clarabel = convex::solve_with_clarabel(program, 1e-8);
            // where Clarabel stalls, its value proves nothing, but its variables are still a candidate to beat
            let stalled = clarabel.status != Status::Solved;
            stalls.fetch_add(usize::from(stalled), Ordering::Relaxed);
            let rival = if stalled { program.objective(&clarabel.z) } else { clarabel.objective };
            let difference = (block.objective - rival) / rival.abs().max(1.0);
            let agrees = difference <= AGREEMENT && (stalled || difference >= -AGREEMENT);
            if block.status != Status::Solved || !agrees {
                let line = format!("{:?} {} against {:?} {rival}", block.status, block.objective, clarabel.status);
                disagreements.lock().expect("no panic while it was held").push(line);
            }
        };
        let plan = plan_and_inspect(&scenario, 0, &mut |_| {}, &compare);
        assert!(plan.history.len() > 1);
        let disagreements = disagreements.into_inner().expect("no panic while it was held");
        assert!(disagreements.is_empty(), "{}: {disagreements:#?}", scenario.name);
        let subproblems = plan.history.len() * scenario.vehicles.len();
        let stalls = stalls.into_inner();
        assert!(stalls as f64 <= MOST_STALLS * subproblems as f64, "Clarabel stalled on {stalls} of {subproblems}");
    }
}
