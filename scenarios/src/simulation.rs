mod planning;

use schemars::JsonSchema;
use serde::{Deserialize, Serialize};

pub use planning::{Planning, PlanningClock};

/// How a plan is flown. Everything that disturbs a flight is off unless it is named.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields, default)]
pub struct Simulation {
    /// Step of the simulator, s.
    pub step_s: f64,
    /// Seed of everything random in planning and flight.
    pub seed: u64,
    /// A plan that takes longer than this is not flown to its end, s.
    pub max_duration_s: f64,
    /// Straight flight beyond the end of the plan, so that a late arrival can be seen, s.
    pub coast_s: f64,
    /// Gains of the tracking controller.
    pub tracker: Tracker,
    /// MovingCylinder air.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub wind: Option<Wind>,
    /// What the tracker's sensors add to the truth.
    pub sensors: Sensors,
    /// How the true vehicle differs from its model.
    pub mismatch: Mismatch,
    /// When planners in the loop are asked, and how long they take.
    pub planning: Planning,
}

impl Default for Simulation {
    fn default() -> Self {
        Self {
            step_s: 0.01,
            seed: 0,
            max_duration_s: 600.0,
            coast_s: 2.0,
            tracker: Tracker::default(),
            wind: None,
            sensors: Sensors::default(),
            mismatch: Mismatch::default(),
            planning: Planning::default(),
        }
    }
}

/// Tracking controller: the plan's load factors plus feedback on position and velocity,
/// a = ω² (p_ref - p) + 2 ζ ω (v_ref - v).
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields, default)]
pub struct Tracker {
    /// Natural frequency ω of the position error, rad/s.
    pub natural_frequency_radps: f64,
    /// Damping ratio ζ of the position error, -.
    pub damping_ratio: f64,
}

impl Default for Tracker {
    fn default() -> Self {
        Self { natural_frequency_radps: 0.8, damping_ratio: 1.0 }
    }
}

/// The motion of the air, the same for all vehicles, plus gusts that each vehicle meets on its own.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields)]
pub struct Wind {
    /// Constant part: velocity of the air in the world frame (towards east, north, up), m/s.
    pub mean_mps: [f64; 3],
    /// Continuous gusts.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub gusts: Option<Gusts>,
    /// Single gusts at given times.
    #[serde(default, skip_serializing_if = "Vec::is_empty")]
    pub pulses: Vec<GustPulse>,
}

/// A single gust of the 1-cosine form (after MIL-F-8785C, 3.7.1.3), from rest to its peak and back to rest.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields)]
pub struct GustPulse {
    /// When it begins, s.
    pub start_s: f64,
    /// How long it lasts, s, > 0.
    pub duration_s: f64,
    /// Velocity of the air at its peak, on top of everything else, world frame, m/s.
    pub peak_mps: [f64; 3],
}

/// Dryden gusts (MIL-F-8785C): the low-altitude form below 1000 ft, interpolated between 1000 ft and 2000 ft.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields)]
pub struct Gusts {
    /// Mean wind speed W20 at 20 ft (6.1 m) above ground, m/s; sets the intensity below 1000 ft. The standard calls
    /// 15 kt (7.7 m/s) light, 30 kt moderate, 45 kt severe.
    pub wind_at_20ft_mps: f64,
    /// Intensity σ of all three components at 2000 ft and above, m/s.
    pub sigma_aloft_mps: f64,
}

/// What is wrong with what the tracker measures: standard deviations of its white noise, per axis, and its age. Zero: the
/// truth, at once.
#[derive(Clone, Debug, Default, PartialEq, Serialize, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields, default)]
pub struct Sensors {
    /// Position, m.
    pub position_noise_m: f64,
    /// Velocity over ground, m/s.
    pub velocity_noise_mps: f64,
    /// Attitude of a quadrotor, about each body axis, deg.
    pub attitude_noise_deg: f64,
    /// Angular velocity of a quadrotor in body axes, deg/s.
    pub rate_noise_degps: f64,
    /// Position of a slung load, m.
    pub load_position_noise_m: f64,
    /// Velocity of a slung load, m/s.
    pub load_velocity_noise_mps: f64,
    /// Age of what a vehicle measures of itself and of its load when its tracker (or planner) gets it, s, rounded to steps of
    /// the simulator. The tracker does not know of it, and takes it for now.
    pub delay_s: f64,
    /// Position of moving obstacles and of other vehicles, m.
    pub sighting_position_noise_m: f64,
    /// Velocity of moving obstacles and of other vehicles, m/s.
    pub sighting_velocity_noise_mps: f64,
}

/// Difference between the model that plans and the vehicle that flies.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields, default)]
pub struct Mismatch {
    /// True mass over nominal mass, -. Forces stay those of the nominal mass.
    pub mass_ratio: f64,
    /// True mass of a slung load over its nominal mass, -.
    pub load_mass_ratio: f64,
    /// Radius of the horizontal disc about its nominal start in which every vehicle's true start is drawn, m.
    pub start_radius_m: f64,
}

impl Default for Mismatch {
    fn default() -> Self {
        Self { mass_ratio: 1.0, load_mass_ratio: 1.0, start_radius_m: 0.0 }
    }
}
