//! A route over the ground, without timing.

use super::dubins::{DubinsPath, Pose};

/// Smallest and largest number of segments of a route, and their number per turn radius in between.
const SEGMENTS: [usize; 2] = [200, 4000];
const SEGMENTS_PER_RADIUS: f64 = 8.0;

/// A polyline, fine enough to approximate a smooth curve.
#[derive(Clone, Debug)]
pub struct Route {
    points_m: Vec<[f64; 2]>,
    /// Distance along the route to each point, m.
    along_m: Vec<f64>,
    start_heading_rad: f64,
}

impl Route {
    /// The path, in segments that are short compared with `radius_m`.
    pub fn along(path: &DubinsPath, radius_m: f64) -> Self {
        let length_m = path.length_m();
        let [min, max] = SEGMENTS;
        let segments = ((SEGMENTS_PER_RADIUS * length_m / radius_m) as usize).clamp(min, max);
        let point = |index: usize| path.at(length_m * index as f64 / segments as f64).position_m;
        Self::through((0..=segments).map(point).collect(), path.at(0.0).heading_rad)
    }

    /// The polyline through `points_m`.
    pub fn through(points_m: Vec<[f64; 2]>, start_heading_rad: f64) -> Self {
        let mut along_m = vec![0.0];
        for pair in points_m.windows(2) {
            let last_m = along_m[along_m.len() - 1];
            along_m.push(last_m + (pair[1][0] - pair[0][0]).hypot(pair[1][1] - pair[0][1]));
        }
        Self { points_m, along_m, start_heading_rad }
    }

    /// Length, m.
    pub fn length_m(&self) -> f64 {
        self.along_m[self.along_m.len() - 1]
    }

    /// Position, m, and heading, rad, in (-π, π], at distance `along_m`.
    pub fn at(&self, along_m: f64) -> Pose {
        let last = self.points_m.len() - 2;
        let index = self.along_m.partition_point(|point_m| *point_m <= along_m).saturating_sub(1).min(last);
        let (a, b) = (self.points_m[index], self.points_m[index + 1]);
        let fraction = (along_m - self.along_m[index]) / (self.along_m[index + 1] - self.along_m[index]);
        let position_m = [0, 1].map(|axis| a[axis] + fraction * (b[axis] - a[axis]));
        Pose { position_m, heading_rad: (b[1] - a[1]).atan2(b[0] - a[0]) }
    }

    /// The route displaced by a raised-cosine bump: to its left by `offset_m` at distance `peak_m`, and to zero within
    /// `reach_m` before and behind (or at the ends of the route, where these are nearer).
    pub fn displaced(&self, offset_m: f64, peak_m: f64, reach_m: f64) -> Self {
        let before_m = reach_m.min(peak_m);
        let behind_m = reach_m.min(self.length_m() - peak_m);
        let moved = |(point_m, &along_m): (&[f64; 2], &f64)| {
            let from_peak_m = along_m - peak_m;
            let fraction = if from_peak_m < 0.0 { -from_peak_m / before_m } else { from_peak_m / behind_m };
            if fraction.is_nan() || fraction >= 1.0 {
                return *point_m;
            }
            let sideways_m = 0.5 * offset_m * (1.0 + (std::f64::consts::PI * fraction).cos());
            let (sin, cos) = self.at(along_m).heading_rad.sin_cos();
            [point_m[0] - sideways_m * sin, point_m[1] + sideways_m * cos]
        };
        Self::through(self.points_m.iter().zip(&self.along_m).map(moved).collect(), self.start_heading_rad)
    }

    /// The route lengthened to `length_m` by successive bumps, if it is shorter: one bump per entry of `sides`, 1 for
    /// left and -1 for right.
    pub fn lengthened(&self, length_m: f64, sides: &[f64]) -> Self {
        let own_m = self.length_m();
        let half_m = 0.5 * own_m / sides.len() as f64;
        let displaced = |offset_m: f64| {
            sides.iter().enumerate().fold(self.clone(), |route, (bump, side)| {
                let scale = route.length_m() / own_m;
                route.displaced(side * offset_m, scale * half_m * (2 * bump + 1) as f64, scale * half_m)
            })
        };
        let (mut low_m, mut high_m) = (0.0, length_m);
        while high_m - low_m > 1.0 {
            let middle_m = 0.5 * (low_m + high_m);
            (low_m, high_m) =
                if displaced(middle_m).length_m() > length_m { (low_m, middle_m) } else { (middle_m, high_m) };
        }
        displaced(low_m)
    }

    /// The route with full circles at distance `along_m`: to the left for a positive radius, else to the right.
    pub fn with_circles(&self, along_m: f64, signed_radius_m: f64, circles: usize) -> Self {
        let at = self.at(along_m);
        let (sin, cos) = at.heading_rad.sin_cos();
        let center = [at.position_m[0] - signed_radius_m * sin, at.position_m[1] + signed_radius_m * cos];
        let per_circle = (std::f64::consts::TAU * SEGMENTS_PER_RADIUS).ceil();
        let on_circle = |index: usize| {
            let turned = signed_radius_m.signum() * std::f64::consts::TAU * index as f64 / per_circle;
            let (sin, cos) = (at.heading_rad + turned).sin_cos();
            [center[0] + signed_radius_m * sin, center[1] - signed_radius_m * cos]
        };
        let (mut before, mut behind) = (Vec::new(), Vec::new());
        for (point_m, &distance_m) in self.points_m.iter().zip(&self.along_m) {
            if distance_m < along_m {
                before.push(*point_m);
            } else if distance_m > along_m {
                behind.push(*point_m);
            }
        }
        let circle = (0..=circles * per_circle as usize).map(on_circle);
        Self::through(before.into_iter().chain(circle).chain(behind).collect(), self.start_heading_rad)
    }

    /// The point of the route nearest to `point_m`: its distance, m; its position relative to `point_m`, m; and its
    /// distance along the route, m.
    pub fn nearest(&self, point_m: [f64; 2]) -> (f64, [f64; 2], f64) {
        let mut nearest = (f64::INFINITY, [0.0; 2], 0.0);
        for (at, &along_m) in self.points_m.iter().zip(&self.along_m) {
            let away = [at[0] - point_m[0], at[1] - point_m[1]];
            let squared = away[0] * away[0] + away[1] * away[1];
            if squared < nearest.0 {
                nearest = (squared, away, along_m);
            }
        }
        (nearest.0.sqrt(), nearest.1, nearest.2)
    }

    /// Largest change of heading between neighbouring segments, rad, in [0, π].
    pub fn max_turn_rad(&self) -> f64 {
        let turn_rad = |three: &[[f64; 2]]| {
            let [a, b] = [0, 1].map(|i| [three[i + 1][0] - three[i][0], three[i + 1][1] - three[i][1]]);
            (a[0] * b[1] - a[1] * b[0]).atan2(a[0] * b[0] + a[1] * b[1]).abs()
        };
        self.points_m.windows(3).map(turn_rad).fold(0.0, f64::max)
    }

    /// Largest curvature, 1/m: the turn between neighbouring segments, over their mean length. Segments that are much
    /// shorter than the others do not count.
    pub fn max_curvature(&self) -> f64 {
        let mean_m = self.length_m() / (self.along_m.len() - 1) as f64;
        let curvature = |(three, along_m): (&[[f64; 2]], &[f64])| {
            let [a, b] = [0, 1].map(|i| [three[i + 1][0] - three[i][0], three[i + 1][1] - three[i][1]]);
            let turn_rad = (a[0] * b[1] - a[1] * b[0]).atan2(a[0] * b[0] + a[1] * b[1]).abs();
            turn_rad / (0.5 * (along_m[2] - along_m[0])).max(0.5 * mean_m)
        };
        self.points_m.windows(3).zip(self.along_m.windows(3)).map(curvature).fold(0.0, f64::max)
    }

    /// The points, m.
    pub fn points(&self) -> impl Iterator<Item = [f64; 2]> + '_ {
        self.points_m.iter().copied()
    }

    /// Heading at the start, as in the scenario, rad.
    pub fn start_heading_rad(&self) -> f64 {
        self.start_heading_rad
    }
}
