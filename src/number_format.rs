//! Formatting of numbers with their units for the terminal, `summary.md` and recordings.
//!
//! Measured values have three digits after the point. Values from a scenario are written as they were given, without the
//! noise of binary fractions.

use scenarios::Range;

/// Largest number of digits of a value from a scenario.
const SIGNIFICANT_DIGITS: usize = 7;
/// Units of counts.
const COUNTED: [&str; 3] = ["crashes", "numbers", "vehicles"];

/// Is this the unit of a count?
pub fn is_count(unit: &str) -> bool {
    COUNTED.contains(&unit)
}

/// A measured value in `unit`, without the unit: three digits after the point, or scientific notation if it would be
/// rounded to zero. Counts are whole numbers.
pub fn number(value: f64, unit: &str) -> String {
    if is_count(unit) && value.fract() == 0.0 {
        format!("{value:.0}")
    } else if value != 0.0 && value.abs() < 5e-4 {
        format!("{value:.1e}")
    } else {
        format!("{value:.3}")
    }
}

/// [`number`] with its sign.
pub fn signed(value: f64, unit: &str) -> String {
    let sign = if value.is_sign_negative() { "" } else { "+" };
    format!("{sign}{}", number(value, unit))
}

/// [`number`] with its unit.
pub fn quantity(value: f64, unit: &str) -> String {
    with_unit(&number(value, unit), unit)
}

/// [`signed`] with its unit.
pub fn signed_quantity(value: f64, unit: &str) -> String {
    with_unit(&signed(value, unit), unit)
}

/// A value from a scenario: at most seven significant digits, without trailing zeros.
pub fn given(value: f64) -> String {
    let rounded = format!("{value:.*e}", SIGNIFICANT_DIGITS - 1);
    rounded.parse::<f64>().unwrap_or(value).to_string()
}

/// [`given`] with its unit.
pub fn given_quantity(value: f64, unit: &str) -> String {
    with_unit(&given(value), unit)
}

/// A range from a scenario, with its unit: `[30, 40] m/s`.
pub fn given_range(range: Range, unit: &str) -> String {
    with_unit(&format!("[{}, {}]", given(range.min), given(range.max)), unit)
}

/// Appends the unit, unless it is empty or `-` (dimensionless).
fn with_unit(number: &str, unit: &str) -> String {
    if unit.is_empty() || unit == "-" { number.to_owned() } else { format!("{number} {unit}") }
}

#[cfg(test)]
mod tests {
    use scenarios::Range;

    use super::{given, given_range, number, quantity, signed};

    #[test]
    fn small_numbers_do_not_vanish() {
        assert_eq!(number(99.9996, "m"), "100.000");
        assert_eq!(number(0.0005, "m"), "0.001");
        assert_eq!(number(-0.00042, "m"), "-4.2e-4");
        assert_eq!(number(0.0, "m"), "0.000");
        assert_eq!(signed(4.2, "m"), "+4.200");
        assert_eq!(signed(-1e-7, "m"), "-1.0e-7");
    }

    #[test]
    fn units_follow_numbers_and_a_dash_is_not_a_unit() {
        assert_eq!(quantity(0.1, "-"), "0.100");
        assert_eq!(quantity(0.1, "m/s"), "0.100 m/s");
        assert_eq!(quantity(2.0, "crashes"), "2 crashes");
        assert_eq!(quantity(f64::NAN, "m"), "NaN m");
    }

    #[test]
    fn given_values_have_neither_binary_noise_nor_trailing_zeros() {
        assert_eq!(given(0.1 + 0.2), "0.3");
        assert_eq!(given(9750.0), "9750");
        assert_eq!(given(f64::INFINITY), "inf");
        assert_eq!(given_range(Range::new(-0.200_000_400_000_000_02, 0.200_000_4), "-"), "[-0.2000004, 0.2000004]");
        assert_eq!(given_range(Range::new(29.999_99, 40.000_01), "m/s"), "[29.99999, 40.00001] m/s");
    }
}
