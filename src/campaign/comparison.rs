//! Comparison of two runs: what got worse by more than its tolerance.
//!
//! A [`Snapshot`] holds what is compared of a run: verdicts, checks, margins, figures. It is read from a result folder or
//! from an accepted baseline file.

mod baseline;
mod rules;
mod snapshot;

use std::collections::BTreeSet;

use serde::Serialize;

use self::rules::MARGIN_OF;

pub use baseline::{Acceptance, Baseline};
pub use snapshot::{CheckEntry, Entry, Snapshot};

use crate::number_format::{quantity, signed_quantity};
use crate::verdict::Status;

/// Differences between two runs, the worst first.
#[derive(Clone, Debug, Default, PartialEq, Serialize)]
pub struct Comparison {
    /// Number of results that are in both runs.
    pub compared: usize,
    /// Every difference beyond tolerance.
    pub differences: Vec<Difference>,
}

/// One difference.
#[derive(Clone, Debug, PartialEq, Serialize)]
pub struct Difference {
    /// Its severity.
    pub rating: Severity,
    /// Scenario.
    pub scenario: String,
    /// Planner.
    pub planner: String,
    /// The subject: a check, a margin, a figure.
    pub what: String,
    /// The old value.
    pub old: String,
    /// The new value.
    pub new: String,
    /// The change of a figure with its tolerance; empty for other subjects.
    pub change: String,
}

/// Severity of a difference.
#[derive(Clone, Copy, Debug, PartialEq, Eq, PartialOrd, Ord, Serialize)]
#[serde(rename_all = "kebab-case")]
pub enum Severity {
    /// Worse by more than the tolerance: the comparison fails.
    Worse,
    /// Better by more than the tolerance.
    Better,
    /// For information only.
    Note,
}

/// Which results of the old run must be in the new one.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Scope {
    /// All: a missing one counts as worse.
    Everything,
    /// None: the new run may be a part of the old one.
    NewRunOnly,
}

impl Comparison {
    /// Differences of this rating.
    pub fn count(&self, rating: Severity) -> usize {
        self.differences.iter().filter(|difference| difference.rating == rating).count()
    }

    /// Whether nothing got worse.
    pub fn is_good(&self) -> bool {
        self.count(Severity::Worse) == 0
    }

    /// What got worse of one result.
    pub fn losses(&self, scenario: &str, planner: &str) -> Vec<&Difference> {
        let is_loss = |difference: &&Difference| {
            difference.rating == Severity::Worse && difference.scenario == scenario && difference.planner == planner
        };
        self.differences.iter().filter(is_loss).collect()
    }

    /// Number of results of which something got worse.
    pub fn worse_results(&self) -> usize {
        let worse = self.differences.iter().filter(|difference| difference.rating == Severity::Worse);
        worse.map(|difference| (&difference.scenario, &difference.planner)).collect::<BTreeSet<_>>().len()
    }

    /// `12 results compared: 1 worse, 3 better`.
    pub fn counts_line(&self) -> String {
        let Self { compared, .. } = self;
        let (worse, better) = (self.count(Severity::Worse), self.count(Severity::Better));
        let results = if *compared == 1 { "result" } else { "results" };
        format!("{compared} {results} compared: {worse} worse, {better} better")
    }
}

/// Compares `new` with `old`.
pub fn compare(old: &Snapshot, new: &Snapshot, scope: Scope) -> Comparison {
    let mut comparison = Comparison::default();
    for before in &old.entries {
        match new.find(&before.scenario, &before.planner) {
            Some(after) => {
                comparison.compared += 1;
                comparison.differences.extend(differences(before, after));
            }
            None if scope == Scope::Everything => {
                comparison.differences.push(before.differs(Severity::Worse, "result", "there", "gone"));
            }
            None => {}
        }
    }
    let is_new = |after: &&Entry| old.find(&after.scenario, &after.planner).is_none();
    let fresh =
        new.entries.iter().filter(is_new).map(|after| after.differs(Severity::Note, "result", "not there", "new"));
    comparison.differences.extend(fresh);
    comparison.differences.sort_by_key(|difference| difference.rating);
    comparison
}

fn differences(old: &Entry, new: &Entry) -> Vec<Difference> {
    let mut differences = Vec::new();
    if old.seed != new.seed {
        differences.push(new.differs(Severity::Note, "seed", &old.seed.to_string(), &new.seed.to_string()));
    }
    if old.verdict != new.verdict {
        let rating = if new.verdict > old.verdict { Severity::Worse } else { Severity::Better };
        differences.push(new.differs(rating, "verdict", &old.verdict.to_string(), &new.verdict.to_string()));
    }
    for (name, before) in &old.checks {
        let after = new.checks.get(name);
        differences.extend(after.and_then(|after| advisory_difference(new, name, before, after)));
        match after {
            Some(after) if before.status != after.status => {
                let rating = status_severity(before, after);
                differences.push(new.differs(rating, name, &before.status.to_string(), &after.status.to_string()));
            }
            Some(_) => {}
            None => differences.push(new.differs(Severity::Worse, name, &before.status.to_string(), "not made")),
        }
    }
    let figures = old.figures.iter().filter_map(|(name, before)| Some((name, *before, *new.figures.get(name)?)));
    differences.extend(figures.filter_map(|(name, before, after)| figure(old, new, name, before, after)));
    differences
}

/// A figure that changed by more than its rule tolerates. Margins of two quantities, in two units, are not compared.
fn figure(old: &Entry, new: &Entry, name: &str, before: f64, after: f64) -> Option<Difference> {
    let unit = old.unit_of(name);
    if new.unit_of(name) != unit {
        return None;
    }
    let rule = rules::rule(name, unit);
    let tolerance = rule.tolerance(before);
    let change = after - before;
    // NaN is a change.
    if change.abs() <= tolerance {
        return None;
    }
    let is_advisory =
        name.strip_prefix(MARGIN_OF).and_then(|check| new.checks.get(check)).is_some_and(|it| it.advisory);
    let rating = match rule.decides && !is_advisory {
        false => Severity::Note,
        true if rule.is_gain(change) => Severity::Better,
        true => Severity::Worse,
    };
    let by = format!("{} (tolerance {})", signed_quantity(change, unit), quantity(tolerance, unit));
    let (before, after) = (quantity(before, unit), quantity(after, unit));
    Some(Difference { change: by, ..new.differs(rating, name, &before, &after) })
}

/// A check that no longer decides is a weaker judge, whatever its status.
fn advisory_difference(new: &Entry, name: &str, before: &CheckEntry, after: &CheckEntry) -> Option<Difference> {
    let in_words = |check: &CheckEntry| if check.advisory { "advisory" } else { "decides" };
    let rating = if after.advisory { Severity::Worse } else { Severity::Better };
    (before.advisory != after.advisory).then(|| new.differs(rating, name, in_words(before), in_words(after)))
}

fn status_severity(old: &CheckEntry, new: &CheckEntry) -> Severity {
    // A check that is skipped now is worse than one that passes.
    let rank = |status: Status| match status {
        Status::Pass => 0,
        Status::Skip => 1,
        Status::Undecided => 2,
        Status::Fail => 3,
    };
    if new.advisory {
        Severity::Note
    } else if rank(new.status) > rank(old.status) {
        Severity::Worse
    } else {
        Severity::Better
    }
}

impl Difference {
    /// `margin of flight.separation: 17.900 m before, 3.100 m now, -14.800 m (tolerance 0.358 m)`.
    pub fn sentence(&self) -> String {
        let Self { what, old, new, change, .. } = self;
        let change = if change.is_empty() { String::new() } else { format!(", {change}") };
        format!("{what}: {old} before, {new} now{change}")
    }

    /// The check that it is about, if it is about one: by its status or by its margin.
    pub fn check(&self) -> &str {
        self.what.strip_prefix(MARGIN_OF).unwrap_or(&self.what)
    }
}

impl Entry {
    fn differs(&self, rating: Severity, what: &str, old: &str, new: &str) -> Difference {
        Difference {
            rating,
            scenario: self.scenario.clone(),
            planner: self.planner.clone(),
            what: what.to_owned(),
            old: old.to_owned(),
            new: new.to_owned(),
            change: String::new(),
        }
    }
}

#[cfg(test)]
mod tests;
