//! The answer of a command, or what is wrong with it in one line.

use scenarios::plan_input::{self, PlanError};
use scenarios::{PlanStatus, Scenario};
use serde::Deserialize;

use super::PROTOCOL;
use crate::plan_source::plan_import::{self, CompletedPlan};

/// Faults of a reply that its reason names.
const FAULTS_NAMED: usize = 2;

/// The part of a reply that is read first: everything else may differ in another version.
#[derive(Deserialize)]
struct Opening {
    protocol: Option<serde_json::Value>,
    status: Option<serde_json::Value>,
}

/// Reads a reply. The error says what is wrong with it.
pub(super) fn read(text: &str, scenario: &Scenario, planner: &str, seed: u64) -> Result<CompletedPlan, String> {
    if text.trim().is_empty() {
        return Err("it wrote no reply to its standard output".into());
    }
    // what is no JSON at all is told by the reader of plans, with its place
    if let Ok(opening) = serde_json::from_str::<Opening>(text) {
        opening.check()?;
    }
    let (mut header, tracks) = plan_input::parse_json("reply", text, scenario).map_err(|error| in_one_line(&error))?;
    if header.status == Some(PlanStatus::NoPlan) {
        header.reason = header.reason.or_else(|| Some("the planner says that it found none".into()));
        return Ok(plan_import::complete(scenario, header, Vec::new(), planner, seed));
    }
    Ok(plan_import::complete(scenario, header, tracks, planner, seed))
}

impl Opening {
    fn check(&self) -> Result<(), String> {
        match (&self.protocol, &self.status) {
            (None, _) => Err(format!("its reply has no `protocol`, which should be {PROTOCOL}")),
            (Some(version), _) if *version != PROTOCOL => {
                Err(format!("its reply is of protocol version {version}, this harness speaks version {PROTOCOL}"))
            }
            (_, None) => Err("its reply has no `status`: \"solved\", \"not-converged\" or \"no-plan\"".into()),
            _ => Ok(()),
        }
    }
}

fn in_one_line(error: &PlanError) -> String {
    let lines = error.lines();
    let named = lines.iter().take(FAULTS_NAMED).cloned().collect::<Vec<_>>().join("; ");
    let syntax = if named.contains("JSON syntax") { "; only the reply belongs on standard output" } else { "" };
    match lines.len().saturating_sub(FAULTS_NAMED) {
        0 => named + syntax,
        more => format!("{named}; and {more} more faults"),
    }
}
