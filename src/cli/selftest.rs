use std::path::PathBuf;

use clap::Args;

use crate::campaign::selftest;
use crate::console;
use crate::error::{Error, Exit};
use crate::output;

/// Test the judge: inject known faults into flights that pass
///
/// Shipped scenarios of every vehicle family are planned and flown. Then one fault at a time is injected into the plan, the
/// flight log or the limits, and the result is judged again: the check that the fault violates must fail. Near misses, just
/// inside a limit, must pass. The exit code is 1 if a fault is missed, a near miss fails, or no fault violates some check.
#[derive(Args, Debug)]
#[command(after_help = EXAMPLES)]
pub struct SelftestCommand {
    /// Folder for the results
    #[arg(short, long, value_name = "DIR", default_value = "out")]
    out: PathBuf,
    /// Print errors only
    #[arg(short, long)]
    quiet: bool,
}

const EXAMPLES: &str = "\
Examples:
  harness selftest             takes about ten seconds
  harness selftest -q -o out   for continuous integration

Results:
  out/selftest.json    every fault with the checks that failed
  out/selftest.md      the same as a page in Markdown";

impl SelftestCommand {
    /// Injects, prints and writes.
    pub fn execute(&self) -> Result<Exit, Error> {
        let selftest = selftest::run(&mut |stage| {
            if !self.quiet {
                console::eprint(stage);
            }
        });
        output::create_folder(&self.out)?;
        output::write_json(&self.out.join("selftest.json"), &selftest)?;
        let page = selftest::markdown(&selftest);
        output::write_file(&self.out.join("selftest.md"), |writer| write!(writer, "{page}"))?;
        if !self.quiet {
            console::print(&selftest::text(&selftest))?;
        }
        Ok(if selftest.is_good() { Exit::Passed } else { Exit::Failed })
    }
}
