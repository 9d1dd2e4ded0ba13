use std::path::PathBuf;

use clap::Args;

use super::sweep::Shown;
use crate::campaign::monte_carlo;
use crate::error::{Error, Exit};
use crate::output;

/// Put the parts of a sweep together that several machines have flown.
///
/// The parts must be of one sweep (scenario, planner, seed, options and version of the harness), and hold every sample
/// once: a sample that is missing is an error, so that nothing is taken for passed that nobody has flown.
#[derive(Args, Debug)]
#[command(after_help = EXAMPLES)]
pub struct Merge {
    /// The tables of all parts
    #[arg(value_name = "SWEEP.PARQUET", required = true)]
    tables: Vec<PathBuf>,
    /// Folder for the results
    #[arg(short, long, value_name = "DIR", default_value = "out")]
    out: PathBuf,
    #[command(flatten)]
    shown: Shown,
}

const EXAMPLES: &str = "\
Examples:
  harness merge out/1/forest/rhc/sweep.parquet out/2/forest/rhc/sweep.parquet -o out/forest

Results:
  out/sweep.parquet, out/sweep.json    as `harness sweep` writes them";

impl Merge {
    /// Reads, writes and prints.
    pub fn execute(&self) -> Result<Exit, Error> {
        let (sweep, samples) = monte_carlo::merge(&self.tables)?;
        output::create_folder(&self.out)?;
        self.shown.finish(&sweep, &samples, &self.out)
    }
}
