//! Violations between the nodes, and how the fleet planner avoids them.

use harness::verdict::{self, Outcome, Status, Verdict};
use scenarios::{Plan, PlanStatus, Scenario};

/// In the exchange vehicles close at 75 m/s, and the nodes are 4 s apart.
#[test]
fn the_paper_s_plan_holds_at_its_nodes_and_collides_between_them() {
    let scenario = super::named("exchange-10");
    let (plan, verdict) = planned_by("dpd-scp", &scenario);
    assert_eq!(plan.status, PlanStatus::Solved, "{:?}", plan.reason);
    assert_eq!(check(&verdict, "nodes.separation").status, Status::Pass);
    assert_eq!(check(&verdict, "plan.separation").status, Status::Fail);
    assert!(check(&verdict, "plan.separation").margin.expect("a distance") < -4.0);
    assert!(verdict.overclaimed);
}

#[test]
fn the_fleet_planner_keeps_the_separation_at_little_cost_in_time() {
    for name in ["exchange-10", "exchange-25"] {
        let scenario = super::named(name);
        let (plan, verdict) = planned_by("fleet-scp", &scenario);
        assert_eq!((plan.status, &plan.reason), (PlanStatus::Solved, &None), "{name}");
        assert!(check(&verdict, "plan.separation").value.expect("a distance") >= 10.0, "{name}");
        assert_eq!(check(&verdict, "plan.rollout").status, Status::Pass, "{name}");
        // 6 km at 40 m/s take 150 s
        let flight_time_s = plan.flight_time_s().expect("a plan");
        assert!((150.0..151.5).contains(&flight_time_s), "{name}: {flight_time_s} s");
    }
}

#[test]
fn an_infeasible_scenario_gets_no_plan_and_the_reason() {
    let mut scenario = super::named("exchange-10");
    // head-on, a second and a half before they meet
    scenario.vehicles.truncate(2);
    let [x_m, y_m] = [scenario.vehicles[0].start.x_m, scenario.vehicles[0].start.y_m];
    let heading_deg = scenario.vehicles[0].start.heading_deg;
    let start = &mut scenario.vehicles[1].start;
    (start.x_m, start.y_m, start.heading_deg) = (0.965 * x_m, 0.965 * y_m, heading_deg + 180.0);
    scenario.planner.max_iterations = Some(20);
    let plan = planners::find("fleet-scp").expect("the planner").plan(&scenario, 0, &mut |_| {});
    assert_eq!(plan.status, PlanStatus::NoPlan);
    assert!(plan.trajectories.is_empty() && plan.history.len() == 20);
    let reason = plan.reason.clone().expect("a reason");
    for part in ["separation", "uav-1", "uav-2", " m at "] {
        assert!(reason.contains(part), "`{part}` is not in: {reason}");
    }
    assert_eq!(verdict::judge(&scenario, &plan, None).outcome, Outcome::NoPlan);
}

fn planned_by(planner: &str, scenario: &Scenario) -> (Plan, Verdict) {
    let plan = planners::find(planner).expect("the planner").plan(scenario, 0, &mut |_| {});
    let verdict = verdict::judge(scenario, &plan, None);
    (plan, verdict)
}

fn check<'a>(verdict: &'a Verdict, name: &str) -> &'a verdict::Check {
    verdict.checks.iter().find(|check| check.name == name).expect("a check of that name")
}
