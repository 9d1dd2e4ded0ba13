//! The summary of all jobs: `summary.json`, and `summary.md` from it.

use serde::{Deserialize, Serialize};

use super::{Links, headline, markdown};
use crate::campaign::comparison::{Comparison, Difference};
use crate::error::{Error, Exit};
use crate::jobs::RejectedJob;
use crate::report::{Report, SCHEMA};
use crate::verdict::Outcome;

/// Every job of a run, and every file that could not be run.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
pub struct Summary {
    /// Version of this format: 1.
    pub schema: u32,
    /// One entry per job, in the order of the run.
    pub runs: Vec<SummaryRun>,
    /// Files that could not be run.
    pub refused: Vec<RefusedFile>,
    /// Number of results that got worse than the baseline; absent without a baseline.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub worse_than_baseline: Option<usize>,
}

/// One job.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
pub struct SummaryRun {
    /// Name of the scenario.
    pub scenario: String,
    /// Name of the planner.
    pub planner: String,
    /// Seed of planning and flight.
    pub seed: u64,
    /// The outcome of the verdict.
    pub verdict: Outcome,
    /// The reason of the verdict: smallest margins, failed checks, or why there is no plan.
    pub reason: String,
    /// Names of the deciding checks that failed or are undecided.
    pub failed: Vec<String>,
    /// Names of the advisory checks that failed or are undecided.
    pub warnings: Vec<String>,
    /// Does the planner call its plan solved although a check of the group `plan` failed?
    pub overclaimed: bool,
    /// Time at which the last vehicle reaches the end of its trajectory, s.
    pub flight_time_s: Option<f64>,
    /// Folder of the results, relative to this file.
    pub folder: String,
    /// Time that the job took, s.
    pub wall_s: f64,
    /// What got worse than the baseline, a sentence each; empty without a baseline.
    #[serde(default, skip_serializing_if = "Vec::is_empty")]
    pub losses: Vec<String>,
}

impl SummaryRun {
    /// Did the verdict pass, and is nothing worse than the baseline?
    pub fn is_good(&self) -> bool {
        self.verdict == Outcome::Pass && self.losses.is_empty()
    }
}

/// A file that could not be run.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
pub struct RefusedFile {
    /// The file.
    pub file: String,
    /// Its faults, one per line, with line and column where they are known.
    pub faults: Vec<String>,
}

impl Default for Summary {
    fn default() -> Self {
        Self { schema: SCHEMA, runs: Vec::new(), refused: Vec::new(), worse_than_baseline: None }
    }
}

impl Summary {
    /// Adds a job.
    pub fn add(&mut self, report: &Report) {
        self.runs.push(SummaryRun {
            scenario: report.scenario.clone(),
            planner: report.planner.clone(),
            seed: report.seed,
            verdict: report.verdict,
            reason: headline::reason(report),
            failed: headline::failed(report).map(|check| check.name.clone()).collect(),
            warnings: headline::warnings(report).map(|check| check.name.clone()).collect(),
            overclaimed: report.overclaimed,
            flight_time_s: report.plan.flight_time_s,
            folder: format!("{}/{}", report.scenario, report.planner),
            wall_s: report.timings.total_s(),
            losses: Vec::new(),
        });
    }

    /// Notes what got worse than the baseline.
    pub fn set_baseline(&mut self, comparison: &Comparison) {
        self.worse_than_baseline = Some(comparison.worse_results());
        for run in &mut self.runs {
            let losses = comparison.losses(&run.scenario, &run.planner);
            run.losses = losses.into_iter().map(Difference::sentence).collect();
        }
    }

    /// What got worse of a job than the baseline.
    pub fn losses(&self, report: &Report) -> &[String] {
        let run = self.runs.iter().find(|run| run.scenario == report.scenario && run.planner == report.planner);
        run.map_or(&[], |run| &run.losses)
    }

    /// Adds a file that could not be run.
    pub fn refuse(&mut self, refusal: &RejectedJob) -> &RefusedFile {
        let faults = match &refusal.error {
            Error::Load(error) => error.lines(),
            Error::Plan(error) => error.lines(),
            error => vec![error.to_string()],
        };
        self.refused.push(RefusedFile { file: refusal.file.display().to_string(), faults });
        &self.refused[self.refused.len() - 1]
    }

    /// Number of jobs with this outcome.
    pub fn count(&self, outcome: Outcome) -> usize {
        self.runs.iter().filter(|run| run.verdict == outcome).count()
    }

    /// `1 refused as bad input, 1 failed, 3 passed`: the worst first, so that the line of a run that is not good never begins
    /// with what passed. Zeros are left out.
    pub fn counts_line(&self) -> String {
        let counts = [
            (self.refused.len(), "refused as bad input"),
            (self.count(Outcome::Fail), "failed"),
            (self.count(Outcome::NoPlan), "without a plan"),
            (self.worse_than_baseline.unwrap_or(0), "worse than the baseline"),
            (self.count(Outcome::Pass), "passed"),
        ];
        let counts: Vec<String> =
            counts.into_iter().filter(|(count, _)| *count > 0).map(|(count, what)| format!("{count} {what}")).collect();
        if counts.is_empty() { "nothing was run".to_owned() } else { counts.join(", ") }
    }

    /// Did every verdict pass, without refused files and without a loss against the baseline?
    pub fn is_good(&self) -> bool {
        self.exit() == Exit::Passed
    }

    /// The exit code of the run. Bad input takes precedence over failed verdicts and losses against the baseline.
    pub fn exit(&self) -> Exit {
        if !self.refused.is_empty() {
            Exit::BadInput
        } else if self.runs.iter().any(|run| run.verdict != Outcome::Pass) || self.worse_than_baseline > Some(0) {
            Exit::Failed
        } else {
            Exit::Passed
        }
    }

    /// `summary.md`.
    ///
    /// - `reports`: of the same jobs
    pub fn markdown(&self, reports: &[Report], links: Links) -> String {
        markdown::page(self, reports, links)
    }
}

#[cfg(test)]
mod tests {
    use super::{RefusedFile, Summary, SummaryRun};
    use crate::error::Exit;
    use crate::output::report::Links;
    use crate::verdict::Outcome;

    fn run(verdict: Outcome) -> SummaryRun {
        SummaryRun {
            scenario: "pair".into(),
            planner: "by-hand".into(),
            seed: 0,
            verdict,
            reason: "a | b".into(),
            failed: Vec::new(),
            warnings: Vec::new(),
            overclaimed: false,
            flight_time_s: Some(50.0),
            folder: "pair/by-hand".into(),
            wall_s: 0.1,
            losses: Vec::new(),
        }
    }

    fn summary(verdicts: &[Outcome], refused: usize) -> Summary {
        let file = RefusedFile { file: "bad.toml".into(), faults: vec!["bad.toml:1:1: no".into()] };
        let runs = verdicts.iter().map(|verdict| run(*verdict)).collect();
        Summary { runs, refused: vec![file; refused], ..Summary::default() }
    }

    #[test]
    fn bad_input_takes_precedence_over_failures_and_failures_over_passes() {
        use Outcome::{Fail, NoPlan, Pass};
        assert_eq!(summary(&[Pass, Pass], 0).exit(), Exit::Passed);
        assert_eq!(summary(&[Pass, Fail], 0).exit(), Exit::Failed);
        assert_eq!(summary(&[Pass, NoPlan], 0).exit(), Exit::Failed);
        assert_eq!(summary(&[Pass, Fail], 1).exit(), Exit::BadInput);
        assert_eq!(summary(&[], 1).exit(), Exit::BadInput);
        let against = |worse| Summary { worse_than_baseline: Some(worse), ..summary(&[Pass, Pass], 0) };
        assert_eq!((against(0).exit(), against(1).exit()), (Exit::Passed, Exit::Failed));
        assert_eq!(
            (against(0).counts_line(), against(1).counts_line()),
            ("2 passed".into(), "1 worse than the baseline, 2 passed".into())
        );
    }

    #[test]
    fn counts_leave_out_zeros() {
        assert_eq!(summary(&[Outcome::Pass], 0).counts_line(), "1 passed");
        assert_eq!(summary(&[Outcome::Fail], 2).counts_line(), "2 refused as bad input, 1 failed");
    }

    #[test]
    fn the_page_names_every_run_and_every_fault() {
        let page = summary(&[Outcome::NoPlan], 1).markdown(&[], Links::Reports);
        assert!(
            page.contains("| NO PLAN | [pair](pair/by-hand/report.json) | by-hand | 0 | 50.000 s | a \\| b |"),
            "{page}"
        );
        assert!(page.contains("- `bad.toml:1:1: no`"), "{page}");
        let page = summary(&[Outcome::NoPlan], 0).markdown(&[], Links::Page);
        assert!(page.contains("[pair](index.html#pair/by-hand)") && page.contains("(index.html)"), "{page}");
        assert!(!summary(&[Outcome::NoPlan], 0).markdown(&[], Links::None).contains("]("));
    }

    #[test]
    fn a_run_that_is_only_worse_than_the_baseline_is_listed_before_those_that_are_good() {
        let mut summary = summary(&[Outcome::Pass, Outcome::Pass], 0);
        summary.worse_than_baseline = Some(1);
        summary.runs[1].losses = vec!["margin of flight.separation: 9 m before, 1 m now".into()];
        let page = summary.markdown(&[], Links::None);
        assert!(page.starts_with("# 1 worse than the baseline, 2 passed"), "{page}");
        let rows: Vec<&str> = page.lines().filter(|line| line.starts_with("| PASS")).collect();
        assert!(rows[0].starts_with("| PASS, worse |") && rows[0].contains("9 m before, 1 m now"), "{page}");
        assert!(rows[1].starts_with("| PASS |"), "{page}");
    }
}
