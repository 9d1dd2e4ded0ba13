//! Requirements: their names, and their formulas.

use super::identifier;
use crate::requirement::{Formula, Requirement};
use crate::{Group, Issue, Scenario, Vehicle};

/// Malformed names and formulas. Formulas are checked if the scenario has vehicles with models: they refer to them.
pub(super) fn issues(scenario: &Scenario) -> Vec<Issue> {
    let names = scenario.requirements.iter().map(|requirement| requirement.name.as_str());
    let mut issues = identifier::entity_names("requirements", names);
    issues.extend(scenario.requirements.iter().enumerate().filter_map(|(index, it)| taken_by_via(scenario, index, it)));
    let is_resolvable = scenario.vehicles.first().is_some_and(|it| scenario.models.get(&it.model).is_some());
    if is_resolvable {
        issues.extend(scenario.requirements.iter().enumerate().filter_map(|(i, it)| formula_issue(scenario, i, it)));
    }
    issues
}

/// The name of the requirement that a vehicle's via-points make.
fn taken_by_via(scenario: &Scenario, index: usize, requirement: &Requirement) -> Option<Issue> {
    let of_vehicle = |vehicle: &Vehicle| vehicle.via_requirement().is_some_and(|it| it.name == requirement.name);
    let vehicle = scenario.vehicles.iter().find(|vehicle| of_vehicle(vehicle))?;
    let expected = format!("another name: the via-points of `{}` have this one", vehicle.name);
    Some(Issue::new(format!("requirements[{index}].name"), format!("\"{}\"", requirement.name), expected))
}

fn formula_issue(scenario: &Scenario, index: usize, requirement: &Requirement) -> Option<Issue> {
    let field = format!("requirements[{index}].formula");
    match requirement.formula(scenario) {
        Ok(formula) => unanswerable(scenario, index, requirement, &formula),
        Err(error) => {
            let issue = Issue::new(field, error.found, error.expected);
            Some(issue.remedy(error.remedy).at_byte(error.span.start))
        }
    }
}

/// A formula that no motion of this scenario can keep or break.
fn unanswerable(scenario: &Scenario, index: usize, requirement: &Requirement, formula: &Formula) -> Option<Issue> {
    if let Some(signal) = formula.logged_signal().filter(|_| !requirement.applies_to.covers(Group::Flight)) {
        let expected = format!("`flight` or `both`: {signal} is known in flight only");
        let issue = Issue::new(format!("requirements[{index}].applies_to"), "`plan`", expected);
        return Some(issue.remedy("remove `applies_to`"));
    }
    let (asked, there) = (formula.quantifiers.iter().map(|it| it.variables.len()).max()?, scenario.vehicles.len());
    (asked > there).then(|| {
        let found = format!("a quantifier over {asked} different vehicles");
        let expected = format!("at most {there}, as the scenario has: with fewer nothing is asked");
        Issue::new(format!("requirements[{index}].formula"), found, expected)
            .remedy("remove the requirement, or add vehicles")
    })
}
