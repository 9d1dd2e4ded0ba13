use std::path::PathBuf;

use clap::Args;

use crate::campaign::selftest;
use crate::console;
use crate::error::{Error, Exit};
use crate::output;

/// Show that the judge notices: known faults are injected into good flights, and every one has to fail.
///
/// Shipped scenarios of every family are planned and flown; then one thing at a time is made wrong in the plan, in the log
/// of the flight, or in the limits, and the same judge judges again. Near misses, just inside a limit, have to pass. The
/// exit code is 1 if a fault passes, a near miss fails, or a check is turned red by no fault at all.
#[derive(Args, Debug)]
#[command(after_help = EXAMPLES)]
pub struct SelftestCommand {
    /// Folder for the results
    #[arg(short, long, value_name = "DIR", default_value = "out")]
    out: PathBuf,
    /// Print nothing but errors; the exit code and the files tell the rest
    #[arg(short, long)]
    quiet: bool,
}

const EXAMPLES: &str = "\
Examples:
  harness selftest             takes some ten seconds
  harness selftest -q -o out   in continuous integration

Results:
  out/selftest.json    every fault with the checks that it turned red
  out/selftest.md      the same as a page";

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
