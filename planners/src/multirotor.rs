//! The planning model of a multirotor: a point mass with bounded speed and acceleration, a double integrator.

mod motion;
pub mod reference;

pub use motion::{PointMassMotion, PointMassState, sagitta_m};

use scenarios::{Family, Scenario};

/// Default distance kept beyond the body, as an allowance for the tracking error, m.
const DEFAULT_MARGIN_M: f64 = 0.25;

/// Norm bounds that a planned motion keeps.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct PlanningLimits {
    /// |v| <= v_max, m/s (eq. 20).
    pub speed_mps: f64,
    /// |a| <= a_max, m/s² (eq. 21).
    pub acceleration_mps2: f64,
}

impl PlanningLimits {
    /// The limits of a scenario's vehicle.
    pub fn of_vehicle(scenario: &Scenario, vehicle: usize) -> Self {
        let limits = scenario.multirotor_model(&scenario.vehicles[vehicle]).planning_limits;
        Self { speed_mps: limits.speed_mps, acceleration_mps2: limits.acceleration_mps2 }
    }

    /// Distance to stop from full speed, m.
    pub fn stopping_distance_m(&self) -> f64 {
        0.5 * self.speed_mps * self.speed_mps / self.acceleration_mps2
    }

    /// Time to stop from full speed, s.
    pub fn stopping_time_s(&self) -> f64 {
        self.speed_mps / self.acceleration_mps2
    }
}

/// Why a planner for multirotors cannot handle a scenario; `None` if it can.
pub fn unsupported_reason(scenario: &Scenario) -> Option<String> {
    if scenario.family() != Family::Multirotor {
        return Some(format!("vehicle `{}` is not a multirotor", scenario.vehicles[0].name));
    }
    None
}

/// Distance that the planner keeps between the vehicle's centre and everything else, m.
pub fn clearance_m(scenario: &Scenario, vehicle: usize) -> f64 {
    body_radius_m(scenario, vehicle) + margin_m(scenario)
}

/// Distance that the planner keeps beyond the body, m.
pub fn margin_m(scenario: &Scenario) -> f64 {
    scenario.planner.margin_m.unwrap_or(DEFAULT_MARGIN_M)
}

/// Radius of the sphere that encloses the vehicle, m.
pub fn body_radius_m(scenario: &Scenario, vehicle: usize) -> f64 {
    scenario.multirotor_model(&scenario.vehicles[vehicle]).body_radius_m
}
