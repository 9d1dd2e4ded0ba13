//! The protocol of external planners, for those who reach a planner in another way than by a command: the Python package
//! calls a function or an object with the same requests, and reads the same replies.

use scenarios::Scenario;
use scenarios::in_loop::{Observation, ReplanResult};
use serde_json::Value;

use super::in_loop::message::{Line, ReplanRequest};
use super::{PlannerFault, reply, request};
use crate::plan_source::plan_import::CompletedPlan;

/// The request for a plan, which holds what is known before the flight.
///
/// - `time_limit_s`: what the planner is told, s
pub fn plan_request(scenario: &Scenario, seed: u64, time_limit_s: f64) -> Value {
    request::document(&scenario.planner_view(), seed, time_limit_s)
}

/// Reads the reply to [`plan_request`], JSON.
///
/// - `planner`: name under which the results go
///
/// # Errors
///
/// Why the reply is invalid; its text is one line.
pub fn read_plan(text: &str, scenario: &Scenario, planner: &str, seed: u64) -> Result<CompletedPlan, PlannerFault> {
    reply::read(text, &scenario.planner_view(), planner, seed)
}

/// The request for a new reference of a vehicle during the flight, JSON, with all obstacles known so far.
///
/// - `id`: number of the request
pub fn replan_request(id: u64, vehicle: &str, observation: &Observation<'_>) -> String {
    let request = ReplanRequest::new(id, vehicle, observation, true);
    serde_json::to_string(&request).expect("a request has no keys but text")
}

/// Reads the reply to [`replan_request`], JSON.
///
/// # Errors
///
/// Why the reply is invalid.
pub fn read_replan(text: &str) -> Result<ReplanResult, PlannerFault> {
    match Line::parse(text) {
        Line::Reply { result, .. } => result,
        Line::Blank | Line::Stray => Err(PlannerFault::NoObject),
    }
}
