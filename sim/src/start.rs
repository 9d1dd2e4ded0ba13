//! Where vehicles really start.

use nalgebra::Vector3;
use rand_distr::{Distribution, UnitDisc};
use scenarios::{Scenario, Vehicle};

/// True start of a vehicle relative to its nominal one, m: drawn from the disc that the scenario asks for.
pub fn offset_m(scenario: &Scenario, vehicle: &Vehicle, seed: u64) -> Vector3<f64> {
    let mut rng = scenarios::stream(seed, &format!("start/{}", vehicle.name));
    let [east, north]: [f64; 2] = UnitDisc.sample(&mut rng);
    Vector3::new(east, north, 0.0) * scenario.simulation.mismatch.start_radius_m
}

#[cfg(test)]
mod tests {
    use super::offset_m;

    const TEXT: &str = r#"
        name = "two"
        description = "Two multirotors"
        [world]
        map = { x_m = [0, 9], y_m = [0, 9], z_m = [0, 4] }
        [models.multirotor.quad]
        mass_kg = 1.5
        body_radius_m = 0.35
        sensor_range_m = 8
        limits = { speed_mps = 3, acceleration_mps2 = 3 }
        planning_limits = { speed_mps = 2.5, acceleration_mps2 = 1.5 }
        [[vehicles]]
        name = "uav-1"
        model = "quad"
        start = { x_m = 1, y_m = 1, z_m = 2 }
        goal = { x_m = 6, y_m = 1, z_m = 2 }
        [[vehicles]]
        name = "uav-2"
        model = "quad"
        start = { x_m = 1, y_m = 3, z_m = 2 }
        goal = { x_m = 6, y_m = 3, z_m = 2 }
        [planner]
        name = "by-hand"
        [simulation]
        mismatch = { start_radius_m = 0.2 }
    "#;

    #[test]
    fn starts_are_drawn_inside_the_disc_each_on_its_own() {
        let mut scenario = scenarios::parse("two.toml", TEXT).unwrap();
        let [one, other] = [0, 1].map(|index| scenario.vehicles[index].clone());
        let offsets_m: Vec<_> = (0..500).map(|seed| offset_m(&scenario, &one, seed)).collect();
        assert!(offsets_m.iter().all(|offset_m| offset_m.norm() <= 0.2 && offset_m.z == 0.0));
        assert!(offsets_m.iter().any(|offset_m| offset_m.norm() > 0.19));
        assert!(
            offsets_m.iter().any(|offset_m| offset_m.x < -0.1) && offsets_m.iter().any(|offset_m| offset_m.y > 0.1)
        );
        assert_ne!(offset_m(&scenario, &one, 3), offset_m(&scenario, &other, 3));
        scenario.simulation.mismatch.start_radius_m = 0.0;
        assert_eq!(offset_m(&scenario, &one, 3).norm(), 0.0);
    }
}
