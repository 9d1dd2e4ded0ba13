//! The initial trajectories of the papers' planners: straight lines with a common flight time.

use nalgebra::Vector3;
use scenarios::{Scenario, Vehicle};

use super::dynamics::{Control, State};
use super::iterate::Iterate;

/// Linear interpolation of the state from start to goal, over the longest straight flight time of the fleet.
pub fn straight_lines(scenario: &Scenario, intervals: usize) -> Vec<Iterate> {
    let max_s = scenario.vehicles.iter().map(straight_flight_time_s).fold(0.0, f64::max);
    scenario.vehicles.iter().map(|vehicle| straight_line(vehicle, intervals, max_s / intervals as f64)).collect()
}

/// Flight time along the straight line at the mean of the initial and final speed, s.
fn straight_flight_time_s(vehicle: &Vehicle) -> f64 {
    let (start, goal) = (Vector3::from(vehicle.start.position_m()), Vector3::from(vehicle.goal.position_m()));
    2.0 * (goal - start).norm() / (vehicle.start.speed_mps + vehicle.goal.speed_mps)
}

fn straight_line(vehicle: &Vehicle, intervals: usize, dt_s: f64) -> Iterate {
    let [start, goal] = boundary_states(vehicle);
    let fraction = |k: usize| k as f64 / intervals as f64;
    Iterate {
        states: (0..=intervals).map(|k| start.lerp(&goal, fraction(k))).collect(),
        controls: vec![Control::new(0.0, 0.0, 1.0); intervals + 1],
        dt_s,
        ramp: 1.0,
    }
}

/// Initial and final state; the final heading is within half a turn of the initial one.
pub fn boundary_states(vehicle: &Vehicle) -> [State; 2] {
    let [start, mut goal] =
        [&vehicle.start, &vehicle.goal].map(|waypoint| State::from(waypoint.fixed_wing_state().to_array()));
    let turn = goal[4] - start[4];
    goal[4] -= (turn / std::f64::consts::TAU).round() * std::f64::consts::TAU;
    [start, goal]
}
