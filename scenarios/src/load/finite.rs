//! Range of the numbers in a document. TOML allows `nan` and `inf`; quantities of a scenario are finite, and not so large
//! or small that arithmetic with them loses all precision.

use std::ops::Range;

use toml::Spanned;
use toml::de::{DeTable, DeValue};

use crate::Issue;

/// Magnitudes of non-zero quantities, in their own units.
const MIN_MAGNITUDE: f64 = 1e-12;
const MAX_MAGNITUDE: f64 = 1e12;

/// Every number that is not finite or out of range, with its byte range in the text.
pub(super) fn issues(root: &DeTable<'_>) -> Vec<(Issue, Range<usize>)> {
    let mut issues = Vec::new();
    for (key, value) in root {
        walk(key.get_ref(), value, &mut issues);
    }
    issues
}

fn walk(field: &str, value: &Spanned<DeValue<'_>>, issues: &mut Vec<(Issue, Range<usize>)>) {
    match value.get_ref() {
        DeValue::Float(float) if !float.as_str().replace('_', "").parse::<f64>().is_ok_and(f64::is_finite) => {
            let issue = Issue::new(field, float.as_str(), "a finite number");
            issues.push((issue.remedy("for \"no limit\", omit the key where it is optional"), value.span()));
        }
        DeValue::Float(float) if float.as_str().replace('_', "").parse().is_ok_and(is_out_of_range) => {
            let expected = format!("0, or a number between {MIN_MAGNITUDE:e} and {MAX_MAGNITUDE:e} in magnitude");
            issues.push((Issue::new(field, float.as_str(), expected), value.span()));
        }
        DeValue::Table(table) => {
            table.iter().for_each(|(key, inner)| walk(&format!("{field}.{}", key.get_ref()), inner, issues));
        }
        DeValue::Array(array) => {
            array.iter().enumerate().for_each(|(index, inner)| walk(&format!("{field}[{index}]"), inner, issues));
        }
        _ => {}
    }
}

fn is_out_of_range(value: f64) -> bool {
    value != 0.0 && !(MIN_MAGNITUDE..=MAX_MAGNITUDE).contains(&value.abs())
}
