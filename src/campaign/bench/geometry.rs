//! Other geometries of one mission: the same goals from other starts.

use rand_distr::{Distribution, Uniform};
use scenarios::Scenario;

/// Largest displacement of a start in x and in y, m.
const MAX_DISPLACEMENT_M: f64 = 100.0;

/// Maximum number of draws until the starts are valid.
const MAX_DRAWS: usize = 1000;

/// Geometry `number` of a fleet, with a planner seed of its own. Number 0 is the scenario itself; in the others every start
/// is displaced at random, by up to [`MAX_DISPLACEMENT_M`] in x and in y, such that the scenario is valid: the starts keep
/// their separation and lie outside all obstacles.
pub fn variant(fleet: &Scenario, number: usize) -> Scenario {
    let mut variant = fleet.clone();
    variant.simulation.seed += number as u64;
    if number == 0 {
        return variant;
    }
    let mut rng = scenarios::stream(number as u64, "bench/geometry");
    let displacement_m = Uniform::new(-MAX_DISPLACEMENT_M, MAX_DISPLACEMENT_M).expect("a range");
    for _ in 0..MAX_DRAWS {
        for (vehicle, original) in variant.vehicles.iter_mut().zip(&fleet.vehicles) {
            vehicle.start.x_m = original.start.x_m + displacement_m.sample(&mut rng);
            vehicle.start.y_m = original.start.y_m + displacement_m.sample(&mut rng);
        }
        if scenarios::validate(&variant).is_empty() {
            return variant;
        }
    }
    // a mission this dense has no other geometry: only the seed differs
    variant.vehicles.clone_from(&fleet.vehicles);
    variant
}

#[cfg(test)]
mod tests {
    use std::path::Path;

    use super::*;

    fn fleet() -> Scenario {
        let path = Path::new(env!("CARGO_MANIFEST_DIR")).join("scenarios/fixed-wing/rendezvous-7.toml");
        scenarios::load(&path).expect("shipped scenario")
    }

    #[test]
    fn variants_are_valid_reproducible_and_different() {
        let fleet = fleet();
        assert_eq!(variant(&fleet, 0).vehicles, fleet.vehicles);
        for number in 1..10 {
            let one = variant(&fleet, number);
            assert!(scenarios::validate(&one).is_empty());
            assert_eq!(one.vehicles, variant(&fleet, number).vehicles);
            for (moved, original) in one.vehicles.iter().zip(&fleet.vehicles) {
                assert_eq!(moved.goal, original.goal);
                let by_m = [moved.start.x_m - original.start.x_m, moved.start.y_m - original.start.y_m];
                assert!(by_m.iter().all(|by_m| *by_m != 0.0 && by_m.abs() <= MAX_DISPLACEMENT_M));
            }
        }
        assert_ne!(variant(&fleet, 1).vehicles, variant(&fleet, 2).vehicles);
    }
}
