//! Margin budgets: what each disturbance costs, from the margin at the planner's nodes to the margin of the flight.
//!
//! Every step is a verdict of its own, on the plan or on a flight with one more disturbance than the step before. Its
//! change is the difference of their margins, so that the changes add up exactly.

use scenarios::{Mismatch, Scenario, Sensors};
use schemars::JsonSchema;
use serde::{Deserialize, Serialize};

use crate::plan_source::PlanSource;
use crate::verdict::{self, Verdict};

/// The margin budget of one kind of check.
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

/// One step of a margin budget.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize, JsonSchema)]
pub struct MarginStep {
    /// What this step adds.
    pub name: String,
    /// The remaining margin.
    pub margin: f64,
    /// This margin less that of the step before; 0 on the first step.
    pub change: f64,
}

/// Checks with a budget, by their names without the group.
const BUDGETED_CHECKS: [&str; 2] = ["separation", "clearance"];

/// The margin budgets of a flight. A check that some step does not measure has none.
///
/// - `source`: the plan that was flown, or the in-loop planner, which plans anew on every step
/// - `seed`: of the flight that was judged
/// - `flown`: the verdict on that flight
pub fn budgets(scenario: &Scenario, source: &PlanSource, seed: u64, flown: &Verdict) -> Vec<MarginBudget> {
    let mut followed = None;
    let mut flights: Vec<(&str, Verdict)> = Vec::new();
    for (name, scenario) in disturbances_added(scenario) {
        let trial = source.fly(&scenario, seed);
        if source.plans_in_the_loop() {
            followed.get_or_insert_with(|| verdict::judge(&scenario, &trial.answer.plan, None));
        }
        flights.push((name, trial.judge(&scenario)));
    }
    // An in-loop planner has no nodes of its own: its budget begins with what was followed without disturbances.
    let planned = match &followed {
        Some(followed) => vec![("followed", "plan", followed)],
        None => vec![("nodes", "nodes", flown), ("between the nodes", "plan", flown)],
    };
    BUDGETED_CHECKS.into_iter().filter_map(|check| budget(check, &planned, &flights, flown)).collect()
}

/// The scenario without disturbances, then with one more of them on every step up to the scenario itself. A disturbance
/// that the scenario does not have makes no step.
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

/// - `planned`: the first steps: their names, their groups of checks and their verdicts
/// - `flights`: the steps after them
/// - `flown`: the verdict on the flight itself, which is the last step
fn budget(
    question: &str,
    planned: &[(&str, &str, &Verdict)],
    flights: &[(&str, Verdict)],
    flown: &Verdict,
) -> Option<MarginBudget> {
    let check = |verdict: &Verdict, group: &str| {
        let check = verdict.check(&format!("{group}.{question}"))?;
        Some((check.margin?, check.unit.clone()))
    };
    let unit = check(flown, "flight")?.1;
    let planned = planned.iter().map(|(name, group, verdict)| Some((*name, check(verdict, group)?.0)));
    let flights = flights.iter().map(|(name, verdict)| Some((*name, check(verdict, "flight")?.0)));
    let mut margins: Vec<(&str, f64)> = planned.chain(flights).collect::<Option<_>>()?;
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
    use super::{BUDGETED_CHECKS, budgets};
    use crate::plan_source::PlanSource;

    #[test]
    fn an_in_loop_flight_has_a_budget_from_the_followed_reference_on() {
        let text = include_str!("../../scenarios/multirotor/paper-map-gusts.toml");
        let scenario = scenarios::parse("paper-map-gusts.toml", text).unwrap();
        let source = PlanSource::Registered(planners::find(&scenario.planner.name).unwrap());
        let verdict = source.fly(&scenario, 1).judge(&scenario);
        let budgets = budgets(&scenario, &source, 1, &verdict);
        let [budget] = budgets.as_slice() else { panic!("one vehicle has no separation: {budgets:?}") };
        let names: Vec<&str> = budget.steps.iter().map(|step| step.name.as_str()).collect();
        assert_eq!(names, ["followed", "tracking", "model", "wind", "noise"]);
        assert_eq!(Some(budget.steps[4].margin), verdict.check("flight.clearance").unwrap().margin);
        let sum: f64 = budget.steps.iter().map(|step| step.change).sum();
        assert!((budget.steps[0].margin + sum - budget.steps[4].margin).abs() < 1e-12, "{budget:?}");
    }

    #[test]
    fn changes_add_up_and_both_ends_are_those_of_the_verdict() {
        let text = include_str!("../../scenarios/fixed-wing/rendezvous-7-wind.toml");
        let scenario = scenarios::parse("rendezvous-7-wind.toml", text).unwrap();
        let flown = PlanSource::Registered(planners::find(&scenario.planner.name).unwrap()).fly(&scenario, 1);
        let verdict = flown.judge(&scenario);
        let budgets = budgets(&scenario, &PlanSource::Imported(Box::new(flown.answer)), 1, &verdict);
        assert_eq!(budgets.iter().map(|it| it.question.as_str()).collect::<Vec<_>>(), BUDGETED_CHECKS);
        for budget in &budgets {
            let names: Vec<&str> = budget.steps.iter().map(|step| step.name.as_str()).collect();
            assert_eq!(names, ["nodes", "between the nodes", "tracking", "model", "wind", "noise"]);
            let margin = |group: &str| verdict.check(&format!("{group}.{}", budget.question)).unwrap().margin.unwrap();
            let (first, last) = (&budget.steps[0], &budget.steps[5]);
            assert_eq!((first.margin, last.margin), (margin("nodes"), margin("flight")));
            let sum: f64 = budget.steps.iter().map(|step| step.change).sum();
            assert!((first.margin + sum - last.margin).abs() < 1e-12, "{budget:?}");
            assert!(budget.steps[2..].iter().any(|step| step.change != 0.0));
        }
    }
}
