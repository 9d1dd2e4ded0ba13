//! Rules for a single number or range. Numbers that are not finite pass, and are reported elsewhere.

use crate::{Issue, Range};

/// `value` > 0.
pub(crate) fn positive(field: &str, value: f64) -> Option<Issue> {
    (value <= 0.0).then(|| Issue::new(field, value.to_string(), "a number greater than 0"))
}

/// `value` > 0, if it is given.
pub(crate) fn positive_if_given(field: &str, value: Option<f64>) -> Option<Issue> {
    value.and_then(|value| positive(field, value))
}

/// `value` >= 0.
pub(crate) fn not_negative(field: &str, value: f64) -> Option<Issue> {
    (value < 0.0).then(|| Issue::new(field, value.to_string(), "0 or more"))
}

/// `above` < `value` <= `max`.
pub(crate) fn above_up_to(field: &str, value: f64, above: f64, max: f64) -> Option<Issue> {
    (value <= above || value > max)
        .then(|| Issue::new(field, value.to_string(), format!("a number greater than {above} and at most {max}")))
}

/// `min` < `max`.
pub(crate) fn ordered(field: &str, range: Range) -> Option<Issue> {
    (range.min >= range.max).then(|| {
        Issue::new(field, range.to_string(), "[min, max] with min below max").remedy("put the smaller number first")
    })
}

/// `value` inside `range`, ends included. `of` says what has this range. A reversed range is reported elsewhere.
pub(crate) fn inside(field: &str, value: f64, range: Range, of: &str) -> Option<Issue> {
    let is_outside = value < range.min || value > range.max;
    (is_outside && range.min < range.max)
        .then(|| Issue::new(field, value.to_string(), format!("a value inside {range}, {of}")))
}
