//! One flight of a changed scenario, and how near it comes to failing.

use std::cmp::Ordering;

use scenarios::{LimitField, Scenario, check_spec};
use serde::Serialize;

use crate::campaign::scenario_document::ScenarioDocument;
use crate::jobs::Job;
use crate::plan_source::PlanSource;
use crate::verdict::compare::is_smaller;
use crate::verdict::{Check, Outcome, Status, Verdict};

/// Fails because something else did: a crashed vehicle has no log to the end.
const CONSEQUENCE: &str = "flight.complete";

/// What is tried, and what is asked of it.
pub struct TestSystem<'a> {
    /// The planner; it plans anew in every trial, unless `first_plan` is what it would plan.
    pub source: &'a PlanSource,
    /// The plan of the scenario as it is; `None` to plan in every trial.
    pub first_plan: Option<&'a FirstPlan>,
    /// Seed of planning and flight.
    pub seed: u64,
    /// The check that is asked; `None` for whichever fails.
    pub check: Option<&'a str>,
}

impl<'a> TestSystem<'a> {
    /// The system of a job.
    ///
    /// - `check`: the one that is asked; `None` for whichever fails
    pub fn new(job: &'a Job, first_plan: Option<&'a FirstPlan>, check: Option<&'a str>) -> Self {
        Self { source: &job.plan_source, first_plan, seed: job.seed, check }
    }
}

/// The plan that is made before the flight of a scenario as it is. Trials that differ in disturbances alone, which planners do
/// not know, fly it again.
pub struct FirstPlan {
    known: Scenario,
    seed: u64,
    plan: PlanSource,
}

impl FirstPlan {
    /// Plans. `None` of a source that plans in the loop, and if the scenario is not valid.
    pub fn of(document: &ScenarioDocument, source: &PlanSource, seed: u64) -> Option<Self> {
        let scenario = document.scenario().ok()?;
        let answer = match source {
            PlanSource::Imported(_) => None,
            source if source.plans_in_the_loop() => None,
            source => source.prepare(&scenario, seed, &mut |_| {}).guidance.into_plan(),
        }?;
        Some(Self { known: known_before_flight(&scenario), seed, plan: source.fixed_to(answer) })
    }

    fn source_for(&self, scenario: &Scenario, seed: u64) -> Option<&PlanSource> {
        (seed == self.seed && known_before_flight(scenario) == self.known).then_some(&self.plan)
    }
}

/// What a planner is told besides its seed.
fn known_before_flight(scenario: &Scenario) -> Scenario {
    let mut view = scenario.planner_view();
    view.simulation.seed = 0;
    view
}

/// The outcome of one trial.
#[derive(Clone, Debug, PartialEq)]
pub enum Trial {
    /// The changed scenario is not valid, or the planner does not support it. Nothing was flown.
    Rejected,
    /// The planner returned no trajectory.
    NoPlan,
    /// The check that is asked is not answered: it was skipped, or has no margin.
    Unanswered,
    /// The check that decides.
    Judged(Finding),
}

/// The check that is nearest to failing, or fails by most.
#[derive(Clone, Debug, PartialEq, Serialize)]
pub struct Finding {
    /// Whether it fails.
    pub fails: bool,
    /// Its name.
    pub check: String,
    /// The margin in its unit.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub margin: Option<f64>,
    /// Unit of the margin.
    pub unit: String,
    /// The margin as a fraction of the limit; of a limit within ±1, the margin itself. -1 if the check fails without one.
    pub relative: f64,
    /// When, s.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub at_s: Option<f64>,
    /// The vehicles and obstacles concerned.
    pub between: Vec<String>,
}

impl TestSystem<'_> {
    /// Plans, flies and judges.
    pub fn try_out(&self, document: &ScenarioDocument) -> Trial {
        self.try_out_with(document, self.seed)
    }

    /// [`try_out`](Self::try_out) with another seed of planning and flight.
    pub fn try_out_with(&self, document: &ScenarioDocument, seed: u64) -> Trial {
        let Ok(scenario) = document.scenario() else { return Trial::Rejected };
        if self.is_unsupported(&scenario) {
            return Trial::Rejected;
        }
        let planned = self.first_plan.and_then(|plan| plan.source_for(&scenario, seed));
        let verdict = planned.unwrap_or(self.source).fly(&scenario, seed).judge(&scenario);
        if verdict.outcome == Outcome::NoPlan {
            return Trial::NoPlan;
        }
        Finding::of(&verdict, self.check).map_or(Trial::Unanswered, Trial::Judged)
    }

    fn is_unsupported(&self, scenario: &Scenario) -> bool {
        match self.source {
            PlanSource::Registered(planner) => (planner.unsupported_reason)(scenario).is_some(),
            PlanSource::External(_) | PlanSource::Imported(_) => false,
        }
    }
}

/// Whether a check compares several quantities with their limits, so that the unit of its margin is that of the decisive one.
pub fn has_several_quantities(check: &str) -> bool {
    check_spec(check).is_some_and(|spec| match spec.limit {
        LimitField::ModelLimits => spec.unit == "-",
        limit => matches!(limit, LimitField::Goal | LimitField::Requirement),
    })
}

impl Trial {
    /// Whether the check fails.
    pub fn fails(&self) -> bool {
        matches!(self, Self::Judged(finding) if finding.fails)
    }

    /// What a search makes smaller: the relative margin; without one, infinity.
    pub fn value(&self) -> f64 {
        match self {
            Self::Judged(finding) => finding.relative,
            Self::Rejected | Self::NoPlan | Self::Unanswered => f64::INFINITY,
        }
    }
}

impl Finding {
    /// Of the check of this name, or of the deciding check that fails by most; if none fails, of the key check of the flight
    /// with the smallest relative margin. (Others say nothing before they fail: counts of faults, and limits that an optimal
    /// plan touches.) `None` if none was answered.
    pub fn of(verdict: &Verdict, name: Option<&str>) -> Option<Self> {
        let guides =
            |check: &Check| check.status == Status::Fail || check.name.starts_with("flight.") && check.is_key();
        let is_asked = |check: &&Check| name.map_or(!check.advisory && guides(check), |name| check.name == name);
        let answered = verdict.checks.iter().filter(is_asked).filter(|check| check.status != Status::Skip);
        let findings = answered.filter_map(Self::of_check);
        findings.reduce(|worst, other| if other.is_worse_than(&worst) { other } else { worst })
    }

    fn of_check(check: &Check) -> Option<Self> {
        let fails = check.status == Status::Fail;
        let scale = check.limit.map_or(1.0, f64::abs).max(1.0);
        let relative = match check.margin {
            Some(margin) => margin / scale,
            None if fails => -1.0,
            None => return None,
        };
        let (check_name, unit, between) = (check.name.clone(), check.unit.clone(), check.between.clone());
        let (margin, at_s) = (check.margin, check.at_s);
        Some(Self { fails, check: check_name, margin, unit, relative, at_s, between })
    }

    /// A failure is worse than a pass, whatever the margins; a log that ends early is only as bad as what ended it.
    fn is_worse_than(&self, other: &Self) -> bool {
        let rank = |it: &Self| (it.fails, it.check != CONSEQUENCE);
        match rank(self).cmp(&rank(other)) {
            Ordering::Greater => true,
            Ordering::Less => false,
            Ordering::Equal => is_smaller(self.relative, other.relative),
        }
    }

    /// Two failures are the same if the same check fails of the same bodies.
    pub fn is_same_failure(&self, other: &Self) -> bool {
        self.check == other.check && self.between == other.between
    }
}

#[cfg(test)]
mod tests {
    use super::Finding;
    use crate::verdict::{Check, Outcome, Status, Verdict};

    fn check(name: &str, status: Status, [margin, limit]: [f64; 2]) -> Check {
        Check {
            name: name.to_owned(),
            status,
            value: None,
            lower: None,
            upper: None,
            limit: Some(limit),
            margin: margin.is_finite().then_some(margin),
            unit: "m".to_owned(),
            at_s: None,
            between: Vec::new(),
            advisory: false,
            reason: None,
            limit_key: None,
        }
    }

    #[test]
    fn margins_compare_as_fractions_of_their_limits_and_failures_come_first() {
        let near = check("flight.separation", Status::Pass, [8.0, 100.0]);
        let far = check("flight.clearance", Status::Pass, [0.9, 0.0]);
        let skipped = check("flight.slack", Status::Skip, [f64::NAN, 0.0]);
        let verdict = |checks: &[&Check]| Verdict {
            outcome: Outcome::Pass,
            overclaimed: false,
            checks: checks.iter().copied().cloned().collect(),
            integration: None,
        };
        let found = |checks: &[&Check], name| Finding::of(&verdict(checks), name).map(|finding| finding.check);
        assert_eq!(found(&[&far, &near, &skipped], None).as_deref(), Some("flight.separation"));
        assert_eq!(found(&[&far, &near], Some("flight.clearance")).as_deref(), Some("flight.clearance"));
        assert_eq!(found(&[&skipped], None), None);
        let undecided = check("flight.goal", Status::Undecided, [-1e-9, 1.0]);
        let faultless = check("flight.finite", Status::Pass, [0.0, 0.0]);
        assert_eq!(found(&[&faultless, &near], None).as_deref(), Some("flight.separation"));
        let failed = check("flight.complete", Status::Fail, [f64::NAN, 0.0]);
        assert_eq!(found(&[&undecided, &failed, &near], None).as_deref(), Some("flight.complete"));
        let mut crash = check("flight.crash", Status::Fail, [-1.0, 0.0]);
        crash.between = vec!["uav-1".to_owned(), "mast".to_owned()];
        let incomplete = check("flight.complete", Status::Fail, [-2.0, 0.0]);
        assert_eq!(found(&[&incomplete, &crash, &near], None).as_deref(), Some("flight.crash"));
        let advisory = Check { advisory: true, ..failed };
        assert_eq!(found(&[&advisory, &near], None).as_deref(), Some("flight.separation"));
    }
}
