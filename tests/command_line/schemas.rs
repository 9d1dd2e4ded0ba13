//! The committed JSON Schemas are those that the code generates, and real files conform to them.

use std::fs;
use std::path::Path;

use serde_json::Value;

use crate::workplace::{Workplace, code, stdout};

fn assert_committed(kind: &str) {
    let output = Workplace::new(&[]).harness(&["schema", kind]);
    assert_eq!(code(&output), 0);
    let generated = stdout(&output);
    serde_json::from_str::<Value>(&generated).expect("a schema is JSON");
    let path = Path::new(env!("CARGO_MANIFEST_DIR")).join(format!("schema/{kind}.json"));
    let committed = fs::read_to_string(&path).unwrap_or_default();
    assert!(
        committed == generated,
        "schema/{kind}.json is not up to date: run `harness schema {kind} > schema/{kind}.json` and read the difference"
    );
}

#[test]
fn the_schema_of_scenarios_is_up_to_date() {
    assert_committed("scenario");
}

#[test]
fn the_schema_of_reports_is_up_to_date() {
    assert_committed("report");
}

#[test]
fn every_field_of_a_scenario_and_of_a_report_is_documented() {
    for kind in ["scenario", "report"] {
        let schema: Value = serde_json::from_str(&stdout(&Workplace::new(&[]).harness(&["schema", kind]))).unwrap();
        let tables = schema["$defs"].as_object().unwrap().values().chain([&schema]);
        for table in tables {
            for (name, field) in table["properties"].as_object().into_iter().flatten() {
                assert!(field["description"].is_string(), "{kind}: {name} is not documented");
            }
        }
    }
}
