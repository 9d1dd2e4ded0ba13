//! Smallest distances of a fleet over time, for plots; the smallest of all, over continuous time, is in the verdict.

use rayon::prelude::*;
use scenarios::{Scenario, SeparationMeasure};

use crate::verdict::Motion;
use crate::verdict::fixed_wing::clearance_at;
use crate::verdict::multirotor::Clearances;

/// The smallest distance at one instant, and the bodies between which it is.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct DistanceSample {
    /// When, s.
    pub t_s: f64,
    /// How far, m.
    pub distance_m: f64,
    /// Two motions, or a motion and an obstacle, by their indices.
    pub who: [usize; 2],
}

/// Smallest distance between any two of `motions`, every `step_s` from 0 s on, while at least two last.
///
/// For a plot: the smallest of all, over continuous time, is in the verdict.
pub fn separation_over_time(motions: &[Motion], measure: SeparationMeasure, step_s: f64) -> Vec<DistanceSample> {
    at_instants(motions, step_s, |present, nearest| {
        // A sweep from west to east: no vehicle farther east than the best distance can be nearer.
        let eastward = measure.scale()[0];
        present.sort_by(|(_, a), (_, b)| a[0].total_cmp(&b[0]));
        for (place, (i, first)) in present.iter().enumerate() {
            for (j, second) in &present[place + 1..] {
                if eastward * (second[0] - first[0]) > nearest.distance_m {
                    break;
                }
                let distance_m = measure.distance_m([0, 1, 2].map(|axis| first[axis] - second[axis]));
                nearest.consider(distance_m, [*i.min(j), *i.max(j)]);
            }
        }
    })
}

/// Smallest distance from the body of any fixed wing to the surface of any obstacle, every `step_s` from 0 s on.
pub fn clearance_over_time(scenario: &Scenario, motions: &[Motion], step_s: f64) -> Vec<DistanceSample> {
    at_instants(motions, step_s, |present, nearest| {
        for (i, position_m) in present.iter() {
            if let Some(closest) = clearance_at(scenario, *i, nearest.t_s, *position_m) {
                nearest.consider(closest.upper_m, closest.who);
            }
        }
    })
}

/// Smallest distance in space from the surface of any multirotor to anything at all, every `step_s` from 0 s on. `who` holds
/// the vehicle twice.
pub fn clearance_in_space_over_time(scenario: &Scenario, motions: &[Motion], step_s: f64) -> Vec<DistanceSample> {
    let clearances = Clearances::new(scenario);
    at_instants(motions, step_s, |present, nearest| {
        for (i, position_m) in present.iter() {
            nearest.consider(clearances.at(*i, nearest.t_s, *position_m).0, [*i, *i]);
        }
    })
}

impl DistanceSample {
    fn consider(&mut self, distance_m: f64, who: [usize; 2]) {
        if distance_m < self.distance_m || (distance_m == self.distance_m && who < self.who) {
            (self.distance_m, self.who) = (distance_m, who);
        }
    }
}

/// Motions that last at an instant, by index, and their positions, m.
type Present = Vec<(usize, [f64; 3])>;

/// Calls `look` with the motions that last at each instant. Panics if `step_s` is not positive.
fn at_instants(
    motions: &[Motion],
    step_s: f64,
    look: impl Fn(&mut Present, &mut DistanceSample) + Sync,
) -> Vec<DistanceSample> {
    assert!(step_s > 0.0, "a step of {step_s} s leads nowhere");
    let end_s = motions.iter().map(Motion::end_s).fold(0.0, f64::max);
    let nearest_at = |step: usize| {
        let t_s = step as f64 * step_s;
        let positions = motions.iter().map(|motion| motion.position_m(t_s)).enumerate();
        let mut present = positions.filter_map(|(index, position_m)| Some((index, position_m?))).collect();
        let mut nearest = DistanceSample { t_s, distance_m: f64::INFINITY, who: [0, 0] };
        look(&mut present, &mut nearest);
        Some(nearest).filter(|nearest| nearest.distance_m.is_finite())
    };
    (0..=(end_s / step_s) as usize).into_par_iter().filter_map(nearest_at).collect()
}
