//! The judge: can the plan be flown, and with what margin?
//!
//! It looks at the plan and at the flight, and never asks the planner whether it succeeded.

mod airspeed;
mod arrival;
mod bernstein;
mod broad_phase;
pub mod case;
mod closest;
mod collision;
pub mod compare;
mod conditions;
mod curve_as_cubics;
mod end;
mod evidence;
mod extreme;
pub mod fixed_wing;
mod flight_integrity;
mod flown;
mod flown_reference;
mod geofence;
mod goal;
mod in_loop_planner;
mod in_loop_planning;
mod integration;
mod integrity;
mod judge;
mod map_bounds;
mod missing_evidence;
mod motion;
pub mod multirotor;
pub mod obstacle_approach;
mod physics;
mod provenance;
#[cfg(test)]
mod random;
pub mod reconstruction;
pub mod recorded;
mod requirements;
mod rotors;
mod separation;
pub mod slung_load;
#[cfg(test)]
mod still_sample;
pub mod tolerance;
mod tracking;
mod trajectory_defect;
mod tube;
mod worst;

use std::fmt;

use schemars::JsonSchema;
use serde::{Deserialize, Serialize};

pub use arrival::duration_s as flown_duration_s;
pub use closest::{ClosestApproach, between_vehicles as closest_vehicles};
pub use curve_as_cubics::CurveAsCubics;
pub use flown::{FlownMotions, FlownVehicle};
pub use integration::{Integration, Method};
pub use integrity::is_flyable;
pub use judge::{judge, judge_imported, judge_recorded, judge_with};
pub use missing_evidence::MissingEvidence;
pub use motion::{Knot, KnotDefect, Motion};
pub use provenance::{EndVelocity, GivenRows, Provenance, Reconstruction, RoundedRows, VehicleProvenance};
pub use requirements::{RobustnessOverTime, robustness_over_time};
pub use separation::at_nodes as separation_at_nodes;
pub use tracking::{
    largest as largest_tracking_error, root_mean_square as root_mean_square_tracking_error, saturation,
};
pub use trajectory_defect::TrajectoryDefect;

/// Checks whose margins say most about how close it was, by their names without the group.
pub const KEY_CHECKS: [&str; 3] = ["separation", "clearance", "tracking_max"];

/// What the judge found.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
pub struct Verdict {
    /// The whole in one word.
    pub outcome: Outcome,
    /// The planner calls its plan solved, and a check of the plan between its nodes (`plan.*`) says otherwise.
    #[serde(default)]
    pub overclaimed: bool,
    /// Every check, in the order nodes, plan, flight.
    pub checks: Vec<Check>,
    /// What two integrators disagree on; absent if there is no flight.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub integration: Option<Integration>,
}

impl Verdict {
    /// The check of this full name.
    pub fn check(&self, name: &str) -> Option<&Check> {
        self.checks.iter().find(|check| check.name == name)
    }

    /// Names of the deciding checks that failed or are undecided.
    pub fn failed_checks(&self) -> Vec<String> {
        let failed = self.checks.iter().filter(|check| check.is_bad() && !check.advisory);
        failed.map(|check| check.name.clone()).collect()
    }
}

/// The whole verdict in one word, from the best to the worst.
#[derive(Clone, Copy, Debug, PartialEq, Eq, PartialOrd, Ord, Serialize, Deserialize, JsonSchema)]
#[serde(rename_all = "kebab-case")]
pub enum Outcome {
    /// Every deciding check passed.
    Pass,
    /// A deciding check failed or is undecided, or a required one was skipped.
    Fail,
    /// The planner returned no trajectory.
    NoPlan,
}

impl fmt::Display for Outcome {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        f.write_str(match self {
            Self::Pass => "PASS",
            Self::Fail => "FAIL",
            Self::NoPlan => "NO PLAN",
        })
    }
}

/// One question put to a plan or a flight, and its answer.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize, JsonSchema)]
pub struct Check {
    /// Group and name, as `flight.separation`.
    pub name: String,
    /// The answer.
    pub status: Status,
    /// What was measured, in `unit`.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub value: Option<f64>,
    /// The true value is not smaller, in `unit`: given where it was bounded over continuous time instead of measured.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub lower: Option<f64>,
    /// The true value is not larger, in `unit`.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub upper: Option<f64>,
    /// What it is held against, in `unit`.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub limit: Option<f64>,
    /// Distance to the limit, positive when it is kept, in `unit`.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub margin: Option<f64>,
    /// Unit of the three.
    pub unit: String,
    /// Where the worst value stands in time, s.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub at_s: Option<f64>,
    /// The vehicles and obstacles concerned at that instant.
    #[serde(default, skip_serializing_if = "Vec::is_empty")]
    pub between: Vec<String>,
    /// Shown and counted, but not deciding.
    #[serde(default, skip_serializing_if = "std::ops::Not::not")]
    pub advisory: bool,
    /// Why it was skipped or is undecided, or what exactly is wrong.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub reason: Option<String>,
    /// Where the limit stands in the scenario, for a check that picks one of several quantities. Not part of a report.
    #[serde(skip)]
    pub limit_key: Option<LimitKey>,
}

/// The place of a limit in a scenario.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum LimitKey {
    /// In `world.map`.
    Map(&'static str),
    /// The geofence that the check names.
    Geofence,
    /// In the limits of the vehicle's model: `planning_limits` for `nodes.*`, else `limits`.
    Limits(&'static str),
    /// In the airframe of the vehicle's model.
    Airframe(&'static str),
    /// In `verdict`.
    Verdict(&'static str),
}

impl Check {
    /// Has it failed, or is it too close to tell?
    pub fn is_bad(&self) -> bool {
        matches!(self.status, Status::Fail | Status::Undecided)
    }

    /// Its name without the group: `separation` of `flight.separation`.
    pub fn question(&self) -> &str {
        self.name.split_once('.').map_or(self.name.as_str(), |(_, question)| question)
    }

    /// Whether its margin belongs in a summary of one line.
    pub fn is_key(&self) -> bool {
        KEY_CHECKS.contains(&self.question())
    }

    /// The bodies that it names, each once, for people: `uav-3 and uav-5`; nothing without one.
    pub fn who(&self) -> Option<String> {
        let mut named: Vec<&str> = Vec::new();
        self.between.iter().for_each(|name| {
            if !named.contains(&name.as_str()) {
                named.push(name);
            }
        });
        (!named.is_empty()).then(|| named.join(" and "))
    }

    /// Time and bodies, for people: `83.10 s, uav-3 and uav-5`; nothing if neither is known.
    pub fn place(&self) -> Option<String> {
        let when = self.at_s.map(|at_s| format!("{at_s:.2} s"));
        let who = self.who();
        let parts: Vec<String> = when.into_iter().chain(who).collect();
        (!parts.is_empty()).then(|| parts.join(", "))
    }
}

/// Status of a check.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Serialize, Deserialize, JsonSchema)]
#[serde(rename_all = "kebab-case")]
pub enum Status {
    /// The limit is kept.
    Pass,
    /// The limit is broken.
    Fail,
    /// It could not be told which.
    Undecided,
    /// Not asked, for the reason given.
    Skip,
}

impl fmt::Display for Status {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        f.pad(match self {
            Self::Pass => "pass",
            Self::Fail => "fail",
            Self::Undecided => "undecided",
            Self::Skip => "skip",
        })
    }
}

#[cfg(test)]
mod tests {
    use scenarios::check_spec;

    use super::Check;
    use crate::verdict::evidence::{Decide, Measurement};

    fn check(at_s: Option<f64>, names: &[&str]) -> Check {
        let measured = names.iter().fold(Measurement::value(1.0), |measured, name| measured.with(name));
        let measured = at_s.into_iter().fold(measured, Measurement::at);
        check_spec("plan.separation").unwrap().at_least(measured, 0.0)
    }

    #[test]
    fn the_place_of_a_check_is_its_time_and_its_bodies_each_once() {
        let place = |at_s, names: &[&str]| check(at_s, names).place();
        assert_eq!(place(Some(83.1), &["uav-3", "uav-5"]).as_deref(), Some("83.10 s, uav-3 and uav-5"));
        assert_eq!(place(Some(83.1), &["uav-3", "uav-3"]).as_deref(), Some("83.10 s, uav-3"));
        assert_eq!(place(None, &["uav-3"]).as_deref(), Some("uav-3"));
        assert_eq!(place(Some(0.0), &[]).as_deref(), Some("0.00 s"));
        assert_eq!(place(None, &[]), None);
    }
}
