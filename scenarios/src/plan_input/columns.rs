//! What the columns of a plan mean, one table per vehicle family. World frame ENU, SI units, radians.

use crate::{Family, multirotor, slung_load};

/// The columns that describe the motion of one kind of vehicle.
#[derive(Clone, Copy, Debug)]
pub struct Columns {
    /// Name of the family, as in `[models.NAME...]`.
    pub family: &'static str,
    /// Columns that must be there.
    pub required: &'static [&'static str],
    /// Forms in which the velocity may be given: all columns of one of them, or none at all.
    pub velocity: &'static [&'static [&'static str]],
    /// Controls: all of them or none.
    pub controls: &'static [&'static str],
    /// Columns that stand for another one in another unit: name, which one, factor.
    pub converted: &'static [(&'static str, &'static str, f64)],
    /// Columns of words: name, and the words for 0, 1, ...
    pub words: &'static [(&'static str, &'static [&'static str])],
    /// Keys of a JSON node that hold several columns as an array.
    pub arrays: &'static [(&'static str, &'static [&'static str])],
    /// May two rows share a time, before and after a jump of the velocity?
    pub allows_discontinuity: bool,
}

/// Name of the column with the vehicle's name.
pub const VEHICLE: &str = "vehicle";
/// Name of the column with the time, s.
pub const TIME: &str = "t_s";

const DEGREE: f64 = std::f64::consts::PI / 180.0;

/// The fixed-wing point mass: position; speed, heading (counterclockwise from east) and flight-path angle, or the
/// velocity in the world frame; load factors along the velocity, to the left, and up.
const FIXED_WING: Columns = Columns {
    family: "fixed-wing",
    required: &["x_m", "y_m", "z_m"],
    velocity: &[&["speed_mps", "heading_rad", "flight_path_rad"], &["vx_mps", "vy_mps", "vz_mps"]],
    controls: &["n_x", "n_y", "n_z"],
    converted: &[("heading_deg", "heading_rad", DEGREE), ("flight_path_deg", "flight_path_rad", DEGREE)],
    words: &[],
    arrays: &[],
    allows_discontinuity: false,
};

/// The quadrotor with a slung load, whole: what is missing is not reconstructed.
const SLUNG_LOAD: Columns = Columns {
    family: "slung-load",
    required: whole(&slung_load::CSV_COLUMNS),
    velocity: &[],
    controls: &[],
    converted: &[],
    words: &[("cable", &["slack", "taut"])],
    arrays: &[
        ("position_m", &["x_m", "y_m", "z_m"]),
        ("velocity_mps", &["vx_mps", "vy_mps", "vz_mps"]),
        ("roll_pitch_yaw_rad", &["roll_rad", "pitch_rad", "yaw_rad"]),
        ("body_rate_radps", &["rate_x_radps", "rate_y_radps", "rate_z_radps"]),
        ("load_position_m", &["load_x_m", "load_y_m", "load_z_m"]),
        ("load_velocity_mps", &["load_vx_mps", "load_vy_mps", "load_vz_mps"]),
        ("thrust_n", &["thrust_1_n", "thrust_2_n", "thrust_3_n", "thrust_4_n"]),
    ],
    allows_discontinuity: true,
};

/// The multirotor, whole: position and velocity.
const MULTIROTOR: Columns = Columns {
    family: "multirotor",
    required: whole(&multirotor::CSV_COLUMNS),
    velocity: &[],
    controls: &[],
    converted: &[],
    words: &[],
    arrays: &[("position_m", &["x_m", "y_m", "z_m"]), ("velocity_mps", &["vx_mps", "vy_mps", "vz_mps"])],
    allows_discontinuity: true,
};

/// All columns of the files that we write, but for vehicle and time, which come first.
const fn whole(written: &'static [&'static str]) -> &'static [&'static str] {
    written.split_at(2).1
}

impl Columns {
    /// The columns of a family.
    pub fn of(family: Family) -> &'static Self {
        match family {
            Family::FixedWing => &FIXED_WING,
            Family::SlungLoad => &SLUNG_LOAD,
            Family::Multirotor => &MULTIROTOR,
        }
    }

    /// Every column that may be there beside vehicle and time.
    pub fn names(&self) -> Vec<&'static str> {
        let velocity = self.velocity.iter().flat_map(|form| form.iter());
        let plain = self.required.iter().chain(velocity).chain(self.controls).copied();
        plain.chain(self.converted.iter().map(|(name, ..)| *name)).collect()
    }

    /// The column that `name` stands for, and the factor between the two; itself if it is not converted.
    pub fn meaning<'n>(&self, name: &'n str) -> (&'n str, f64) {
        match self.converted.iter().find(|(other, ..)| *other == name) {
            Some((_, meant, factor)) => (meant, *factor),
            None => (name, 1.0),
        }
    }

    /// The number for a word in the column `name`; `None` if the column holds no words, or not this one.
    pub fn word(&self, name: &str, word: &str) -> Option<f64> {
        let (_, words) = self.words.iter().find(|(column, _)| *column == name)?;
        words.iter().position(|known| *known == word).map(|index| index as f64)
    }

    /// What stands in a cell of the column `name`, for messages.
    pub fn expectation(&self, name: &str) -> String {
        match self.words.iter().find(|(column, _)| *column == name) {
            Some((_, words)) => words.iter().map(|word| format!("`{word}`")).collect::<Vec<_>>().join(" or "),
            None => "a number, with a point and without a unit".to_owned(),
        }
    }
}

#[cfg(test)]
mod tests {
    use super::{Columns, TIME, VEHICLE};
    use crate::{Family, fixed_wing, multirotor, slung_load};

    /// What we write, we read.
    #[test]
    fn the_columns_of_our_own_files_are_known() {
        let families = [
            (Family::FixedWing, &fixed_wing::CSV_COLUMNS[..]),
            (Family::SlungLoad, &slung_load::CSV_COLUMNS[..]),
            (Family::Multirotor, &multirotor::CSV_COLUMNS[..]),
        ];
        for (family, written) in families {
            let known = Columns::of(family).names();
            assert_eq!(written[..2], [VEHICLE, TIME]);
            assert!(written[2..].iter().all(|name| known.contains(name)), "{family}: {known:?}");
        }
    }
}
