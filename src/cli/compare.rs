use std::path::PathBuf;

use clap::{Args, Subcommand};

use super::session::Format;
use crate::campaign::comparison::{self, Baseline, Entry, Scope, Snapshot};
#[cfg(feature = "parquet")]
use crate::campaign::sweep_comparison;
use crate::console;
use crate::error::{Error, Exit};
use crate::output::page;
use crate::output::report::comparison_table;
use crate::output::report::json_lines::{self, Event};
use crate::verdict::Outcome;

/// Show what got worse from one run to another
///
/// Verdicts, check statuses, margins, flight times and tracking errors are compared, numbers within a tolerance. Planning
/// times are reported but do not decide. The exit code is 1 if anything got worse by more than its tolerance.
///
/// Of two sweep.parquet, sample k of both is a pair: verdicts and margins are compared by sign tests, which find a difference
/// in two sweeps of one system with a probability of 5 % at most.
#[derive(Args, Debug)]
#[command(
    after_help = "Examples:\n  harness compare out/main out/branch\n  harness compare baseline.json out\n  harness compare out/main out/branch --html\n  harness compare old/forest/rhc/sweep.parquet new/forest/rhc/sweep.parquet"
)]
pub struct Compare {
    /// The reference: a result folder, a report.json, a baseline file or a sweep.parquet
    #[arg(value_name = "OLD")]
    old: PathBuf,
    /// The results to compare with it: a result folder, a report.json, a baseline file or a sweep.parquet
    #[arg(value_name = "NEW")]
    new: PathBuf,
    /// Write the report page NEW/index.html, with the old results beside the new ones; NEW must be a result folder
    #[arg(long)]
    html: bool,
    /// Format of standard output
    #[arg(long, value_enum, value_name = "FORMAT", default_value = "text")]
    format: Format,
}

impl Compare {
    /// Compares and prints.
    pub fn execute(&self) -> Result<Exit, Error> {
        if [&self.old, &self.new].iter().all(|path| path.extension().is_some_and(|it| it == "parquet")) {
            return self.sweeps();
        }
        let (old, new) = (Snapshot::read(&self.old)?, Snapshot::read(&self.new)?);
        let compared = comparison::compare(&old, &new, Scope::Everything);
        if self.html {
            page::write_comparison(&self.new, Some((&self.old, &compared)))?;
            page::write(&self.new)?;
        }
        match self.format {
            Format::Text => console::print(&comparison_table::text(&compared))?,
            Format::JsonLines => json_lines::print(&Event::Comparison { comparison: &compared })?,
        }
        Ok(if compared.is_good() { Exit::Passed } else { Exit::Failed })
    }
}

impl Compare {
    #[cfg(feature = "parquet")]
    fn sweeps(&self) -> Result<Exit, Error> {
        let compared = sweep_comparison::compare(&self.old, &self.new)?;
        match self.format {
            Format::Text => console::print(&sweep_comparison::text(&compared))?,
            Format::JsonLines => json_lines::print(&Event::SweepComparison { comparison: &compared })?,
        }
        Ok(if compared.has_losses() { Exit::Failed } else { Exit::Passed })
    }

    #[cfg(not(feature = "parquet"))]
    fn sweeps(&self) -> Result<Exit, Error> {
        Err(Error::results(&self.old, "this harness was built without the feature `parquet`".to_owned()))
    }
}

/// Accept results as the baseline of later runs
#[derive(Args, Debug)]
pub struct BaselineCommand {
    #[command(subcommand)]
    action: Action,
}

#[derive(Debug, Subcommand)]
enum Action {
    Accept(Accept),
}

/// Copy the results of a run into a baseline file, with the reason
///
/// The file keeps its results of scenarios that were not run, and all earlier reasons.
#[derive(Args, Debug)]
#[command(
    after_help = "Examples:\n  harness baseline accept --reason 'multiple shooting replaces the trapezoid rule'\n  \
                        harness run --baseline baseline.json"
)]
struct Accept {
    /// Result folder, or a report.json
    #[arg(value_name = "RESULTS", default_value = "out")]
    results: PathBuf,
    /// Why these results are accepted
    #[arg(long, value_name = "TEXT", value_parser = clap::builder::NonEmptyStringValueParser::new())]
    reason: String,
    /// The baseline file
    #[arg(short, long, value_name = "FILE", default_value = "baseline.json")]
    file: PathBuf,
}

impl BaselineCommand {
    /// Executes the subcommand.
    pub fn execute(&self) -> Result<Exit, Error> {
        let Action::Accept(accept) = &self.action;
        accept.execute()
    }
}

impl Accept {
    fn execute(&self) -> Result<Exit, Error> {
        let results = Snapshot::read(&self.results)?;
        let earlier = if self.file.exists() { Some(Baseline::read(&self.file)?) } else { None };
        if let Some(earlier) = &earlier {
            let compared = comparison::compare(&earlier.results, &results, Scope::NewRunOnly);
            console::print(&comparison_table::text(&compared))?;
        }
        for entry in results.entries.iter().filter(|entry| entry.verdict != Outcome::Pass) {
            let Entry { scenario, planner, verdict, .. } = entry;
            console::eprint(&format!("note: {scenario} · {planner} is accepted although its verdict is {verdict}"));
        }
        let count = results.entries.len();
        Baseline::accept(earlier, results, &self.reason).write(&self.file)?;
        let results = if count == 1 { "result" } else { "results" };
        console::print(&format!("{count} {results} accepted into {}", self.file.display()))?;
        Ok(Exit::Passed)
    }
}
