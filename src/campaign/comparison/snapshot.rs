use std::collections::BTreeMap;
use std::fs;
use std::path::Path;

use serde::{Deserialize, Serialize};

use super::{Baseline, rules};
use crate::error::Error;
use crate::report::Report;
use crate::verdict::{Outcome, Status};

/// What is compared of a run: one entry per scenario and planner, in the order of their names.
#[derive(Clone, Debug, Default, PartialEq, Serialize, Deserialize)]
pub struct Snapshot {
    /// The results.
    pub entries: Vec<Entry>,
}

/// One result.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct Entry {
    /// Scenario.
    pub scenario: String,
    /// Planner.
    pub planner: String,
    /// Seed of planning and flight.
    pub seed: u64,
    /// The outcome.
    pub verdict: Outcome,
    /// Every check, by its full name.
    pub checks: BTreeMap<String, CheckEntry>,
    /// The compared numbers: margins (`margin of flight.separation`), flight time, tracking errors, planning time.
    pub figures: BTreeMap<String, f64>,
}

/// One check.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct CheckEntry {
    /// Its status.
    pub status: Status,
    /// Unit of its margin.
    pub unit: String,
    /// Whether it is advisory.
    #[serde(default, skip_serializing_if = "std::ops::Not::not")]
    pub advisory: bool,
}

impl Snapshot {
    /// The snapshot of reports, in any order.
    pub fn of<'r>(reports: impl IntoIterator<Item = &'r Report>) -> Self {
        let mut entries: Vec<Entry> = reports.into_iter().map(Entry::of).collect();
        entries.sort_by(|a, b| (&a.scenario, &a.planner).cmp(&(&b.scenario, &b.planner)));
        Self { entries }
    }

    /// Reads a result folder (`out`), a single `report.json`, or a baseline file.
    ///
    /// # Errors
    ///
    /// [`Error::Results`] if there is no such file, or it is invalid.
    pub fn read(path: &Path) -> Result<Self, Error> {
        let metadata = fs::metadata(path).map_err(|reason| Error::results(path, reason.to_string()))?;
        if !metadata.is_dir() {
            return read_file(path);
        }
        let mut reports = Vec::new();
        for scenario in folders_in(path)? {
            for planner in folders_in(&scenario)? {
                let file = planner.join("report.json");
                if file.is_file() {
                    reports.push(read_report(&file)?);
                }
            }
        }
        if reports.is_empty() {
            return Err(Error::results(path, "found no <scenario>/<planner>/report.json in it".into()));
        }
        Ok(Self::of(&reports))
    }

    /// The result of one scenario and planner.
    pub fn find(&self, scenario: &str, planner: &str) -> Option<&Entry> {
        self.entries.iter().find(|entry| entry.scenario == scenario && entry.planner == planner)
    }
}

impl Entry {
    fn of(report: &Report) -> Self {
        let made = report.checks.iter().filter(|check| check.status != Status::Skip);
        // how far a flight is from its longest duration says nothing that the flight time does not say better, and
        // how far it is from the plan is compared by itself
        let told = ["duration", "tracking_max", "tracking_rms"];
        let margins = made.filter(|check| !told.contains(&check.question()));
        let margins = margins.filter_map(|check| Some((format!("{}{}", rules::MARGIN_OF, check.name), check.margin?)));
        let (flight, slung) = (report.metrics.flight.as_ref(), report.metrics.slung_load.as_ref());
        let figures = [
            (rules::PLANNED_TIME, report.plan.flight_time_s),
            (rules::FLOWN_TIME, flight.and_then(|flight| flight.flight_time_s)),
            (rules::TRACKING_MAX, flight.map_or_else(|| slung?.tracking_max_m, |flight| flight.tracking_max_m)),
            (rules::TRACKING_RMS, flight.map_or_else(|| slung?.tracking_rms_m, |flight| flight.tracking_rms_m)),
            (rules::PLANNING_TIME, Some(report.plan.wall_s)),
        ];
        let figures = figures.into_iter().filter_map(|(name, value)| Some((name.to_owned(), value?)));
        let check = |check: &crate::verdict::Check| {
            (
                check.name.clone(),
                CheckEntry { status: check.status, unit: check.unit.clone(), advisory: check.advisory },
            )
        };
        Self {
            scenario: report.scenario.clone(),
            planner: report.planner.clone(),
            seed: report.seed,
            verdict: report.verdict,
            checks: report.checks.iter().map(check).collect(),
            figures: margins.chain(figures).collect(),
        }
    }

    /// Unit of a figure.
    pub(super) fn unit_of(&self, figure: &str) -> &str {
        match figure.strip_prefix(rules::MARGIN_OF).and_then(|check| self.checks.get(check)) {
            Some(check) => &check.unit,
            None if figure.starts_with("tracking") => "m",
            None => "s",
        }
    }
}

fn read_file(path: &Path) -> Result<Snapshot, Error> {
    match Baseline::read(path) {
        Ok(baseline) => Ok(baseline.results),
        Err(_) if path.file_name().is_some_and(|name| name == "report.json") => Ok(Snapshot::of(&[read_report(path)?])),
        Err(error) => Err(error),
    }
}

fn read_report(path: &Path) -> Result<Report, Error> {
    let text = fs::read_to_string(path).map_err(|reason| Error::results(path, reason.to_string()))?;
    serde_json::from_str(&text)
        .map_err(|reason| Error::results(path, format!("not a report of this version: {reason}")))
}

fn folders_in(path: &Path) -> Result<Vec<std::path::PathBuf>, Error> {
    let unreadable = |reason: std::io::Error| Error::results(path, reason.to_string());
    let mut folders = Vec::new();
    for entry in fs::read_dir(path).map_err(unreadable)? {
        let entry = entry.map_err(unreadable)?.path();
        if entry.is_dir() {
            folders.push(entry);
        }
    }
    folders.sort();
    Ok(folders)
}
