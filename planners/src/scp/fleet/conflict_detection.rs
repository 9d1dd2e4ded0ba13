//! The motion of the fleet, and its conflicts with itself and with obstacles.

use nalgebra::Vector2;
use rayon::prelude::*;
use scenarios::Cylinder;

use super::super::iterate::Iterate;
use super::closest_approach::{self, ClosestApproach};
use super::grid::{self, Disc};
use super::motion::{TimeSlice, VehicleMotion, locate};

/// Bound of the distance between the cubic interpolant and the samples of a time slice, m: far more than an aircraft
/// deviates within a second or two.
const MAX_DEVIATION_M: f64 = 5.0;

/// The motion of all vehicles on common time slices.
#[derive(Clone, Debug)]
pub struct FleetMotion {
    /// One per vehicle.
    pub vehicles: Vec<VehicleMotion>,
    slices: Vec<Vec<TimeSlice>>,
    /// The fraction of its last slice after which each vehicle has arrived.
    ends: Vec<f64>,
    width_s: f64,
    /// Is every slice an interval of every vehicle?
    is_synchronised: bool,
}

/// Two vehicles closer than a given distance during one time slice.
#[derive(Clone, Copy, Debug)]
pub struct Conflict {
    /// The two vehicles, the smaller index first.
    pub vehicles: [usize; 2],
    /// Time of closest approach, s.
    pub at_s: f64,
    /// Motion of the first relative to the second at closest approach.
    pub approach: ClosestApproach,
}

/// A vehicle closer than a given distance to an obstacle during one of its intervals.
#[derive(Clone, Copy, Debug)]
pub struct ObstacleConflict {
    /// The vehicle.
    pub vehicle: usize,
    /// The obstacle.
    pub obstacle: usize,
    /// Interval of the vehicle.
    pub interval: usize,
    /// Motion relative to the obstacle's axis at closest approach.
    pub approach: ClosestApproach,
}

impl FleetMotion {
    /// The flow of all trajectories.
    pub fn new(trajectories: &[Iterate]) -> Self {
        Self::of_vehicles(trajectories.par_iter().map(VehicleMotion::new).collect())
    }

    /// The motions of all vehicles.
    pub fn of_vehicles(vehicles: Vec<VehicleMotion>) -> Self {
        let width_s = vehicles.iter().map(|vehicle| vehicle.dt_s).fold(0.0, f64::max);
        let slices: Vec<Vec<TimeSlice>> = vehicles.par_iter().map(|vehicle| vehicle.slices(width_s)).collect();
        let end = |(vehicle, slices): (&VehicleMotion, &Vec<TimeSlice>)| {
            vehicle.end_s() / width_s - (slices.len() as f64 - 1.0)
        };
        let ends = vehicles.iter().zip(&slices).map(end).collect();
        Self { vehicles, slices, ends, width_s, is_synchronised: false }
    }

    /// The motion with every interval taken to be as long as the longest one, as it will be when all arrive together.
    pub fn synchronised(trajectories: &[Iterate]) -> Self {
        let mut motion = Self::new(trajectories);
        motion.slices = motion.vehicles.iter().map(|vehicle| vehicle.slices(vehicle.dt_s)).collect();
        motion.ends.fill(1.0);
        motion.is_synchronised = true;
        motion
    }

    /// Every pair and time slice with a closest approach below `reach_m`, by time and then by vehicle.
    pub fn conflicts(&self, reach_m: f64) -> Vec<Conflict> {
        let count = self.slices.iter().map(Vec::len).max().unwrap_or(0);
        let during = |slice: usize| {
            let discs: Vec<Option<Disc>> =
                self.slices.iter().map(|slices| slices.get(slice).map(bounding_disc)).collect();
            let near = grid::near_pairs(&discs, reach_m).into_iter();
            let conflict = |vehicles: [usize; 2]| {
                let [a, b] = vehicles.map(|i| &self.slices[i][slice]);
                let [u, v] = vehicles.map(|i| if slice + 1 == self.slices[i].len() { self.ends[i] } else { 1.0 });
                let approach = closest_approach::of_vehicles(a, b, self.width_s, u.min(v));
                Conflict { vehicles, at_s: (slice as f64 + approach.fraction) * self.width_s, approach }
            };
            near.map(conflict).filter(|conflict| conflict.approach.distance_m < reach_m).collect::<Vec<_>>()
        };
        (0..count).into_par_iter().flat_map_iter(during).collect()
    }

    /// Every vehicle and interval with a distance below `reach_m` to the surface of an obstacle.
    pub fn obstacle_conflicts(&self, obstacles: &[Cylinder], reach_m: f64) -> Vec<ObstacleConflict> {
        let of_vehicle = |vehicle: usize| {
            let motion = &self.vehicles[vehicle];
            let mut conflicts = Vec::new();
            for (interval, slice) in motion.slices(motion.dt_s).iter().enumerate() {
                let disc = bounding_disc(slice);
                for (obstacle, cylinder) in obstacles.iter().enumerate() {
                    let center_m = Vector2::from(cylinder.center_m);
                    if disc.gap_m(&Disc { center_m, radius_m: cylinder.radius_m }) < reach_m {
                        let approach = closest_approach::to_point(slice, center_m, motion.dt_s);
                        conflicts.push(ObstacleConflict { vehicle, obstacle, interval, approach });
                    }
                }
            }
            conflicts.retain(|conflict| conflict.approach.distance_m < obstacles[conflict.obstacle].radius_m + reach_m);
            conflicts
        };
        (0..self.vehicles.len()).into_par_iter().flat_map_iter(of_vehicle).collect()
    }

    /// The interval of a vehicle at a time, and the fraction of it that has passed.
    pub fn locate(&self, vehicle: usize, at_s: f64) -> (usize, f64) {
        let motion = &self.vehicles[vehicle];
        locate(at_s, if self.is_synchronised { self.width_s } else { motion.dt_s }, motion.intervals.len())
    }
}

/// A disc that contains the motion in a time slice.
fn bounding_disc(slice: &TimeSlice) -> Disc {
    let center_m = (slice[0].position_m + slice[slice.len() - 1].position_m) * 0.5;
    let distance_m = |at: Vector2<f64>| (at.x - center_m.x).hypot(at.y - center_m.y);
    let radius_m = slice.iter().map(|at| distance_m(at.position_m)).fold(0.0, f64::max) + MAX_DEVIATION_M;
    Disc { center_m, radius_m }
}
