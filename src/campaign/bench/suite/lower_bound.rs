//! Lower bound of the flight time of a scenario.

use scenarios::Scenario;

use crate::families;

/// Time in which the last vehicle can arrive at the earliest, s. `None` where the scenario gives the flight time.
pub fn lower_bound_s(scenario: &Scenario) -> Option<f64> {
    let of_vehicle = families::of(scenario.family()).min_flight_time_s?;
    scenario.vehicles.iter().map(|vehicle| of_vehicle(scenario, vehicle)).reduce(f64::max)
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
