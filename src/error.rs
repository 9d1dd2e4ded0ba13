//! Every way in which a run can end, and its exit code.
//!
//! Findings about a plan (no plan, a failed check, a crash) are no errors: they are data in a verdict. A bug is a panic,
//! which ends the process with 101. What is left is bad input and trouble with the environment: the errors of this file.

use std::path::{Path, PathBuf};
use std::process::ExitCode;

use miette::Diagnostic;
use scenarios::plan_input::PlanError;
use scenarios::{FindError, LoadError};
use thiserror::Error;

/// How a command ended that did what it was asked to do.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Exit {
    /// Every verdict passed, or there was none to make.
    Passed,
    /// Some verdict failed, or no plan was found.
    Failed,
    /// Some input could not be used; the rest was done all the same.
    BadInput,
}

impl Exit {
    /// The process's exit code: 0, 1 or 2.
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

/// Why a command could not do what it was asked to do: bad usage, bad input, or the environment.
#[derive(Debug, Error, Diagnostic)]
pub enum Error {
    /// No list of scenario files could be made.
    #[error(transparent)]
    #[diagnostic(transparent)]
    Find(#[from] FindError),
    /// A file is no scenario, or not one for the planner that it names.
    #[error(transparent)]
    #[diagnostic(transparent)]
    Load(#[from] LoadError),
    /// A file is no plan for its scenario.
    #[error(transparent)]
    #[diagnostic(transparent)]
    Plan(#[from] PlanError),
    /// Tags and names leave nothing over.
    #[error("no scenario matches {options}")]
    #[diagnostic(help("`harness list` shows names and tags"))]
    NothingSelected {
        /// What was asked for.
        options: String,
    },
    /// `--planner-command` is no command.
    #[error("--planner-command: found `{command}`, expected a program and its arguments, quoted as in a shell")]
    PlannerCommand {
        /// What was given.
        command: String,
    },
    /// `harness plan` with several planners.
    #[error("one planner makes one plan: --planner was given more than once")]
    OnePlanner,
    /// `harness plan` with a planner that plans in the loop.
    #[error("{planner} plans in the loop: there is no plan before the flight")]
    #[diagnostic(help("`harness run` flies it, and writes what it followed as plan.json and plan.csv"))]
    PlansInTheLoop {
        /// The planner.
        planner: String,
    },
    /// `harness plan --output` with an unknown ending.
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
        /// What is wrong with it.
        reason: String,
    },
    /// A file is no table of samples, or not one that fits the others.
    #[error("{}: {reason}", path.display())]
    #[diagnostic(help("expected the sweep.parquet of every partition of one `harness sweep`, with the same options"))]
    Samples {
        /// The file.
        path: PathBuf,
        /// What is wrong with it.
        reason: String,
    },
    /// `--planner` names none.
    #[error("--planner {name}: there is no planner of that name, expected one of {known}")]
    #[diagnostic(help("{remedy}"))]
    UnknownPlanner {
        /// What was asked for.
        name: String,
        /// What there is.
        known: String,
        /// What may have been meant.
        remedy: String,
    },
    /// A planner that was asked for on the command line cannot handle a scenario.
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
    /// `--record` with a format that was left out of this build.
    #[error("--record {format}: this harness was built without the {what}")]
    #[diagnostic(help("build it with `--features {format}` (on by default), or ask for `--record none`"))]
    RecordingNotBuilt {
        /// As on the command line.
        format: &'static str,
        /// In words.
        what: &'static str,
    },
    /// The worker threads could not be started.
    #[error("--jobs {jobs}: cannot start the worker threads: {reason}")]
    Threads {
        /// How many.
        jobs: usize,
        /// What stood in the way.
        reason: String,
    },
    /// A benchmark could not be run.
    #[error("cannot {what}: {reason}")]
    #[diagnostic(help("`harness bench` starts this program once more for every entry, in a temporary folder"))]
    Bench {
        /// What was tried.
        what: String,
        /// What stood in the way.
        reason: String,
    },
    /// A result could not be written.
    #[error("cannot write {}: {reason}", path.display())]
    #[diagnostic(help("is there space left, and may you write there? `--out` chooses another folder"))]
    Write {
        /// The file or folder.
        path: PathBuf,
        /// What the operating system says, or the library that writes the file.
        reason: Box<dyn std::error::Error + Send + Sync>,
    },
    /// Standard output is gone.
    #[error("cannot write to standard output")]
    Output(#[from] std::io::Error),
}

impl Error {
    /// Results of an earlier run that cannot be read.
    pub(crate) fn results(path: &Path, reason: String) -> Self {
        Self::Results { path: path.to_owned(), reason }
    }
}
