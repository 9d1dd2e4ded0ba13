//! One trajectory of a document: columns as arrays over time, or states and controls as one object per node.

use std::collections::BTreeMap;

use serde_json::{Map, Value};

use super::super::columns::Columns;
use super::super::{ColumnTable, RowLocations};
use super::{describe, issue};
use crate::Issue;

/// Values by column name.
type Values = BTreeMap<String, Vec<f64>>;

/// Reads the trajectory at `index` of the document.
pub(super) fn table(trajectory: &Value, index: usize, known: &Columns) -> Result<ColumnTable, Issue> {
    let field = format!("trajectories[{index}]");
    let Value::Object(trajectory) = trajectory else {
        return Err(issue(&field, describe(trajectory), "an object"));
    };
    let vehicle = vehicle_name(trajectory, &field, known)?;
    let times = match (trajectory.get("times_s"), trajectory.get("t_s")) {
        (Some(_), Some(_)) => {
            return Err(issue(&format!("{field}.t_s"), "the times a second time".into(), "either `t_s` or `times_s`"));
        }
        (times, short) => times.or(short),
    };
    let times_s = numbers(times.unwrap_or(&Value::Null), &format!("{field}.times_s"))?;
    let mut columns = Values::new();
    let mut planner_nodes = Vec::new();
    for (key, value) in trajectory {
        let inner = format!("{field}.{key}");
        match key.as_str() {
            "vehicle" | "family" | "interpolation" | "times_s" | "t_s" => {}
            "planner_nodes" => planner_nodes = indices(value, &inner)?,
            "states" | "controls" => transpose(value, &inner, known, &mut columns)?,
            _ => {
                if columns.insert(key.clone(), column(value, &inner, key, known)?).is_some() {
                    return Err(issue(&inner, "the values a second time".into(), "a column or a value of each node"));
                }
            }
        }
    }
    if let Some((name, column)) = columns.iter().find(|(_, column)| column.len() != times_s.len()) {
        let expected = format!("{}, one per time", times_s.len());
        return Err(issue(&format!("{field}.{name}"), format!("{} values", column.len()), &expected));
    }
    Ok(ColumnTable { vehicle, locations: RowLocations::Trajectory(index), times_s, columns, planner_nodes })
}

/// The name of the vehicle, after checks of the optional family and interpolation.
fn vehicle_name(trajectory: &Map<String, Value>, field: &str, known: &Columns) -> Result<String, Issue> {
    let words = [
        ("family", known.family.key(), "the family of the scenario's vehicles"),
        ("interpolation", "first-order-hold", "the only supported interpolation of controls"),
    ];
    for (key, wanted, why) in words {
        if let Some(other) = trajectory.get(key).filter(|value| **value != wanted) {
            let expected = format!("\"{wanted}\", {why}");
            return Err(issue(&format!("{field}.{key}"), other.to_string(), &expected));
        }
    }
    match trajectory.get("vehicle").and_then(Value::as_str) {
        Some(vehicle) => Ok(vehicle.to_owned()),
        None => {
            let found = trajectory.get("vehicle").map_or_else(|| "nothing".into(), describe);
            Err(issue(&format!("{field}.vehicle"), found, "the name of the vehicle"))
        }
    }
}

/// Converts one object per node into one column per number.
fn transpose(nodes: &Value, field: &str, known: &Columns, columns: &mut Values) -> Result<(), Issue> {
    let Value::Array(nodes) = nodes else {
        return Err(issue(field, describe(nodes), "an array, one object per node"));
    };
    for (index, node) in nodes.iter().enumerate() {
        let inner = format!("{field}[{index}]");
        let Value::Object(node) = node else {
            return Err(issue(&inner, describe(node), "an object with named values"));
        };
        for (key, value) in node {
            let inner = format!("{inner}.{key}");
            for (name, number) in parts(key, value, &inner, known)? {
                let column = columns.entry(name).or_default();
                column.push(number);
                if column.len() != index + 1 {
                    let found = "a value that earlier nodes lack";
                    return Err(issue(&inner, found.into(), "the same keys at every node"));
                }
            }
        }
    }
    Ok(())
}

/// The columns of a key: the key itself, or one for each number of its array.
fn parts(key: &str, value: &Value, field: &str, known: &Columns) -> Result<Vec<(String, f64)>, Issue> {
    let Some((_, names)) = known.arrays.iter().find(|(name, _)| *name == key) else {
        return Ok(vec![(key.to_owned(), number(value, field)?)]);
    };
    let values = numbers(value, field)?;
    if values.len() != names.len() {
        return Err(issue(field, format!("{} values", values.len()), &format!("{} numbers", names.len())));
    }
    Ok(names.iter().map(|name| (*name).to_owned()).zip(values).collect())
}

/// A column of numbers or of words.
fn column(value: &Value, field: &str, name: &str, known: &Columns) -> Result<Vec<f64>, Issue> {
    let Value::Array(values) = value else { return Err(issue(field, describe(value), "an array over time")) };
    let cell = |(index, value): (usize, &Value)| {
        let field = format!("{field}[{index}]");
        match value.as_str() {
            Some(word) => {
                known.word(name, word).ok_or_else(|| issue(&field, describe(value), &known.expectation(name)))
            }
            None => number(value, &field),
        }
    };
    values.iter().enumerate().map(cell).collect()
}

fn indices(value: &Value, field: &str) -> Result<Vec<usize>, Issue> {
    serde_json::from_value(value.clone()).map_err(|_| issue(field, describe(value), "an array of node indices"))
}

fn numbers(value: &Value, field: &str) -> Result<Vec<f64>, Issue> {
    let Value::Array(values) = value else { return Err(issue(field, describe(value), "an array of numbers")) };
    values.iter().enumerate().map(|(index, value)| number(value, &format!("{field}[{index}]"))).collect()
}

/// A number. `null`, as which NaN is written, becomes NaN.
fn number(value: &Value, field: &str) -> Result<f64, Issue> {
    match value {
        Value::Null => Ok(f64::NAN),
        _ => value.as_f64().ok_or_else(|| issue(field, describe(value), "a number")),
    }
}
