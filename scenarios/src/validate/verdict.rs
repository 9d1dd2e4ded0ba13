//! Limits of the verdict, and names of checks.

use super::quantity::{not_negative, positive_if_given};
use crate::requirement::Requirement;
use crate::{CHECKS, Issue, Scenario, check_spec, closest_name};

pub(super) fn issues(scenario: &Scenario) -> Vec<Issue> {
    let limits = &scenario.verdict;
    let positive_quantities = [
        ("tracking_max_m", limits.tracking_max_m),
        ("tracking_rms_m", limits.tracking_rms_m),
        ("arrival_spread_s", limits.arrival_spread_s),
        ("goal_m", limits.goal_m),
        ("goal_heading_deg", limits.goal_heading_deg),
        ("goal_flight_path_deg", limits.goal_flight_path_deg),
        ("goal_speed_mps", limits.goal_speed_mps),
        ("rest_mps", limits.rest_mps),
        ("dynamics_m", limits.dynamics_m),
        ("rollout_m", limits.rollout_m),
        ("switch_s", limits.switch_s),
    ];
    let rules =
        positive_quantities.into_iter().map(|(name, value)| positive_if_given(&format!("verdict.{name}"), value));
    let others = [
        limits.envelope_m.and_then(|value| not_negative("verdict.envelope_m", value)),
        limits.saturation.and_then(|value| fraction("verdict.saturation", value)),
    ];
    let requirements = scenario.all_requirements();
    let of_requirements = requirements.iter().flat_map(Requirement::check_names);
    let known: Vec<String> = CHECKS.iter().map(|check| check.name.to_owned()).chain(of_requirements).collect();
    let names = unknown_checks("verdict.advisory", &limits.advisory, &known);
    rules
        .chain(others)
        .flatten()
        .chain(names)
        .chain(decisive_checks(&limits.advisory))
        .chain(unknown_checks("verdict.required", &limits.required, &known))
        .collect()
}

/// Advisory checks that always decide.
fn decisive_checks(advisory: &[String]) -> Vec<Issue> {
    let is_decisive = |(_, name): &(usize, &String)| check_spec(name).is_some_and(|check| !check.may_be_advisory());
    let issue = |(index, name): (usize, &String)| {
        let expected =
            "a check that may be advisory: those of crashes, completeness, finiteness, conditions and dynamics decide";
        Issue::new(format!("verdict.advisory[{index}]"), format!("\"{name}\""), expected)
            .remedy("remove it from the list")
    };
    advisory.iter().enumerate().filter(is_decisive).map(issue).collect()
}

fn fraction(field: &str, value: f64) -> Option<Issue> {
    (!(0.0..=1.0).contains(&value)).then(|| Issue::new(field, value.to_string(), "a fraction from 0 to 1"))
}

fn unknown_checks(field: &str, names: &[String], known: &[String]) -> Vec<Issue> {
    let is_unknown = |(_, name): &(usize, &String)| !known.contains(name);
    names.iter().enumerate().filter(is_unknown).map(|(index, name)| unknown_check(field, index, name, known)).collect()
}

fn unknown_check(field: &str, index: usize, name: &str, known: &[String]) -> Issue {
    let remedy = match closest_name(name, known.iter().map(String::as_str)) {
        Some(known) => format!("did you mean \"{known}\"?"),
        None => format!("the checks are {}", known.join(", ")),
    };
    let expected = "the full name of a check, such as \"flight.separation\"";
    Issue::new(format!("{field}[{index}]"), format!("\"{name}\""), expected).remedy(remedy)
}
