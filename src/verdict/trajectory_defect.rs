//! What makes a trajectory impossible to fly.

use std::cmp::Ordering;

use scenarios::slung_load::State;
use scenarios::{Family, Scenario, Trajectory, Vehicle};
use sim::slung_load::SlungLoadState;
use thiserror::Error;

use crate::verdict::compare::exceeds;

/// A first node may differ from the vehicle's start by this much, m, m/s, rad and rad/s: the rounding of a file's decimals.
const START_TOLERANCE: f64 = 0.01;
/// The first time may differ from 0 by this much, s.
pub const TIME_TOLERANCE_S: f64 = 1e-9;

/// What is wrong with a trajectory.
#[derive(Clone, Debug, PartialEq, Error)]
pub enum TrajectoryDefect {
    /// The vehicle has none.
    #[error("there is no trajectory")]
    Missing,
    /// The trajectory of another vehicle is in its place.
    #[error("the trajectory of {found} is in its place")]
    Misplaced {
        /// The vehicle that the trajectory names.
        found: String,
    },
    /// No vehicle of the scenario is left for it.
    #[error("there is no such vehicle, or its trajectory is there twice")]
    WithoutVehicle,
    /// It is for a vehicle of another family.
    #[error("the trajectory is that of a {found}, the vehicle is a {expected}")]
    WrongFamily {
        /// Family of the trajectory.
        found: Family,
        /// Family of the vehicle.
        expected: Family,
    },
    /// Times, states and controls differ in number.
    #[error("{times} times, {counts}: the numbers should be equal")]
    UnequalCounts {
        /// Number of times.
        times: usize,
        /// The numbers of everything else: `3 states and 2 controls`.
        counts: String,
    },
    /// It names a planner's node beyond its last one.
    #[error("planner node {node} does not exist: there are {count} nodes")]
    StrayNode {
        /// Index of the node.
        node: usize,
        /// Number of nodes.
        count: usize,
    },
    /// It needs two nodes.
    #[error("{count} nodes, at least 2 are needed")]
    TooFewNodes {
        /// Number of nodes.
        count: usize,
    },
    /// Its first time is not 0.
    #[error("the first time is {t_s} s, it should be 0 s")]
    FirstTime {
        /// The first time, s.
        t_s: f64,
    },
    /// Its times do not increase.
    #[error("the time {before_s} s is followed by {after_s} s")]
    TimeOrder {
        /// A time, s.
        before_s: f64,
        /// The time after it, s.
        after_s: f64,
    },
    /// It begins elsewhere than the vehicle.
    #[error(
        "it begins {distance:.3} {unit} away from the vehicle's start, where at most {tolerance} {unit} are allowed"
    )]
    Start {
        /// Distance between the first node and the start, in `unit`.
        distance: f64,
        /// Unit, with the load named if it is meant.
        unit: &'static str,
        /// Largest distance that is allowed, in `unit`.
        tolerance: f64,
    },
    /// It holds NaN or an infinity.
    #[error("the trajectory has a value that is not finite")]
    NotFinite,
}

/// The first defect of a vehicle's trajectory, apart from values that are not finite.
pub fn find(scenario: &Scenario, vehicle: &Vehicle, trajectory: &Trajectory) -> Option<TrajectoryDefect> {
    let (nodes, times_s) = (trajectory.nodes(), trajectory.times_s());
    if trajectory.vehicle() != vehicle.name {
        return Some(TrajectoryDefect::Misplaced { found: trajectory.vehicle().to_owned() });
    }
    let (found, expected) = (trajectory.family(), scenario.family());
    if found != expected {
        return Some(TrajectoryDefect::WrongFamily { found, expected });
    }
    if nodes.counts().iter().any(|(_, count)| *count != times_s.len()) {
        let counts: Vec<String> = nodes.counts().iter().map(|(what, count)| format!("{count} {what}")).collect();
        return Some(TrajectoryDefect::UnequalCounts { times: times_s.len(), counts: counts.join(" and ") });
    }
    if let Some(node) = stray_node(trajectory) {
        return Some(TrajectoryDefect::StrayNode { node, count: times_s.len() });
    }
    if times_s.len() < 2 {
        return Some(TrajectoryDefect::TooFewNodes { count: times_s.len() });
    }
    let (position_m, velocity_mps) = (vehicle.start.position_m(), vehicle.start.velocity_mps());
    time_defect(trajectory)
        .or_else(|| start_defect("m", nodes.position_m(0), position_m, START_TOLERANCE))
        .or_else(|| start_defect("m/s", nodes.velocity_mps(0), velocity_mps, START_TOLERANCE))
        .or_else(|| load_start_defect(scenario, vehicle, trajectory))
}

/// A planner's node that the trajectory names and does not have.
fn stray_node(trajectory: &Trajectory) -> Option<usize> {
    let Trajectory::SlungLoad(it) = trajectory else { return None };
    it.planner_nodes.iter().copied().find(|node| *node >= it.times_s.len())
}

/// A quadrotor with a load begins level, without rotation, and with its load at the load's start.
fn load_start_defect(scenario: &Scenario, vehicle: &Vehicle, trajectory: &Trajectory) -> Option<TrajectoryDefect> {
    let Trajectory::SlungLoad(trajectory) = trajectory else { return None };
    let first = &trajectory.states[0];
    let start = State::at(&vehicle.start, scenario.slung_load_model(vehicle).cable_length_m);
    start_defect("m (the load)", first.load_position_m, start.load_position_m, START_TOLERANCE)
        .or_else(|| start_defect("m/s (the load)", first.load_velocity_mps, start.load_velocity_mps, START_TOLERANCE))
        .or_else(|| start_attitude_defect(first, &start))
        .or_else(|| start_defect("rad/s", first.body_rate_radps, start.body_rate_radps, START_TOLERANCE))
}

/// Attitudes differ by the angle of the rotation between them: Euler angles that are full turns apart are the same attitude.
fn start_attitude_defect(first: &State, start: &State) -> Option<TrajectoryDefect> {
    let [first, start] = [first, start].map(|state| SlungLoadState::from(state).attitude);
    let distance = first.angle_to(&start);
    exceeds(distance, START_TOLERANCE).then_some(TrajectoryDefect::Start {
        distance,
        unit: "rad",
        tolerance: START_TOLERANCE,
    })
}

/// Times begin at 0 and increase; where the family allows a discontinuity, two nodes may share one time.
fn time_defect(trajectory: &Trajectory) -> Option<TrajectoryDefect> {
    let times_s = trajectory.times_s();
    if times_s[0] != 0.0 {
        return Some(TrajectoryDefect::FirstTime { t_s: times_s[0] });
    }
    let is_in_order = |pair: &&[f64]| match pair[0].partial_cmp(&pair[1]) {
        Some(Ordering::Less) => true,
        Some(Ordering::Equal) => trajectory.allows_discontinuity(),
        _ => false,
    };
    let pair = times_s.windows(2).find(|pair| !is_in_order(pair))?;
    Some(TrajectoryDefect::TimeOrder { before_s: pair[0], after_s: pair[1] })
}

/// The defect of a motion that begins at `first` instead of `start`, both in `unit`, if they are more than `tolerance` apart.
pub fn start_defect(unit: &'static str, first: [f64; 3], start: [f64; 3], tolerance: f64) -> Option<TrajectoryDefect> {
    let distance = (0..3).map(|axis| (first[axis] - start[axis]).powi(2)).sum::<f64>().sqrt();
    exceeds(distance, tolerance).then_some(TrajectoryDefect::Start { distance, unit, tolerance })
}
