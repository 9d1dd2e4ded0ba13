//! Errors and exit codes.
//!
//! Findings about a plan (no plan, a failed check, a crash) are not errors but data in a verdict. A bug is a panic, which
//! ends the process with exit code 101. The errors of this module are bad input and failures of the environment.

use std::path::{Path, PathBuf};
use std::process::ExitCode;

use miette::Diagnostic;
use scenarios::plan_input::PlanError;
use scenarios::{FindError, Issue, LoadError};
use thiserror::Error;

use crate::campaign::generate::GenerateError;

/// Result of a command that was carried out.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Exit {
    /// Every verdict passed, or there was none.
    Passed,
    /// A verdict failed, no plan was found, or something got worse than the baseline.
    Failed,
    /// Some input was invalid; the rest was carried out.
    BadInput,
}

impl Exit {
    /// The exit code of the process: 0, 1 or 2.
    pub fn code(self) -> u8 {
        match self {
            Self::Passed => 0,
            Self::Failed => 1,
            Self::BadInput => 2,
        }
    }
}

impl From<Exit> for ExitCode {
    fn from(exit: Exit) -> Self {
        exit.code().into()
    }
}

/// Why a command could not be carried out: bad usage, bad input, or the environment.
#[derive(Debug, Error, Diagnostic)]
pub enum Error {
    /// Scenario files could not be listed.
    #[error(transparent)]
    #[diagnostic(transparent)]
    Find(#[from] FindError),
    /// A file is not a valid scenario, or not one for the planner that it names.
    #[error(transparent)]
    #[diagnostic(transparent)]
    Load(#[from] LoadError),
    /// A file is not a valid plan for its scenario.
    #[error(transparent)]
    #[diagnostic(transparent)]
    Plan(#[from] PlanError),
    /// A log of ROS 2 or PX4 cannot be read.
    #[cfg(feature = "mcap")]
    #[error(transparent)]
    #[diagnostic(transparent)]
    Log(#[from] crate::plan_source::logs::LogError),
    /// An MCAP file, but the feature `mcap` is off.
    #[error("{}: this harness was built without MCAP support", path.display())]
    #[diagnostic(help("build it with `--features mcap` (on by default), or convert the file to CSV"))]
    McapNotBuilt {
        /// The file.
        path: PathBuf,
    },
    /// Tags and names match no scenario.
    #[error("no scenario matches {options}")]
    #[diagnostic(help("`harness list` shows names and tags"))]
    NothingSelected {
        /// What was given.
        options: String,
    },
    /// `--planner-command` is not a command.
    #[error("--planner-command: found `{command}`, expected a program and its arguments, quoted as in a shell")]
    PlannerCommand {
        /// What was given.
        command: String,
    },
    /// An in-loop command was given vehicles that are not planned for in the loop.
    #[error("{file}: {planner} is to plan in the loop, which is only for multirotors")]
    #[diagnostic(help(
        "leave out `--in-loop`, or `in_loop = true` in the scenario: the command then plans once, before the flight"
    ))]
    NotInTheLoop {
        /// The scenario file.
        file: String,
        /// The planner.
        planner: String,
    },
    /// A file that would be written exists already.
    #[error("{}: the file exists already", path.display())]
    #[diagnostic(help("give another name, or remove it"))]
    FileExists {
        /// The file.
        path: PathBuf,
    },
    /// `harness plan` was given several planners.
    #[error("one planner makes one plan: --planner was given more than once")]
    OnePlanner,
    /// `harness plan` was given an in-loop planner.
    #[error("{planner} plans in the loop: there is no plan before the flight")]
    #[diagnostic(help("`harness run` flies it, and writes what it followed as plan.json and plan.csv"))]
    PlansInTheLoop {
        /// The planner.
        planner: String,
    },
    /// `harness plan --output` has an unknown extension.
    #[error("{}: a plan is written as .json or .csv", path.display())]
    #[diagnostic(help("`-o plan.csv`, or `-o -` for JSON on standard output"))]
    PlanForm {
        /// The file.
        path: PathBuf,
    },
    /// Results of an earlier run cannot be read.
    #[error("{}: {reason}", path.display())]
    #[diagnostic(help(
        "expected a folder that `harness run` wrote (`out`), a report.json, or a file of `harness baseline accept`"
    ))]
    Results {
        /// The file or folder.
        path: PathBuf,
        /// Why.
        reason: String,
    },
    /// A file is not a table of samples, or does not match the others.
    #[error("{}: {reason}", path.display())]
    #[diagnostic(help("expected the sweep.parquet of every partition of one `harness sweep`, with the same options"))]
    Samples {
        /// The file.
        path: PathBuf,
        /// Why.
        reason: String,
    },
    /// `--planner` names an unknown planner.
    #[error("--planner {name}: there is no planner of that name, expected one of {known}")]
    #[diagnostic(help("{remedy}"))]
    UnknownPlanner {
        /// What was given.
        name: String,
        /// The known planners.
        known: String,
        /// The closest known name.
        remedy: String,
    },
    /// A planner from the command line cannot handle a scenario.
    #[error("{file}: planner `{planner}` cannot handle this scenario: {reason}")]
    #[diagnostic(help("`harness list` shows what each planner handles"))]
    Unfit {
        /// The scenario's file.
        file: String,
        /// The planner.
        planner: &'static str,
        /// Why.
        reason: String,
    },
    /// A field of the command line is not in the file.
    #[error("{}: {field}: there is no such number in the file", file.display())]
    #[diagnostic(help(
        "give the field in the file, or correct its path; elements of lists go by index or by name: \
        world.cylinders[0].radius_m, world.cylinders.tree-1.radius_m"
    ))]
    NoNumber {
        /// The scenario's file.
        file: PathBuf,
        /// The field.
        field: String,
    },
    /// A check is asked for that no verdict of the scenario has.
    #[error("{}: no check `{check}` in its verdict", file.display())]
    #[diagnostic(help("{}", closest.as_ref().map_or_else(
        || "docs/verdict.md lists the checks; those of requirements are flight.requirement.NAME and plan.requirement.NAME".to_owned(),
        |name| format!("did you mean `{name}`?")
    )))]
    NoSuchCheck {
        /// The scenario's file.
        file: PathBuf,
        /// The check.
        check: String,
        /// The most similar one.
        closest: Option<String>,
    },
    /// A search has judged no flight.
    #[error("{}: nothing was judged: {why}", file.display())]
    #[diagnostic(help(
        "narrow the ranges of --vary to scenarios that are valid and that the planner solves, or ask for another check"
    ))]
    NothingJudged {
        /// The scenario's file.
        file: PathBuf,
        /// What became of the candidates.
        why: String,
    },
    /// A comparison was given one system.
    #[error("found one planner and one scenario, expected two systems to compare")]
    #[diagnostic(help("name the other planner with `-p`, or give a second scenario file with another [planner]"))]
    OneSystem,
    /// A comparison was given more than two systems.
    #[error("found {count} planners, expected two systems to compare")]
    #[diagnostic(help("compare them pair by pair"))]
    TooManySystems {
        /// Their number.
        count: usize,
    },
    /// A disturbance from the command line cannot act on the vehicles.
    #[error("{}: {option} has no effect: found {}, expected {}", file.display(), issue.found, issue.expected)]
    #[diagnostic(help("add the drag area to the model, or vary another disturbance"))]
    NoEffect {
        /// The scenario's file.
        file: PathBuf,
        /// The option.
        option: &'static str,
        /// Why.
        issue: Box<Issue>,
    },
    /// `--record` names a format that this build lacks.
    #[error("--record {format}: this harness was built without the {what}")]
    #[diagnostic(help("build it with `--features {format}` (on by default), or ask for `--record none`"))]
    RecordingNotBuilt {
        /// The format, as on the command line.
        format: &'static str,
        /// What it is.
        what: &'static str,
    },
    /// The worker threads could not be started.
    #[error("--jobs {jobs}: cannot start the worker threads: {reason}")]
    Threads {
        /// Their number.
        jobs: usize,
        /// Why.
        reason: String,
    },
    /// A scenario cannot be generated.
    #[error(transparent)]
    #[diagnostic(transparent)]
    Generate(#[from] GenerateError),
    /// `harness generate` was given a kind and `--kind`.
    #[error("--kind {second}: `{first}` is a kind already, and --kind selects kinds of a family")]
    #[diagnostic(help("`harness generate {first}`, or name the family and both kinds with --kind"))]
    KindTwice {
        /// The positional argument.
        first: &'static str,
        /// The option.
        second: String,
    },
    /// Several scenarios were to be written to one file or to standard output.
    #[error("--output {}: {count} scenarios do not fit into one file", path.display())]
    #[diagnostic(help("name a folder, or one kind and `--count 1`"))]
    OneScenario {
        /// The file, or `-`.
        path: PathBuf,
        /// Their number.
        count: usize,
    },
    /// An option of another benchmark was given.
    #[error("{found} does not belong to this benchmark")]
    #[diagnostic(help("`harness bench --help` lists the options of `suite`; PATH is for the other benchmarks"))]
    BenchOption {
        /// What was given.
        found: String,
    },
    /// A benchmark could not be run.
    #[error("cannot {what}: {reason}")]
    #[diagnostic(help("`harness bench` starts this program again for every entry, in a temporary folder"))]
    Bench {
        /// What was attempted.
        what: String,
        /// Why.
        reason: String,
    },
    /// A result could not be written.
    #[error("cannot write {}: {reason}", path.display())]
    #[diagnostic(help("check free space and write permission, or choose another folder with `--out`"))]
    Write {
        /// The file or folder.
        path: PathBuf,
        /// The error of the operating system or of the library that writes the file.
        reason: Box<dyn std::error::Error + Send + Sync>,
    },
    /// Standard output cannot be written to.
    #[error("cannot write to standard output")]
    Output(#[from] std::io::Error),
}

impl Error {
    /// Results of an earlier run that cannot be read.
    pub(crate) fn results(path: &Path, reason: String) -> Self {
        Self::Results { path: path.to_owned(), reason }
    }
}
