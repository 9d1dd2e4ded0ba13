//! Ways of straight lines and arcs at constant speed.

/// Position and direction in the plane.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Pose {
    pub position_m: [f64; 2],
    pub heading_rad: f64,
}

/// A piece of constant curvature, positive to the left.
#[derive(Clone, Copy, Debug)]
pub struct Leg {
    pub length_m: f64,
    pub curvature_per_m: f64,
}

/// A flyable path.
#[derive(Clone, Debug)]
pub struct Path {
    pub start: Pose,
    pub legs: Vec<Leg>,
    pub speed_mps: f64,
}

impl Leg {
    /// A straight line.
    pub fn straight(length_m: f64) -> Self {
        Self { length_m, curvature_per_m: 0.0 }
    }

    /// A turn by an angle, rad, positive to the left.
    pub fn turn(angle_rad: f64, radius_m: f64) -> Self {
        Self { length_m: angle_rad.abs() * radius_m, curvature_per_m: angle_rad.signum() / radius_m }
    }
}

impl Pose {
    pub fn after(self, length_m: f64, curvature_per_m: f64) -> Self {
        let [x, y] = self.position_m;
        let heading_rad = self.heading_rad + curvature_per_m * length_m;
        let ((sin, cos), (sin_after, cos_after)) = (self.heading_rad.sin_cos(), heading_rad.sin_cos());
        let position_m = if curvature_per_m == 0.0 {
            [x + length_m * cos, y + length_m * sin]
        } else {
            [x + (sin_after - sin) / curvature_per_m, y + (cos - cos_after) / curvature_per_m]
        };
        Self { position_m, heading_rad }
    }
}

impl Path {
    pub fn length_m(&self) -> f64 {
        length_m(&self.legs)
    }

    pub fn duration_s(&self) -> f64 {
        self.length_m() / self.speed_mps
    }

    /// The pose at a time, s; after the goal straight ahead.
    pub fn at(&self, t_s: f64) -> Pose {
        let mut left_m = self.speed_mps * t_s;
        let mut pose = self.start;
        for leg in &self.legs {
            if left_m < leg.length_m {
                return pose.after(left_m, leg.curvature_per_m);
            }
            pose = pose.after(leg.length_m, leg.curvature_per_m);
            left_m -= leg.length_m;
        }
        pose.after(left_m, 0.0)
    }

    pub fn goal(&self) -> Pose {
        self.at(self.duration_s())
    }

    /// The same path elsewhere: at half of its duration it passes `middle_m`.
    pub fn through(mut self, middle_m: [f64; 2]) -> Self {
        let own_m = self.at(self.duration_s() / 2.0).position_m;
        self.start.position_m = std::array::from_fn(|axis| self.start.position_m[axis] + middle_m[axis] - own_m[axis]);
        self
    }

    /// Poses at most `step_m` apart, both ends included.
    pub fn samples(&self, step_m: f64) -> impl Iterator<Item = Pose> + '_ {
        let steps = (self.length_m() / step_m).ceil().max(1.0);
        (0..=steps as usize).map(move |step| self.at(self.duration_s() * step as f64 / steps))
    }
}

pub fn length_m(legs: &[Leg]) -> f64 {
    legs.iter().map(|leg| leg.length_m).sum()
}

/// Two opposite turns of equal angle with a straight line between them: `along_m` ahead and `aside_m` to the left, with the
/// heading of the start at the end. `None` if the turns are too wide for that.
///
/// With turns of radius r by θ around a line of length s, (2r + i s) exp(iθ) = 2r - aside + i along.
pub fn lane_change(along_m: f64, aside_m: f64, radius_m: f64) -> Option<[Leg; 3]> {
    let (lateral_m, double_m) = (aside_m.abs(), 2.0 * radius_m);
    let straight_m = (along_m * along_m + lateral_m * lateral_m - 2.0 * double_m * lateral_m).sqrt();
    let angle_rad = along_m.atan2(double_m - lateral_m) - straight_m.atan2(double_m);
    let turn = |sign: f64| Leg::turn(sign * aside_m.signum() * angle_rad, radius_m);
    (straight_m >= 0.0 && angle_rad >= 0.0).then(|| [turn(1.0), Leg::straight(straight_m), turn(-1.0)])
}

#[cfg(test)]
mod tests {
    use std::f64::consts::{FRAC_PI_2, PI};

    use super::{Leg, Path, Pose, lane_change};

    const ORIGIN: Pose = Pose { position_m: [0.0; 2], heading_rad: 0.0 };

    #[test]
    fn a_lane_change_ends_where_it_should() {
        for (along_m, aside_m) in [(4000.0, 300.0), (2000.0, -900.0), (2500.0, 5000.0), (3000.0, 0.0)] {
            let legs = lane_change(along_m, aside_m, 700.0).unwrap().to_vec();
            let goal = Path { start: ORIGIN, legs, speed_mps: 30.0 }.goal();
            assert!((goal.position_m[0] - along_m).abs() < 1e-6, "{goal:?}");
            assert!((goal.position_m[1] - aside_m).abs() < 1e-6 && goal.heading_rad.abs() < 1e-12, "{goal:?}");
        }
        assert!(lane_change(500.0, 1400.0, 700.0).is_none(), "too short for two turns");
    }

    #[test]
    fn a_path_keeps_its_speed_and_direction() {
        let legs = vec![Leg::turn(FRAC_PI_2, 100.0), Leg::straight(50.0), Leg::turn(-PI, 80.0)];
        let path = Path { start: ORIGIN, legs, speed_mps: 10.0 };
        let at = |t_s: f64| path.at(t_s).position_m;
        for step in 0..1000 {
            let t_s = path.duration_s() * f64::from(step) / 950.0;
            let moved = [0, 1].map(|axis| (at(t_s + 1e-4)[axis] - at(t_s)[axis]) / 1e-4);
            let (sin, cos) = path.at(t_s).heading_rad.sin_cos();
            assert!((moved[0] - 10.0 * cos).hypot(moved[1] - 10.0 * sin) < 1e-2, "at {t_s} s: {moved:?}");
        }
        assert!((path.goal().heading_rad + FRAC_PI_2).abs() < 1e-12);
    }
}
