//! Routes around obstacles that respect the turn radius.

use std::f64::consts::PI;

use scenarios::{Cylinder, Map, Range};

use super::route::Route;

/// Maximum number of bumps of a route.
const MAX_BUMPS: usize = 12;

/// Number of unfinished routes that the beam search keeps.
const BEAM_WIDTH: usize = 3;

/// Additional distance at which a bump passes an obstacle, as a fraction of its radius.
const CLEARANCE_FRACTION: f64 = 0.02;

/// Cost of a metre of intrusion in the ranking of unfinished routes, in metres of length.
const INTRUSION_PENALTY: f64 = 2.0;

/// Largest turn between neighbouring segments of a route without kinks, rad.
const MAX_TURN_RAD: f64 = 0.6;

/// Intrusion assigned to a route with a kink, m.
const KINK_PENALTY_M: f64 = 1000.0;

/// A route and its remaining intrusion.
#[derive(Clone, Debug)]
struct Candidate {
    route: Route,
    intrusion_m: f64,
}

/// The best route found by a beam search over bumps around the obstacles that `route` intrudes on. An intrusion that
/// remains is left to the subproblems.
///
/// Each step passes the obstacle of deepest intrusion on either side.
///
/// A bump A (1 + cos(π s/w)) / 2 has the curvature A π²/(2 w²) at its peak, so that `turn_radius_m` determines w.
pub fn around(route: Route, map: &ObstacleMap, turn_radius_m: f64) -> Route {
    let mut best = Candidate { intrusion_m: map.intrusion_m(&route), route };
    let mut beam = vec![best.clone()];
    for _ in 0..MAX_BUMPS {
        let sides = beam.iter().flat_map(|from| both_sides(from, map, turn_radius_m));
        beam = sides.filter(|candidate| cost_m(candidate) < cost_m(&best) || best.intrusion_m > 0.0).collect();
        beam.sort_by(|a, b| cost_m(a).total_cmp(&cost_m(b)));
        beam.truncate(BEAM_WIDTH);
        for candidate in &beam {
            if (candidate.intrusion_m, cost_m(candidate)) < (best.intrusion_m, cost_m(&best)) {
                best = candidate.clone();
            }
        }
        beam.retain(|candidate| candidate.intrusion_m > 0.0);
    }
    best.route
}

fn cost_m(candidate: &Candidate) -> f64 {
    candidate.route.length_m() + INTRUSION_PENALTY * candidate.intrusion_m
}

/// The candidate with one more bump, to either side of the obstacle of deepest intrusion.
fn both_sides(from: &Candidate, map: &ObstacleMap, turn_radius_m: f64) -> Vec<Candidate> {
    let Some(intrusion) = map.deepest(&from.route) else { return Vec::new() };
    let bumped = |side: f64| {
        let offset_m = side * (intrusion.required_m - side * intrusion.left_m);
        let reach_m = PI * (0.5 * offset_m.abs() * turn_radius_m).sqrt();
        let route = from.route.displaced(offset_m, intrusion.along_m, reach_m);
        Candidate { intrusion_m: map.intrusion_m(&route), route }
    };
    [1.0, -1.0].map(bumped).into()
}

/// The deepest intrusion of a route on one obstacle.
struct Intrusion {
    /// Depth, m.
    depth_m: f64,
    /// Distance along the route, m.
    along_m: f64,
    /// Offset of the route to the left of the axis, m.
    left_m: f64,
    /// Required distance from the axis, m.
    required_m: f64,
}

/// The obstacles and the map of a scenario.
#[derive(Clone, Copy, Debug)]
pub struct ObstacleMap<'a> {
    /// Obstacles.
    pub obstacles: &'a [Cylinder],
    /// The map, which routes must not leave.
    pub map: &'a Map,
    /// Required distance from the surfaces of the obstacles, m.
    pub margin_m: f64,
}

impl ObstacleMap<'_> {
    /// Intrusion of a route, m: its depths into the obstacles, summed, and its largest distance beyond the map. A kink,
    /// which bumps on bumps can cause, counts as [`KINK_PENALTY_M`].
    pub fn intrusion_m(&self, route: &Route) -> f64 {
        let depth_m = |cylinder: &Cylinder| cylinder.radius_m + self.margin_m - route.nearest(cylinder.center_m).0;
        let intrusions_m: f64 = self.obstacles.iter().map(|cylinder| depth_m(cylinder).max(0.0)).sum();
        let kink_m = if route.max_turn_rad() > MAX_TURN_RAD { KINK_PENALTY_M } else { 0.0 };
        intrusions_m + kink_m + route.points().map(|at| self.beyond_map_m(at)).fold(0.0, f64::max)
    }

    fn beyond_map_m(&self, [x, y]: [f64; 2]) -> f64 {
        let beyond_m = |range: Range, value: f64| (range.min - value).max(value - range.max).max(0.0);
        beyond_m(self.map.x_m, x) + beyond_m(self.map.y_m, y)
    }

    fn deepest(&self, route: &Route) -> Option<Intrusion> {
        let intrusions = self.obstacles.iter().filter_map(|cylinder| {
            let (distance_m, [dx, dy], along_m) = route.nearest(cylinder.center_m);
            let depth_m = cylinder.radius_m + self.margin_m - distance_m;
            let (sin, cos) = route.at(along_m).heading_rad.sin_cos();
            let required_m = (1.0 + CLEARANCE_FRACTION) * cylinder.radius_m + self.margin_m;
            (depth_m > 0.0).then_some(Intrusion { depth_m, along_m, left_m: dy * cos - dx * sin, required_m })
        });
        intrusions.max_by(|a, b| a.depth_m.total_cmp(&b.depth_m))
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn cylinder(x: f64, y: f64, radius_m: f64) -> Cylinder {
        Cylinder { name: "threat".into(), center_m: [x, y], radius_m }
    }

    fn map(half_height_m: f64) -> Map {
        let high = Range::new(-half_height_m, half_height_m);
        Map { x_m: Range::new(-1.0, 6001.0), y_m: high, z_m: Range::new(0.0, 1000.0) }
    }

    fn straight() -> Route {
        Route::through((0..=100).map(|k| [60.0 * f64::from(k), 0.0]).collect(), 0.0)
    }

    #[test]
    fn passes_on_the_shorter_side() {
        let threat = [cylinder(3000.0, 100.0, 400.0)];
        let map = map(2000.0);
        let map = ObstacleMap { obstacles: &threat, map: &map, margin_m: 10.0 };
        let route = around(straight(), &map, 600.0);
        assert!(map.intrusion_m(&route) < 1.0, "intrusion {} m", map.intrusion_m(&route));
        assert!(route.at(3000.0).position_m[1] < -300.0);
        assert!(route.length_m() < 6150.0, "{} m", route.length_m());
        let clear = ObstacleMap { obstacles: &[cylinder(3000.0, 900.0, 400.0)], ..map };
        assert_eq!(around(straight(), &clear, 600.0).length_m(), 6000.0);
    }

    #[test]
    fn passes_on_the_longer_side_if_the_shorter_one_is_off_the_map() {
        let threat = [cylinder(3000.0, 100.0, 400.0)];
        let map = Map { y_m: Range::new(-200.0, 2000.0), ..map(0.0) };
        let route = around(straight(), &ObstacleMap { obstacles: &threat, map: &map, margin_m: 10.0 }, 600.0);
        assert!(route.at(route.length_m() / 2.0).position_m[1] > 500.0);
    }

    #[test]
    fn finds_a_gap_that_is_wide_enough() {
        let wall: Vec<Cylinder> = [-1500.0, -700.0, 100.0, 1500.0].map(|y| cylinder(3000.0, y, 410.0)).into();
        let map = map(4000.0);
        let map = ObstacleMap { obstacles: &wall, map: &map, margin_m: 10.0 };
        let route = around(straight(), &map, 600.0);
        assert!(map.intrusion_m(&route) < 1.0);
        let [_, y_m] = route.at(route.length_m() / 2.0).position_m;
        assert!((520.0..1080.0).contains(&y_m), "{y_m}");
    }
}
