//! Where known messages of ROS 2 and PX4 hold position, velocity and time, and how they become rows.

use std::path::Path;

use nalgebra::{Quaternion, UnitQuaternion, Vector3};

use super::cdr::Value;
use super::{LogError, not_understood};

/// The frame of positions and velocities.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
enum Frame {
    /// As the scenario: x east, y north, z up.
    EastNorthUp,
    /// As PX4: x north, y east, z down.
    NorthEastDown,
}

/// How a message is understood.
#[derive(Clone, Debug, PartialEq)]
pub struct Layout {
    /// The list of rows in one message; `None` if a message is one row.
    rows: Option<&'static str>,
    /// Paths of the coordinates, within a row.
    position: [String; 3],
    /// Paths of the velocity, within a row.
    velocity: Option<[String; 3]>,
    /// Path of the time within a row; `None`: the stamp of the header, or the time at which the message was logged.
    time: Option<Time>,
    frame: Frame,
    /// Paths of what has to be true of a valid position.
    valid: &'static [&'static str],
    /// Whether the velocity is in the axes of the body, whose orientation the message gives.
    is_of_body: bool,
}

/// Where the time stands.
#[derive(Clone, Debug, PartialEq)]
enum Time {
    /// A message of seconds and nanoseconds.
    Stamp(String),
    /// A number of this many seconds.
    Number(String, f64),
}

/// A sample of a message.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Row {
    /// Time in the clock of the log, ns; a number of seconds since 1970 would be rounded.
    pub t_ns: i128,
    /// World frame, east, north, up, m.
    pub position_m: [f64; 3],
    /// The same, m/s.
    pub velocity_mps: Option<[f64; 3]>,
}

/// Why a message gives no row.
#[derive(Clone, Debug, PartialEq, Eq)]
pub enum RowError {
    /// There is no number at this path.
    Missing(String),
    /// The field at this path says that the position is not valid.
    Invalid(String),
}

impl RowError {
    /// The error with its place.
    ///
    /// - `place`: the topic, and the number of the message
    /// - `kind`: its type
    pub fn at(self, path: &Path, place: &str, kind: &str, value: &Value) -> LogError {
        match self {
            Self::Missing(missing) => {
                let remedy = format!("its numbers are at {}", paths(value));
                not_understood(
                    path,
                    place,
                    &format!("no number at `{missing}`"),
                    &format!("a field of {kind}"),
                    &remedy,
                )
            }
            Self::Invalid(field) => {
                let remedy = "give a log in which the estimator had a valid position from the start to the goal";
                not_understood(path, place, &format!("`{field}` false"), "a valid position", remedy)
            }
        }
    }

    /// The error of a `--field` that is missing or not known.
    pub fn field(path: &Path, topic: &str, name: &str) -> LogError {
        let remedy = "`--field NAME=PATH`, once per name; z=-PATH turns an axis around";
        not_understood(path, topic, &format!("--field `{name}`"), "x, y, z, or all of vx, vy, vz, or t", remedy)
    }
}

/// Some of the paths of a message, for people.
fn paths(value: &Value) -> String {
    const SHOWN: usize = 30;
    let paths = value.number_paths();
    let shown: Vec<&str> = paths.iter().take(SHOWN).map(|path| path.trim_start_matches('.')).collect();
    if paths.len() > SHOWN { format!("{}, ...", shown.join(", ")) } else { shown.join(", ") }
}

const XYZ: [&str; 3] = ["x", "y", "z"];

fn at(prefix: &str) -> [String; 3] {
    XYZ.map(|axis| format!("{prefix}.{axis}"))
}

fn indexed(name: &str) -> [String; 3] {
    [0, 1, 2].map(|index| format!("{name}[{index}]"))
}

/// The types that are understood, by their names without `/msg/`.
pub const KNOWN: [&str; 7] = [
    "nav_msgs/Odometry",
    "nav_msgs/Path",
    "geometry_msgs/PoseStamped",
    "trajectory_msgs/MultiDOFJointTrajectory",
    "px4_msgs/VehicleLocalPosition",
    "px4_msgs/TrajectorySetpoint",
    "px4_msgs/VehicleLocalPositionSetpoint",
];

impl Layout {
    /// The layout of a type, by its name without `/msg/`; `None` if it is not known.
    pub fn of(name: &str) -> Option<Self> {
        let header = || Some(Time::Stamp("header.stamp".into()));
        let px4 = || Some(Time::Number("timestamp".into(), 1e-6));
        let plain = Self {
            rows: None,
            position: at("pose.position"),
            velocity: None,
            time: header(),
            frame: Frame::EastNorthUp,
            valid: &[],
            is_of_body: false,
        };
        Some(match name {
            "nav_msgs/Odometry" => Self {
                position: at("pose.pose.position"),
                velocity: Some(at("twist.twist.linear")),
                is_of_body: true,
                ..plain
            },
            "nav_msgs/Path" => Self { rows: Some("poses"), ..plain },
            "geometry_msgs/PoseStamped" => plain,
            "trajectory_msgs/MultiDOFJointTrajectory" => Self {
                rows: Some("points"),
                position: at("transforms[0].translation"),
                velocity: Some(at("velocities[0].linear")),
                time: Some(Time::Stamp("time_from_start".into())),
                ..plain
            },
            "px4_msgs/VehicleLocalPosition" => Self {
                position: XYZ.map(str::to_owned),
                velocity: Some(["vx", "vy", "vz"].map(str::to_owned)),
                time: px4(),
                frame: Frame::NorthEastDown,
                valid: &["xy_valid", "z_valid"],
                ..plain
            },
            "px4_msgs/VehicleLocalPositionSetpoint" => {
                Self { position: XYZ.map(str::to_owned), time: px4(), frame: Frame::NorthEastDown, ..plain }
            }
            "px4_msgs/TrajectorySetpoint" => {
                Self { position: indexed("position"), time: px4(), frame: Frame::NorthEastDown, ..plain }
            }
            _ => return None,
        })
    }

    /// The layout that the user gives by the paths of fields.
    ///
    /// - `fields`: names `t`, `x`, `y`, `z`, `vx`, `vy`, `vz` and their paths; `t` in s, `t[ms]`, `t[us]` and `t[ns]` in these
    ///
    /// # Errors
    ///
    /// The name that is missing or not known.
    pub fn by_fields(fields: &[(String, String)]) -> Result<Self, String> {
        const NAMES: [&str; 6] = ["x", "y", "z", "vx", "vy", "vz"];
        const TIMES: [(&str, f64); 4] = [("t", 1.0), ("t[ms]", 1e-3), ("t[us]", 1e-6), ("t[ns]", 1e-9)];
        let is_time = |name: &str| TIMES.iter().any(|(time, _)| *time == name);
        let is_known = |name: &str| NAMES.contains(&name) || is_time(name);
        if let Some((unknown, _)) = fields.iter().find(|(name, _)| !is_known(name)) {
            return Err(unknown.clone());
        }
        let path = |name: &str| fields.iter().find(|(other, _)| other == name).map(|(_, path)| path.clone());
        let all = |names: [&str; 3]| -> Result<[String; 3], String> {
            let [a, b, c] = names.map(|name| path(name).ok_or_else(|| name.to_owned()));
            Ok([a?, b?, c?])
        };
        let velocity = ["vx", "vy", "vz"];
        let has_velocity = velocity.iter().any(|name| path(name).is_some());
        Ok(Self {
            rows: None,
            position: all(["x", "y", "z"])?,
            velocity: if has_velocity { Some(all(velocity)?) } else { None },
            time: TIMES.iter().find_map(|(name, unit_s)| Some(Time::Number(path(name)?, *unit_s))),
            frame: Frame::EastNorthUp,
            valid: &[],
            is_of_body: false,
        })
    }

    /// Whether one message holds all rows.
    pub fn is_whole(&self) -> bool {
        self.rows.is_some()
    }

    /// What the user should know of how a message is read.
    pub fn remark(&self, topic: &str, first: &Value) -> String {
        let mut text = format!("{topic}: ");
        text += match self.frame {
            Frame::NorthEastDown => "north, east, down, converted to east, north, up",
            Frame::EastNorthUp => "taken as east, north, up",
        };
        if let Some(frame) = first.text("header.frame_id").filter(|frame| !frame.is_empty()) {
            text += &format!(" (frame {frame})");
        }
        if self.is_of_body {
            text += match is_of_body(first) {
                true => "; velocities rotated from the axes of the body",
                false => "; velocities in the frame of the positions, which child_frame_id names",
            };
        }
        text
    }

    /// The rows of a message.
    ///
    /// - `log_ns`: when it was logged, ns
    ///
    /// # Errors
    ///
    /// A field that is not a number of the message, or says that the position is not valid.
    pub fn rows(&self, message: &Value, log_ns: i128) -> Result<Vec<Row>, RowError> {
        match self.rows {
            None => Ok(vec![self.row(message, log_ns)?]),
            Some(list) => match message.at(list) {
                Some(Value::List(rows)) => rows.iter().map(|row| self.row(row, log_ns)).collect(),
                _ => Err(RowError::Missing(list.to_owned())),
            },
        }
    }

    fn row(&self, row: &Value, log_ns: i128) -> Result<Row, RowError> {
        if let Some(path) = self.valid.iter().find(|path| row.number(path) == Some(0.0)) {
            return Err(RowError::Invalid((*path).to_owned()));
        }
        let t_ns = match &self.time {
            None => log_ns,
            Some(Time::Stamp(path)) => {
                let [sec, nanosec] = ["sec", "nanosec"].map(|part| number(row, &format!("{path}.{part}")));
                (sec? as i128).saturating_mul(1_000_000_000).saturating_add(nanosec? as i128)
            }
            Some(Time::Number(path, unit_s)) => (number(row, path)? * unit_s * 1e9).round() as i128,
        };
        let position_m = self.world(vector(row, &self.position)?);
        let velocity_mps = match &self.velocity {
            // A trajectory need not give velocities.
            Some(paths) if self.rows.is_none() || row.at(&paths[0]).is_some() => {
                let velocity = vector(row, paths)?;
                Some(self.world(if self.is_of_body && is_of_body(row) { rotated(row, velocity)? } else { velocity }))
            }
            _ => None,
        };
        Ok(Row { t_ns, position_m, velocity_mps })
    }

    fn world(&self, [x, y, z]: [f64; 3]) -> [f64; 3] {
        match self.frame {
            Frame::EastNorthUp => [x, y, z],
            Frame::NorthEastDown => [y, x, -z],
        }
    }
}

/// The twist of an odometry is in the frame `child_frame_id`, that of the body unless it is the frame of the pose.
fn is_of_body(odometry: &Value) -> bool {
    odometry.text("child_frame_id") != odometry.text("header.frame_id")
}

/// A velocity in the axes of the body, in those of the pose.
fn rotated(odometry: &Value, velocity: [f64; 3]) -> Result<[f64; 3], RowError> {
    let of = |axis: &str| number(odometry, &format!("pose.pose.orientation.{axis}"));
    let world_from_body = UnitQuaternion::from_quaternion(Quaternion::new(of("w")?, of("x")?, of("y")?, of("z")?));
    Ok((world_from_body * Vector3::from(velocity)).into())
}

fn number(value: &Value, path: &str) -> Result<f64, RowError> {
    let (sign, plain) = path.strip_prefix('-').map_or((1.0, path), |plain| (-1.0, plain));
    value.number(plain).map(|number| sign * number).ok_or_else(|| RowError::Missing(plain.to_owned()))
}

fn vector(value: &Value, paths: &[String; 3]) -> Result<[f64; 3], RowError> {
    let [x, y, z] = [0, 1, 2].map(|axis| number(value, &paths[axis]));
    Ok([x?, y?, z?])
}
