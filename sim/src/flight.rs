//! The flight log: what the simulated vehicles did.

use scenarios::{fixed_wing, slung_load};

use crate::actuation::{Actuation, Commanded};
use crate::planning_log::PlanningLog;

/// A simulated flight of the whole fleet. Positions and velocities in the world frame (ENU).
#[derive(Clone, Debug, PartialEq)]
pub struct Flight {
    /// Step of the simulator, s. Logs hold every step.
    pub step_s: f64,
    /// End of the plan, s: from then on the vehicles coast.
    pub plan_end_s: f64,
    /// One log per vehicle, in the order of the scenario.
    pub vehicles: Vec<VehicleLog>,
    /// Events in the order of time.
    pub events: Vec<Event>,
    /// What was planned in the loop; `None` for a plan that was made before the flight.
    pub planning: Option<PlanningLog>,
    /// Wall time of the simulation, s.
    pub wall_s: f64,
}

/// What a family's simulation returns.
pub(crate) struct FleetLog {
    /// One log per vehicle, in the order of the scenario.
    pub vehicles: Vec<VehicleLog>,
    /// Events in any order.
    pub events: Vec<Event>,
    /// Of a flight that was planned in the loop.
    pub in_loop: Option<InLoopLog>,
}

/// What is known of a flight that was planned in the loop once it is over.
pub(crate) struct InLoopLog {
    /// When all vehicles had arrived, or the flight ended, s.
    pub end_s: f64,
    pub planning: PlanningLog,
}

/// The log of one vehicle.
#[derive(Clone, Debug, PartialEq)]
pub struct VehicleLog {
    /// Name of the vehicle.
    pub vehicle: String,
    /// From time 0 to the end of the simulation, or to the vehicle's crash.
    pub samples: Vec<Sample>,
    /// Its load at the same times; empty if it carries none.
    pub loads: Vec<LoadSample>,
}

/// One vehicle at one instant.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Sample {
    /// Time, s.
    pub t_s: f64,
    /// True position, m.
    pub position_m: [f64; 3],
    /// True velocity over ground, m/s.
    pub velocity_mps: [f64; 3],
    /// Velocity of the air around the vehicle, m/s.
    pub wind_mps: [f64; 3],
    /// Attitude as a unit quaternion (x, y, z, w), world from body (x forward, y left, z up).
    pub world_from_body: [f64; 4],
    /// Position as the tracker measured it, m.
    pub measured_position_m: [f64; 3],
    /// Velocity over ground as the tracker measured it, m/s.
    pub measured_velocity_mps: [f64; 3],
    /// Position of the reference, m.
    pub reference_position_m: [f64; 3],
    /// Velocity of the reference, m/s.
    pub reference_velocity_mps: [f64; 3],
    /// Controls of the step that begins here.
    pub actuation: Actuation,
}

/// A slung load at one instant. World frame.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct LoadSample {
    /// True position, m.
    pub position_m: [f64; 3],
    /// True velocity, m/s.
    pub velocity_mps: [f64; 3],
    /// Position as the tracker measured it, m.
    pub measured_position_m: [f64; 3],
    /// Velocity as the tracker measured it, m/s.
    pub measured_velocity_mps: [f64; 3],
    /// Position of the reference, m.
    pub reference_position_m: [f64; 3],
    /// Mean tension of the cable over the step that ends here, N.
    pub tension_n: f64,
    /// State of the cable.
    pub cable: slung_load::Cable,
}

impl Sample {
    /// Velocity relative to the air, world frame, m/s.
    pub fn air_velocity_mps(&self) -> [f64; 3] {
        std::array::from_fn(|axis| self.velocity_mps[axis] - self.wind_mps[axis])
    }

    /// Was the tracker's command cut off at a limit?
    pub fn is_saturated(&self) -> bool {
        self.actuation.is_saturated()
    }

    /// Every number in it.
    pub fn numbers(&self) -> impl Iterator<Item = f64> + '_ {
        let vectors = [
            self.position_m,
            self.velocity_mps,
            self.wind_mps,
            self.measured_position_m,
            self.measured_velocity_mps,
            self.reference_position_m,
            self.reference_velocity_mps,
        ];
        let others = self.world_from_body.into_iter().chain([self.t_s]);
        vectors.into_iter().flatten().chain(self.actuation.numbers()).chain(others)
    }

    /// Load factors, commanded and applied.
    ///
    /// # Panics
    ///
    /// If the vehicle is not a fixed wing.
    pub fn load_factors(&self) -> &Commanded<fixed_wing::Control> {
        match &self.actuation {
            Actuation::LoadFactors(factors) => factors,
            _ => panic!("the sample is not that of a fixed wing"),
        }
    }
}

impl LoadSample {
    /// Every number in it.
    pub fn numbers(&self) -> impl Iterator<Item = f64> {
        let vectors = [
            self.position_m,
            self.velocity_mps,
            self.measured_position_m,
            self.measured_velocity_mps,
            self.reference_position_m,
        ];
        vectors.into_iter().flatten().chain([self.tension_n])
    }
}

/// An event of a flight.
#[derive(Clone, Debug, PartialEq)]
pub struct Event {
    /// Time, s.
    pub t_s: f64,
    /// What happened.
    pub kind: EventKind,
    /// Names of the vehicles concerned.
    pub vehicles: Vec<String>,
}

impl Event {
    /// An event that concerns one vehicle.
    pub(crate) fn of_vehicle(vehicle: &str, (t_s, kind): (f64, EventKind)) -> Self {
        Self { t_s, kind, vehicles: vec![vehicle.to_owned()] }
    }
}

/// Kinds of events.
#[derive(Clone, Debug, PartialEq)]
pub enum EventKind {
    /// A vehicle collided with an obstacle, or (two vehicles concerned) with another vehicle. Its log ends here.
    Crash {
        /// Name of the obstacle, if it was one.
        obstacle: Option<String>,
    },
    /// A vehicle's command reached its limits.
    SaturationBegan,
    /// A vehicle's command is inside its limits again.
    SaturationEnded,
    /// A slack cable became taut.
    CableTaut {
        /// Impulse of the impact, N s.
        impulse_ns: f64,
    },
    /// A taut cable became slack.
    CableSlack,
    /// A vehicle's sensors discovered an obstacle that was not known before.
    Discovered {
        /// Its name.
        obstacle: String,
    },
    /// A planner's result was late; its reference was entered after its beginning.
    ReplanLate {
        /// Delay, s.
        by_s: f64,
    },
    /// A planner's result could not be flown.
    ReplanRejected {
        /// Why.
        reason: String,
    },
    /// A planner gave no result that can be used. Equal failures in a row are one event.
    ReplanFailed {
        /// Why.
        reason: String,
    },
    /// What is to be said of the planners beyond their results.
    PlannerRemark {
        /// One sentence.
        text: String,
    },
    /// All vehicles rest at their goals, and stay there until the end of the flight.
    Arrived,
}
