//! Shortest path of bounded curvature from one pose to another by a turn, a straight line and a turn (Dubins, American
//! Journal of Mathematics 79, 1957). The words of three turns are shortest only between close poses and are left out.

use std::f64::consts::TAU;

/// Turns closer than this to a full circle are rounding errors of no turn, rad.
const FULL_TURN_TOLERANCE_RAD: f64 = 1e-6;

/// Position, m, and heading, rad.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Pose {
    /// East, north, m.
    pub position_m: [f64; 2],
    /// Heading, counterclockwise from east, rad, not wrapped.
    pub heading_rad: f64,
}

/// Turn, straight line, turn.
#[derive(Clone, Copy, Debug)]
pub struct DubinsPath {
    start: Pose,
    radius_m: f64,
    /// First and last turn, positive to the left, rad.
    turns_rad: [f64; 2],
    straight_m: f64,
}

impl DubinsPath {
    /// Number of words: LSL, LSR, RSL, RSR.
    pub const WORDS: usize = 4;

    /// The paths of all words from `start` to `goal` with turns of `radius_m`, the shortest first. Two turns to the same side
    /// always reach the goal: there are two at least.
    pub fn all(start: Pose, goal: Pose, radius_m: f64) -> Vec<Self> {
        let mut paths: Vec<Self> =
            (0..Self::WORDS).filter_map(|word| Self::by_word(start, goal, radius_m, word)).collect();
        paths.sort_by(|a, b| a.length_m().total_cmp(&b.length_m()));
        paths
    }

    /// The path of one word.
    pub fn by_word(start: Pose, goal: Pose, radius_m: f64, word: usize) -> Option<Self> {
        let sides = [[1.0, 1.0], [1.0, -1.0], [-1.0, 1.0], [-1.0, -1.0]];
        Self::by_sides(start, goal, radius_m, sides[word])
    }

    /// The path with full circles before its first turn, to the same side.
    pub fn with_circles(self, circles: usize) -> Self {
        let [first, last] = self.turns_rad;
        Self { turns_rad: [first + first.signum() * TAU * circles as f64, last], ..self }
    }

    /// The path with turns to `sides`, 1 for left and -1 for right. `None` if the circles are too close to each other
    /// for a change of side.
    fn by_sides(start: Pose, goal: Pose, radius_m: f64, sides: [f64; 2]) -> Option<Self> {
        let [from, to] = [center(&start, sides[0] * radius_m), center(&goal, sides[1] * radius_m)];
        let [dx, dy] = [to[0] - from[0], to[1] - from[1]];
        let distance_m = dx.hypot(dy);
        // the straight line is tangent to both circles: its offset across the line between the centres
        let offset_m = (sides[1] - sides[0]) * radius_m;
        if offset_m.abs() > distance_m {
            return None;
        }
        let straight_m = (distance_m * distance_m - offset_m * offset_m).sqrt();
        let line_rad = if distance_m > 0.0 { dy.atan2(dx) - offset_m.atan2(straight_m) } else { start.heading_rad };
        let turns_rad = [turn(start.heading_rad, line_rad, sides[0]), turn(line_rad, goal.heading_rad, sides[1])];
        Some(Self { start, radius_m, turns_rad, straight_m })
    }

    /// Length, m.
    pub fn length_m(&self) -> f64 {
        self.straight_m + self.radius_m * (self.turns_rad[0].abs() + self.turns_rad[1].abs())
    }

    /// The pose at distance `along_m`, at most the length.
    pub fn at(&self, along_m: f64) -> Pose {
        let [first, last] = self.turns_rad;
        let first_m = self.radius_m * first.abs();
        let turned = turned(self.start, self.radius_m * first.signum(), along_m.min(first_m));
        let straight_m = (along_m - first_m).clamp(0.0, self.straight_m);
        let (sin, cos) = turned.heading_rad.sin_cos();
        let [x, y] = turned.position_m;
        let straight = Pose { position_m: [x + straight_m * cos, y + straight_m * sin], ..turned };
        turned_last(straight, self.radius_m * last.signum(), along_m - first_m - self.straight_m)
    }
}

fn turned_last(pose: Pose, signed_radius_m: f64, along_m: f64) -> Pose {
    if along_m > 0.0 { turned(pose, signed_radius_m, along_m) } else { pose }
}

/// Centre of the circle to the left (positive radius) or to the right.
fn center(pose: &Pose, signed_radius_m: f64) -> [f64; 2] {
    let (sin, cos) = pose.heading_rad.sin_cos();
    [pose.position_m[0] - signed_radius_m * sin, pose.position_m[1] + signed_radius_m * cos]
}

fn turned(pose: Pose, signed_radius_m: f64, along_m: f64) -> Pose {
    let [x, y] = center(&pose, signed_radius_m);
    let heading_rad = pose.heading_rad + along_m / signed_radius_m;
    let (sin, cos) = heading_rad.sin_cos();
    Pose { position_m: [x + signed_radius_m * sin, y - signed_radius_m * cos], heading_rad }
}

/// Turn from one heading to another to the given side, rad, in (-2π, 2π).
fn turn(from_rad: f64, to_rad: f64, side: f64) -> f64 {
    let angle = (side * (to_rad - from_rad)).rem_euclid(TAU);
    if angle > TAU - FULL_TURN_TOLERANCE_RAD { 0.0 } else { side * angle }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn pose(x: f64, y: f64, heading_deg: f64) -> Pose {
        Pose { position_m: [x, y], heading_rad: heading_deg.to_radians() }
    }

    #[test]
    fn paths_end_at_their_goals() {
        let start = pose(100.0, -50.0, 30.0);
        for goal in [pose(4000.0, 3000.0, 90.0), pose(4000.0, -3000.0, -100.0), pose(-3000.0, 10.0, 200.0)] {
            let paths = DubinsPath::all(start, goal, 700.0);
            assert!(paths.len() == 4 && paths.is_sorted_by(|a, b| a.length_m() <= b.length_m()));
            for path in &paths {
                let end = path.at(path.length_m());
                let off_m = (end.position_m[0] - goal.position_m[0]).hypot(end.position_m[1] - goal.position_m[1]);
                assert!(off_m < 1e-6, "{goal:?} missed by {off_m} m");
                let turns = (end.heading_rad - goal.heading_rad) / TAU;
                assert!((turns - turns.round()).abs() < 1e-9, "{goal:?}: {} rad", end.heading_rad);
            }
            let straight_m = (goal.position_m[0] - 100.0).hypot(goal.position_m[1] + 50.0);
            let shortest_m = paths[0].length_m();
            assert!(shortest_m >= straight_m && shortest_m < straight_m + TAU * 700.0);
        }
    }

    #[test]
    fn straight_ahead_is_straight() {
        let paths = DubinsPath::all(pose(0.0, 0.0, 45.0), pose(3000.0, 3000.0, 45.0), 700.0);
        assert!((paths[0].length_m() - 3000.0 * 2_f64.sqrt()).abs() < 1e-3);
    }
}
