//! JSON without blanks, numbers rounded to six significant digits.

use std::io;

use serde_json::Serializer;
use serde_json::ser::{CompactFormatter, Formatter};

/// Significant digits of a number.
const DIGITS: i32 = 6;

/// A serializer to `writer`.
pub fn serializer<W: io::Write>(writer: W) -> Serializer<W, Rounding> {
    Serializer::with_formatter(writer, Rounding(CompactFormatter))
}

/// Rounds numbers; all else is written compactly.
pub struct Rounding(CompactFormatter);

impl Formatter for Rounding {
    fn write_f64<W: io::Write + ?Sized>(&mut self, writer: &mut W, value: f64) -> io::Result<()> {
        let rounded = rounded(value);
        // Integers without `.0`.
        if rounded.fract() == 0.0 && rounded.abs() < 1e15 {
            return self.0.write_i64(writer, rounded as i64);
        }
        self.0.write_f64(writer, rounded)
    }

    fn write_f32<W: io::Write + ?Sized>(&mut self, writer: &mut W, value: f32) -> io::Result<()> {
        self.write_f64(writer, f64::from(value))
    }
}

/// To [`DIGITS`] significant digits; what is smaller than 1e-9 is zero.
fn rounded(value: f64) -> f64 {
    if value.abs() < 1e-9 {
        return 0.0;
    }
    let decimals = DIGITS - 1 - value.abs().log10().floor() as i32;
    if decimals >= 0 {
        let scale = 10_f64.powi(decimals);
        (value * scale).round() / scale
    } else {
        let scale = 10_f64.powi(-decimals);
        (value / scale).round() * scale
    }
}

#[cfg(test)]
mod tests {
    use serde::Serialize;

    use super::serializer;

    #[test]
    fn numbers_have_six_digits_and_what_is_not_finite_is_null() {
        let mut json = Vec::new();
        let numbers =
            [5000.1234567, -0.1 - 0.2, 1e-12, 226.0, 123_456_789.0, f64::NAN, f64::INFINITY, 0.000_123_456_78];
        numbers.serialize(&mut serializer(&mut json)).unwrap();
        assert_eq!(String::from_utf8(json).unwrap(), "[5000.12,-0.3,0,226,123457000,null,null,0.000123457]");
    }
}
