use schemars::JsonSchema;
use serde::{Deserialize, Serialize};

use super::prism::extruded;
use crate::Range;

/// A vertical cylinder that moves along a path at constant speed, back and forth. Vehicles must sense it.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields)]
pub struct MovingCylinder {
    /// Name, unique among all obstacles.
    pub name: String,
    /// Radius, m, > 0.
    pub radius_m: f64,
    /// Lowest and highest altitude, m. Absent: unbounded.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub z_m: Option<Range>,
    /// Corners (x, y) of the path of its axis, m: at least two, successive ones different.
    pub path_m: Vec<[f64; 2]>,
    /// Speed along the path, m/s, 0 or more.
    pub speed_mps: f64,
    /// Distance travelled along the path, back and forth, at time 0, m.
    #[serde(default)]
    pub offset_m: f64,
}

impl MovingCylinder {
    /// Position of the axis, m.
    pub fn position_m(&self, t_s: f64) -> [f64; 2] {
        let (leg, along_m, _) = self.leg_at(t_s);
        let [from, to] = self.leg(leg);
        let fraction = along_m / distance_m(from, to);
        std::array::from_fn(|axis| from[axis] + (to[axis] - from[axis]) * fraction)
    }

    /// Velocity, m/s; at a corner that of one of the two adjacent legs.
    pub fn velocity_mps(&self, t_s: f64) -> [f64; 2] {
        let (leg, _, sign) = self.leg_at(t_s);
        let [from, to] = self.leg(leg);
        std::array::from_fn(|axis| (to[axis] - from[axis]) / distance_m(from, to) * self.speed_mps * sign)
    }

    /// Signed distance from a point to the surface at time `t_s`, m; negative inside.
    pub fn signed_distance_m(&self, t_s: f64, [x_m, y_m, z_m]: [f64; 3]) -> f64 {
        let [axis_x_m, axis_y_m] = self.position_m(t_s);
        extruded((x_m - axis_x_m).hypot(y_m - axis_y_m) - self.radius_m, self.z_m, z_m)
    }

    /// Whether the path has at least two corners and no leg of length 0. Without a path it has no position.
    pub fn has_path(&self) -> bool {
        self.path_m.len() >= 2 && self.path_m.windows(2).all(|leg| distance_m(leg[0], leg[1]) > 0.0)
    }

    /// Current leg, distance along it (m), and direction of travel: forth (+1) or back (-1).
    fn leg_at(&self, t_s: f64) -> (usize, f64, f64) {
        let length_m = self.length_m();
        let unfolded_m = (self.offset_m + self.speed_mps * t_s).rem_euclid(2.0 * length_m);
        let (mut along_m, sign) =
            if unfolded_m <= length_m { (unfolded_m, 1.0) } else { (2.0 * length_m - unfolded_m, -1.0) };
        let last = self.path_m.len() - 2;
        for leg in 0..last {
            let [from, to] = self.leg(leg);
            let leg_m = distance_m(from, to);
            if along_m < leg_m {
                return (leg, along_m, sign);
            }
            along_m -= leg_m;
        }
        (last, along_m, sign)
    }

    fn leg(&self, leg: usize) -> [[f64; 2]; 2] {
        [self.path_m[leg], self.path_m[leg + 1]]
    }

    fn length_m(&self) -> f64 {
        self.path_m.windows(2).map(|leg| distance_m(leg[0], leg[1])).sum()
    }
}

fn distance_m(from: [f64; 2], to: [f64; 2]) -> f64 {
    (to[0] - from[0]).hypot(to[1] - from[1])
}

#[cfg(test)]
mod tests {
    use super::MovingCylinder;

    fn cart() -> MovingCylinder {
        MovingCylinder {
            name: "cart".into(),
            radius_m: 0.5,
            z_m: None,
            path_m: vec![[0.0, 0.0], [3.0, 0.0], [3.0, 4.0]],
            speed_mps: 2.0,
            offset_m: 1.0,
        }
    }

    fn near(a: [f64; 2], b: [f64; 2]) -> bool {
        (a[0] - b[0]).hypot(a[1] - b[1]) < 1e-12
    }

    #[test]
    fn it_moves_back_and_forth() {
        assert!(near(cart().position_m(0.0), [1.0, 0.0]) && near(cart().velocity_mps(0.0), [2.0, 0.0]));
        assert!(near(cart().position_m(2.0), [3.0, 2.0]) && near(cart().velocity_mps(2.0), [0.0, 2.0]));
        // At the end after 3 s, at the corner again after 5 s, at the beginning after 6.5 s.
        assert!(near(cart().position_m(4.0), [3.0, 2.0]) && near(cart().velocity_mps(4.0), [0.0, -2.0]));
        assert!(near(cart().position_m(6.0), [1.0, 0.0]) && near(cart().velocity_mps(6.0), [-2.0, 0.0]));
        assert!(near(cart().position_m(7.0), [1.0, 0.0]) && near(cart().velocity_mps(7.0), [2.0, 0.0]));
    }
}
