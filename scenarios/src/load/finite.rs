//! Are all numbers of the document finite? TOML knows `nan` and `inf`; no quantity of a scenario may be either.

use std::ops::Range;

use toml::Spanned;
use toml::de::{DeTable, DeValue};

use crate::Problem;

/// Every number that is not finite, with the bytes of the text where it stands.
pub(super) fn faults(root: &DeTable<'_>) -> Vec<(Problem, Range<usize>)> {
    let mut faults = Vec::new();
    for (key, value) in root {
        walk(key.get_ref(), value, &mut faults);
    }
    faults
}

fn walk(field: &str, value: &Spanned<DeValue<'_>>, faults: &mut Vec<(Problem, Range<usize>)>) {
    match value.get_ref() {
        DeValue::Float(float) if !float.as_str().parse::<f64>().is_ok_and(f64::is_finite) => {
            let problem = Problem::new(field, float.as_str(), "a finite number");
            faults.push((
                problem.remedy("to say \"no limit\", leave the key out where it may be left out"),
                value.span(),
            ));
        }
        DeValue::Table(table) => {
            table.iter().for_each(|(key, inner)| walk(&format!("{field}.{}", key.get_ref()), inner, faults));
        }
        DeValue::Array(array) => {
            array.iter().enumerate().for_each(|(index, inner)| walk(&format!("{field}[{index}]"), inner, faults));
        }
        _ => {}
    }
}
