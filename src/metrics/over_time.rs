use scenarios::Cylinder;

use crate::verdict::Motion;

/// The smallest distance at one instant, and between whom.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Nearest {
    /// When, s.
    pub t_s: f64,
    /// How far, m.
    pub distance_m: f64,
    /// Two motions, or a motion and a cylinder, by their indices.
    pub who: [usize; 2],
}

/// Smallest horizontal distance between any two of `motions`, every `step_s` from 0 s on, while at least two last.
///
/// For a plot: the smallest of all, over continuous time, is in the verdict.
pub fn separation_over_time(motions: &[Motion], step_s: f64) -> Vec<Nearest> {
    at_instants(motions, step_s, |present, nearest| {
        for (place, (i, first)) in present.iter().enumerate() {
            for (j, second) in &present[place + 1..] {
                nearest.consider((first[0] - second[0]).hypot(first[1] - second[1]), [*i, *j]);
            }
        }
    })
}

/// Smallest signed horizontal distance from any of `motions` to the surface of any of `cylinders`, every `step_s` from
/// 0 s on. With a single motion it is that vehicle's own clearance.
pub fn clearance_over_time(motions: &[Motion], cylinders: &[Cylinder], step_s: f64) -> Vec<Nearest> {
    at_instants(motions, step_s, |present, nearest| {
        for (i, position_m) in present {
            for (m, cylinder) in cylinders.iter().enumerate() {
                nearest.consider(cylinder.signed_distance_m(position_m[0], position_m[1]), [*i, m]);
            }
        }
    })
}

impl Nearest {
    fn consider(&mut self, distance_m: f64, who: [usize; 2]) {
        if distance_m < self.distance_m {
            (self.distance_m, self.who) = (distance_m, who);
        }
    }
}

/// Calls `look` with the motions that last at each instant, and their positions, m. Panics if `step_s` is not positive.
fn at_instants(motions: &[Motion], step_s: f64, look: impl Fn(&[(usize, [f64; 3])], &mut Nearest)) -> Vec<Nearest> {
    assert!(step_s > 0.0, "a step of {step_s} s leads nowhere");
    let end_s = motions.iter().map(Motion::end_s).fold(0.0, f64::max);
    let mut series = Vec::new();
    let mut present = Vec::with_capacity(motions.len());
    for step in 0..=(end_s / step_s) as usize {
        let t_s = step as f64 * step_s;
        present.clear();
        let positions = motions.iter().map(|motion| motion.position_m(t_s)).enumerate();
        present.extend(positions.filter_map(|(index, position_m)| Some((index, position_m?))));
        let mut nearest = Nearest { t_s, distance_m: f64::INFINITY, who: [0, 0] };
        look(&present, &mut nearest);
        if nearest.distance_m.is_finite() {
            series.push(nearest);
        }
    }
    series
}
