//! One entry of a benchmark: a planner on a scenario, in a process of its own, so that a time limit can terminate it.

use std::fs;
use std::path::{Path, PathBuf};
use std::process::{Child, Command, Stdio};
use std::time::{Duration, Instant};

use scenarios::Scenario;
use serde::Serialize;

use crate::error::Error;
use crate::interrupt::RemoveOnInterrupt;
use crate::output;
use crate::plan_source::external::group::Guard;
use crate::report::Report;

/// Polling interval of the process.
const POLL: Duration = Duration::from_millis(5);

/// Outcome of an entry.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Serialize)]
#[serde(rename_all = "kebab-case")]
pub enum Outcome {
    /// Every check passed.
    Pass,
    /// Some check failed.
    Fail,
    /// The planner found no plan.
    NoPlan,
    /// The time limit was reached.
    TimedOut,
}

impl Outcome {
    /// Its name in a table.
    pub fn name(self) -> &'static str {
        match self {
            Self::Pass => "pass",
            Self::Fail => "FAIL",
            Self::NoPlan => "no plan",
            Self::TimedOut => "timed out",
        }
    }
}

/// Result of an entry.
#[derive(Clone, Debug)]
pub struct Entry {
    /// The outcome.
    pub outcome: Outcome,
    /// The report; `None` after a timeout.
    pub report: Option<Report>,
}

/// Plans, flies and judges `scenario` with `planner`, within `limit_s` seconds.
///
/// # Errors
///
/// [`Error::Bench`] if the process cannot be started or leaves no report.
pub fn run(scenario: &Scenario, planner: &str, limit_s: f64) -> Result<Entry, Error> {
    let folder = tempfile::tempdir().map_err(|error| environment("make a temporary folder", &error))?;
    let _cleanup = RemoveOnInterrupt::new(folder.path());
    let file = folder.path().join(format!("{}.toml", scenario.name));
    output::write_file(&file, |writer| writer.write_all(scenario.to_toml().as_bytes()))?;
    let out = folder.path().join("out");
    let (mut child, guard) = start(&file, planner, &out)?;
    let has_ended = ends_within(&guard, &mut child, limit_s);
    guard.end(&mut child);
    let _ = child.wait();
    if !has_ended {
        return Ok(Entry { outcome: Outcome::TimedOut, report: None });
    }
    let path = out.join(&scenario.name).join(planner).join("report.json");
    let text = fs::read_to_string(&path).map_err(|error| environment("read the report of a benchmark", &error))?;
    let report: Report =
        serde_json::from_str(&text).map_err(|error| environment("read the report of a benchmark", &error))?;
    Ok(Entry { outcome: outcome(&report), report: Some(report) })
}

fn start(file: &Path, planner: &str, out: &Path) -> Result<(Child, Guard), Error> {
    let program = this_program().map_err(|error| environment("find this program", &error))?;
    let mut command = Command::new(program);
    command.arg("run").arg(file).args(["--planner", planner, "--record", "none", "--quiet", "--out"]).arg(out);
    command.stdin(Stdio::null()).stdout(Stdio::null()).stderr(Stdio::null());
    Guard::start(&mut command).map_err(|error| environment("start this program once more", &error))
}

/// Waits for the end of the process. Returns false after `limit_s` seconds.
fn ends_within(guard: &Guard, child: &mut Child, limit_s: f64) -> bool {
    let started = Instant::now();
    while !guard.has_exited(child) {
        if started.elapsed().as_secs_f64() >= limit_s {
            return false;
        }
        std::thread::sleep(POLL);
    }
    true
}

fn outcome(report: &Report) -> Outcome {
    match report.verdict {
        crate::verdict::Outcome::Pass => Outcome::Pass,
        crate::verdict::Outcome::Fail => Outcome::Fail,
        crate::verdict::Outcome::NoPlan => Outcome::NoPlan,
    }
}

fn environment(what: &str, error: &dyn std::fmt::Display) -> Error {
    Error::Bench { what: what.to_owned(), reason: error.to_string() }
}

/// What to start for an entry: this program, or what `HARNESS_PROGRAM` names where the program is part of another one.
fn this_program() -> std::io::Result<PathBuf> {
    std::env::var_os("HARNESS_PROGRAM").map_or_else(std::env::current_exe, |program| Ok(program.into()))
}
