use clap::{Args, ValueEnum};
use serde_json::{Map, Value};

use crate::console;
use crate::error::{Error, Exit};
use crate::report::Report;

/// Print the JSON Schema of scenario files or of report.json
#[derive(Args, Debug)]
#[command(after_help = EXAMPLES)]
pub struct Schema {
    /// The kind of file
    #[arg(value_enum, default_value = "scenario")]
    kind: Kind,
}

const EXAMPLES: &str = "\
Examples:
  harness schema scenario > schema/scenario.json
  harness schema report > schema/report.json

An editor with a TOML language server validates and completes scenario files whose first line is
  #:schema ../../schema/scenario.json";

/// Kinds of files that have a schema.
#[derive(Clone, Copy, Debug, ValueEnum)]
enum Kind {
    /// Scenario files (TOML)
    Scenario,
    /// report.json
    Report,
}

impl Schema {
    /// Prints the schema, its keys in alphabetical order.
    pub fn execute(&self) -> Result<Exit, Error> {
        let schema = match self.kind {
            Kind::Scenario => scenarios::Scenario::json_schema(),
            Kind::Report => schemars::schema_for!(Report).into(),
        };
        console::print(&format!("{:#}", sorted(schema)))?;
        Ok(Exit::Passed)
    }
}

/// The same value with the keys of every object in alphabetical order, whatever features the JSON library is built with.
fn sorted(value: Value) -> Value {
    match value {
        Value::Object(object) => {
            let mut entries: Vec<(String, Value)> =
                object.into_iter().map(|(key, inner)| (key, sorted(inner))).collect();
            entries.sort_by(|(a, _), (b, _)| a.cmp(b));
            Value::Object(Map::from_iter(entries))
        }
        Value::Array(values) => Value::Array(values.into_iter().map(sorted).collect()),
        other => other,
    }
}
