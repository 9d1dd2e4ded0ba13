use std::path::PathBuf;

use clap::Args;

use crate::console;
use crate::error::{Error, Exit};
use crate::output::page;

/// Write the report page of a result folder
///
/// The page is one file that needs neither network nor server: verdicts, scenes with a time slider, series with their
/// limits, margin budgets, comparisons, sweeps. Scenes come from scene.json, which every run writes unless its --record
/// leaves out `page`.
#[derive(Args, Debug)]
#[command(after_help = EXAMPLES)]
pub struct ReportCommand {
    /// Result folder
    #[arg(value_name = "OUT", default_value = "out")]
    out: PathBuf,
    /// Print errors only
    #[arg(short, long)]
    quiet: bool,
}

const EXAMPLES: &str = "\
Examples:
  harness report out                  writes out/index.html
  harness run --tag ci --html         writes it at the end of the run
  harness sweep SCENARIO -n 200 && harness report";

impl ReportCommand {
    /// Writes the page. The verdicts in it do not decide the exit code.
    pub fn execute(&self) -> Result<Exit, Error> {
        let path = page::write(&self.out)?;
        if !self.quiet {
            console::print(&format!("{}", path.display()))?;
        }
        Ok(Exit::Passed)
    }
}
