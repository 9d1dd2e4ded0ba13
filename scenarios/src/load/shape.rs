//! Shape of the document: unknown keys, missing keys, types of values.
//!
//! The document is checked against the JSON Schema generated from the scenario's own types. All issues are found in one
//! pass, each with its place in the text and the documentation of the field. Deserialisation alone would stop at the first
//! issue, and accept `[1, 2, 3]` as a pair.

use std::ops::Range;

use serde_json::{Map, Value};
use toml::Spanned;
use toml::de::{DeTable, DeValue};

use crate::{Issue, closest_name};

/// `found` of an issue about an unknown key.
pub(super) const UNKNOWN_KEY: &str = "an unknown key";

/// Every deviation of `root` from `schema`, with its byte range in the text.
pub(super) fn issues(schema: &Value, root: &Spanned<DeTable<'_>>) -> Vec<(Issue, Range<usize>)> {
    let mut check = Check { definitions: &schema["$defs"], issues: Vec::new() };
    check.table(schema, root.get_ref(), &root.span(), "");
    check.issues
}

struct Check<'s> {
    definitions: &'s Value,
    issues: Vec<(Issue, Range<usize>)>,
}

impl<'s> Check<'s> {
    /// The schema that `schema` refers to, without the alternative `null`, which TOML does not have.
    fn resolve(&self, schema: &'s Value) -> &'s Value {
        if let Some(reference) = schema["$ref"].as_str() {
            return self.resolve(&self.definitions[reference.trim_start_matches("#/$defs/")]);
        }
        if schema["properties"].is_object() {
            return schema;
        }
        match schema["anyOf"].as_array().and_then(|schemas| schemas.iter().find(|schema| schema["type"] != "null")) {
            Some(inner) => self.resolve(inner),
            None => schema,
        }
    }

    fn value(&mut self, schema: &'s Value, value: &Spanned<DeValue<'_>>, field: &str) {
        let schema = self.resolve(schema);
        match (kind(schema), value.get_ref()) {
            ("object", DeValue::Table(table)) => self.table(schema, table, &value.span(), field),
            ("array", DeValue::Array(array)) => self.array(schema, array, &value.span(), field),
            ("string", DeValue::String(text)) => self.choice(schema, text, &value.span(), field),
            ("integer", DeValue::Integer(integer)) => self.integer(schema, integer.as_str(), &value.span(), field),
            ("number", DeValue::Integer(_) | DeValue::Float(_)) | ("boolean", DeValue::Boolean(_)) => {}
            _ => self.issue(field, describe(value.get_ref()), expectation(schema), &value.span(), String::new()),
        }
    }

    fn table(&mut self, schema: &'s Value, table: &DeTable<'_>, span: &Range<usize>, field: &str) {
        let no_properties = Map::new();
        let properties = schema["properties"].as_object().unwrap_or(&no_properties);
        for (key, value) in table {
            let inner = join(field, key.get_ref());
            match schema["properties"].get(key.get_ref().as_ref()) {
                Some(property) => self.value(property, value, &inner),
                None if schema["additionalProperties"].is_object() => {
                    self.value(&schema["additionalProperties"], value, &inner);
                }
                None if schema["additionalProperties"] == true => {}
                None => self.unknown_key(properties, table, key.get_ref(), &key.span(), &inner),
            }
        }
        let required = keys(&schema["required"]).chain(required_of_alternatives(schema, table));
        for key in required.filter(|key| !table.contains_key(*key) && !is_misspelt(key, table, properties)) {
            let expected = expectation(self.resolve(&schema["properties"][key]));
            let remedy = format!("add `{key}`: {}", documentation(&schema["properties"][key]));
            self.issue(&join(field, key), "nothing".into(), expected, span, remedy);
        }
    }

    fn array(&mut self, schema: &'s Value, array: &[Spanned<DeValue<'_>>], span: &Range<usize>, field: &str) {
        let min = schema["minItems"].as_u64().unwrap_or(0);
        let max = schema["maxItems"].as_u64().unwrap_or(u64::MAX);
        if !(min..=max).contains(&(array.len() as u64)) {
            self.issue(field, format!("{} values", array.len()), expectation(schema), span, String::new());
        }
        for (index, value) in array.iter().enumerate() {
            self.value(&schema["items"], value, &format!("{field}[{index}]"));
        }
    }

    fn choice(&mut self, schema: &Value, text: &str, span: &Range<usize>, field: &str) {
        let choices = choices(schema);
        if !choices.is_empty() && !choices.contains(&text) {
            let remedy =
                closest_name(text, choices).map_or_else(String::new, |choice| format!("did you mean \"{choice}\"?"));
            self.issue(field, format!("\"{text}\""), expectation(schema), span, remedy);
        }
    }

    fn integer(&mut self, schema: &Value, digits: &str, span: &Range<usize>, field: &str) {
        if schema["minimum"] == 0 && digits.starts_with('-') {
            self.issue(field, digits.to_owned(), expectation(schema), span, String::new());
        }
    }

    fn unknown_key(
        &mut self,
        properties: &Map<String, Value>,
        table: &DeTable<'_>,
        key: &str,
        span: &Range<usize>,
        field: &str,
    ) {
        let free: Vec<&str> = properties.keys().map(String::as_str).filter(|name| !table.contains_key(*name)).collect();
        let remedy = match closest_name(key, free.iter().copied()) {
            Some(name) => format!("did you mean `{name}`: {}", documentation(&properties[name])),
            None => "remove it; unknown keys are rejected so that misspelt ones are noticed".into(),
        };
        let expected = match free.as_slice() {
            [] => "no further key".into(),
            names => format!("one of the keys {}", names.join(", ")),
        };
        self.issue(field, UNKNOWN_KEY.into(), expected, span, remedy);
    }

    fn issue(&mut self, field: &str, found: String, expected: String, span: &Range<usize>, remedy: String) {
        self.issues.push((Issue::new(field, found, expected).remedy(remedy), span.clone()));
    }
}

/// The keys of the way to give a position that the table follows, if there are several: that of which it has most keys.
fn required_of_alternatives<'s>(schema: &'s Value, table: &DeTable<'_>) -> impl Iterator<Item = &'s str> {
    let ways = schema["anyOf"].as_array().into_iter().flatten().map(|way| &way["required"]);
    let given = |way: &&Value| keys(way).filter(|key| table.contains_key(*key)).count();
    let way = ways.min_by_key(|way| std::cmp::Reverse(given(way)));
    way.into_iter().flat_map(keys)
}

fn keys(required: &Value) -> impl Iterator<Item = &str> {
    required.as_array().into_iter().flatten().filter_map(Value::as_str)
}

/// Whether an unknown key of `table` is probably a misspelt `key`, so that one issue covers both.
fn is_misspelt(key: &str, table: &DeTable<'_>, properties: &Map<String, Value>) -> bool {
    let free = || properties.keys().map(String::as_str).filter(|name| !table.contains_key(*name));
    let unknown = table.keys().filter(|written| !properties.contains_key(written.get_ref().as_ref()));
    unknown.into_iter().any(|written| closest_name(written.get_ref(), free()) == Some(key))
}

fn join(field: &str, key: &str) -> String {
    if field.is_empty() { key.to_owned() } else { format!("{field}.{key}") }
}

/// `object`, `array`, `string`, `number`, `integer` or `boolean`.
fn kind(schema: &Value) -> &str {
    match &schema["type"] {
        Value::Array(kinds) => kinds.iter().filter_map(Value::as_str).find(|kind| *kind != "null").unwrap_or(""),
        kind => kind.as_str().unwrap_or(if schema["oneOf"].is_array() { "string" } else { "" }),
    }
}

fn choices(schema: &Value) -> Vec<&str> {
    let documented = schema["oneOf"].as_array().into_iter().flatten().map(|choice| &choice["const"]);
    let plain = schema["enum"].as_array().into_iter().flatten();
    documented.chain(plain).filter_map(Value::as_str).collect()
}

/// The value that the schema requires, in words.
fn expectation(schema: &Value) -> String {
    match kind(schema) {
        "object" => "a table".into(),
        "array" => match (schema["minItems"].as_u64(), kind(&schema["items"])) {
            (Some(length), "number") => format!("{length} numbers in brackets"),
            _ => "an array".into(),
        },
        "string" if choices(schema).is_empty() => "text in quotes".into(),
        "string" => choices(schema).iter().map(|choice| format!("\"{choice}\"")).collect::<Vec<_>>().join(" or "),
        "integer" if schema["minimum"] == 0 => "a whole number, 0 or more".into(),
        "integer" => "a whole number".into(),
        "boolean" => "true or false".into(),
        _ => "a number".into(),
    }
}

/// The documentation of a field, on one line.
fn documentation(schema: &Value) -> String {
    schema["description"].as_str().unwrap_or_default().replace('\n', " ")
}

fn describe(value: &DeValue<'_>) -> String {
    match value {
        DeValue::String(text) => format!("the text \"{text}\""),
        DeValue::Integer(integer) => format!("the whole number {}", integer.as_str()),
        DeValue::Float(float) => format!("the number {}", float.as_str()),
        DeValue::Boolean(boolean) => boolean.to_string(),
        DeValue::Datetime(_) => "a date".into(),
        DeValue::Array(_) => "an array".into(),
        DeValue::Table(_) => "a table".into(),
    }
}
