//! Names, which become parts of paths, tables and CSV files.

use std::collections::HashMap;

use crate::Issue;

/// Maximum length of a name: file names derived from it are valid on every system, and tables stay readable.
const MAX_NAME_LENGTH: usize = 64;

/// Name of a scenario: lower case letters, digits and `-`.
pub(super) fn scenario_name(name: &str) -> Option<Issue> {
    let is_allowed = |c: char| c.is_ascii_lowercase() || c.is_ascii_digit() || c == '-';
    name_issue("name", name, is_allowed, "lower case letters, digits and `-`, a letter or a digit first")
}

/// Name of a vehicle, an obstacle or a model: letters, digits, `-` and `_`.
pub(super) fn entity_name(field: &str, name: &str) -> Option<Issue> {
    let is_allowed = |c: char| c.is_ascii_alphanumeric() || c == '-' || c == '_';
    name_issue(field, name, is_allowed, "letters, digits, `-` and `_`, a letter or a digit first")
}

fn name_issue(field: &str, name: &str, is_allowed: impl Fn(char) -> bool, expected: &str) -> Option<Issue> {
    let is_well_formed = name.starts_with(|c: char| c.is_ascii_alphanumeric()) && name.chars().all(is_allowed);
    if !is_well_formed {
        return Some(Issue::new(field, format!("\"{name}\""), expected));
    }
    let length = name.len();
    (length > MAX_NAME_LENGTH).then(|| {
        let found = format!("a name of {length} characters");
        Issue::new(field, found, format!("at most {MAX_NAME_LENGTH} characters")).remedy("shorten it")
    })
}

/// Malformed and duplicate names in a list: `list[i].name`.
pub(super) fn entity_names<'n>(list: &str, names: impl IntoIterator<Item = &'n str>) -> Vec<Issue> {
    let mut issues = Vec::new();
    let mut seen: HashMap<&str, usize> = HashMap::new();
    for (index, name) in names.into_iter().enumerate() {
        let field = format!("{list}[{index}].name");
        issues.extend(entity_name(&field, name));
        if let Some(first) = seen.get(name) {
            let expected = format!("a unique name; {list}[{first}] has the same");
            issues.push(Issue::new(field, format!("\"{name}\""), expected).remedy("rename one of them"));
        }
        seen.entry(name).or_insert(index);
    }
    issues
}
