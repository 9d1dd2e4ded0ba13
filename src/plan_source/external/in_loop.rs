//! An external in-loop planner: one JSON request per line on its standard input, one JSON reply per line on its standard
//! output, until the flight ends.
//!
//! ```text
//! {"request": "begin", scenario ...}                                no reply
//! {"request": "replan", "id": 1, "vehicle": ..., observation ...}   {"id": 1, "fly": [nodes]} or {"id": 1, "keep": reason}
//! {"request": "end"}, then end of file                              no reply; the program ends
//! ```

pub(super) mod message;
mod session;

use std::sync::{Arc, Mutex, PoisonError};

use scenarios::Scenario;
use scenarios::in_loop::{InLoopPlanner, Observation, PlannerRemarks, ReplanResult};
use serde_json::json;

use self::message::ReplanRequest;
use self::session::Session;
use super::{ExternalPlanner, request};

/// Default time limit of a reply, s.
const DEFAULT_TIME_LIMIT_S: f64 = 10.0;

/// A running external in-loop planner.
pub struct ExternalSession {
    /// One planner per vehicle; all share the same process.
    pub planners: Vec<Box<dyn InLoopPlanner>>,
    /// The process.
    session: Arc<Mutex<Session>>,
}

impl ExternalSession {
    /// Starts the command. If it cannot be started, every result holds the reason.
    pub fn start(planner: &ExternalPlanner, scenario: &Scenario, seed: u64) -> Self {
        let time_limit_s = planner.time_limit_s.unwrap_or(DEFAULT_TIME_LIMIT_S);
        let session = Session::start(planner, time_limit_s);
        let mut begin = request::document(scenario, seed, time_limit_s);
        begin["request"] = "begin".into();
        begin["planning"] = json!({
            "period_s": scenario.simulation.planning.period_s,
            "deadline_s": scenario.simulation.planning.deadline_s,
        });
        session.send(message::line(&begin));
        let session = Arc::new(Mutex::new(session));
        let planner = |vehicle: &scenarios::Vehicle| -> Box<dyn InLoopPlanner> {
            Box::new(ExternalInLoopPlanner { vehicle: vehicle.name.clone(), session: Arc::clone(&session) })
        };
        Self { planners: scenario.vehicles.iter().map(planner).collect(), session }
    }

    /// Returns a function that terminates the command and returns its standard error.
    pub fn log(&self) -> impl FnOnce() -> String + use<> {
        let session = Arc::clone(&self.session);
        move || session.lock().unwrap_or_else(PoisonError::into_inner).log()
    }
}

/// The in-loop planner of one vehicle.
struct ExternalInLoopPlanner {
    vehicle: String,
    session: Arc<Mutex<Session>>,
}

impl InLoopPlanner for ExternalInLoopPlanner {
    fn replan(&mut self, observation: &Observation<'_>) -> ReplanResult {
        let mut session = self.session.lock().unwrap_or_else(PoisonError::into_inner);
        let replies_have_ids = session.replies_have_ids();
        session
            .request(|id| message::line(&ReplanRequest::new(id, &self.vehicle, observation, !replies_have_ids)))
            .unwrap_or_else(|fault| ReplanResult::failed(fault.to_string()))
    }

    fn finish(&mut self) -> PlannerRemarks {
        self.session.lock().unwrap_or_else(PoisonError::into_inner).finish()
    }
}

#[cfg(all(test, unix))]
mod tests;
