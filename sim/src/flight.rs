//! The flight log: what the simulated vehicles did, as far as anybody may ask afterwards.

use scenarios::{fixed_wing, slung_load};

use crate::PlanningLog;

/// A simulated flight of the whole fleet. Positions and velocities in the world frame (ENU).
#[derive(Clone, Debug, PartialEq)]
pub struct Flight {
    /// Step of the simulator, s. Logs hold every step.
    pub step_s: f64,
    /// End of the plan, s: from then on the vehicles coast along their last heading.
    pub plan_end_s: f64,
    /// One log per vehicle, in the order of the scenario.
    pub vehicles: Vec<VehicleLog>,
    /// What happened, in the order of time.
    pub events: Vec<Event>,
    /// What was planned in the loop; `None` for a plan that was there before the flight.
    pub planning: Option<PlanningLog>,
    /// Wall time of the simulation, s.
    pub wall_s: f64,
}

/// What one vehicle did.
#[derive(Clone, Debug, PartialEq)]
pub struct VehicleLog {
    /// Name of the vehicle.
    pub vehicle: String,
    /// From time 0 to the end of the simulation, or to its crash.
    pub samples: Vec<Sample>,
    /// Its load at the same instants; empty if it carries none.
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
    /// Velocity of the air around it, m/s.
    pub wind_mps: [f64; 3],
    /// Attitude as a unit quaternion (x, y, z, w), world from body (x forward, y left, z up).
    pub world_from_body: [f64; 4],
    /// Position as the tracker measured it, m.
    pub measured_position_m: [f64; 3],
    /// Velocity over ground as the tracker measured it, m/s.
    pub measured_velocity_mps: [f64; 3],
    /// Position that the plan asks for, m.
    pub reference_position_m: [f64; 3],
    /// Velocity that the plan asks for, m/s.
    pub reference_velocity_mps: [f64; 3],
    /// What steered it.
    pub actuation: Actuation,
}

/// Controls of one instant, those of the vehicle's family.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum Actuation {
    /// Load factors of a fixed wing.
    LoadFactors(Commanded<fixed_wing::Control>),
    /// Rotor thrusts of a quadrotor.
    Thrusts(Commanded<slung_load::Control>),
    /// Acceleration of a point mass beyond what carries its weight, world frame, m/s².
    Acceleration(Commanded<[f64; 3]>),
}

/// What was asked for, and what was given.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Commanded<C> {
    /// What the tracker asked for.
    pub command: C,
    /// What acted, inside the vehicle's limits.
    pub control: C,
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
    /// Position that the plan asks for, m.
    pub reference_position_m: [f64; 3],
    /// Tension of the cable over the step that ends here, N: the impulse that it gave, by the step's length.
    pub tension_n: f64,
    /// What the cable does.
    pub cable: slung_load::Cable,
}

impl Sample {
    /// Velocity relative to the air, world frame, m/s.
    pub fn air_velocity_mps(&self) -> [f64; 3] {
        std::array::from_fn(|axis| self.velocity_mps[axis] - self.wind_mps[axis])
    }

    /// Was the tracker's command cut off at a limit?
    pub fn is_saturated(&self) -> bool {
        match self.actuation {
            Actuation::LoadFactors(Commanded { command, control }) => command != control,
            Actuation::Thrusts(Commanded { command, control }) => command != control,
            Actuation::Acceleration(Commanded { command, control }) => command != control,
        }
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
        let controls: Vec<f64> = match self.actuation {
            Actuation::LoadFactors(Commanded { command, control }) => {
                [command, control].map(|it| it.to_array()).concat()
            }
            Actuation::Thrusts(Commanded { command, control }) => [command.thrust_n, control.thrust_n].concat(),
            Actuation::Acceleration(Commanded { command, control }) => [command, control].concat(),
        };
        let others = self.world_from_body.into_iter().chain([self.t_s]);
        vectors.into_iter().flatten().chain(controls).chain(others)
    }

    /// Load factors asked for and given. Panics for a vehicle that is not a fixed wing.
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

/// Something worth a line in the log.
#[derive(Clone, Debug, PartialEq)]
pub struct Event {
    /// When, s.
    pub t_s: f64,
    /// What.
    pub kind: EventKind,
    /// The vehicles concerned.
    pub vehicles: Vec<String>,
}

/// Kinds of events.
#[derive(Clone, Debug, PartialEq)]
pub enum EventKind {
    /// A vehicle touched an obstacle, by its name, or (two vehicles concerned) another vehicle. Its log ends here.
    Crash {
        /// The obstacle, if it was one.
        obstacle: Option<String>,
    },
    /// A vehicle's command reached its limits.
    SaturationBegan,
    /// A vehicle's command is inside its limits again.
    SaturationEnded,
    /// A slack cable became taut, with this impulse.
    CableTaut {
        /// Impulse of the impact, N s.
        impulse_ns: f64,
    },
    /// A taut cable became slack.
    CableSlack,
    /// A vehicle's sensors found an obstacle that it had not known of.
    Discovered {
        /// Its name.
        obstacle: String,
    },
    /// A planner's answer came too late, and was joined in its middle.
    ReplanLate {
        /// By how much, s.
        by_s: f64,
    },
    /// A planner's answer could not be flown.
    ReplanRejected {
        /// Why.
        reason: String,
    },
    /// All vehicles have come to rest at their goals.
    Arrived,
}
