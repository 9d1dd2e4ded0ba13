//! Why a check has nothing to measure.

use thiserror::Error;

use crate::verdict::trajectory_defect::TrajectoryDefect;

/// Why a plan or a flight cannot be measured. A check that needs it fails with this as its reason.
#[derive(Clone, Debug, PartialEq, Error)]
pub enum MissingEvidence {
    /// The planner returned no trajectory.
    #[error("there is no plan")]
    NoPlan,
    /// A trajectory cannot be flown.
    #[error("{vehicle}: {defect}")]
    NotFlyable {
        /// Name of the vehicle.
        vehicle: String,
        /// What is wrong with its trajectory.
        defect: TrajectoryDefect,
    },
    /// The plan exceeds the duration that is simulated.
    #[error("the plan takes {duration_s} s, longer than the {max_s} s that are simulated")]
    PlanTooLong {
        /// Planned flight time, s.
        duration_s: f64,
        /// `simulation.max_duration_s`, s.
        max_s: f64,
    },
    /// The plan has no trajectory, or none with two nodes.
    #[error("the plan has no interval")]
    NoInterval,
    /// The plan has no trajectory with a node.
    #[error("the plan has no node")]
    NoNode,
    /// There is no flight.
    #[error("the plan was not flown")]
    NotFlown,
    /// The flight has more or fewer logs than the scenario has vehicles.
    #[error("the flight has {logs} logs, the scenario has {vehicles} vehicles")]
    LogCount {
        /// Number of logs.
        logs: usize,
        /// Number of vehicles.
        vehicles: usize,
    },
    /// The logs are not in the order of the vehicles.
    #[error("the log of {found} is in the place of that of {expected}")]
    LogOrder {
        /// The vehicle that the log names.
        found: String,
        /// The vehicle of the scenario at this place.
        expected: String,
    },
    /// The log has no step.
    #[error("the log of {vehicle} has no step")]
    EmptyLog {
        /// Name of the vehicle.
        vehicle: String,
    },
    /// The samples of the load do not match those of the vehicle.
    #[error("the log of {vehicle} has {samples} samples of the vehicle and {loads} of its load")]
    LoadSampleCount {
        /// Name of the vehicle.
        vehicle: String,
        /// Number of samples of the vehicle.
        samples: usize,
        /// Number of samples of the load.
        loads: usize,
    },
    /// The log contradicts itself.
    #[error("{0}")]
    Contradiction(String),
    /// A logged attitude is not a unit quaternion.
    #[error("the attitude of {vehicle} at {t_s} s is not a rotation")]
    NotARotation {
        /// Name of the vehicle.
        vehicle: String,
        /// Time of the sample, s.
        t_s: f64,
    },
    /// A motion needs two knots.
    #[error("the motion of {body} has {knots} samples, at least 2 are needed")]
    TooFewKnots {
        /// The vehicle or its load.
        body: String,
        /// Number of knots.
        knots: usize,
    },
    /// A motion has a value that is not finite, or beyond the range in which distances are exact.
    #[error("the motion of {body} has a value at {t_s} s that is not finite or too large")]
    OutOfRange {
        /// The vehicle or its load.
        body: String,
        /// Time of the knot, s.
        t_s: f64,
    },
    /// The times of a motion decrease.
    #[error("the motion of {body} goes back in time at {t_s} s")]
    DecreasingTime {
        /// The vehicle or its load.
        body: String,
        /// Time of the last knot in order, s.
        t_s: f64,
    },
    /// A motion ends before the instant that the check is about.
    #[error("the motion of {vehicle} ends before its plan does")]
    EndsEarly {
        /// Name of the vehicle.
        vehicle: String,
    },
    /// The log ends before the window in which an arrival is searched for.
    #[error("{vehicle} has not come near its goal: its log ends at {log_end_s:.3} s")]
    NeverNearGoal {
        /// Name of the vehicle.
        vehicle: String,
        /// End of its log, s.
        log_end_s: f64,
    },
    /// The log ends while the vehicle is approaching its goal.
    #[error(
        "{vehicle} has not arrived: it is {distance_m:.3} m from its goal and approaching it when its log ends at \
         {log_end_s:.3} s"
    )]
    NotArrived {
        /// Name of the vehicle.
        vehicle: String,
        /// Distance from the goal, m.
        distance_m: f64,
        /// End of its log, s.
        log_end_s: f64,
    },
    /// No vehicle.
    #[error("there is no vehicle")]
    NoVehicle,
    /// No two vehicles exist at the same time.
    #[error("no two vehicles could be compared at any time")]
    NoCommonTime,
    /// No vehicle can be compared with an obstacle.
    #[error("no vehicle could be compared with an obstacle at any time")]
    NoApproach,
    /// A gate's depth is known at no time.
    #[error("the motion could be compared with gate {gate} at no time")]
    NoGateDepth {
        /// Name of the gate.
        gate: String,
    },
    /// No limited quantity was found.
    #[error("there is no value to compare with a limit")]
    NoValue,
}

impl From<&Self> for MissingEvidence {
    fn from(missing: &Self) -> Self {
        missing.clone()
    }
}
