use scenarios::{CheckSpec, Group, Plan, PlanStatus, Scenario, check_spec};
use sim::Flight;

use crate::families;
use crate::verdict::case::Case;
use crate::verdict::{Check, Integration, Outcome, Provenance, Status, Verdict, collision};

/// Judges a plan and its flight.
///
/// - `flight`: `None` when the plan was not flown
///
/// Every check of [`scenarios::check_names`] is answered, in that order. What does not apply to the scenario is skipped
/// with the reason; what applies and cannot be measured, because something is missing, empty or not a number, fails
/// with the reason. Nothing that a plan or a flight may hold makes it panic.
pub fn judge(scenario: &Scenario, plan: &Plan, flight: Option<&Flight>) -> Verdict {
    judge_imported(scenario, plan, &Provenance::whole(), flight)
}

/// [`judge`], of a plan that was not whole: what was reconstructed decides nothing that it cannot tell.
pub fn judge_imported(scenario: &Scenario, plan: &Plan, provenance: &Provenance, flight: Option<&Flight>) -> Verdict {
    judge_with(scenario, plan, provenance, flight, None)
}

/// [`judge_imported`], with what a second integrator made of the flight; without it the disagreement is estimated.
pub fn judge_with(
    scenario: &Scenario,
    plan: &Plan,
    provenance: &Provenance,
    flight: Option<&Flight>,
    integration: Option<Integration>,
) -> Verdict {
    let case = Case::new(scenario, plan, provenance, flight);
    let mut checks = (families::of(scenario.family()).checks)(&case);
    provenance.mark_undecided(&mut checks);
    let integration = integration.or_else(|| Integration::by_replay(&checks));
    if let Some(integration) = &integration {
        integration.mark_undecided(&mut checks);
    }
    collision::mark_crashed(&case, &mut checks);
    let overclaimed = plan.status == PlanStatus::Solved && checks.iter().any(|check| check.is_bad_in(Group::Plan));
    apply_check_policy(scenario, &mut checks);
    let outcome = if plan.status == PlanStatus::NoPlan || plan.trajectories.is_empty() {
        Outcome::NoPlan
    } else if checks.iter().any(|check| check.is_bad() && !check.advisory) {
        Outcome::Fail
    } else {
        Outcome::Pass
    };
    Verdict { outcome, overclaimed, checks, integration }
}

/// Applies what the scenario says of single checks: advisory ones do not decide, required ones must have been made.
fn apply_check_policy(scenario: &Scenario, checks: &mut Vec<Check>) {
    for name in &scenario.verdict.required {
        match checks.iter_mut().find(|check| check.name == *name) {
            Some(check) if check.status == Status::Skip => {
                check.status = Status::Fail;
                let why = check.reason.take().unwrap_or_default();
                check.reason = Some(format!("required, but it could not be asked: {why}"));
            }
            Some(_) => {}
            None => checks.push(Check::unknown(name)),
        }
    }
    for check in checks {
        let may_be_advisory = check_spec(&check.name).is_some_and(CheckSpec::may_be_advisory);
        check.advisory = may_be_advisory && scenario.verdict.advisory.contains(&check.name);
    }
}

impl Check {
    fn is_bad_in(&self, group: Group) -> bool {
        self.is_bad() && self.name.starts_with(&format!("{group}."))
    }

    /// A required check that does not exist has failed, since it was not made.
    fn unknown(name: &str) -> Self {
        Self {
            name: name.to_owned(),
            status: Status::Fail,
            value: None,
            lower: None,
            upper: None,
            limit: None,
            margin: None,
            unit: "-".to_owned(),
            at_s: None,
            between: Vec::new(),
            advisory: false,
            reason: Some("required, but there is no check of this name".to_owned()),
            limit_key: None,
        }
    }
}
