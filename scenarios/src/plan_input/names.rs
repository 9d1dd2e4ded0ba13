//! Names of columns as people write them: aliases, units in brackets, and renaming by the user.

use super::columns::{Columns, TIME, VEHICLE};
use crate::{Issue, closest_name};

/// Common names of columns, in lower case with underscores, by the name of the format. Lengths are in m, times in s.
pub const ALIASES: [(&str, &[&str]); 11] = [
    (VEHICLE, &["name", "vehicle_name", "drone", "uav", "robot", "agent"]),
    (TIME, &["t", "time", "times", "time_s", "timestamp", "timestamp_s", "sec", "seconds"]),
    ("x_m", &["x", "px", "p_x", "tx", "pos_x", "x_pos", "position_x", "pose_position_x", "east", "east_m"]),
    ("y_m", &["y", "py", "p_y", "ty", "pos_y", "y_pos", "position_y", "pose_position_y", "north", "north_m"]),
    ("z_m", &["z", "pz", "p_z", "tz", "pos_z", "z_pos", "position_z", "pose_position_z", "up", "up_m"]),
    ("vx_mps", &["vx", "v_x", "vel_x", "x_vel", "velocity_x", "xdot", "x_dot", "dx", "vx_m_s"]),
    ("vy_mps", &["vy", "v_y", "vel_y", "y_vel", "velocity_y", "ydot", "y_dot", "dy", "vy_m_s"]),
    ("vz_mps", &["vz", "v_z", "vel_z", "z_vel", "velocity_z", "zdot", "z_dot", "dz", "vz_m_s"]),
    (
        "reference_x_m",
        &["reference_x", "ref_x", "ref_x_m", "x_ref", "setpoint_x", "x_setpoint", "x_sp", "sp_x", "x_des", "desired_x"],
    ),
    (
        "reference_y_m",
        &["reference_y", "ref_y", "ref_y_m", "y_ref", "setpoint_y", "y_setpoint", "y_sp", "sp_y", "y_des", "desired_y"],
    ),
    (
        "reference_z_m",
        &["reference_z", "ref_z", "ref_z_m", "z_ref", "setpoint_z", "z_setpoint", "z_sp", "sp_z", "z_des", "desired_z"],
    ),
];

/// Units that may follow a name in brackets: the unit, the suffix of the columns that it measures, and its size in theirs.
pub const UNITS: [(&str, &str, f64); 19] = [
    ("m", "_m", 1.0),
    ("km", "_m", 1e3),
    ("cm", "_m", 1e-2),
    ("mm", "_m", 1e-3),
    ("ft", "_m", 0.3048),
    ("s", "_s", 1.0),
    ("min", "_s", 60.0),
    ("ms", "_s", 1e-3),
    ("us", "_s", 1e-6),
    ("ns", "_s", 1e-9),
    ("m/s", "_mps", 1.0),
    ("cm/s", "_mps", 1e-2),
    ("mm/s", "_mps", 1e-3),
    ("km/h", "_mps", 1.0 / 3.6),
    ("ft/s", "_mps", 0.3048),
    ("kn", "_mps", 1852.0 / 3600.0),
    ("mph", "_mps", 0.44704),
    ("rad", "_rad", 1.0),
    ("deg", "_rad", std::f64::consts::PI / 180.0),
];

/// The meaning of the columns of one file.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct ColumnMap {
    entries: Vec<Entry>,
}

/// One column of the file, named by the user.
#[derive(Clone, Debug, PartialEq)]
struct Entry {
    theirs: String,
    factor: f64,
    ours: String,
}

/// What a column of a file is.
#[derive(Clone, Debug, PartialEq)]
pub(super) enum Meaning {
    /// The column of this name, after multiplication by the factor.
    Column(String, f64),
    /// Nothing that a plan needs.
    Unused,
}

impl ColumnMap {
    /// Parses `theirs=ours, theirs[unit]=ours, ...`: names of the file's columns, and of those of the format. A unit may have
    /// a minus sign, which turns the axis around: `z[-m]=z_m`. Without `ours`, a column is not used.
    ///
    /// # Errors
    ///
    /// An entry without `=`, with an unknown unit, or with a unit of another kind.
    pub fn parse(text: &str) -> Result<Self, Issue> {
        let entry = |entry: &str| {
            let shape = "entries `theirs=ours` or `theirs[unit]=ours`, separated by commas";
            let (theirs, ours) =
                entry.split_once('=').ok_or_else(|| Issue::new("--columns", format!("\"{entry}\""), shape))?;
            let ours = ours.trim().to_owned();
            let (theirs, unit) = without_unit(theirs.trim());
            let factor = unit.map_or(Ok(1.0), |unit| factor(unit, &ours))?;
            Ok(Entry { theirs: theirs.to_owned(), factor, ours })
        };
        let entries = text.split(',').map(str::trim).filter(|entry| !entry.is_empty()).map(entry);
        Ok(Self { entries: entries.collect::<Result<_, Issue>>()? })
    }

    /// Names of the map that the file does not have.
    pub(super) fn missing(&self, names: &[String]) -> Vec<Issue> {
        let has = |theirs: &str| names.iter().any(|name| is_named(name, theirs));
        let issue = |entry: &Entry| {
            let found = format!("`{}`, which the file does not have", entry.theirs);
            let issue = Issue::new("--columns", found, format!("one of {}", names.join(", ")));
            let remedy = closest_name(&entry.theirs, names.iter().map(String::as_str));
            issue.remedy(remedy.map_or_else(String::new, |name| format!("did you mean `{name}`?")))
        };
        self.entries.iter().filter(|entry| !has(&entry.theirs)).map(issue).collect()
    }

    /// The meaning of a column of the file.
    ///
    /// # Errors
    ///
    /// An unknown unit, or one of another kind than the column's.
    pub(super) fn meaning(&self, name: &str, known: &Columns) -> Result<Meaning, Issue> {
        if let Some(entry) = self.entries.iter().find(|entry| is_named(name, &entry.theirs)) {
            let column = Meaning::Column(entry.ours.clone(), entry.factor);
            return Ok(if entry.ours.is_empty() { Meaning::Unused } else { column });
        }
        if known.ignored.contains(&name) {
            return Ok(Meaning::Unused);
        }
        let names: Vec<&str> = known.names().into_iter().chain([TIME, VEHICLE]).collect();
        if names.contains(&name) {
            return Ok(Meaning::Column(name.to_owned(), 1.0));
        }
        let (plain, unit) = without_unit(name);
        let normal = normalised(plain);
        let alias = ALIASES
            .iter()
            .find(|(ours, aliases)| names.contains(ours) && (normal == *ours || aliases.contains(&normal.as_str())));
        let angle = names.iter().find(|ours| ours.strip_suffix("_rad") == Some(&normal) && unit.is_some());
        let exact = names.iter().find(|ours| **ours == normal);
        let ours = alias.map(|(ours, _)| *ours).or(angle.copied()).or(exact.copied());
        match (ours, unit) {
            (Some(ours), Some(unit)) => Ok(Meaning::Column(ours.to_owned(), factor(unit, ours)?)),
            (Some(ours), None) => Ok(Meaning::Column(ours.to_owned(), 1.0)),
            // A misspelt name is an error, which the check of the columns explains.
            (None, _) if closest_name(name, names.iter().copied()).is_some() => {
                Ok(Meaning::Column(name.to_owned(), 1.0))
            }
            (None, _) => Ok(Meaning::Unused),
        }
    }
}

/// Whether `theirs` names the column, with or without the unit in its header.
fn is_named(name: &str, theirs: &str) -> bool {
    name == theirs || without_unit(name).0 == theirs
}

/// `px [ft]` as `px` and `ft`; also with round brackets.
fn without_unit(name: &str) -> (&str, Option<&str>) {
    for (open, close) in [('[', ']'), ('(', ')')] {
        if let Some((plain, unit)) = name.strip_suffix(close).and_then(|rest| rest.split_once(open)) {
            return (plain.trim(), Some(unit.trim()));
        }
    }
    (name, None)
}

/// The name in lower case with underscores, without the field of a message that surrounds it.
fn normalised(name: &str) -> String {
    let name: String =
        name.to_lowercase().chars().map(|c| if matches!(c, '.' | ' ' | '-' | '/') { '_' } else { c }).collect();
    name.trim_matches('_').trim_start_matches("pose_pose_").to_owned()
}

/// Size of `unit` in the unit of the column `ours`.
fn factor(unit: &str, ours: &str) -> Result<f64, Issue> {
    let (sign, size) = unit.strip_prefix('-').map_or((1.0, unit), |size| (-1.0, size));
    let is_of = |suffix: &str| ours.ends_with(suffix) && (suffix != "_s" || ours == TIME);
    match UNITS.iter().find(|(name, suffix, _)| *name == size && is_of(suffix)) {
        Some((.., factor)) => Ok(sign * factor),
        None => {
            let fitting: Vec<&str> =
                UNITS.iter().filter(|(_, suffix, _)| is_of(suffix)).map(|(name, ..)| *name).collect();
            Err(Issue::new(ours, format!("the unit `{unit}`"), format!("one of {}", fitting.join(", "))))
        }
    }
}

#[cfg(test)]
mod tests {
    use super::{ColumnMap, Meaning};
    use crate::Family;

    fn meaning(map: &str, name: &str) -> Option<(String, f64)> {
        let map = ColumnMap::parse(map).unwrap();
        match map.meaning(name, Family::FixedWing.spec().columns).unwrap() {
            Meaning::Column(ours, factor) => Some((ours, factor)),
            Meaning::Unused => None,
        }
    }

    #[test]
    fn common_names_and_units_in_brackets_are_understood() {
        for (name, ours, factor) in [
            ("x_m", "x_m", 1.0),
            ("X", "x_m", 1.0),
            ("pose.pose.position.y", "y_m", 1.0),
            ("pos z", "z_m", 1.0),
            ("px [ft]", "x_m", 0.3048),
            ("time(ms)", "t_s", 1e-3),
            ("vel_x[km/h]", "vx_mps", 1.0 / 3.6),
            ("heading[deg]", "heading_rad", std::f64::consts::PI / 180.0),
            ("z[-m]", "z_m", -1.0),
        ] {
            assert_eq!(meaning("", name), Some((ours.to_owned(), factor)), "{name}");
        }
    }

    #[test]
    fn other_columns_are_unused_and_misspelt_ones_are_kept_for_the_error() {
        assert_eq!(meaning("", "battery_voltage"), None);
        assert_eq!(meaning("", "qw"), None);
        assert_eq!(meaning("", "speed_mp").unwrap().0, "speed_mp");
    }

    #[test]
    fn the_user_s_names_come_first() {
        assert_eq!(meaning("alt[ft]=z_m, when=t_s", "alt"), Some(("z_m".to_owned(), 0.3048)));
        assert_eq!(meaning("x=y_m", "x"), Some(("y_m".to_owned(), 1.0)));
        assert_eq!((meaning("", "q_x").is_some(), meaning("q_x=", "q_x")), (true, None));
        let map = ColumnMap::parse("alt=z_m").unwrap();
        assert_eq!(map.missing(&["altitude".to_owned()]).len(), 1);
    }

    #[test]
    fn units_of_another_kind_are_refused() {
        for (map, part) in [("x[kg]=x_m", "one of m, km"), ("x[s]=x_m", "one of m, km"), ("x", "theirs=ours")] {
            let issue = ColumnMap::parse(map).unwrap_err();
            assert!(issue.to_string().contains(part), "{issue}");
        }
    }
}
