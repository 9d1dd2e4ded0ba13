use std::path::PathBuf;

use clap::{Args, Subcommand};

use super::session::Format;
use crate::campaign::comparison::{self, Baseline, Scope, Snapshot};
use crate::console;
use crate::error::{Error, Exit};
use crate::output::report::comparison_table;
use crate::output::report::json_lines::{self, Event};

/// Show what got worse from one run to another.
///
/// Verdicts, statuses of checks, margins, flight times and tracking errors decide, each with a tolerance; planning times
/// are only told. Exit code 1 if anything got worse beyond its tolerance.
#[derive(Args, Debug)]
#[command(after_help = "Examples:\n  harness compare out/main out/branch\n  harness compare baseline.json out")]
pub struct Compare {
    /// Result folder, report.json or baseline file to compare with
    #[arg(value_name = "OLD")]
    old: PathBuf,
    /// Result folder, report.json or baseline file that is compared
    #[arg(value_name = "NEW")]
    new: PathBuf,
    /// What to print on standard output
    #[arg(long, value_enum, value_name = "FORMAT", default_value = "text")]
    format: Format,
}

impl Compare {
    /// Compares and prints.
    pub fn execute(&self) -> Result<Exit, Error> {
        let (old, new) = (Snapshot::read(&self.old)?, Snapshot::read(&self.new)?);
        let compared = comparison::compare(&old, &new, Scope::Everything);
        match self.format {
            Format::Text => console::print(&comparison_table::text(&compared))?,
            Format::JsonLines => json_lines::print(&Event::Comparison { comparison: &compared })?,
        }
        Ok(if compared.is_good() { Exit::Passed } else { Exit::Failed })
    }
}

/// Keep a run as the one to compare later ones with.
#[derive(Args, Debug)]
pub struct BaselineCommand {
    #[command(subcommand)]
    action: Action,
}

#[derive(Debug, Subcommand)]
enum Action {
    Accept(Accept),
}

/// Take the results of a run into a baseline file, with the reason why they are right.
///
/// Results of scenarios that were not run stay as they are in the file, and so do earlier reasons.
#[derive(Args, Debug)]
#[command(after_help = "Examples:\n  harness baseline accept --reason 'shooting instead of trapezoid'\n  \
                        harness run --baseline baseline.json")]
struct Accept {
    /// Result folder, or a report.json
    #[arg(value_name = "RESULTS", default_value = "out")]
    results: PathBuf,
    /// Why these results are right
    #[arg(long, value_name = "TEXT", value_parser = clap::builder::NonEmptyStringValueParser::new())]
    reason: String,
    /// The baseline file
    #[arg(short, long, value_name = "FILE", default_value = "baseline.json")]
    file: PathBuf,
}

impl BaselineCommand {
    /// Does what was asked.
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
        let count = results.entries.len();
        Baseline::accept(earlier, results, &self.reason).write(&self.file)?;
        let results = if count == 1 { "result" } else { "results" };
        console::print(&format!("{count} {results} accepted into {}", self.file.display()))?;
        Ok(Exit::Passed)
    }
}
