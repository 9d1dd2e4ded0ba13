//! What every planner guarantees on every scenario that it claims to handle, whether or not its plan passes.

use harness::verdict;
use scenarios::{Plan, PlanStatus, Scenario};

#[test]
fn plans_are_complete_and_their_status_is_honest() {
    for_every_claim(|scenario, plan| {
        let what = format!("{} on {}", plan.planner, scenario.name);
        assert_eq!(plan.scenario, scenario.name);
        if plan.status == PlanStatus::NoPlan {
            assert!(plan.trajectories.is_empty() && plan.reason.is_some(), "{what}");
            return;
        }
        // finite, one trajectory per vehicle, starts at the start, time increases
        assert_eq!(verdict::is_flyable(scenario, plan), Ok(()), "{what}");
        assert_eq!(plan.reason.is_none(), plan.status == PlanStatus::Solved, "{what}");
    });
}

#[test]
fn same_seed_gives_the_same_plan_on_any_number_of_threads() {
    let rectangle = super::shipped_in("scenarios/slung").into_iter().find(|(_, scenario)| scenario.name == "rectangle");
    let map = super::shipped_in("scenarios/multirotor").into_iter().find(|(_, scenario)| scenario.name == "paper-map");
    let others = [rectangle, map].map(|found| found.expect("a shipped scenario").1);
    let scenarios: Vec<Scenario> = [super::named("rendezvous-7")].into_iter().chain(others).collect();
    // In-loop planners are tested in `multirotor`.
    for entry in planners::registry().iter().filter(|entry| !entry.plans_in_the_loop()) {
        let claimed = scenarios.iter().find(|scenario| (entry.unsupported_reason)(scenario).is_none());
        let mut scenario = claimed.unwrap_or_else(|| panic!("{} handles none of them", entry.name)).clone();
        scenario.vehicles.truncate(largest_fleet(entry.name));
        let plan_on = |threads: usize| {
            let pool = rayon::ThreadPoolBuilder::new().num_threads(threads).build().expect("a thread pool");
            let mut plan = pool.install(|| entry.plan(&scenario, 3, &mut |_| {}));
            forget_wall_times(&mut plan);
            plan
        };
        let alone = plan_on(1);
        assert_eq!(alone, plan_on(1), "{} twice on one thread", entry.name);
        assert_eq!(alone, plan_on(2), "{} on two threads", entry.name);
    }
}

/// Every planner on every scenario that it does not refuse and that takes seconds at most: large fleets are planned by the
/// planner that they name, and judged, in `verdicts`.
fn for_every_claim(check: impl Fn(&Scenario, &Plan)) {
    for (_, scenario) in super::shipped_in("scenarios") {
        let willing = planners::registry().iter().filter(|entry| (entry.unsupported_reason)(&scenario).is_none());
        for entry in willing.filter(|entry| scenario.vehicles.len() <= largest_fleet(entry.name)) {
            let plan = match entry.plans_in_the_loop() {
                true => super::multirotor::followed(&scenario, entry),
                false => entry.plan(&scenario.planner_view(), 0, &mut |_| {}),
            };
            check(&scenario, &plan);
        }
    }
}

/// Largest fleet of this test.
fn largest_fleet(planner: &str) -> usize {
    match planner {
        "coupled-scp" | "decoupled-lgr" => 2,
        "serial-scp" => 3,
        _ => 15,
    }
}

fn forget_wall_times(plan: &mut Plan) {
    plan.timings = Default::default();
    for iteration in &mut plan.history {
        (iteration.wall_s, iteration.distributed_s) = (0.0, 0.0);
    }
}
