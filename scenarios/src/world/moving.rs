use schemars::JsonSchema;
use serde::{Deserialize, Serialize};

use super::prism::upright;
use crate::Range;

/// An upright cylinder that goes along a path at constant speed, to its end and back, again and again. Whoever flies has to
/// sense it.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields)]
pub struct MovingCylinder {
    /// Name, unique among all obstacles.
    pub name: String,
    /// Radius, m, > 0.
    pub radius_m: f64,
    /// Lowest and highest altitude, m. Absent: without bottom or top.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub z_m: Option<Range>,
    /// Corners (x, y) of its axis's path, two at least, no two in a row the same, m.
    pub path_m: Vec<[f64; 2]>,
    /// Speed along the path, m/s, 0 or more.
    pub speed_mps: f64,
    /// How far along the path, there and back, it is at time 0, m.
    #[serde(default)]
    pub offset_m: f64,
}

impl MovingCylinder {
    /// Position of its axis, m.
    pub fn position_m(&self, t_s: f64) -> [f64; 2] {
        let (leg, along_m, _) = self.place(t_s);
        let [from, to] = self.leg(leg);
        let share = along_m / length_m(from, to);
        std::array::from_fn(|axis| from[axis] + (to[axis] - from[axis]) * share)
    }

    /// Velocity, m/s; at a corner that of the leg which it comes from or goes to.
    pub fn velocity_mps(&self, t_s: f64) -> [f64; 2] {
        let (leg, _, sign) = self.place(t_s);
        let [from, to] = self.leg(leg);
        std::array::from_fn(|axis| (to[axis] - from[axis]) / length_m(from, to) * self.speed_mps * sign)
    }

    /// Signed distance from a point in space to its surface at an instant, m: negative inside.
    pub fn signed_distance_m(&self, t_s: f64, [x_m, y_m, z_m]: [f64; 3]) -> f64 {
        let [axis_x_m, axis_y_m] = self.position_m(t_s);
        upright((x_m - axis_x_m).hypot(y_m - axis_y_m) - self.radius_m, self.z_m, z_m)
    }

    /// Has its path two corners at least, and a length between each two? Without one, it is nowhere.
    pub fn has_a_path(&self) -> bool {
        self.path_m.len() >= 2 && self.path_m.windows(2).all(|leg| length_m(leg[0], leg[1]) > 0.0)
    }

    /// Instants after 0 and before `end_s` at which it changes its direction, s, in order: between two of them it goes
    /// straight.
    pub fn turns_s(&self, end_s: f64) -> Vec<f64> {
        let mut turns_s = Vec::new();
        if self.speed_mps <= 0.0 {
            return turns_s;
        }
        let (corners, last) = (self.path_m.len(), self.path_m.len() - 1);
        let length_m = self.length_m();
        for lap in 0.. {
            let begin_m = f64::from(lap) * length_m;
            if (begin_m - self.offset_m) / self.speed_mps >= end_s {
                break;
            }
            for corner in 1..corners {
                let corner_m = if lap % 2 == 0 { self.along_m(corner) } else { length_m - self.along_m(last - corner) };
                turns_s.push((begin_m + corner_m - self.offset_m) / self.speed_mps);
            }
        }
        turns_s.retain(|t_s| 0.0 < *t_s && *t_s < end_s);
        turns_s
    }

    /// Leg, how far along it, m, and whether it goes there (+1) or back (-1).
    fn place(&self, t_s: f64) -> (usize, f64, f64) {
        let length_m = self.length_m();
        let unfolded_m = (self.offset_m + self.speed_mps * t_s).rem_euclid(2.0 * length_m);
        let (mut along_m, sign) =
            if unfolded_m <= length_m { (unfolded_m, 1.0) } else { (2.0 * length_m - unfolded_m, -1.0) };
        let last = self.path_m.len() - 2;
        for leg in 0..last {
            let [from, to] = self.leg(leg);
            let leg_m = self::length_m(from, to);
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

    /// Distance of a corner from the path's beginning, along it, m.
    fn along_m(&self, corner: usize) -> f64 {
        self.path_m[..=corner].windows(2).map(|leg| length_m(leg[0], leg[1])).sum()
    }

    fn length_m(&self) -> f64 {
        self.along_m(self.path_m.len() - 1)
    }
}

fn length_m(from: [f64; 2], to: [f64; 2]) -> f64 {
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
    fn it_goes_there_and_back_for_ever() {
        assert!(near(cart().position_m(0.0), [1.0, 0.0]) && near(cart().velocity_mps(0.0), [2.0, 0.0]));
        assert!(near(cart().position_m(2.0), [3.0, 2.0]) && near(cart().velocity_mps(2.0), [0.0, 2.0]));
        // The end after 3 s, the corner again after 5 s, the beginning after 6.5 s.
        assert!(near(cart().position_m(4.0), [3.0, 2.0]) && near(cart().velocity_mps(4.0), [0.0, -2.0]));
        assert!(near(cart().position_m(6.0), [1.0, 0.0]) && near(cart().velocity_mps(6.0), [-2.0, 0.0]));
        assert!(near(cart().position_m(7.0), [1.0, 0.0]) && near(cart().velocity_mps(7.0), [2.0, 0.0]));
    }

    #[test]
    fn between_its_turns_it_goes_straight() {
        assert_eq!(cart().turns_s(10.0), [1.0, 3.0, 5.0, 6.5, 8.0]);
        assert!(MovingCylinder { speed_mps: 0.0, ..cart() }.turns_s(10.0).is_empty());
        let knots = [vec![0.0], cart().turns_s(20.0), vec![20.0]].concat();
        for pair in knots.windows(2) {
            let [a, m, b] = [0.0, 0.5, 1.0].map(|share| cart().position_m(pair[0] + (pair[1] - pair[0]) * share));
            assert!(near(m, [f64::midpoint(a[0], b[0]), f64::midpoint(a[1], b[1])]), "{pair:?}");
        }
    }
}
