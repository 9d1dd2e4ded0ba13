//! Ways around obstacles, wide enough to be flown.

use std::f64::consts::PI;

use scenarios::{Cylinder, Map, Range};

use super::route::Route;

/// Most bumps that a route is given.
const MOST_BUMPS: usize = 12;

/// Unfinished routes that are followed side by side.
const BEAM: usize = 3;

/// Distance by which a bump clears the obstacle, as a share of its radius.
const BEYOND: f64 = 0.02;

/// Length that a metre of cut is worth, where an unfinished route is compared with another.
const CUT_COSTS: f64 = 2.0;

/// Turn from one piece of a route to the next beyond which it has a kink, rad.
const KINK_RAD: f64 = 0.6;

/// Cut that a kink counts as, m.
const KINK_COSTS_M: f64 = 1000.0;

/// A route, and how deep it still cuts.
#[derive(Clone, Debug)]
struct Candidate {
    route: Route,
    cut_m: f64,
}

/// The shortest route that was found with bumps around the obstacles that `route` cuts; what is still cut in the end is
/// left to the subproblems.
///
/// The deepest cut comes first, and both sides of it are tried; of all unfinished routes only the most promising are
/// followed.
///
/// A bump A (1 + cos(π s/w)) / 2 has the curvature A π²/(2 w²) at its peak: `turn_radius_m` gives w.
pub fn around(route: Route, ground: &Ground, turn_radius_m: f64) -> Route {
    let mut best = Candidate { cut_m: ground.cut_m(&route), route };
    let mut beam = vec![best.clone()];
    for _ in 0..MOST_BUMPS {
        let sides = beam.iter().flat_map(|from| both_sides(from, ground, turn_radius_m));
        beam = sides.filter(|candidate| cost_m(candidate) < cost_m(&best) || best.cut_m > 0.0).collect();
        beam.sort_by(|a, b| cost_m(a).total_cmp(&cost_m(b)));
        beam.truncate(BEAM);
        for candidate in &beam {
            if (candidate.cut_m, cost_m(candidate)) < (best.cut_m, cost_m(&best)) {
                best = candidate.clone();
            }
        }
        beam.retain(|candidate| candidate.cut_m > 0.0);
    }
    best.route
}

fn cost_m(candidate: &Candidate) -> f64 {
    candidate.route.length_m() + CUT_COSTS * candidate.cut_m
}

/// A candidate with one more bump, to either side of the obstacle that it cuts deepest.
fn both_sides(from: &Candidate, ground: &Ground, turn_radius_m: f64) -> Vec<Candidate> {
    let Some(cut) = ground.deepest(&from.route) else { return Vec::new() };
    let bumped = |side: f64| {
        let offset_m = side * (cut.wanted_m - side * cut.left_m);
        let reach_m = PI * (0.5 * offset_m.abs() * turn_radius_m).sqrt();
        let route = from.route.bowed(offset_m, cut.along_m, reach_m);
        Candidate { cut_m: ground.cut_m(&route), route }
    };
    [1.0, -1.0].map(bumped).into()
}

/// Where a route cuts an obstacle deepest.
struct Cut {
    /// By how much, m.
    depth_m: f64,
    /// Way to the place, m.
    along_m: f64,
    /// How far the route passes to the left of the axis, m.
    left_m: f64,
    /// Distance from the axis to pass at, m.
    wanted_m: f64,
}

/// What a route has to keep clear of.
#[derive(Clone, Copy, Debug)]
pub struct Ground<'a> {
    /// Obstacles.
    pub obstacles: &'a [Cylinder],
    /// The map, which must not be left.
    pub map: &'a Map,
    /// Distance to keep from the obstacles' surfaces, m.
    pub margin_m: f64,
}

impl Ground<'_> {
    /// Depths to which a route cuts obstacles, summed over them, and how far it leaves the map, m; a route that folds
    /// back on itself, as bumps upon bumps may, counts as a deep cut.
    pub fn cut_m(&self, route: &Route) -> f64 {
        let depth_m = |cylinder: &Cylinder| cylinder.radius_m + self.margin_m - route.nearest(cylinder.center_m).0;
        let cuts_m: f64 = self.obstacles.iter().map(|cylinder| depth_m(cylinder).max(0.0)).sum();
        let kink_m = if route.sharpest_turn_rad() > KINK_RAD { KINK_COSTS_M } else { 0.0 };
        cuts_m + kink_m + route.points().map(|at| self.beyond_map_m(at)).fold(0.0, f64::max)
    }

    fn beyond_map_m(&self, [x, y]: [f64; 2]) -> f64 {
        let beyond_m = |range: Range, value: f64| (range.min - value).max(value - range.max).max(0.0);
        beyond_m(self.map.x_m, x) + beyond_m(self.map.y_m, y)
    }

    fn deepest(&self, route: &Route) -> Option<Cut> {
        let cuts = self.obstacles.iter().filter_map(|cylinder| {
            let (distance_m, [dx, dy], along_m) = route.nearest(cylinder.center_m);
            let depth_m = cylinder.radius_m + self.margin_m - distance_m;
            let (sin, cos) = route.at(along_m).heading_rad.sin_cos();
            let wanted_m = (1.0 + BEYOND) * cylinder.radius_m + self.margin_m;
            (depth_m > 0.0).then_some(Cut { depth_m, along_m, left_m: dy * cos - dx * sin, wanted_m })
        });
        cuts.max_by(|a, b| a.depth_m.total_cmp(&b.depth_m))
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn pillar(x: f64, y: f64, radius_m: f64) -> Cylinder {
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
    fn goes_round_on_the_shorter_side_and_nowhere_else() {
        let threat = [pillar(3000.0, 100.0, 400.0)];
        let map = map(2000.0);
        let ground = Ground { obstacles: &threat, map: &map, margin_m: 10.0 };
        let route = around(straight(), &ground, 600.0);
        assert!(ground.cut_m(&route) < 1.0, "cut by {} m", ground.cut_m(&route));
        assert!(route.at(3000.0).position_m[1] < -300.0);
        assert!(route.length_m() < 6150.0, "{} m", route.length_m());
        let aside = Ground { obstacles: &[pillar(3000.0, 900.0, 400.0)], ..ground };
        assert_eq!(around(straight(), &aside, 600.0).length_m(), 6000.0);
    }

    #[test]
    fn the_longer_side_is_taken_where_the_shorter_one_is_off_the_map() {
        let threat = [pillar(3000.0, 100.0, 400.0)];
        let map = Map { y_m: Range::new(-200.0, 2000.0), ..map(0.0) };
        let route = around(straight(), &Ground { obstacles: &threat, map: &map, margin_m: 10.0 }, 600.0);
        assert!(route.at(route.length_m() / 2.0).position_m[1] > 500.0);
    }

    #[test]
    fn a_gap_that_is_wide_enough_is_found() {
        let wall: Vec<Cylinder> = [-1500.0, -700.0, 100.0, 1500.0].map(|y| pillar(3000.0, y, 410.0)).into();
        let map = map(4000.0);
        let ground = Ground { obstacles: &wall, map: &map, margin_m: 10.0 };
        let route = around(straight(), &ground, 600.0);
        assert!(ground.cut_m(&route) < 1.0);
        let [_, y_m] = route.at(route.length_m() / 2.0).position_m;
        assert!((520.0..1080.0).contains(&y_m), "{y_m}");
    }
}
