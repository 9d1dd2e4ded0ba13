//! Lower bounds of a vehicle's flight time, s: on a straight line, at the planning limits.

use scenarios::{Scenario, Vehicle};

/// Of a fixed wing: at the largest speed.
pub fn fixed_wing_s(scenario: &Scenario, vehicle: &Vehicle) -> f64 {
    distance_m(vehicle) / scenario.models.fixed_wing[&vehicle.model].planning_limits.speed_mps.max
}

/// Of a multirotor: from rest to rest, at the largest speed if there is room to reach it.
pub fn multirotor_s(scenario: &Scenario, vehicle: &Vehicle) -> f64 {
    let limits = scenario.models.multirotor[&vehicle.model].planning_limits;
    let (speed_mps, acceleration_mps2) = (limits.speed_mps, limits.acceleration_mps2);
    let distance_m = distance_m(vehicle);
    if distance_m >= speed_mps * speed_mps / acceleration_mps2 {
        distance_m / speed_mps + speed_mps / acceleration_mps2
    } else {
        2.0 * (distance_m / acceleration_mps2).sqrt()
    }
}

fn distance_m(vehicle: &Vehicle) -> f64 {
    let (start_m, goal_m) = (vehicle.start.position_m(), vehicle.goal.position_m());
    (0..3).map(|axis| (goal_m[axis] - start_m[axis]).powi(2)).sum::<f64>().sqrt()
}
