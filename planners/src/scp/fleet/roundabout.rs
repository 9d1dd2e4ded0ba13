//! Breaks the symmetry of many vehicles that meet at one point at one time.
//!
//! Such vehicles are neighbours of each other on all sides, so the normals of the avoidance rows cancel. Displaced to
//! their right, all vehicles circle the point in the same sense. n vehicles with separation R on a circle need a radius
//! of R / (2 sin(π/n)).

use std::f64::consts::PI;

use super::conflict_detection::{Conflict, FleetMotion};
use super::initial_route::InitialRoute;

/// Smallest number of vehicles of a crowd.
const MIN_CROWD: usize = 4;

/// Smallest fraction of the pairs of a crowd that are in conflict.
const MIN_CONFLICT_FRACTION: f64 = 0.5;

/// Radius of the roundabout relative to the smallest possible one.
const RADIUS_FACTOR: f64 = 1.25;

/// Vehicles that meet at one point.
#[derive(Clone, Debug)]
pub struct Crowd {
    /// The vehicles.
    pub vehicles: Vec<usize>,
    /// Mean time of their conflicts, s.
    pub at_s: f64,
}

/// Displaces the routes of all vehicles of each crowd to their right.
pub fn displace(routes: &mut [InitialRoute], crowds: &[Crowd], required_m: f64) {
    for crowd in crowds {
        let radius_m = RADIUS_FACTOR * required_m / (2.0 * (PI / crowd.vehicles.len() as f64).sin());
        for &vehicle in &crowd.vehicles {
            let length_m = routes[vehicle].route.length_m();
            let peak_m = length_m * (crowd.at_s / routes[vehicle].flight_time_s).clamp(0.2, 0.8);
            routes[vehicle].route = routes[vehicle].route.displaced(-radius_m, peak_m, length_m);
        }
    }
}

/// Groups of vehicles in which most pairs come closer to each other than half of `required_m`.
pub fn crowds(motion: &FleetMotion, required_m: f64) -> Vec<Crowd> {
    let conflicts = motion.conflicts(0.5 * required_m);
    let mut remaining: Vec<&Conflict> = conflicts.iter().collect();
    let mut crowds = Vec::new();
    while let Some(first) = remaining.first() {
        let group = connected(first, &remaining);
        let pairs = remaining.iter().filter(|conflict| conflict.vehicles.iter().all(|vehicle| group.contains(vehicle)));
        let (count, sum_s) = pairs.fold((0, 0.0), |(count, sum_s), conflict| (count + 1, sum_s + conflict.at_s));
        let all_pairs = group.len() * (group.len() - 1) / 2;
        if group.len() >= MIN_CROWD && count as f64 >= MIN_CONFLICT_FRACTION * all_pairs as f64 {
            crowds.push(Crowd { at_s: sum_s / f64::from(count), vehicles: group.clone() });
        }
        remaining.retain(|conflict| !conflict.vehicles.iter().any(|vehicle| group.contains(vehicle)));
    }
    crowds
}

/// All vehicles that a chain of conflicts connects with `first`, ascending.
fn connected(first: &Conflict, conflicts: &[&Conflict]) -> Vec<usize> {
    let mut group = first.vehicles.to_vec();
    loop {
        let before = group.len();
        for conflict in conflicts {
            let [a, b] = conflict.vehicles.map(|vehicle| group.contains(&vehicle));
            match (a, b) {
                (true, false) => group.push(conflict.vehicles[1]),
                (false, true) => group.push(conflict.vehicles[0]),
                _ => {}
            }
        }
        if group.len() == before {
            group.sort_unstable();
            return group;
        }
    }
}
