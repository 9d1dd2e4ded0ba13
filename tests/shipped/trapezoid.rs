//! A finding to preserve: with steps of 5 s, the paper's trapezoidal rule converges to a plan that is feasible at its nodes
//! but whose controls do not lead to its states.

use harness::verdict::{self, Outcome, Status};
use scenarios::{PlanStatus, Transcription};

#[test]
fn trapezoid_plan_is_solved_for_its_planner_and_fails_the_rollout() {
    let mut scenario = super::named("rendezvous-7");
    scenario.planner.transcription = Some(Transcription::Trapezoid);
    let plan = planners::find("parallel-scp").expect("the planner").plan(&scenario, 0, &mut |_| {});
    assert_eq!(plan.status, PlanStatus::Solved, "{:?}", plan.reason);
    let flight = sim::fly(&scenario, &plan, 0, &mut |_| {});
    let verdict = verdict::judge(&scenario, &plan, Some(&flight));

    let check = |name: &str| verdict.checks.iter().find(|check| check.name == name).expect("a check of that name");
    assert_eq!(check("nodes.separation").status, Status::Pass);
    assert_eq!(check("plan.rollout").status, Status::Fail);
    let rollout_m = check("plan.rollout").value.expect("a rollout has an end error");
    assert!(rollout_m > 10.0, "the rollout ends {rollout_m} m from the plan's end");
    assert!(check("flight.tracking_max").value.is_some(), "it was flown all the same");
    assert_eq!(verdict.outcome, Outcome::Fail);
    assert!(verdict.overclaimed);
}
