//! JSON documents: the format of `plan.json`, or the same with columns instead of states and controls.
//!
//! A trajectory may also be a curve, see `curve`.
//!
//! ```text
//! { "status": "solved", "trajectories": [ { "vehicle": "uav-1", "times_s": [...], "x_m": [...], "y_m": [...], ... } ] }
//! ```

mod curve;
mod trajectory;
mod unique_keys;

use serde::de::DeserializeOwned;
use serde_json::{Map, Value};

use self::unique_keys::UniqueKeys;
use super::columns::Columns;
use super::{ColumnTable, PlanDocument, PlanHeader, PlanIssue};
use crate::curve::Curve;
use crate::{Issue, Plan, PlanStatus, closest_name};

/// Keys of a document. `protocol` occurs in replies of external planners.
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

/// Reads the text.
pub(super) fn read(text: &str, columns: &Columns) -> Result<PlanDocument, Vec<PlanIssue>> {
    let document: UniqueKeys = serde_json::from_str(text).map_err(|error| vec![syntax(&error, text)])?;
    let UniqueKeys(document) = document;
    let Value::Object(document) = document else {
        let issue = issue("document", describe(&document), "an object with `trajectories`");
        return Err(vec![PlanIssue::new("", issue)]);
    };
    let mut issues: Vec<PlanIssue> = unknown_keys(&document).collect();
    if let Some(schema) = document.get("schema").filter(|schema| schema.as_u64() != Some(Plan::SCHEMA.into())) {
        let issue = issue("schema", schema.to_string(), "1, the supported version of the format");
        issues.push(PlanIssue::new("", issue));
    }
    let header = header(&document, &mut issues);
    let (tables, curves) = match document.get("trajectories") {
        Some(Value::Array(trajectories)) => tables(trajectories, columns, &mut issues),
        None | Some(Value::Null) if header.status == Some(PlanStatus::NoPlan) => Default::default(),
        other => {
            let found = describe(other.unwrap_or(&Value::Null));
            let issue = issue("trajectories", found, "an array with one trajectory per vehicle");
            issues.push(PlanIssue::new("", issue));
            Default::default()
        }
    };
    if issues.is_empty() { Ok(PlanDocument { header, tables, curves }) } else { Err(issues) }
}

fn unknown_keys(document: &Map<String, Value>) -> impl Iterator<Item = PlanIssue> + '_ {
    document.keys().filter(|key| !KEYS.contains(&key.as_str())).map(|key| {
        let remedy =
            closest_name(key, KEYS).map_or_else(|| "remove it".into(), |known| format!("did you mean `{known}`?"));
        let issue = Issue::new(key, "an unknown key", format!("one of {}", KEYS.join(", ")));
        PlanIssue::new("", issue.remedy(remedy))
    })
}

fn header(document: &Map<String, Value>, issues: &mut Vec<PlanIssue>) -> PlanHeader {
    let field = |key: &str, expected: &str| {
        (document.get(key).cloned().unwrap_or(Value::Null), key.to_owned(), expected.to_owned())
    };
    let fields = [
        field("scenario", "the name of the scenario"),
        field("planner", "the name of the planner"),
        field("status", "\"solved\", \"not-converged\" or \"no-plan\""),
        field("reason", "text"),
        field("objective", "a number"),
        field("history", "an array of iterations, as in a written plan.json"),
        field("account", "an object with `events` or `alternatives`"),
        field("timings", "an object with `wall_s`"),
    ];
    let [scenario, planner, status, reason, objective, history, diagnostics, timings] = fields;
    let header = PlanHeader {
        scenario: optional(scenario, issues),
        planner: optional(planner, issues),
        status: optional(status, issues),
        reason: optional(reason, issues),
        objective: optional(objective, issues),
        history: optional(history, issues).unwrap_or_default(),
        diagnostics: optional(diagnostics, issues).unwrap_or_default(),
        timings: optional(timings, issues),
        remarks: Vec::new(),
    };
    issues.extend(negative_times(&header));
    header
}

/// Planning times that no clock measures.
fn negative_times(header: &PlanHeader) -> Vec<PlanIssue> {
    let timings = header.timings.iter();
    let timings = timings.flat_map(|it| {
        [("timings.wall_s".to_owned(), it.wall_s), ("timings.distributed_s".to_owned(), it.distributed_s)]
    });
    let history = header.history.iter().enumerate().flat_map(|(index, it)| {
        let field = |name: &str| format!("history[{index}].{name}");
        [(field("wall_s"), it.wall_s), (field("distributed_s"), it.distributed_s)]
    });
    let negative = timings.chain(history).filter(|(_, time_s)| *time_s < 0.0);
    negative.map(|(field, time_s)| PlanIssue::new("", issue(&field, format!("{time_s} s"), "0 s or more"))).collect()
}

/// The value as a `T`; `None` for `null`, and for another type, which is added to `issues`.
fn optional<T: DeserializeOwned>(
    (value, key, expected): (Value, String, String),
    issues: &mut Vec<PlanIssue>,
) -> Option<T> {
    if value.is_null() {
        return None;
    }
    let found = describe(&value);
    match serde_json::from_value(value) {
        Ok(value) => Some(value),
        Err(error) => {
            issues.push(PlanIssue::new("", issue(&key, format!("{found} ({error})"), &expected)));
            None
        }
    }
}

/// The trajectories that are tables, and those that are curves.
fn tables(trajectories: &[Value], columns: &Columns, issues: &mut Vec<PlanIssue>) -> (Vec<ColumnTable>, Vec<Curve>) {
    let (mut tables, mut curves) = (Vec::with_capacity(trajectories.len()), Vec::new());
    for (index, trajectory) in trajectories.iter().enumerate() {
        let read = if curve::is_curve(trajectory) {
            curve::read(trajectory, index).map(|curve| curves.push(curve))
        } else {
            trajectory::table(trajectory, index, columns).map(|table| tables.push(table))
        };
        if let Err(issue) = read {
            issues.push(PlanIssue::new("", issue));
        }
    }
    (tables, curves)
}

fn issue(field: &str, found: String, expected: &str) -> Issue {
    Issue::new(field, found, expected)
}

fn syntax(error: &serde_json::Error, text: &str) -> PlanIssue {
    let found = error.to_string();
    let found = found.split(" at line ").next().unwrap_or_default().to_owned();
    let line = text.lines().nth(error.line().saturating_sub(1)).unwrap_or_default();
    let is_number = ["NaN", "Infinity", "nan"].iter().any(|word| line.contains(word));
    let remedy = if is_number { "JSON has no NaN and no infinity" } else { "" };
    let place = format!(":{}:{}", error.line(), error.column());
    PlanIssue::new(
        place,
        Issue::new("JSON syntax", format!("invalid JSON ({found})"), "a JSON document").remedy(remedy),
    )
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
