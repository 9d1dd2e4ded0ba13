//! The meaning of the columns of a plan. World frame ENU, SI units, radians. Each vehicle family declares its own.

use crate::Family;

/// The columns that describe the motion of one kind of vehicle.
#[derive(Clone, Copy, Debug)]
pub struct Columns {
    /// The family of these vehicles.
    pub family: Family,
    /// Columns of a written file, vehicle and time first.
    pub written: &'static [&'static str],
    /// Required columns.
    pub required: &'static [&'static str],
    /// Alternative forms of the velocity. A file has all columns of one form, or none of any.
    pub velocity: &'static [&'static [&'static str]],
    /// Controls. A file has all of them or none.
    pub controls: &'static [&'static str],
    /// Other columns that a file may have.
    pub optional: &'static [&'static str],
    /// Columns that a file may have and that are not used, although their names resemble those of others.
    pub ignored: &'static [&'static str],
    /// Columns in another unit: name, the column that it is converted to, and the factor.
    pub converted: &'static [(&'static str, &'static str, f64)],
    /// Columns of words: name, and the words for the numbers 0, 1, ...
    pub words: &'static [(&'static str, &'static [&'static str])],
    /// Keys of a JSON node that hold several columns as one array.
    pub arrays: &'static [(&'static str, &'static [&'static str])],
    /// Whether two successive rows may share a time, before and after a jump in velocity.
    pub allows_discontinuity: bool,
    /// What an interval much longer than the others means.
    pub gaps: Gaps,
}

/// What an interval between two rows means that is much longer than the others.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Gaps {
    /// Nothing: the judge accounts for what may happen between two rows.
    Judged,
    /// Rows are missing, unless the vehicle rests at one place from one row to the next: the rows alone determine the motion
    /// between them.
    Refused,
    /// Rows are missing, also of a vehicle at rest: what a log does not show is not known.
    RefusedAlways,
}

/// Name of the column with the vehicle's name.
pub const VEHICLE: &str = "vehicle";
/// Name of the column with the time, s.
pub const TIME: &str = "t_s";

/// All columns of a written file except the first two, vehicle and time.
pub(crate) const fn without_vehicle_and_time(written: &'static [&'static str]) -> &'static [&'static str] {
    written.split_at(2).1
}

impl Columns {
    /// Every known column except vehicle and time.
    pub fn names(&self) -> Vec<&'static str> {
        let velocity = self.velocity.iter().flat_map(|form| form.iter());
        let plain = self.required.iter().chain(velocity).chain(self.controls).chain(self.optional).copied();
        plain.chain(self.converted.iter().map(|(name, ..)| *name)).collect()
    }

    /// The column that `name` is converted to, and the factor; `name` itself and 1 if it is not converted.
    pub fn meaning<'n>(&self, name: &'n str) -> (&'n str, f64) {
        match self.converted.iter().find(|(other, ..)| *other == name) {
            Some((_, meant, factor)) => (meant, *factor),
            None => (name, 1.0),
        }
    }

    /// The number for a word in the column `name`; `None` if the column does not hold this word.
    pub fn word(&self, name: &str, word: &str) -> Option<f64> {
        let (_, words) = self.words.iter().find(|(column, _)| *column == name)?;
        words.iter().position(|known| *known == word).map(|index| index as f64)
    }

    /// What a cell of the column `name` holds, for messages.
    pub fn expectation(&self, name: &str) -> String {
        match self.words.iter().find(|(column, _)| *column == name) {
            Some((_, words)) => words.iter().map(|word| format!("`{word}`")).collect::<Vec<_>>().join(" or "),
            None => "a number with a decimal point and without a unit".to_owned(),
        }
    }
}

#[cfg(test)]
mod tests {
    use super::{TIME, VEHICLE};
    use crate::Family;

    #[test]
    fn every_written_column_can_be_read() {
        for family in Family::ALL {
            let (written, known) = (family.spec().columns.written, family.spec().columns.names());
            assert_eq!(written[..2], [VEHICLE, TIME]);
            assert!(written[2..].iter().all(|name| known.contains(name)), "{family}: {known:?}");
        }
    }
}
