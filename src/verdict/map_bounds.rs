use scenarios::{Range, Scenario};

use crate::verdict::LimitKey;
use crate::verdict::bernstein;
use crate::verdict::motion::Motion;
use crate::verdict::worst::{Quantity, Worst};

/// Distance between the bounds of an extreme position that counts as close enough, m.
const RESOLUTION_M: f64 = 1e-9;

/// A vehicle and the map that it has to stay on.
#[derive(Clone, Copy)]
pub struct MapBounds<'a> {
    vehicle: &'a str,
    axes: [Range; 3],
}

impl<'a> MapBounds<'a> {
    /// The vehicle of this name.
    pub fn new(scenario: &Scenario, vehicle: &'a str) -> Self {
        Self { vehicle, axes: scenario.world.map.axes() }
    }

    /// Considers a place.
    pub fn place(&self, worst: &mut Worst<'a>, position_m: [f64; 3], t_s: f64) {
        for (axis, value) in position_m.into_iter().enumerate() {
            worst.consider(self.vehicle, self.quantity(axis), value, t_s);
        }
    }

    /// Considers a motion over continuous time. Returns its lowest and highest altitude, m, and when, s.
    pub fn path(&self, worst: &mut Worst<'a>, motion: &Motion) -> [(f64, f64); 2] {
        let extremes_m = [0, 1, 2].map(|axis| extremes_m(motion, axis));
        for (axis, of_axis) in extremes_m.iter().enumerate() {
            for &(value, t_s) in of_axis {
                worst.consider(self.vehicle, self.quantity(axis), value, t_s);
            }
        }
        extremes_m[2]
    }

    fn quantity(&self, axis: usize) -> Quantity {
        let (name, key) = [("x", "x_m"), ("y", "y_m"), ("z", "z_m")][axis];
        Quantity { name, unit: "m", range: self.axes[axis], key: LimitKey::Map(key) }
    }
}

/// Lowest and highest value of one coordinate over continuous time, m, and when, s.
pub fn extremes_m(motion: &Motion, axis: usize) -> [(f64, f64); 2] {
    [1.0, -1.0].map(|sign| {
        let (mut lowest, mut at_s) = (f64::INFINITY, motion.knots()[0].t_s);
        for segment in motion.segments() {
            let c = segment.points_m.map(|point| sign * point[axis]);
            if c.iter().any(|&coefficient| coefficient < lowest) {
                let minimum = bernstein::minimise(&c, lowest, |_| RESOLUTION_M);
                lowest = minimum.lower;
                at_s = minimum.at.map_or(at_s, |u| segment.instant_s(u));
            }
        }
        (sign * lowest, at_s)
    })
}
