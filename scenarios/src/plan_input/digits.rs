//! How many digits the numbers of a text table were written with.

/// Numbers with fewer digits were written by hand, or are meant exactly.
const MIN_DIGITS: usize = 5;
/// Numbers with more digits are exact.
const MAX_DIGITS: usize = 14;

/// The format in which numbers were written.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(super) enum Digits {
    /// Without rounding.
    Exact,
    /// With this number of decimals (`%.6f`).
    Decimals(usize),
    /// With at most this number of significant digits, trailing zeros left out (`%g`).
    Significant(usize),
}

impl Digits {
    /// The format of these cells.
    pub fn of<'a>(cells: impl Iterator<Item = &'a str> + Clone) -> Self {
        let decimals = |cell: &str| cell.split_once('.').map_or(0, |(_, decimals)| decimals.len());
        let mut numbers = cells.filter(|cell| cell.parse::<f64>().is_ok());
        let Some(first) = numbers.next().map(decimals) else { return Self::Exact };
        let significant = numbers.clone().map(significant_digits).max().unwrap_or(0);
        let is_fixed = numbers.all(|cell| decimals(cell) == first && !cell.contains(['e', 'E']));
        match (is_fixed, first, significant) {
            (_, _, MAX_DIGITS..) => Self::Exact,
            (true, decimals @ MIN_DIGITS.., _) => Self::Decimals(decimals),
            (false, _, digits @ MIN_DIGITS..) => Self::Significant(digits),
            _ => Self::Exact,
        }
    }

    /// Half a unit in the last digit of a number.
    pub fn half_unit(self, value: f64) -> f64 {
        match self {
            Self::Exact => 0.0,
            Self::Decimals(decimals) => 0.5 * 10_f64.powi(-(decimals as i32)),
            Self::Significant(_) if value == 0.0 => 0.0,
            Self::Significant(digits) => 0.5 * 10_f64.powi(value.abs().log10().floor() as i32 + 1 - digits as i32),
        }
    }
}

/// Digits of a number as it is written, from the first that is not 0.
fn significant_digits(cell: &str) -> usize {
    let mantissa = cell.split(['e', 'E']).next().unwrap_or_default();
    let digits: String = mantissa.chars().filter(char::is_ascii_digit).collect();
    digits.trim_start_matches('0').len()
}

#[cfg(test)]
mod tests {
    use super::Digits;

    fn of(cells: &str) -> Digits {
        Digits::of(cells.split(' '))
    }

    #[test]
    fn the_format_of_the_numbers_tells_the_rounding() {
        assert_eq!(of("1.050000 -0.000000 12.480798"), Digits::Decimals(6));
        assert_eq!(of("0.4 -6.1852e-05 0.113468 1.46341 0"), Digits::Significant(6));
        assert_eq!(of("0.1 0.25 3"), Digits::Exact);
        assert_eq!(of("0.1 0.3333333333333333"), Digits::Exact);
        assert_eq!(Digits::Decimals(6).half_unit(12.0), 5e-7);
        assert!((Digits::Significant(6).half_unit(0.4) - 5e-7).abs() < 1e-18);
        assert!((Digits::Significant(6).half_unit(-12.3456) - 5e-5).abs() < 1e-16);
    }
}
