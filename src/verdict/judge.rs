use scenarios::requirement::Requirement;
use scenarios::{CheckSpec, Group, Plan, PlanStatus, Scenario, check_spec, checks_of};
use sim::Flight;

use crate::families;
use crate::verdict::case::Case;
use crate::verdict::evidence::Decide;
use crate::verdict::recorded::RecordedFlight;
use crate::verdict::{Check, Integration, Outcome, Provenance, Status, Verdict, collision};

/// Judges a plan and its flight.
///
/// - `flight`: `None` when the plan was not flown
///
/// Every check of [`scenarios::check_names`] is answered, in that order. What does not apply to the scenario is skipped
/// with the reason; what applies and cannot be measured, because something is missing, empty or not a number, fails
/// with the reason. Nothing that a plan or a flight may hold makes it panic.
///
/// # Examples
///
/// A planned flight passes; the same flight with one sample 5 m to the north does not, because its log contradicts itself:
///
/// ```
/// use harness::verdict::{Outcome, Status, judge};
///
/// let file = concat!(env!("CARGO_MANIFEST_DIR"), "/scenarios/fixed-wing/rendezvous-1.toml");
/// let scenario = scenarios::load(file.as_ref())?;
/// let planner = planners::find(&scenario.planner.name).expect("a registered planner");
/// let plan = planner.plan(&scenario.planner_view(), 0, &mut |_| {});
/// let mut flight = sim::fly(&scenario, &plan, 0, &mut |_| {});
/// assert_eq!(judge(&scenario, &plan, Some(&flight)).outcome, Outcome::Pass);
///
/// flight.vehicles[0].samples[100].position_m[1] += 5.0;
/// let verdict = judge(&scenario, &plan, Some(&flight));
/// let dynamics = verdict.checks.iter().find(|check| check.name == "flight.dynamics").expect("every check is answered");
/// assert_eq!((verdict.outcome, dynamics.status), (Outcome::Fail, Status::Fail));
/// # Ok::<(), scenarios::LoadError>(())
/// ```
pub fn judge(scenario: &Scenario, plan: &Plan, flight: Option<&Flight>) -> Verdict {
    judge_imported(scenario, plan, &Provenance::whole(), flight)
}

/// As [`judge`], for a plan of which parts were reconstructed: checks whose margin is below the error of the reconstruction
/// are undecided.
pub fn judge_imported(scenario: &Scenario, plan: &Plan, provenance: &Provenance, flight: Option<&Flight>) -> Verdict {
    judge_with(scenario, plan, provenance, flight, None)
}

/// As [`judge_imported`], with the integration error found by a second integrator; `None` estimates it by a replay.
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

/// Judges a flight that was flown elsewhere, by its log.
///
/// The checks of the groups `nodes` and `plan` are skipped, since there is no plan, and so are those that need more than
/// positions, velocities and setpoints. What the vehicle may have done between two samples is unknown within its limits: it is
/// part of every distance and of every limit, and a check that it leaves open is undecided.
pub fn judge_recorded(recording: &RecordedFlight<'_>) -> Verdict {
    let scenario = recording.scenario;
    let mut checks = match families::of(scenario.family()).recorded_checks {
        Some(checks) => checks(recording),
        None => all_skipped(scenario),
    };
    apply_check_policy(scenario, &mut checks);
    let is_asked = checks.iter().any(|check| check.status != Status::Skip);
    let passes = is_asked && !checks.iter().any(|check| check.is_bad() && !check.advisory);
    let outcome = if passes { Outcome::Pass } else { Outcome::Fail };
    Verdict { outcome, overclaimed: false, checks, integration: None }
}

/// Of a family whose flights are not judged from logs.
fn all_skipped(scenario: &Scenario) -> Vec<Check> {
    let reason = format!("flights of a {} are not judged from logs", scenario.family());
    checks_of(scenario.family()).map(|spec| spec.skip(&reason)).collect()
}

/// Applies the scenario's rules on single checks: advisory ones do not decide, required ones must have been made.
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
    let requirements = scenario.all_requirements();
    for check in checks {
        let may_be_advisory = check_spec(&check.name).is_some_and(CheckSpec::may_be_advisory);
        let of_requirement = |it: &&Requirement| it.advisory && it.check_names().any(|name| name == check.name);
        let is_advisory =
            scenario.verdict.advisory.contains(&check.name) || requirements.iter().any(|it| of_requirement(&it));
        check.advisory = may_be_advisory && is_advisory;
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
