//! Range of the numbers in a document. TOML allows `nan` and `inf`; quantities of a scenario are finite, and not so large
//! or small that arithmetic with them loses all precision.

use std::ops::Range;

use toml::Spanned;
use toml::de::{DeTable, DeValue};

use crate::Issue;

/// Quantities of either sign, where scripts write rounding in place of 0.
const SIGNED: [&str; 10] =
    ["x_m", "y_m", "z_m", "center_m", "corners_m", "offset_m", "position_m", "path_m", "ends_m", "velocity_mps"];
const SIGNED_UNIT: &str = "_deg";

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
        DeValue::Float(float) if float.as_str().replace('_', "").parse().is_ok_and(|it| is_out_of_range(field, it)) => {
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

fn is_out_of_range(field: &str, value: f64) -> bool {
    let is_too_small = value != 0.0 && value.abs() < MIN_MAGNITUDE && !is_signed(field);
    is_too_small || value.abs() > MAX_MAGNITUDE
}

fn is_signed(field: &str) -> bool {
    let name = field.rsplit('.').next().unwrap_or(field);
    let name = name.split('[').next().unwrap_or(name);
    SIGNED.contains(&name) || name.ends_with(SIGNED_UNIT)
}
