use crate::free_space::{Obstacle, Point};

/// Number of directions that are distinguished.
const DIRECTIONS: usize = 1024;

/// Obstacles further away cast no shadow, m: what they hide is found by exact tests.
const MAX_DISTANCE_M: f64 = 30.0;

/// Distance by which a shadow is smaller than the obstacle with its clearance, against rounding, m.
const STANDOFF_M: f64 = 1e-6;

/// What obstacles hide from a point, by direction in the plane: a fast test that precedes the exact one. It is conservative,
/// so that hidden points are certainly not visible, and others may be.
pub struct Shadows {
    eye: [f64; 2],
    /// Square of the distance from which on everything in a direction is hidden, m².
    hidden_from_m2: Vec<f64>,
}

impl Shadows {
    /// The shadows as seen from `eye`, with segments to be `clearance_m` from the obstacles.
    pub fn from_eye<'a>(eye: Point, obstacles: impl Iterator<Item = &'a Obstacle>, clearance_m: f64) -> Self {
        let mut shadows = Self { eye: [eye.x, eye.y], hidden_from_m2: vec![f64::INFINITY; DIRECTIONS] };
        // what ends at some altitude can be passed above or below it
        let hiding = obstacles.filter(|it| it.altitude_m() == [f64::NEG_INFINITY, f64::INFINITY]);
        for obstacle in hiding {
            let (center, radius_m) = obstacle.bounding_circle();
            let to_center = [center[0] - eye.x, center[1] - eye.y];
            let distance_m = to_center[0].hypot(to_center[1]);
            if distance_m - radius_m > MAX_DISTANCE_M {
                continue;
            }
            if obstacle.is_cylinder() {
                shadows.cast_by_disc(to_center, distance_m, radius_m + clearance_m - STANDOFF_M);
            } else {
                shadows.cast_by_polygon(obstacle, to_center, distance_m - radius_m);
            }
        }
        shadows
    }

    /// Is a point certainly not visible?
    pub fn hides(&self, point: Point) -> bool {
        let to_point = [point.x - self.eye[0], point.y - self.eye[1]];
        let length_m2 = to_point[0] * to_point[0] + to_point[1] * to_point[1];
        let direction = (diamond_angle(to_point) * (DIRECTIONS as f64 / 4.0)) as usize;
        // false for NaN
        length_m2 > self.hidden_from_m2[direction.min(DIRECTIONS - 1)]
    }

    /// A ray within the tangents enters the disc before it is as long as they are.
    fn cast_by_disc(&mut self, to_center: [f64; 2], distance_m: f64, radius_m: f64) {
        let tangent_m2 = distance_m * distance_m - radius_m * radius_m;
        if tangent_m2 > 0.0 {
            // unit vectors along both tangents: the direction of the centre, turned by asin(r/d)
            let (sin, cos) = (radius_m / distance_m, tangent_m2.sqrt() / distance_m);
            let [x, y] = to_center;
            self.hide([x * cos + y * sin, y * cos - x * sin], [x * cos - y * sin, y * cos + x * sin], tangent_m2);
        }
    }

    /// A ray between the outermost corners has entered the polygon where it is as long as the distance of the furthest one.
    fn cast_by_polygon(&mut self, obstacle: &Obstacle, to_center: [f64; 2], free_m: f64) {
        // from within the bounding circle the corners may span more than half a turn
        if free_m <= 0.0 {
            return;
        }
        let (mut right, mut left, mut furthest_m2) = (to_center, to_center, 0.0_f64);
        for edge in obstacle.edges() {
            let corner = [edge.corner[0] - self.eye[0], edge.corner[1] - self.eye[1]];
            if cross(right, corner) < 0.0 {
                right = corner;
            }
            if cross(left, corner) > 0.0 {
                left = corner;
            }
            furthest_m2 = furthest_m2.max(corner[0] * corner[0] + corner[1] * corner[1]);
        }
        self.hide(right, left, furthest_m2);
    }

    /// Hides what lies beyond a distance in the directions from `right` to `left`, which are less than half a turn apart.
    fn hide(&mut self, right: [f64; 2], left: [f64; 2], beyond_m2: f64) {
        let [first, last] = [right, left].map(|at| diamond_angle(at) * (DIRECTIONS as f64 / 4.0));
        // whole sectors only
        let (first, mut end) = (first.ceil() as usize, last.floor() as usize);
        if end + DIRECTIONS / 2 < first {
            end += DIRECTIONS;
        }
        for direction in first..end {
            let hidden_from_m2 = &mut self.hidden_from_m2[direction % DIRECTIONS];
            *hidden_from_m2 = hidden_from_m2.min(beyond_m2);
        }
    }
}

/// A number in [0, 4) that grows with the angle of a vector, counterclockwise from the x axis: its place on the square
/// |x| + |y| = 1.
fn diamond_angle([x, y]: [f64; 2]) -> f64 {
    let along = x / (x.abs() + y.abs());
    if y >= 0.0 { 1.0 - along } else { 3.0 + along }
}

fn cross(a: [f64; 2], b: [f64; 2]) -> f64 {
    a[0] * b[1] - a[1] * b[0]
}

#[cfg(test)]
mod tests {
    use rand::RngExt;

    use super::*;
    use crate::free_space::FreeSpace;

    #[test]
    fn hidden_points_are_not_visible_and_few_others_are_not() {
        const UNBOUNDED: [f64; 2] = [f64::NEG_INFINITY, f64::INFINITY];
        let clearance_m = 0.5;
        let (mut hidden, mut blocked) = (0, 0);
        for seed in 0..10 {
            let mut stream = scenarios::stream(seed, "shadows");
            let mut draw = |from: f64, to: f64| stream.random_range(from..to);
            let mut space = FreeSpace::empty([UNBOUNDED; 3]);
            for i in 0..60 {
                let [x, y] = [draw(0.0, 40.0), draw(0.0, 40.0)];
                space.static_obstacles.push(match i % 3 {
                    0 => Obstacle::prism(&[[x, y], [x + draw(1.0, 9.0), y], [x, y + draw(0.5, 4.0)]], UNBOUNDED),
                    1 => Obstacle::cylinder([x, y], draw(0.1, 1.0), [0.0, 2.0]),
                    _ => Obstacle::cylinder([x, y], draw(0.1, 1.0), UNBOUNDED),
                });
            }
            let eye = Point::new(draw(0.0, 40.0), draw(0.0, 40.0), 1.0);
            let shadows = Shadows::from_eye(eye, space.static_obstacles.iter(), clearance_m);
            for _ in 0..2000 {
                let point = Point::new(draw(0.0, 40.0), draw(0.0, 40.0), draw(1.0, 3.0));
                let is_clear = space.is_clear(eye, point, clearance_m);
                assert!(!(shadows.hides(point) && is_clear), "seed {seed}: {point:?} from {eye:?}");
                hidden += usize::from(shadows.hides(point));
                blocked += usize::from(!is_clear);
            }
        }
        assert!(2 * hidden > blocked && blocked > 10_000, "{hidden} of {blocked}");
    }
}
