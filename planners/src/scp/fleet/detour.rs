//! Ways around obstacles, wide enough to be flown.

use scenarios::Cylinder;

use super::route::Route;

/// Most bumps that a route is given.
const MOST_BUMPS: usize = 40;

/// Distance by which a bump clears the obstacle, as a share of its radius.
const BEYOND: f64 = 0.02;

/// The route with bumps around the obstacles that it cuts, the deepest cut first, each to the side on which less is cut
/// afterwards. What is still cut in the end is left to the subproblems.
///
/// A bump A (1 + cos(π s/w)) / 2 has the curvature A π²/(2 w²) at its peak: `turn_radius_m` gives w.
pub fn around(route: Route, obstacles: &[Cylinder], margin_m: f64, turn_radius_m: f64) -> Route {
    let mut route = route;
    let mut depth_m = cut_m(&route, obstacles, margin_m);
    for _ in 0..MOST_BUMPS {
        let Some(cut) = deepest(&route, obstacles, margin_m) else { break };
        let sides = [1.0, -1.0].map(|side| {
            let offset_m = side * (cut.wanted_m - side * cut.left_m);
            let reach_m = std::f64::consts::PI * (0.5 * offset_m.abs() * turn_radius_m).sqrt();
            let moved = route.bowed(offset_m, cut.along_m, reach_m);
            (cut_m(&moved, obstacles, margin_m), offset_m.abs(), moved)
        });
        let [left, right] = sides;
        let better = if (left.0, left.1) <= (right.0, right.1) { left } else { right };
        if better.0 >= depth_m {
            break;
        }
        (depth_m, route) = (better.0, better.2);
    }
    route
}

/// Where a route cuts an obstacle deepest.
struct Cut {
    /// Way to the place, m.
    along_m: f64,
    /// How far the route passes to the left of the axis, m.
    left_m: f64,
    /// Distance from the axis to pass at, m.
    wanted_m: f64,
}

fn deepest(route: &Route, obstacles: &[Cylinder], margin_m: f64) -> Option<Cut> {
    let mut deepest: Option<(f64, Cut)> = None;
    for cylinder in obstacles {
        let distance_m = |at: [f64; 2]| (at[0] - cylinder.center_m[0]).hypot(at[1] - cylinder.center_m[1]);
        let nearest = route.points().map(|(at, along_m)| (distance_m(at), at, along_m)).min_by(|a, b| a.0.total_cmp(&b.0));
        let Some((nearest_m, at, along_m)) = nearest else { continue };
        let depth_m = cylinder.radius_m + margin_m - nearest_m;
        if depth_m > 0.0 && deepest.as_ref().is_none_or(|(deepest_m, _)| depth_m > *deepest_m) {
            let (sin, cos) = route.at(along_m).heading_rad.sin_cos();
            let [dx, dy] = [0, 1].map(|axis| at[axis] - cylinder.center_m[axis]);
            let wanted_m = (1.0 + BEYOND) * cylinder.radius_m + margin_m;
            deepest = Some((depth_m, Cut { along_m, left_m: dy * cos - dx * sin, wanted_m }));
        }
    }
    deepest.map(|(_, cut)| cut)
}

/// Depths to which a route cuts obstacles, summed over them, m.
fn cut_m(route: &Route, obstacles: &[Cylinder], margin_m: f64) -> f64 {
    let depth_m = |cylinder: &Cylinder| {
        let distances = route.points().map(|(at, _)| cylinder.signed_distance_m(at[0], at[1]));
        (margin_m - distances.fold(f64::INFINITY, f64::min)).max(0.0)
    };
    obstacles.iter().map(depth_m).sum()
}
