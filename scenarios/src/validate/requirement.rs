//! Requirements: their names, and their formulas.

use super::identifier;
use crate::requirement::Requirement;
use crate::{Issue, Scenario};

/// Malformed names and formulas. Formulas are checked if the scenario has vehicles with models: they refer to them.
pub(super) fn issues(scenario: &Scenario) -> Vec<Issue> {
    let names = scenario.requirements.iter().map(|requirement| requirement.name.as_str());
    let mut issues = identifier::entity_names("requirements", names);
    let is_resolvable = scenario.vehicles.first().is_some_and(|it| scenario.models.get(&it.model).is_some());
    if is_resolvable {
        issues.extend(scenario.requirements.iter().enumerate().filter_map(|(i, it)| formula_issue(scenario, i, it)));
    }
    issues
}

fn formula_issue(scenario: &Scenario, index: usize, requirement: &Requirement) -> Option<Issue> {
    let error = requirement.formula(scenario).err()?;
    let issue = Issue::new(format!("requirements[{index}].formula"), error.found, error.expected);
    Some(issue.remedy(error.remedy).at_byte(error.span.start))
}
