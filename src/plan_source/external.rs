//! External planners: a command that reads a request from its standard input and writes a reply to its standard output.
//!
//! ```text
//! Scenario -> request (JSON) -> | stdin  command  stdout | -> reply (JSON) -> Plan
//!                                        stderr -> planner.log
//! ```
//!
//! Whatever the command does, the result is a plan, or no plan with a reason: a crash, a timeout and an invalid reply are
//! findings about that planner.

mod fault;
pub(crate) mod group;
mod in_loop;
mod process;
pub mod protocol;
mod reply;
pub(crate) mod request;

use std::path::PathBuf;
use std::time::Duration;

use scenarios::{Plan, PlanTimings, Scenario};

pub use self::fault::PlannerFault;
use self::in_loop::ExternalSession;
use crate::plan_source::plan_import::CompletedPlan;
use crate::plan_source::{Guidance, PlannerOutput};

/// Version of the protocol. Replies of version 1 are read as well.
pub const PROTOCOL: u64 = 2;
/// Oldest version of replies that are read.
const OLDEST_PROTOCOL: u64 = 1;
/// Default time limit of a plan, s.
pub const DEFAULT_TIME_LIMIT_S: f64 = 60.0;

/// A command that plans.
#[derive(Clone, Debug)]
pub struct ExternalPlanner {
    /// Name under which its results go.
    pub name: String,
    /// Program and arguments.
    pub command: Vec<String>,
    /// Working directory of the command.
    pub folder: PathBuf,
    /// Time limit, s. [default: 60; for in-loop planners 10 per reply]
    pub time_limit_s: Option<f64>,
    /// Whether it plans in the loop.
    pub in_loop: bool,
}

/// What a command returned.
struct ExternalAnswer {
    /// A plan, or the reason why there is none.
    answer: CompletedPlan,
    /// Standard error.
    log: String,
}

impl ExternalPlanner {
    /// Requests a plan, or starts the command as an in-loop planner.
    pub(super) fn prepare(&self, planner_view: &Scenario, seed: u64) -> PlannerOutput {
        if self.in_loop {
            let session = ExternalSession::start(self, planner_view, seed);
            let log = session.log();
            let guidance = Guidance::InLoop { planner: self.name.clone(), planners: session.planners };
            PlannerOutput { guidance, log: Some(Box::new(log)) }
        } else {
            let ExternalAnswer { answer, log } = self.plan(planner_view, seed);
            PlannerOutput { guidance: Guidance::Plan(Box::new(answer)), log: Some(Box::new(|| log)) }
        }
    }

    /// Requests a plan, and waits until the time limit.
    fn plan(&self, scenario: &Scenario, seed: u64) -> ExternalAnswer {
        let time_limit_s = self.time_limit_s.unwrap_or(DEFAULT_TIME_LIMIT_S);
        let request = request::document(scenario, seed, time_limit_s);
        let time_limit = Duration::try_from_secs_f64(time_limit_s).unwrap_or(Duration::MAX);
        let ended = process::run(&self.command, &self.folder, request.to_string().into_bytes(), time_limit);
        let wall_s = ended.wall.as_secs_f64();
        let answer = ended.output.and_then(|text| reply::read(&text, scenario, &self.name, seed));
        let mut answer = answer.unwrap_or_else(|fault| CompletedPlan::whole(self.no_plan(scenario, seed, &fault)));
        if answer.plan.timings == PlanTimings::default() {
            answer.plan.timings.wall_s = wall_s;
        }
        ExternalAnswer { answer, log: ended.log }
    }

    fn no_plan(&self, scenario: &Scenario, seed: u64, fault: &PlannerFault) -> Plan {
        Plan::no_plan(&scenario.name, &self.name, seed, fault.to_string())
    }
}

#[cfg(all(test, unix))]
mod tests;
