//! What may be wrong with an external planner.

use std::io;
use std::process::ExitStatus;
use std::time::Duration;

use thiserror::Error;

use super::PROTOCOL;

/// Why a command has not replied as the protocol demands. Each is a finding about that planner, in the words that follow
/// its name: "it ended with exit code 3".
#[derive(Clone, Debug, PartialEq, Error)]
pub enum PlannerFault {
    /// The program does not exist, or may not be run.
    #[error("cannot start `{command}`: {reason}")]
    CannotStart {
        /// The command as given.
        command: String,
        /// What the operating system says.
        reason: String,
    },
    /// It did not reply in time.
    #[error("it took longer than its limit of {} s and was terminated", .0.as_secs_f64())]
    TimedOut(Duration),
    /// It ended without success.
    #[error("{}", ending(*.0))]
    Ended(ExitStatus),
    /// It runs no longer, and nothing is known of its end.
    #[error("its exit status is unknown: {0}")]
    UnknownStatus(String),
    /// It closed its standard output, and went on.
    #[error("it closed its standard output")]
    Silent,
    /// The flight is over, so that nothing is asked of it.
    #[error("the flight is over")]
    FlightOver,
    /// A failure, beside which its standard error says more.
    #[error("{fault}; the last line in planner.log: {line}")]
    Logged {
        /// The failure.
        fault: Box<PlannerFault>,
        /// Its last line, shortened, which usually names the exception.
        line: String,
    },
    /// All of its output is too long, MiB.
    #[error("it wrote more than {0} MiB")]
    LongOutput(u64),
    /// One line of its output is too long, MiB.
    #[error("it wrote a line of {0} MiB")]
    LongLine(u64),
    /// Its output is not text.
    #[error("its reply is not valid UTF-8")]
    NotText,
    /// It succeeded and wrote nothing.
    #[error("it wrote no reply to its standard output")]
    NoReply,
    /// It wrote something else than a JSON object.
    #[error("its reply is no JSON object")]
    NoObject,
    /// The reply does not say in which protocol it is.
    #[error("its reply has no `protocol`; expected {PROTOCOL}")]
    NoProtocol,
    /// The reply is in a protocol that is not known.
    #[error("its reply has protocol version {0}; expected {PROTOCOL}")]
    UnknownProtocol(serde_json::Value),
    /// The reply does not say whether there is a plan.
    #[error("its reply has no `status`; expected \"solved\", \"not-converged\" or \"no-plan\"")]
    NoStatus,
    /// The plan in the reply is not valid, which the text says with fields.
    #[error("{0}")]
    InvalidPlan(String),
    /// The reply of an in-loop planner is not valid.
    #[error("its reply is invalid: {0}")]
    InvalidReply(String),
    /// A reply without a request.
    #[error("it replied before it was asked")]
    Unasked,
    /// The reply to another request.
    #[error("its reply has the id {found}, and the request has {expected}")]
    WrongId {
        /// The id in the reply.
        found: u64,
        /// The id of the request.
        expected: u64,
    },
    /// A reply without an id, after others that had one.
    #[error("its reply has no id, and the request has {0}")]
    NoId(u64),
    /// An invalid reply without an id, after which no reply can be matched with its request.
    #[error("{0}; without an `id` the replies after it cannot be matched")]
    Unmatched(Box<PlannerFault>),
}

impl PlannerFault {
    pub(super) fn cannot_start(command: &[String], error: &io::Error) -> Self {
        Self::CannotStart { command: command.join(" "), reason: error.to_string() }
    }

    /// The fault with the last line of the log, if there is one.
    pub(super) fn with_last_line_of(self, log: &str) -> Self {
        match log.lines().rev().map(str::trim).find(|line| !line.is_empty()) {
            Some(line) => Self::Logged { fault: Box::new(self), line: line.chars().take(200).collect() },
            None => self,
        }
    }
}

/// How a command ended, in words.
pub(super) fn ending(status: ExitStatus) -> String {
    match status.code() {
        Some(code) => format!("it ended with exit code {code}"),
        None => format!("it crashed ({status})"),
    }
}
