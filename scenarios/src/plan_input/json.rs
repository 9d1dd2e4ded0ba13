//! A plan as a JSON document: our own `plan.json`, or the same with columns instead of states and controls.
//!
//! ```text
//! { "status": "solved", "trajectories": [ { "vehicle": "uav-1", "times_s": [...], "x_m": [...], "y_m": [...], ... } ] }
//! ```

mod trajectory;

use serde::de::DeserializeOwned;
use serde_json::{Map, Value};

use super::columns::Columns;
use super::{PlanFault, PlanHeader, PlanTable, Track};
use crate::{Problem, nearest};

/// Keys that a document may have. `protocol` belongs to replies of outside planners.
const KEYS: [&str; 12] = [
    "schema",
    "protocol",
    "scenario",
    "planner",
    "seed",
    "status",
    "reason",
    "objective",
    "trajectories",
    "history",
    "account",
    "timings",
];
/// Version of the form that is read.
const SCHEMA: u64 = 1;

/// Reads the whole text.
pub(super) fn read(text: &str, columns: &Columns) -> Result<PlanTable, Vec<PlanFault>> {
    let document: Value = serde_json::from_str(text).map_err(|error| vec![syntax(&error, text)])?;
    let Value::Object(document) = document else {
        let problem = problem("document", describe(&document), "an object with `trajectories`");
        return Err(vec![PlanFault::new("", problem)]);
    };
    let mut faults: Vec<PlanFault> = unknown_keys(&document).collect();
    if let Some(schema) = document.get("schema").filter(|schema| schema.as_u64() != Some(SCHEMA)) {
        faults.push(PlanFault::new(
            "",
            problem("schema", schema.to_string(), "1, the version of the form that this harness reads"),
        ));
    }
    let header = header(&document, &mut faults);
    let tracks = match document.get("trajectories") {
        Some(Value::Array(trajectories)) => tracks(trajectories, columns, &mut faults),
        // a planner without a plan has no trajectories to show
        None | Some(Value::Null) if header.status == Some(crate::PlanStatus::NoPlan) => Vec::new(),
        None => {
            faults.push(PlanFault::new(
                "",
                problem("trajectories", "nothing".into(), "an array with one trajectory per vehicle"),
            ));
            Vec::new()
        }
        Some(other) => {
            faults.push(PlanFault::new(
                "",
                problem("trajectories", describe(other), "an array with one trajectory per vehicle"),
            ));
            Vec::new()
        }
    };
    if faults.is_empty() { Ok(PlanTable { header, tracks }) } else { Err(faults) }
}

fn unknown_keys(document: &Map<String, Value>) -> impl Iterator<Item = PlanFault> + '_ {
    document.keys().filter(|key| !KEYS.contains(&key.as_str())).map(|key| {
        let remedy = nearest(key, KEYS).map_or_else(|| "remove it".into(), |known| format!("did you mean `{known}`?"));
        let problem = Problem::new(key, "an unknown key", format!("one of {}", KEYS.join(", ")));
        PlanFault::new("", problem.remedy(remedy))
    })
}

fn header(document: &Map<String, Value>, faults: &mut Vec<PlanFault>) -> PlanHeader {
    let field = |key: &str, expected: &str| {
        (document.get(key).cloned().unwrap_or(Value::Null), key.to_owned(), expected.to_owned())
    };
    let fields = [
        field("scenario", "the name of the scenario"),
        field("planner", "the name of the planner"),
        field("status", "\"solved\", \"not-converged\" or \"no-plan\""),
        field("reason", "text"),
        field("objective", "a number"),
        field("history", "an array of iterations, as in our plan.json"),
        field("account", "an object with `events` or `alternatives`"),
        field("timings", "an object with `wall_s`"),
    ];
    let [scenario, planner, status, reason, objective, history, diagnostics, timings] = fields;
    PlanHeader {
        scenario: optional(scenario, faults),
        planner: optional(planner, faults),
        status: optional(status, faults),
        reason: optional(reason, faults),
        objective: optional(objective, faults),
        history: optional(history, faults).unwrap_or_default(),
        diagnostics: optional(diagnostics, faults).unwrap_or_default(),
        timings: optional(timings, faults),
    }
}

/// The value in the form that is wanted; nothing for `null`, and a fault for what has another form.
fn optional<T: DeserializeOwned>(
    (value, key, expected): (Value, String, String),
    faults: &mut Vec<PlanFault>,
) -> Option<T> {
    if value.is_null() {
        return None;
    }
    let found = describe(&value);
    match serde_json::from_value(value) {
        Ok(value) => Some(value),
        Err(error) => {
            faults.push(PlanFault::new("", problem(&key, format!("{found} ({error})"), &expected)));
            None
        }
    }
}

fn tracks(trajectories: &[Value], columns: &Columns, faults: &mut Vec<PlanFault>) -> Vec<Track> {
    let mut tracks = Vec::with_capacity(trajectories.len());
    for (index, trajectory) in trajectories.iter().enumerate() {
        match trajectory::track(trajectory, index, columns) {
            Ok(track) => tracks.push(track),
            Err(problem) => faults.push(PlanFault::new("", problem)),
        }
    }
    tracks
}

fn problem(field: &str, found: String, expected: &str) -> Problem {
    Problem::new(field, found, expected)
}

fn syntax(error: &serde_json::Error, text: &str) -> PlanFault {
    let found = error.to_string();
    let found = found.split(" at line ").next().unwrap_or_default().to_owned();
    let line = text.lines().nth(error.line().saturating_sub(1)).unwrap_or_default();
    let is_number = ["NaN", "Infinity", "nan"].iter().any(|word| line.contains(word));
    let remedy = if is_number { "JSON has no NaN and no infinity: what is no number is no plan" } else { "" };
    let place = format!(":{}:{}", error.line(), error.column());
    PlanFault::new(place, Problem::new("JSON syntax", found, "a JSON document").remedy(remedy))
}

fn describe(value: &Value) -> String {
    match value {
        Value::Null => "nothing".into(),
        Value::Bool(value) => value.to_string(),
        Value::Number(number) => format!("the number {number}"),
        Value::String(text) => format!("the text \"{}\"", text.chars().take(40).collect::<String>()),
        Value::Array(_) => "an array".into(),
        Value::Object(_) => "an object".into(),
    }
}
