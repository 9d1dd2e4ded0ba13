//! What is measured of a plan and its flight, as data.

use schemars::JsonSchema;
use serde::{Deserialize, Serialize};

use super::in_loop::InLoopMetrics;
use super::slung_load::SlungLoadMetrics;
use super::trajectory_error::VehicleErrors;

/// Everything that was measured of a plan and its flight.
#[derive(Clone, Debug, Default, PartialEq, Serialize, Deserialize, JsonSchema)]
pub struct Metrics {
    /// Absent when the plan is not flyable.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub plan: Option<PlanMetrics>,
    /// Absent when there is no flight, or its logs cannot be matched with the vehicles.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub flight: Option<FlightMetrics>,
    /// Of a quadrotor with a slung load, in the place of the two above.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub slung_load: Option<SlungLoadMetrics>,
    /// Of planning in the loop.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub in_loop: Option<InLoopMetrics>,
    /// Pose errors by the definitions of evo, per vehicle.
    #[serde(default, skip_serializing_if = "Vec::is_empty")]
    pub pose_errors: Vec<VehicleErrors>,
}

/// Figures of the plan, at its nodes unless said otherwise. A figure that is absent could not be measured.
#[derive(Clone, Debug, Default, PartialEq, Serialize, Deserialize, JsonSchema)]
pub struct PlanMetrics {
    /// Time at which the last vehicle arrives, s.
    pub flight_time_s: Option<f64>,
    /// Speed: mean over the nodes of each vehicle, mean over the vehicles, m/s.
    pub mean_speed_mps: Option<f64>,
    /// Speed: standard deviation over the nodes of each vehicle, mean over the vehicles, m/s.
    pub speed_std_mps: Option<f64>,
    /// Altitude: standard deviation over the nodes of each vehicle, mean over the vehicles, m.
    pub altitude_std_m: Option<f64>,
    /// Σ|n_x| over all nodes of all vehicles, -. (The paper's figures are too large to be those of one vehicle.)
    pub sum_abs_n_x: Option<f64>,
    /// Σ|n_y| over all nodes of all vehicles, -.
    pub sum_abs_n_y: Option<f64>,
    /// Σ|n_z - 1| over all nodes of all vehicles, -.
    pub sum_abs_n_z_minus_1: Option<f64>,
    /// Smallest distances at the nodes.
    pub at_nodes: SmallestDistances,
    /// Smallest distances over continuous time.
    pub between_nodes: SmallestDistances,
}

/// Figures of the flight, over the time for which it is judged. A figure that is absent could not be measured.
#[derive(Clone, Debug, Default, PartialEq, Serialize, Deserialize, JsonSchema)]
pub struct FlightMetrics {
    /// Time until the last vehicle arrived, or until the log of one that did not arrive ends, s.
    pub flight_time_s: Option<f64>,
    /// Airspeed: mean over time of each vehicle, mean over the vehicles, m/s.
    pub mean_speed_mps: Option<f64>,
    /// Airspeed: standard deviation over time of each vehicle, mean over the vehicles, m/s.
    pub speed_std_mps: Option<f64>,
    /// Altitude: standard deviation over time of each vehicle, mean over the vehicles, m.
    pub altitude_std_m: Option<f64>,
    /// Largest distance from the plan, m.
    pub tracking_max_m: Option<f64>,
    /// Root mean square over time of the distance from the plan, of the worst vehicle, m.
    pub tracking_rms_m: Option<f64>,
    /// Share of the steps in which the command was cut off, of the worst vehicle, -.
    pub saturation: Option<f64>,
    /// Smallest distances over continuous time.
    pub distances: SmallestDistances,
}

/// Smallest distances of a fleet; absent with fewer than two vehicles, or without obstacles.
#[derive(Clone, Copy, Debug, Default, PartialEq, Serialize, Deserialize, JsonSchema)]
pub struct SmallestDistances {
    /// Distance between two vehicles, m: horizontal, of multirotors in space.
    pub separation_m: Option<f64>,
    /// Signed horizontal distance from a vehicle to an obstacle's surface, m; of multirotors in space, from the surface of
    /// their bodies, to the map's frame too.
    pub clearance_m: Option<f64>,
}
