//! Every shipped scenario passes with the planner that it names.

use harness::verdict::{self, Outcome, Status};

#[test]
fn every_shipped_scenario_passes() {
    let shipped = super::shipped();
    assert!(shipped.len() >= 24);
    for (_, scenario) in shipped {
        let entry = planners::find(&scenario.planner.name).expect("a planner that exists");
        let seed = scenario.simulation.seed;
        let plan = entry.plan(&scenario, seed, &mut |_| {});
        let flight = sim::fly(&scenario, &plan, seed, &mut |_| {});
        let verdict = verdict::judge(&scenario, &plan, Some(&flight));
        let failed: Vec<_> = verdict.checks.iter().filter(|check| check.status != Status::Pass).collect();
        assert_eq!(verdict.outcome, Outcome::Pass, "{}: {failed:#?}", scenario.name);
        assert!(!verdict.overclaimed);
    }
}
