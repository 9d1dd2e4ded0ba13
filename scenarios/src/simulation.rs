mod planning;

use schemars::JsonSchema;
use serde::{Deserialize, Serialize};

pub use planning::{Planning, PlanningClock};

/// Settings and disturbances of the simulated flight. A disturbance that is not given is off.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields, default)]
pub struct Simulation {
    /// Time step of the simulator, s.
    pub step_s: f64,
    /// Seed of all random numbers in planning and flight.
    pub seed: u64,
    /// Maximum flight time, s; a longer plan is not flown to its end.
    pub max_duration_s: f64,
    /// Duration of straight flight after the end of the plan, s, so that a late arrival is observed.
    pub coast_s: f64,
    /// Gains of the tracking controller.
    pub tracker: Tracker,
    /// Wind.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub wind: Option<Wind>,
    /// Sensor noise and delay.
    pub sensors: Sensors,
    /// Differences between the true vehicle and its model.
    pub mismatch: Mismatch,
    /// Schedule and planning times of in-loop planners.
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

/// Tracking controller: feedforward of the plan's load factors plus feedback on position and velocity,
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

/// Wind: the mean and the pulses are the same for all vehicles; each vehicle has continuous gusts of its own. Wind acts on
/// multirotors and slung loads by their drag areas, which their models must have.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields)]
pub struct Wind {
    /// Mean velocity of the air in the world frame (towards east, north, up), m/s.
    pub mean_mps: [f64; 3],
    /// Continuous gusts.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub gusts: Option<Gusts>,
    /// Discrete gusts at given times.
    #[serde(default, skip_serializing_if = "Vec::is_empty")]
    pub pulses: Vec<GustPulse>,
}

/// A discrete gust of 1-cosine shape (after MIL-F-8785C, 3.7.1.3), from zero to its peak and back to zero.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields)]
pub struct GustPulse {
    /// Start time, s.
    pub start_s: f64,
    /// Duration, s, at least four time steps of the simulator.
    pub duration_s: f64,
    /// Peak velocity, added to all other wind, world frame, m/s.
    pub peak_mps: [f64; 3],
}

/// Dryden gusts (MIL-F-8785C): the low-altitude model below 1000 ft, interpolated between 1000 ft and 2000 ft.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields)]
pub struct Gusts {
    /// Mean wind speed W20 at 20 ft (6.1 m) above ground, m/s; sets the intensity below 1000 ft. In the standard, 15 kt
    /// (7.7 m/s) is light, 30 kt moderate, 45 kt severe.
    pub wind_at_20ft_mps: f64,
    /// Intensity σ of all three components at 2000 ft and above, m/s.
    pub sigma_aloft_mps: f64,
}

/// Sensor errors: standard deviations of white noise per axis, and delay. Zero: exact and immediate measurements.
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
    /// Delay of the measurements of a vehicle's own state and of its load, s, rounded to time steps of the simulator, but not
    /// to none of them. Tracker and planner are not told, and take the measurements as current.
    pub delay_s: f64,
    /// Position of moving obstacles and of other vehicles, m.
    pub sighting_position_noise_m: f64,
    /// Velocity of moving obstacles and of other vehicles, m/s.
    pub sighting_velocity_noise_mps: f64,
}

/// Differences between the planning model and the simulated vehicle.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields, default)]
pub struct Mismatch {
    /// True mass over nominal mass, -. Forces are those of the nominal mass.
    pub mass_ratio: f64,
    /// True mass of a slung load over its nominal mass, -.
    pub load_mass_ratio: f64,
    /// Radius of the horizontal disc around the nominal start from which each vehicle's true start is drawn, m.
    pub start_radius_m: f64,
}

impl Default for Mismatch {
    fn default() -> Self {
        Self { mass_ratio: 1.0, load_mass_ratio: 1.0, start_radius_m: 0.0 }
    }
}
