use std::path::PathBuf;

use clap::Args;

use super::sweep::ResultArgs;
use crate::campaign::monte_carlo;
use crate::error::{Error, Exit};
use crate::output;

/// Merge the partitions of a sweep
///
/// All partitions must belong to one sweep: the same scenario, planner, seed, options and version of the harness. Together
/// they must hold every sample exactly once; a missing or duplicate sample is an error.
#[derive(Args, Debug)]
#[command(after_help = EXAMPLES)]
pub struct Merge {
    /// The tables of all partitions
    #[arg(value_name = "SWEEP.PARQUET", required = true)]
    tables: Vec<PathBuf>,
    /// Folder for the results
    #[arg(short, long, value_name = "DIR", default_value = "out")]
    out: PathBuf,
    #[command(flatten)]
    results: ResultArgs,
}

const EXAMPLES: &str = "\
Examples:
  harness merge out/1/forest/rhc/sweep.parquet out/2/forest/rhc/sweep.parquet -o out/forest

Results:
  out/sweep.parquet, out/sweep.json    as `harness sweep` writes them for a whole sweep";

impl Merge {
    /// Merges, writes and prints.
    pub fn execute(&self) -> Result<Exit, Error> {
        let (sweep, samples) = monte_carlo::merge(&self.tables)?;
        output::create_folder(&self.out)?;
        self.results.finish(&sweep, &samples, &self.out, &self.out)
    }
}
