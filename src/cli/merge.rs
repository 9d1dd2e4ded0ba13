mod results;

use std::path::PathBuf;

use clap::Args;

use super::sweep::ResultArgs;
use crate::campaign::monte_carlo;
use crate::error::{Error, Exit};
use crate::output;

/// Merge the partitions of a sweep, or the result folders of several machines
///
/// Result folders: the results of all of them are copied into one folder, with one summary, one junit.xml and, with --html,
/// one page. Each pair of scenario and planner may occur in one of them only. The exit code is that of one run of all of them.
///
/// Partitions: all of them must belong to one sweep: the same scenario, planner, seed, options and version of the harness. Together
/// they must hold every sample exactly once; a missing or duplicate sample is an error.
#[derive(Args, Debug)]
#[command(after_help = EXAMPLES)]
pub struct Merge {
    /// The tables of all partitions, or result folders
    #[arg(value_name = "SWEEP.PARQUET|DIR", required = true)]
    inputs: Vec<PathBuf>,
    /// Folder for the results
    #[arg(short, long, value_name = "DIR", default_value = "out")]
    out: PathBuf,
    #[command(flatten)]
    results: ResultArgs,
}

const EXAMPLES: &str = "\
Examples:
  harness merge out/1/forest/rhc/sweep.parquet out/2/forest/rhc/sweep.parquet -o out/forest
  harness merge out/machine-1 out/machine-2 -o out/all --html

Results:
  out/sweep.parquet, out/sweep.json    as `harness sweep` writes them for a whole sweep";

impl Merge {
    /// Merges, writes and prints.
    pub fn execute(&self) -> Result<Exit, Error> {
        if self.inputs.iter().all(|input| input.is_dir()) {
            return results::merge(&self.inputs, &self.out, self.results.html, self.results.quiet);
        }
        let (sweep, samples) = monte_carlo::merge(&self.inputs)?;
        output::create_folder(&self.out)?;
        self.results.finish(&sweep, &samples, &self.out, &self.out)
    }
}
