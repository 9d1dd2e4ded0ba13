//! Names end up in paths, tables and CSV files, so they are plain words.

use std::collections::HashMap;

use crate::Issue;

/// Longest name: every system takes files of this name, with what results add to it, and tables stay readable.
const LONGEST_NAME: usize = 64;

/// A scenario's name: lower case letters, digits and `-`.
pub(super) fn scenario_name(name: &str) -> Option<Issue> {
    let is_allowed = |c: char| c.is_ascii_lowercase() || c.is_ascii_digit() || c == '-';
    well_formed("name", name, is_allowed, "lower case letters, digits and `-`, a letter or a digit first")
}

/// The name of a vehicle, an obstacle or a model: letters, digits, `-` and `_`.
pub(super) fn entity_name(field: &str, name: &str) -> Option<Issue> {
    let is_allowed = |c: char| c.is_ascii_alphanumeric() || c == '-' || c == '_';
    well_formed(field, name, is_allowed, "letters, digits, `-` and `_`, a letter or a digit first")
}

fn well_formed(field: &str, name: &str, is_allowed: impl Fn(char) -> bool, expected: &str) -> Option<Issue> {
    let is_good = name.starts_with(|c: char| c.is_ascii_alphanumeric()) && name.chars().all(is_allowed);
    if !is_good {
        return Some(Issue::new(field, format!("\"{name}\""), expected));
    }
    let length = name.len();
    (length > LONGEST_NAME).then(|| {
        let found = format!("a name of {length} characters");
        Issue::new(field, found, format!("{LONGEST_NAME} characters at most")).remedy("shorten it")
    })
}

/// Problems with a list of things that need names of their own: `list[i].name`.
pub(super) fn entity_names<'n>(list: &str, names: impl IntoIterator<Item = &'n str>) -> Vec<Issue> {
    let mut issues = Vec::new();
    let mut seen: HashMap<&str, usize> = HashMap::new();
    for (index, name) in names.into_iter().enumerate() {
        let field = format!("{list}[{index}].name");
        issues.extend(entity_name(&field, name));
        if let Some(first) = seen.get(name) {
            let expected = format!("a name of its own; {list}[{first}] has this one already");
            issues.push(Issue::new(field, format!("\"{name}\""), expected).remedy("rename one of the two"));
        }
        seen.entry(name).or_insert(index);
    }
    issues
}
