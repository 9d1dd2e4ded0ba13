//! Parses the reply of a command.

use scenarios::plan_input::{self, PlanError};
use scenarios::{PlanStatus, Scenario};
use serde::Deserialize;

use super::{OLDEST_PROTOCOL, PROTOCOL, PlannerFault};
use crate::plan_source::plan_import::{self, CompletedPlan};

/// Largest number of errors that a reason names.
const MAX_NAMED_ERRORS: usize = 2;

/// The fields that are checked first, since all others may differ in another version.
#[derive(Deserialize)]
struct Header {
    protocol: Option<serde_json::Value>,
    status: Option<serde_json::Value>,
}

/// Parses a reply.
///
/// # Errors
///
/// Why the reply is invalid; its text is one line.
pub(super) fn read(text: &str, scenario: &Scenario, planner: &str, seed: u64) -> Result<CompletedPlan, PlannerFault> {
    if text.trim().is_empty() {
        return Err(PlannerFault::NoReply);
    }
    // Invalid JSON is reported by the plan reader, with its position.
    if let Ok(header_fields) = serde_json::from_str::<Header>(text) {
        header_fields.check()?;
    }
    let (mut header, tracks) = plan_input::parse_json("reply", text, scenario)
        .map_err(|error| PlannerFault::InvalidPlan(in_one_line(&error)))?;
    if header.status == Some(PlanStatus::NoPlan) {
        header.reason = header.reason.or_else(|| Some("the planner reports no plan".into()));
        return Ok(plan_import::complete(scenario, header, Vec::new(), planner, seed));
    }
    Ok(plan_import::complete(scenario, header, tracks, planner, seed))
}

impl Header {
    fn check(&self) -> Result<(), PlannerFault> {
        match (&self.protocol, &self.status) {
            (None, _) => Err(PlannerFault::NoProtocol),
            (Some(version), _) if !version.as_u64().is_some_and(is_read) => {
                Err(PlannerFault::UnknownProtocol(version.clone()))
            }
            (_, None) => Err(PlannerFault::NoStatus),
            _ => Ok(()),
        }
    }
}

fn is_read(version: u64) -> bool {
    (OLDEST_PROTOCOL..=PROTOCOL).contains(&version)
}

fn in_one_line(error: &PlanError) -> String {
    let lines = error.lines();
    let named = lines.iter().take(MAX_NAMED_ERRORS).cloned().collect::<Vec<_>>().join("; ");
    let syntax = if named.contains("JSON syntax") { "; standard output must hold the reply only" } else { "" };
    match lines.len().saturating_sub(MAX_NAMED_ERRORS) {
        0 => named + syntax,
        more => format!("{named}; and {more} more errors"),
    }
}
