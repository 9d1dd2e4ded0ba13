//! Where did the margin go? A budget from what the planner saw at its nodes to what was flown, one step at a time.
//!
//! Every step is a verdict of its own, of the plan or of a flight with one disturbance more than the last; its term is the
//! difference to the step before. So the terms add up to the whole way from first to last, and none is an estimate.

use scenarios::{Mismatch, Plan, Scenario, Sensors};
use schemars::JsonSchema;
use serde::{Deserialize, Serialize};

use crate::plan_source::PlanSource;
use crate::verdict::{self, Provenance, Verdict};

/// The budget of one question.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize, JsonSchema)]
pub struct MarginBudget {
    /// Name of the checks without their group: `separation`, `clearance`.
    pub question: String,
    /// Unit of the margins.
    pub unit: String,
    /// From the nodes to the flight.
    #[serde(rename = "rungs")]
    pub steps: Vec<MarginStep>,
}

/// One step of a budget.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize, JsonSchema)]
pub struct MarginStep {
    /// What is new on it.
    pub name: String,
    /// The margin that is left.
    pub margin: f64,
    /// What this step cost: its margin less the one before; 0 on the first.
    pub change: f64,
}

/// Questions with a budget.
const BUDGETED_CHECKS: [&str; 2] = ["separation", "clearance"];

/// The budgets of a plan that was flown. A question that some step cannot answer has none.
///
/// - `seed`: of the flight that was judged
/// - `flown`: its verdict
pub fn of(scenario: &Scenario, plan: &Plan, provenance: &Provenance, seed: u64, flown: &Verdict) -> Vec<MarginBudget> {
    if verdict::is_flyable(scenario, plan).is_err() {
        return Vec::new();
    }
    let fly = |(name, scenario): (&'static str, Scenario)| {
        let flight = sim::fly(&scenario, plan, seed, &mut |_| {});
        (name, verdict::judge_imported(&scenario, plan, provenance, Some(&flight)))
    };
    let flights: Vec<(&str, Verdict)> = disturbances_added(scenario).into_iter().map(fly).collect();
    let from = [("nodes", "nodes", flown), ("between the nodes", "plan", flown)];
    BUDGETED_CHECKS.into_iter().filter_map(|question| budget(question, &from, &flights, flown)).collect()
}

/// The budgets of a flight that was planned while it lasted. On every step it is planned anew; the first one is what was
/// followed in the mildest flight, as if it had been a plan before.
///
/// Empty for one who plans ahead.
pub fn in_the_loop(scenario: &Scenario, plan_source: &PlanSource, seed: u64, flown: &Verdict) -> Vec<MarginBudget> {
    let mut followed = None;
    let mut flights: Vec<(&str, Verdict)> = Vec::new();
    for (name, scenario) in disturbances_added(scenario) {
        let Some((plan, flight)) = plan_source.fly_in_loop(&scenario, seed) else { return Vec::new() };
        followed.get_or_insert_with(|| verdict::judge(&scenario, &plan, None));
        flights.push((name, verdict::judge(&scenario, &plan, Some(&flight))));
    }
    let Some(followed) = &followed else { return Vec::new() };
    let from = [("followed", "plan", followed)];
    BUDGETED_CHECKS.into_iter().filter_map(|question| budget(question, &from, &flights, flown)).collect()
}

/// The scenario with one disturbance after the other put back, the last one aside: that is the scenario itself. What it does
/// not have makes no step.
fn disturbances_added(scenario: &Scenario) -> Vec<(&'static str, Scenario)> {
    let mut calm = scenario.clone();
    calm.simulation.wind = None;
    calm.simulation.sensors = Sensors::default();
    calm.simulation.mismatch = Mismatch::default();
    let mut steps = vec![("tracking", calm.clone())];
    if calm.simulation.mismatch != scenario.simulation.mismatch {
        calm.simulation.mismatch = scenario.simulation.mismatch.clone();
        steps.push(("model", calm.clone()));
    }
    if calm.simulation.wind != scenario.simulation.wind {
        calm.simulation.wind = scenario.simulation.wind.clone();
        steps.push(("wind", calm.clone()));
    }
    if calm.simulation.sensors.delay_s != scenario.simulation.sensors.delay_s {
        calm.simulation.sensors.delay_s = scenario.simulation.sensors.delay_s;
        steps.push(("delay", calm.clone()));
    }
    if calm.simulation.sensors != scenario.simulation.sensors {
        steps.push(("noise", scenario.clone()));
    }
    steps
}

/// - `from`: the first steps: their names, the groups of checks that answer them, and whose
/// - `flights`: the steps above, from mild to wild
fn budget(
    question: &str,
    from: &[(&str, &str, &Verdict)],
    flights: &[(&str, Verdict)],
    flown: &Verdict,
) -> Option<MarginBudget> {
    let check = |verdict: &Verdict, group: &str| {
        let name = format!("{group}.{question}");
        verdict
            .checks
            .iter()
            .find(|check| check.name == name)
            .and_then(|check| Some((check.margin?, check.unit.clone())))
    };
    let unit = check(flown, "flight")?.1;
    let planned = from.iter().map(|(name, group, verdict)| Some((*name, check(verdict, group)?.0)));
    let flights = flights.iter().map(|(name, verdict)| Some((*name, check(verdict, "flight")?.0)));
    let mut margins: Vec<(&str, f64)> = planned.chain(flights).collect::<Option<_>>()?;
    // The last step is the flight itself, not one that should be the same.
    margins.last_mut()?.1 = check(flown, "flight")?.0;
    let mut before = margins.first()?.1;
    let steps = margins.into_iter().map(|(name, margin)| {
        let change = margin - before;
        before = margin;
        MarginStep { name: name.to_owned(), margin, change }
    });
    Some(MarginBudget { question: question.to_owned(), unit, steps: steps.collect() })
}

#[cfg(test)]
mod tests {
    use super::{BUDGETED_CHECKS, in_the_loop, of};
    use crate::plan_source::PlanSource;
    use crate::verdict::{Provenance, judge};

    #[test]
    fn a_flight_that_is_planned_while_it_lasts_has_a_ladder_too() {
        let text = include_str!("../../scenarios/multirotor/paper-map-gusts.toml");
        let scenario = scenarios::parse("paper-map-gusts.toml", text).unwrap();
        let plan_source = PlanSource::Registered(planners::find(&scenario.planner.name).unwrap());
        let (plan, flight) = plan_source.fly_in_loop(&scenario, 1).unwrap();
        let verdict = judge(&scenario, &plan, Some(&flight));
        let budgets = in_the_loop(&scenario, &plan_source, 1, &verdict);
        let [budget] = budgets.as_slice() else { panic!("one vehicle has no separation: {budgets:?}") };
        let names: Vec<&str> = budget.steps.iter().map(|step| step.name.as_str()).collect();
        assert_eq!(names, ["followed", "tracking", "model", "wind", "noise"]);
        let flown = verdict.checks.iter().find(|check| check.name == "flight.clearance").unwrap();
        assert_eq!(Some(budget.steps[4].margin), flown.margin);
        let sum: f64 = budget.steps.iter().map(|step| step.change).sum();
        assert!((budget.steps[0].margin + sum - budget.steps[4].margin).abs() < 1e-12, "{budget:?}");
    }

    #[test]
    fn the_terms_add_up_and_the_ends_are_those_of_the_verdict() {
        let text = include_str!("../../scenarios/fixed-wing/rendezvous-7-wind.toml");
        let scenario = scenarios::parse("rendezvous-7-wind.toml", text).unwrap();
        let planner = planners::find(&scenario.planner.name).unwrap();
        let plan = planner.plan(&scenario, 1, &mut |_| {});
        let flight = sim::fly(&scenario, &plan, 1, &mut |_| {});
        let verdict = judge(&scenario, &plan, Some(&flight));
        let budgets = of(&scenario, &plan, &Provenance::whole(), 1, &verdict);
        assert_eq!(budgets.iter().map(|it| it.question.as_str()).collect::<Vec<_>>(), BUDGETED_CHECKS);
        for budget in &budgets {
            let names: Vec<&str> = budget.steps.iter().map(|step| step.name.as_str()).collect();
            assert_eq!(names, ["nodes", "between the nodes", "tracking", "model", "wind", "noise"]);
            let margin = |group: &str| {
                let name = format!("{group}.{}", budget.question);
                verdict.checks.iter().find(|check| check.name == name).unwrap().margin.unwrap()
            };
            let (first, last) = (&budget.steps[0], &budget.steps[5]);
            assert_eq!((first.margin, last.margin), (margin("nodes"), margin("flight")));
            let sum: f64 = budget.steps.iter().map(|step| step.change).sum();
            assert!((first.margin + sum - last.margin).abs() < 1e-12, "{budget:?}");
            assert!(budget.steps[2..].iter().any(|step| step.change != 0.0));
        }
    }
}
