//! Numbers with their units, for people to read.

use crate::verdict::Check;

/// Three digits after the point; what would show as zero without being it is shown by its power of ten.
pub(super) fn number(value: f64) -> String {
    if value != 0.0 && value.abs() < 5e-4 { format!("{value:.1e}") } else { format!("{value:.3}") }
}

/// [`number`] with its sign.
pub(super) fn signed(value: f64) -> String {
    if value.is_sign_negative() { number(value) } else { format!("+{}", number(value)) }
}

/// `value` in `unit`, where the unit is more than a dash.
pub(super) fn with_unit(value: &str, unit: &str) -> String {
    if unit.is_empty() || unit == "-" { value.to_owned() } else { format!("{value} {unit}") }
}

/// The margin of a check with its sign and unit; nothing if it has none.
pub(super) fn margin(check: &Check) -> Option<String> {
    check.margin.map(|margin| with_unit(&signed(margin), &check.unit))
}

/// When and between whom: `83.10 s, uav-3 and uav-5`; nothing if neither is known.
pub(super) fn place(check: &Check) -> Option<String> {
    let when = check.at_s.map(|at_s| format!("{at_s:.2} s"));
    let who = (!check.between.is_empty()).then(|| check.between.join(" and "));
    let parts: Vec<String> = when.into_iter().chain(who).collect();
    (!parts.is_empty()).then(|| parts.join(", "))
}

#[cfg(test)]
mod tests {
    use super::{number, signed, with_unit};

    #[test]
    fn small_numbers_do_not_vanish() {
        assert_eq!(number(99.9996), "100.000");
        assert_eq!(number(0.0005), "0.001");
        assert_eq!(number(-0.00042), "-4.2e-4");
        assert_eq!(number(0.0), "0.000");
        assert_eq!(signed(4.2), "+4.200");
        assert_eq!(signed(-1e-7), "-1.0e-7");
        assert_eq!(with_unit("0.1", "-"), "0.1");
        assert_eq!(with_unit("0.1", "m/s"), "0.1 m/s");
    }
}
