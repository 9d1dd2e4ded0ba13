use scenarios::{Geofence, Range, Scenario};

use crate::verdict::LimitKey;
use crate::verdict::bernstein;
use crate::verdict::extreme::Extreme;
use crate::verdict::geofence::smallest_margin;
use crate::verdict::motion::Motion;
use crate::verdict::worst::{Quantity, Worst};

/// Distance between the bounds of an extreme position that counts as close enough, m.
const RESOLUTION_M: f64 = 1e-9;

/// A vehicle or its load, a ball, the map that it has to stay on and the geofences that it has to respect, with its whole body.
#[derive(Clone, Copy)]
pub struct MapBounds<'a> {
    vehicle: &'a str,
    /// Where its centre may be, m.
    axes: [Range; 3],
    radius_m: f64,
    geofences: &'a [Geofence],
}

impl<'a> MapBounds<'a> {
    /// The body or the load, of this radius, of the vehicle of this name.
    pub fn new(scenario: &'a Scenario, vehicle: &'a str, radius_m: f64) -> Self {
        let axes = scenario.world.map.inset(radius_m).axes();
        Self { vehicle, axes, radius_m, geofences: &scenario.world.geofences }
    }

    /// Considers a place of the centre.
    pub fn place(&self, worst: &mut Worst<'a>, position_m: [f64; 3], t_s: f64) {
        for (axis, value) in position_m.into_iter().enumerate() {
            worst.consider(self.vehicle, self.quantity(axis), value, t_s);
        }
        for fence in self.geofences {
            self.geofence(worst, fence, Extreme { value: fence.margin_m(position_m), error: 0.0, t_s });
        }
    }

    /// Considers a motion of the centre over continuous time. Returns its lowest and highest altitude, m.
    pub fn path(&self, worst: &mut Worst<'a>, motion: &Motion) -> [Extreme; 2] {
        let extremes_m = [0, 1, 2].map(|axis| extremes_m(motion, axis));
        for (axis, of_axis) in extremes_m.iter().enumerate() {
            for &Extreme { value, error, t_s } in of_axis {
                worst.consider_within(self.vehicle, self.quantity(axis), (value, error), t_s);
            }
        }
        for fence in self.geofences {
            self.geofence(worst, fence, smallest_margin(fence, motion));
        }
        extremes_m[2]
    }

    /// Half the width of the map counts as far enough, so that margins compare with those to the map.
    fn geofence(&self, worst: &mut Worst<'a>, fence: &'a Geofence, margin: Extreme) {
        let width_m = self.axes[0].width().max(self.axes[1].width());
        let range = Range::new(0.0, width_m);
        let quantity = Quantity { name: "geofence", unit: "m", range, key: LimitKey::Geofence };
        let Extreme { value, error, t_s } = margin;
        let value = value - self.radius_m;
        let value = if value > width_m / 2.0 { width_m / 2.0 } else { value };
        worst.consider_geofence([self.vehicle, &fence.name], quantity, (value, error), t_s);
    }

    fn quantity(&self, axis: usize) -> Quantity {
        let (name, key) = [("x of the centre", "x_m"), ("y of the centre", "y_m"), ("z of the centre", "z_m")][axis];
        Quantity { name, unit: "m", range: self.axes[axis], key: LimitKey::Map(key) }
    }
}

/// Lowest and highest value of one coordinate over continuous time, where the true motion may be lowest and highest.
pub fn extremes_m(motion: &Motion, axis: usize) -> [Extreme; 2] {
    [1.0, -1.0].map(|sign| {
        let (mut lowest, mut at) = (f64::INFINITY, Extreme { value: f64::NAN, error: 0.0, t_s: motion.knots()[0].t_s });
        for (index, segment) in motion.segments().enumerate() {
            let error = motion.tube_m(index);
            let c = segment.points_m.map(|point| sign * point[axis] - error);
            if c.iter().any(|&coefficient| coefficient < lowest) {
                let minimum = bernstein::minimise(&c, lowest, |_| RESOLUTION_M);
                lowest = minimum.lower;
                let t_s = minimum.at.map_or(at.t_s, |u| segment.instant_s(u));
                at = Extreme { value: sign * (lowest + error), error, t_s };
            }
        }
        at
    })
}
