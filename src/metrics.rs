//! Figures of a plan and its flight: those that the fixed-wing papers report, and how near it came to its limits.
//!
//! Wang, Xu, Long (2020), section 5, give for a fleet: flight time, mean speed, standard deviations of speed and
//! altitude, sums of the absolute load factors, smallest distance between vehicles.

mod in_loop;
mod over_time;
mod slung_load;
pub mod trajectory_error;

use scenarios::fixed_wing::Trajectory;
use scenarios::{Family, Plan, Scenario};
use schemars::JsonSchema;
use serde::{Deserialize, Serialize};
use sim::{Flight, Sample};

use self::trajectory_error::VehicleErrors;
use crate::verdict::{self, Flown, Motion, Planned};

pub use in_loop::InLoopMetrics;
pub use over_time::{Nearest, clearance_over_time, separation_over_time};
pub use slung_load::{CableSwitch, SlungLoadMetrics};

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
    /// Horizontal distance between two vehicles, m.
    pub separation_m: Option<f64>,
    /// Signed horizontal distance from a vehicle to an obstacle's surface, m; of multirotors in space, from the surface of
    /// their bodies, to the map's frame too.
    pub clearance_m: Option<f64>,
}

/// Measures a plan and, if there is one, its flight.
pub fn measure(scenario: &Scenario, plan: &Plan, flight: Option<&Flight>) -> Metrics {
    if verdict::is_flyable(scenario, plan).is_err() {
        return Metrics::default();
    }
    let pose_errors = flight.map(trajectory_error::of_fleet).unwrap_or_default();
    if scenario.family() == Family::SlungLoad {
        let slung_load = Some(slung_load::measure(scenario, plan, flight));
        return Metrics { slung_load, pose_errors, ..Metrics::default() };
    }
    let flown = flight.and_then(|flight| Flown::new(scenario, plan, flight).ok());
    Metrics {
        plan: (scenario.family() == Family::FixedWing).then(|| of_plan(scenario, plan)),
        flight: flown.map(|flown| of_flight(scenario, &flown)),
        slung_load: None,
        in_loop: flight.and_then(|flight| Some(in_loop::measure(flight, flight.planning.as_ref()?))),
        pose_errors,
    }
}

fn of_plan(scenario: &Scenario, plan: &Plan) -> PlanMetrics {
    let planned = Planned::new(scenario, plan);
    let trajectories = || plan.trajectories.iter().map(scenarios::Trajectory::fixed_wing);
    let states = |value: fn(&scenarios::fixed_wing::State) -> f64| {
        Spread::over(trajectories().map(|trajectory| trajectory.states.iter().map(value)))
    };
    let controls = |axis: usize, trim: f64| {
        let magnitudes = |trajectory: &Trajectory| -> f64 {
            trajectory.controls.iter().map(|control| (control.to_array()[axis] - trim).abs()).sum()
        };
        finite(trajectories().map(magnitudes).sum())
    };
    let (speed, altitude) = (states(|state| state.speed_mps), states(|state| state.z_m));
    PlanMetrics {
        flight_time_s: plan.flight_time_s().and_then(finite),
        mean_speed_mps: speed.mean,
        speed_std_mps: speed.standard_deviation,
        altitude_std_m: altitude.standard_deviation,
        sum_abs_n_x: controls(0, 0.0),
        sum_abs_n_y: controls(1, 0.0),
        sum_abs_n_z_minus_1: controls(2, 1.0),
        at_nodes: SmallestDistances {
            separation_m: verdict::separation_at_nodes(plan).and_then(|nearest| finite(nearest.lower_m)),
            clearance_m: verdict::clearance_at_nodes(&scenario.world, plan).and_then(|nearest| finite(nearest.lower_m)),
        },
        between_nodes: planned.map_or_else(|_| SmallestDistances::default(), |it| distances(scenario, &it.motions)),
    }
}

fn of_flight(scenario: &Scenario, flown: &Flown<'_>) -> FlightMetrics {
    let vehicles = || flown.vehicles.iter();
    let speed = Spread::over(vehicles().map(|vehicle| vehicle.judged.iter().map(airspeed_mps)));
    let altitude = Spread::over(vehicles().map(|vehicle| vehicle.judged.iter().map(|sample| sample.position_m[2])));
    let worst = |value: fn(&[Sample]) -> f64| {
        let values: Option<Vec<f64>> = vehicles().map(|vehicle| finite(value(vehicle.tracked))).collect();
        values?.into_iter().reduce(f64::max)
    };
    FlightMetrics {
        flight_time_s: finite(verdict::flown_duration_s(flown)),
        mean_speed_mps: speed.mean,
        speed_std_mps: speed.standard_deviation,
        altitude_std_m: altitude.standard_deviation,
        tracking_max_m: worst(|samples| verdict::largest_tracking_error(samples).0),
        tracking_rms_m: worst(verdict::root_mean_square_tracking_error),
        saturation: worst(verdict::saturation),
        distances: distances(scenario, &flown.motions),
    }
}

fn distances(scenario: &Scenario, motions: &[Motion]) -> SmallestDistances {
    let clearance_m = match scenario.family() {
        Family::Multirotor => verdict::multirotor::closest(scenario, motions).map(|nearest| nearest.lower_m),
        _ => verdict::closest_to_cylinders(motions, &scenario.world.cylinders).map(|nearest| nearest.lower_m),
    };
    SmallestDistances { separation_m: verdict::closest_vehicles(motions).map(|nearest| nearest.lower_m), clearance_m }
}

fn airspeed_mps(sample: &Sample) -> f64 {
    sample.air_velocity_mps().iter().map(|component| component * component).sum::<f64>().sqrt()
}

fn finite(value: f64) -> Option<f64> {
    value.is_finite().then_some(value)
}

/// Mean over the vehicles of each one's mean and standard deviation.
struct Spread {
    mean: Option<f64>,
    standard_deviation: Option<f64>,
}

impl Spread {
    fn over<V: Iterator<Item = f64> + Clone>(vehicles: impl Iterator<Item = V>) -> Self {
        let (mut count, mut mean, mut standard_deviation) = (0.0, 0.0, 0.0);
        for values in vehicles {
            let length = values.clone().count() as f64;
            let own_mean = values.clone().sum::<f64>() / length;
            let variance = values.map(|value| (value - own_mean).powi(2)).sum::<f64>() / length;
            count += 1.0;
            mean += own_mean;
            standard_deviation += variance.sqrt();
        }
        Self { mean: finite(mean / count), standard_deviation: finite(standard_deviation / count) }
    }
}
