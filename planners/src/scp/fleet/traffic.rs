//! The whole fleet in motion, and who comes near whom.

use rayon::prelude::*;
use scenarios::Cylinder;

use super::super::iterate::Iterate;
use super::closest::{self, Approach};
use super::grid::{self, Disc};
use super::track::{Slab, Track, place};

/// What the cubic between two instants may bulge beyond their hull, m: far more than aircraft do in a second or two.
const BULGE_M: f64 = 5.0;

/// Everybody's motion on common slabs of time.
#[derive(Clone, Debug)]
pub struct Traffic {
    /// One per vehicle.
    pub tracks: Vec<Track>,
    slabs: Vec<Vec<Slab>>,
    width_s: f64,
    /// Is every slab an interval of everybody?
    in_step: bool,
}

/// Two vehicles near each other.
#[derive(Clone, Copy, Debug)]
pub struct Encounter {
    /// The two, the smaller index first.
    pub who: [usize; 2],
    /// When they are nearest to each other, s.
    pub at_s: f64,
    /// Motion of the first relative to the second.
    pub approach: Approach,
}

/// A vehicle near an obstacle.
#[derive(Clone, Copy, Debug)]
pub struct Passage {
    /// The vehicle.
    pub who: usize,
    /// The obstacle.
    pub obstacle: usize,
    /// Interval of the vehicle.
    pub interval: usize,
    /// Motion relative to the obstacle's axis where it is nearest.
    pub approach: Approach,
}

impl Traffic {
    /// The flow of everybody's trajectory.
    pub fn new(trajectories: &[Iterate]) -> Self {
        let tracks: Vec<Track> = trajectories.par_iter().map(Track::new).collect();
        let width_s = tracks.iter().map(|track| track.dt_s).fold(0.0, f64::max);
        let slabs = tracks.par_iter().map(|track| track.slabs(width_s)).collect();
        Self { tracks, slabs, width_s, in_step: false }
    }

    /// The motion as though every interval lasted as long as the longest one: what it becomes when all arrive together.
    pub fn in_step(trajectories: &[Iterate]) -> Self {
        let mut traffic = Self::new(trajectories);
        let own = |track: &Track| track.slabs(track.dt_s);
        traffic.slabs = traffic.tracks.iter().map(own).collect();
        traffic.in_step = true;
        traffic
    }

    /// Every pair and slab whose closest approach is below `reach_m`, in the order of time, then of the vehicles.
    pub fn encounters(&self, reach_m: f64) -> Vec<Encounter> {
        let count = self.slabs.iter().map(Vec::len).max().unwrap_or(0);
        let during = |slab: usize| {
            let discs: Vec<Option<Disc>> = self.slabs.iter().map(|slabs| slabs.get(slab).map(disc)).collect();
            let near = grid::near_pairs(&discs, reach_m).into_iter();
            let encounter = |who: [usize; 2]| {
                let [a, b] = who.map(|i| &self.slabs[i][slab]);
                let approach = closest::of_vehicles(a, b, self.width_s);
                Encounter { who, at_s: (slab as f64 + approach.share) * self.width_s, approach }
            };
            near.map(encounter).filter(|encounter| encounter.approach.distance_m < reach_m).collect::<Vec<_>>()
        };
        (0..count).into_par_iter().flat_map_iter(during).collect()
    }

    /// Every vehicle and interval that passes within `reach_m` of an obstacle's surface.
    pub fn passages(&self, obstacles: &[Cylinder], reach_m: f64) -> Vec<Passage> {
        let of_vehicle = |who: usize| {
            let track = &self.tracks[who];
            let slabs = track.slabs(track.dt_s);
            let mut passages = Vec::new();
            for (interval, slab) in slabs.iter().enumerate() {
                let disc = disc(slab);
                for (obstacle, cylinder) in obstacles.iter().enumerate() {
                    let far = Disc { center_m: cylinder.center_m, radius_m: cylinder.radius_m };
                    if disc.gap_m(&far) < reach_m {
                        let approach = closest::to_point(slab, cylinder.center_m, track.dt_s);
                        passages.push(Passage { who, obstacle, interval, approach });
                    }
                }
            }
            passages.retain(|passage| passage.approach.distance_m < obstacles[passage.obstacle].radius_m + reach_m);
            passages
        };
        (0..self.tracks.len()).into_par_iter().flat_map_iter(of_vehicle).collect()
    }

    /// Interval of a vehicle, and share of it, at a time.
    pub fn place(&self, who: usize, at_s: f64) -> (usize, f64) {
        let track = &self.tracks[who];
        place(at_s, if self.in_step { self.width_s } else { track.dt_s }, track.intervals.len())
    }
}

/// A disc around the motion in a slab.
fn disc(slab: &Slab) -> Disc {
    let (first, last) = (slab[0].position_m, slab[slab.len() - 1].position_m);
    let center_m = [0, 1].map(|axis| 0.5 * (first[axis] + last[axis]));
    let distance_m = |at: [f64; 2]| (at[0] - center_m[0]).hypot(at[1] - center_m[1]);
    let radius_m = slab.iter().map(|at| distance_m(at.position_m)).fold(0.0, f64::max) + BULGE_M;
    Disc { center_m, radius_m }
}
