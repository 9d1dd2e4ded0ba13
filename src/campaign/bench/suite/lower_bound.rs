//! Lower bounds of the flight time: on a straight line, at the planning limits.

use scenarios::{Family, Scenario, Vehicle};

/// Time in which the last vehicle can arrive at the earliest, s. `None` where the scenario gives the flight time.
pub fn lower_bound_s(scenario: &Scenario) -> Option<f64> {
    let of_vehicle: fn(&Scenario, &Vehicle) -> f64 = match scenario.family() {
        Family::FixedWing => fixed_wing_s,
        Family::Multirotor => multirotor_s,
        Family::SlungLoad => return None,
    };
    scenario.vehicles.iter().map(|vehicle| of_vehicle(scenario, vehicle)).reduce(f64::max)
}

/// At the largest speed.
fn fixed_wing_s(scenario: &Scenario, vehicle: &Vehicle) -> f64 {
    distance_m(vehicle) / scenario.models.fixed_wing[&vehicle.model].planning_limits.speed_mps.max
}

/// From rest to rest, at the largest speed if there is room to reach it.
fn multirotor_s(scenario: &Scenario, vehicle: &Vehicle) -> f64 {
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

#[cfg(test)]
mod tests {
    use super::lower_bound_s;
    use crate::campaign::generate::{Request, find};

    fn bound_s(kind: &str) -> Option<f64> {
        let mut scenario = Request { size: 2, ..Request::new(find(kind).unwrap(), 1) }.generate().unwrap().scenario();
        for (vehicle, x_m) in scenario.vehicles.iter_mut().zip([3.0, 6000.0]) {
            vehicle.goal = vehicle.start;
            vehicle.goal.x_m += x_m;
        }
        lower_bound_s(&scenario)
    }

    #[test]
    fn the_last_vehicle_decides() {
        assert_eq!(bound_s("ring"), Some(6000.0 / 40.0));
        assert!((bound_s("crossing").unwrap() - 2001.0).abs() < 1e-9, "3 m/s after 1 s and until 1 s before the end");
        assert_eq!(bound_s("blocks"), None);
    }

    #[test]
    fn a_short_hop_never_reaches_the_largest_speed() {
        let mut scenario = Request::new(find("building").unwrap(), 1).generate().unwrap().scenario();
        scenario.vehicles[0].goal = scenario.vehicles[0].start;
        scenario.vehicles[0].goal.z_m += 0.75;
        assert!((lower_bound_s(&scenario).unwrap() - 1.0).abs() < 1e-12, "0.375 m at 3 m/s² and back");
    }
}
