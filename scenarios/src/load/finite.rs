//! Are all numbers of the document quantities? TOML knows `nan` and `inf`; no quantity of a scenario may be either, nor so
//! large or so small that arithmetic with it loses everything else.

use std::ops::Range;

use toml::Spanned;
use toml::de::{DeTable, DeValue};

use crate::Issue;

/// No quantity is larger than this, or smaller without being zero, in the unit that it is given in.
const LARGEST: f64 = 1e12;
const SMALLEST: f64 = 1e-12;

/// Every number that is none or beyond all measure, with the bytes of the text where it stands.
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
            issues
                .push((issue.remedy("to say \"no limit\", leave the key out where it may be left out"), value.span()));
        }
        DeValue::Float(float) if float.as_str().replace('_', "").parse().is_ok_and(is_beyond_measure) => {
            let expected = format!("0, or a number between {SMALLEST:e} and {LARGEST:e} in magnitude");
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

fn is_beyond_measure(value: f64) -> bool {
    value != 0.0 && !(SMALLEST..=LARGEST).contains(&value.abs())
}
