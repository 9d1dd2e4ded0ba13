//! The flight log: what the simulated vehicles did, as far as anybody may ask afterwards.

use scenarios::fixed_wing::Control;

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
    /// Load factors that the tracker asked for.
    pub command: Control,
    /// Load factors that acted, inside the vehicle's limits.
    pub control: Control,
}

impl Sample {
    /// Velocity relative to the air, world frame, m/s.
    pub fn air_velocity_mps(&self) -> [f64; 3] {
        std::array::from_fn(|axis| self.velocity_mps[axis] - self.wind_mps[axis])
    }

    /// Was the tracker's command cut off at a limit?
    pub fn is_saturated(&self) -> bool {
        self.command != self.control
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
}
