//! A scenario as the tree of its file, in which fields are found by their paths and changed.

use std::fmt;

use scenarios::{LoadError, Scenario, ScenarioFile};
use toml::{Table, Value};

use crate::plan_source::PlanSource;
use crate::plan_source::external::ExternalPlanner;

/// The tree of a scenario file.
#[derive(Clone, Debug, PartialEq)]
pub struct ScenarioDocument {
    root: Table,
}

/// The place of a field: `world.cylinders[0].center_m[1]`, or `world.cylinders.tree-1.center_m[1]` by the name of an element.
#[derive(Clone, Debug, PartialEq, Eq, PartialOrd, Ord)]
pub struct FieldPath(Vec<Step>);

#[derive(Clone, Debug, PartialEq, Eq, PartialOrd, Ord)]
enum Step {
    /// A key of a table, or the name of an element of a list of tables.
    Key(String),
    /// An element of a list, from 0.
    Index(usize),
}

impl FieldPath {
    /// Reads a path; `None` if it is malformed.
    pub fn parse(text: &str) -> Option<Self> {
        let mut steps = Vec::new();
        for part in text.split('.') {
            let (key, indices) = part.split_once('[').map_or((part, None), |(key, rest)| (key, Some(rest)));
            if key.is_empty() {
                return None;
            }
            steps.push(Step::Key(key.to_owned()));
            if let Some(indices) = indices {
                for index in indices.strip_suffix(']')?.split("][") {
                    steps.push(Step::Index(index.parse().ok()?));
                }
            }
        }
        Some(Self(steps))
    }

    fn child(&self, step: Step) -> Self {
        Self(self.0.iter().cloned().chain([step]).collect())
    }

    /// Whether it lies in the table of this key.
    pub fn is_below(&self, key: &str) -> bool {
        matches!(self.0.first(), Some(Step::Key(first)) if first == key)
    }

    /// Its last key.
    pub fn last_key(&self) -> Option<&str> {
        self.0.iter().rev().find_map(|step| match step {
            Step::Key(key) => Some(key.as_str()),
            Step::Index(_) => None,
        })
    }
}

impl fmt::Display for FieldPath {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        for (position, step) in self.0.iter().enumerate() {
            match step {
                Step::Key(key) if position == 0 => f.write_str(key)?,
                Step::Key(key) => write!(f, ".{key}")?,
                Step::Index(index) => write!(f, "[{index}]")?,
            }
        }
        Ok(())
    }
}

/// The fields of a world that name files.
fn file_fields(world: &mut Table) -> Vec<&mut Value> {
    let mut fields = Vec::new();
    for (key, value) in world {
        let tables: Vec<&mut Table> = match (key.as_str(), value) {
            ("meshes", Value::Array(meshes)) => meshes.iter_mut().filter_map(Value::as_table_mut).collect(),
            ("terrain", Value::Table(terrain)) => vec![terrain],
            _ => Vec::new(),
        };
        fields.extend(tables.into_iter().filter_map(|table| table.get_mut("file")));
    }
    fields
}

impl ScenarioDocument {
    /// The tree of a file that holds a valid scenario. The paths in it become absolute, so that it can be written elsewhere.
    pub fn of(file: &ScenarioFile) -> Self {
        let mut root: Table = file.text().parse().expect("the text of a valid scenario is TOML");
        let resolve = |field: &mut Value| {
            if let Value::String(path) = field {
                *path = file.resolve(path).to_string_lossy().into_owned();
            }
        };
        let world = root.get_mut("world").and_then(Value::as_table_mut);
        world.into_iter().flat_map(file_fields).for_each(resolve);
        Self { root }
    }

    /// Name of the scenario.
    pub fn name(&self) -> &str {
        self.root.get("name").and_then(Value::as_str).unwrap_or_default()
    }

    /// The text of the file.
    pub fn text(&self) -> String {
        self.root.to_string()
    }

    /// The scenario; lists what is invalid.
    ///
    /// # Errors
    ///
    /// It is not valid.
    pub fn scenario(&self) -> Result<Scenario, LoadError> {
        scenarios::parse(&format!("{}.toml", self.name()), &self.text())
    }

    /// The same scenario, naming its planner where that is valid: a registered one, or a command and the folder in which it is
    /// started, so that the file gives the same flight from any folder.
    pub fn planned_by(self, source: &PlanSource) -> Self {
        let fields = match source {
            PlanSource::Registered(planner) => vec![("name", planner.name.into())],
            PlanSource::External(planner) => command_fields(planner),
            PlanSource::Imported(_) => return self,
        };
        let mut named = self.clone();
        let settings = named.root.entry("planner").or_insert_with(|| Value::Table(Table::new()));
        if let Value::Table(settings) = settings {
            settings.extend(fields.into_iter().map(|(key, value)| (key.to_owned(), value)));
        }
        if named.scenario().is_ok() { named } else { self }
    }

    /// The same scenario under another name.
    pub fn renamed(&self, name: &str) -> Self {
        let mut renamed = self.clone();
        renamed.root.insert("name".into(), name.into());
        renamed
    }

    /// The same scenario with another seed.
    ///
    /// - `seed`: at most `i64::MAX`, the largest integer of a TOML file
    pub fn with_seed(mut self, seed: u64) -> Self {
        let simulation = self.root.entry("simulation").or_insert_with(|| Value::Table(Table::new()));
        if let Value::Table(simulation) = simulation {
            simulation.insert("seed".into(), Value::Integer(seed.cast_signed()));
        }
        self
    }

    /// The number at a path.
    pub fn number(&self, path: &FieldPath) -> Option<f64> {
        let (first, rest) = path.0.split_first()?;
        as_number(rest.iter().try_fold(self.root.get(key_of(first)?)?, inside)?)
    }

    /// Replaces the number at a path. Returns whether there is one.
    pub fn set_number(&mut self, path: &FieldPath, number: f64) -> bool {
        let Some(value) = self.value_mut(path) else { return false };
        match value {
            Value::Float(float) => *float = number,
            Value::Integer(integer) if number.fract() == 0.0 && number.abs() < 1e15 => *integer = number as i64,
            Value::Integer(_) => *value = Value::Float(number),
            _ => return false,
        }
        true
    }

    /// Every number with its path, in the order of the tree.
    pub fn numbers(&self) -> Vec<(FieldPath, f64)> {
        let mut found = Vec::new();
        self.walk(&mut |path, value| found.extend(as_number(value).map(|number| (path.clone(), number))));
        found
    }

    /// The paths of all elements of lists of tables: vehicles, obstacles, gates.
    pub fn elements(&self) -> Vec<FieldPath> {
        let mut found = Vec::new();
        self.walk(&mut |path, value| {
            if value.is_table() && matches!(path.0.last(), Some(Step::Index(_))) {
                found.push(path.clone());
            }
        });
        found
    }

    /// The paths of all keys in the table of this key, and in the tables within it.
    pub fn keys_below(&self, key: &str) -> Vec<FieldPath> {
        let mut found = Vec::new();
        self.walk(&mut |path, _| {
            if path.0.len() > 1 && path.is_below(key) && matches!(path.0.last(), Some(Step::Key(_))) {
                found.push(path.clone());
            }
        });
        found
    }

    /// Removes what is at a path. A list that becomes empty goes too. Returns whether there was anything.
    pub fn remove(&mut self, path: &FieldPath) -> bool {
        let Some((last, parents)) = path.0.split_last() else { return false };
        match last {
            Step::Key(key) if parents.is_empty() => self.root.remove(key).is_some(),
            Step::Key(key) => match self.value_mut(&FieldPath(parents.to_vec())) {
                Some(Value::Table(table)) => table.remove(key).is_some(),
                _ => false,
            },
            Step::Index(index) => {
                let list = FieldPath(parents.to_vec());
                let Some(Value::Array(elements)) = self.value_mut(&list) else { return false };
                if *index >= elements.len() {
                    return false;
                }
                elements.remove(*index);
                !elements.is_empty() || self.remove(&list)
            }
        }
    }

    fn value_mut(&mut self, path: &FieldPath) -> Option<&mut Value> {
        let (first, rest) = path.0.split_first()?;
        let mut value = self.root.get_mut(key_of(first)?)?;
        for step in rest {
            value = match (value, step) {
                (Value::Table(table), Step::Key(key)) => table.get_mut(key)?,
                (Value::Array(elements), Step::Index(index)) => elements.get_mut(*index)?,
                (Value::Array(elements), Step::Key(name)) => {
                    elements.iter_mut().find(|element| has_name(element, name))?
                }
                _ => return None,
            };
        }
        Some(value)
    }

    fn walk(&self, visit: &mut dyn FnMut(&FieldPath, &Value)) {
        for (key, value) in &self.root {
            walk(value, &FieldPath(vec![Step::Key(key.clone())]), visit);
        }
    }
}

fn walk(value: &Value, path: &FieldPath, visit: &mut dyn FnMut(&FieldPath, &Value)) {
    visit(path, value);
    match value {
        Value::Table(table) => {
            table.iter().for_each(|(key, value)| walk(value, &path.child(Step::Key(key.clone())), visit));
        }
        Value::Array(elements) => {
            elements.iter().enumerate().for_each(|(i, value)| walk(value, &path.child(Step::Index(i)), visit));
        }
        _ => {}
    }
}

fn key_of(step: &Step) -> Option<&str> {
    match step {
        Step::Key(key) => Some(key),
        Step::Index(_) => None,
    }
}

fn inside<'a>(value: &'a Value, step: &Step) -> Option<&'a Value> {
    match (value, step) {
        (Value::Table(table), Step::Key(key)) => table.get(key),
        (Value::Array(elements), Step::Index(index)) => elements.get(*index),
        (Value::Array(elements), Step::Key(name)) => elements.iter().find(|element| has_name(element, name)),
        _ => None,
    }
}

fn has_name(element: &Value, name: &str) -> bool {
    element.get("name").and_then(Value::as_str) == Some(name)
}

fn as_number(value: &Value) -> Option<f64> {
    match value {
        Value::Float(number) => Some(*number),
        Value::Integer(number) => Some(*number as f64),
        _ => None,
    }
}

/// The fields of a scenario that describe a command.
fn command_fields(planner: &ExternalPlanner) -> Vec<(&'static str, Value)> {
    let folder = planner.folder.canonicalize().unwrap_or_else(|_| planner.folder.clone());
    let mut fields = vec![
        ("name", planner.name.clone().into()),
        ("command", Value::Array(planner.command.iter().cloned().map(Value::from).collect())),
        ("folder", folder.display().to_string().into()),
        ("in_loop", planner.in_loop.into()),
    ];
    fields.extend(planner.time_limit_s.map(|time_limit_s| ("time_limit_s", time_limit_s.into())));
    fields
}

#[cfg(test)]
mod tests {
    use scenarios::ScenarioFile;

    use super::{FieldPath, ScenarioDocument};

    const TEXT: &str = "name = \"a\"\n[world]\nx_m = 2\n[[world.cylinders]]\nname = \"tree\"\ncenter_m = [1.5, 2]\n";

    fn document() -> ScenarioDocument {
        ScenarioDocument::of(&ScenarioFile::new("a.toml", TEXT))
    }

    fn path(text: &str) -> FieldPath {
        FieldPath::parse(text).unwrap()
    }

    #[test]
    fn fields_are_found_by_index_and_by_name() {
        let mut document = document();
        for text in ["world.cylinders[0].center_m[1]", "world.cylinders.tree.center_m[1]"] {
            assert_eq!(document.number(&path(text)), Some(2.0));
            assert_eq!(path(text).to_string(), text);
        }
        assert_eq!(document.number(&path("world.cylinders.bush.center_m[1]")), None);
        assert!(document.set_number(&path("world.cylinders.tree.center_m[1]"), 2.5));
        assert!(document.set_number(&path("world.x_m"), 7.0) && !document.set_number(&path("name"), 7.0));
        let numbers: Vec<f64> = document.numbers().into_iter().map(|(_, number)| number).collect();
        assert_eq!(numbers, [1.5, 2.5, 7.0]);
        assert!(document.text().contains("x_m = 7\n"), "an integer stays one: {}", document.text());
    }

    #[test]
    fn the_last_element_takes_its_list_along() {
        let mut document = document();
        assert_eq!(document.elements(), [path("world.cylinders[0]")]);
        assert!(document.remove(&path("world.cylinders[0]")) && !document.text().contains("cylinders"));
        assert!(!document.remove(&path("world.cylinders[0]")) && document.remove(&path("world")));
    }

    #[test]
    fn malformed_paths_are_refused() {
        assert!(["", "a..b", "a[", "a[x]", "a[1", ".a", "a.[1]"].iter().all(|text| FieldPath::parse(text).is_none()));
    }
}
