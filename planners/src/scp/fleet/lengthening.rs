//! Longer routes with the same ends, for vehicles that would arrive too early or have to climb too steeply.

use std::f64::consts::TAU;

use super::detour::{self, ObstacleMap};
use super::dubins::{DubinsPath, Pose};
use super::route::Route;

/// Largest curvature of a route whose bumps are wide enough, relative to that of the tightest turn.
const MAX_CURVATURE: f64 = 1.2;

/// Intrusion, m, up to which a route counts as free: the subproblems move it.
const MAX_INTRUSION_M: f64 = 1.0;

/// Largest difference from the wanted length, as a fraction of it.
const MAX_LENGTH_ERROR: f64 = 0.02;

/// Largest radius of turns that take up length, in radii of the tightest turn, and the number of radii that are tried.
const MAX_RADIUS_FACTOR: f64 = 6.0;
const RADII: usize = 24;

/// Positions of a full circle along the route, as fractions of its length.
const CIRCLE_POSITIONS: [f64; 5] = [0.0, 0.25, 0.5, 0.75, 1.0];

/// What a longer route must respect.
#[derive(Clone, Copy, Debug)]
pub struct Lengthening<'a> {
    /// Start and goal.
    pub ends: [Pose; 2],
    /// Obstacles and map.
    pub map: &'a ObstacleMap<'a>,
    /// Radius of the tightest turn, m.
    pub turn_radius_m: f64,
    /// Wanted length, m.
    pub length_m: f64,
    /// Largest length that can be flown in time, m.
    pub max_length_m: f64,
}

impl Lengthening<'_> {
    /// The best route of about the wanted length: with bumps where these are wide enough, else with wider turns or with
    /// full circles.
    pub fn of(&self, route: &Route) -> Route {
        let bumped = self.best(self.bumped(route));
        match bumped {
            Some(bumped) if self.shortcoming_m(&bumped) <= MAX_INTRUSION_M => bumped,
            bumped => {
                let others = self.with_wider_turns().into_iter().chain(self.with_circles(route));
                self.best(bumped.into_iter().chain(others)).unwrap_or_else(|| route.clone())
            }
        }
    }

    fn bumped(&self, route: &Route) -> impl Iterator<Item = Route> {
        let shapes: [&[f64]; 4] = [&[1.0], &[-1.0], &[1.0, -1.0], &[-1.0, 1.0]];
        shapes
            .map(|sides| detour::around(route.lengthened(self.length_m, sides), self.map, self.turn_radius_m))
            .into_iter()
    }

    /// Dubins paths whose turns are so wide that they have the wanted length, with and without a full circle.
    fn with_wider_turns(&self) -> Vec<Route> {
        let mut found = Vec::new();
        for word in 0..DubinsPath::WORDS {
            for circles in 0..2 {
                let path = |factor: f64| {
                    let radius_m = factor * self.turn_radius_m;
                    let path = DubinsPath::by_word(self.ends[0], self.ends[1], radius_m, word)?;
                    Some(path.with_circles(circles))
                };
                found.extend(self.wide_enough(&path).map(|path| Route::along(&path, self.turn_radius_m)));
            }
        }
        found
    }

    /// The first path of the wanted length as the radius grows, by bisection.
    fn wide_enough(&self, path: &dyn Fn(f64) -> Option<DubinsPath>) -> Option<DubinsPath> {
        let factor = |step: usize| 1.0 + (MAX_RADIUS_FACTOR - 1.0) * step as f64 / RADII as f64;
        let missing_m = |factor: f64| path(factor).map(|path| self.length_m - path.length_m());
        let bracket = (0..RADII)
            .map(|step| [factor(step), factor(step + 1)])
            .find(|ends| matches!(ends.map(missing_m), [Some(a), Some(b)] if a.signum() != b.signum()))?;
        let ([mut low, mut high], sign) = (bracket, missing_m(bracket[0])?.signum());
        for _ in 0..40 {
            let middle = 0.5 * (low + high);
            if missing_m(middle)?.signum() == sign { low = middle } else { high = middle }
        }
        path(low).filter(|path| (path.length_m() - self.length_m).abs() < MAX_LENGTH_ERROR * self.length_m)
    }

    /// The route with as many full circles as fit into the additional length, at several places and on both sides.
    fn with_circles(&self, route: &Route) -> Vec<Route> {
        let additional_m = self.length_m - route.length_m();
        let circles = (additional_m / (TAU * self.turn_radius_m)).floor().max(1.0);
        let radius_m = (additional_m / (TAU * circles)).max(self.turn_radius_m);
        let places = CIRCLE_POSITIONS.into_iter().flat_map(|fraction| [1.0, -1.0].map(|side| (fraction, side)));
        places
            .map(|(fraction, side)| route.with_circles(fraction * route.length_m(), side * radius_m, circles as usize))
            .collect()
    }

    /// The best route; the first one of equals.
    fn best(&self, routes: impl IntoIterator<Item = Route>) -> Option<Route> {
        let rank = |route: &Route| {
            let shortcoming_m = self.shortcoming_m(route);
            let counted_m = if shortcoming_m <= MAX_INTRUSION_M { 0.0 } else { shortcoming_m };
            (route.length_m() > self.max_length_m, counted_m, route.length_m())
        };
        let ranked = routes.into_iter().map(|route| (rank(&route), route));
        // A route without length has no direction.
        let ranked = ranked.filter(|((_, counted_m, length_m), _)| !counted_m.is_nan() && !length_m.is_nan());
        let best = ranked.min_by(|a, b| a.0.partial_cmp(&b.0).expect("lengths are numbers"));
        best.map(|(_, route)| route)
    }

    /// Intrusion, excessive curvature and missing length of a route, in metres.
    fn shortcoming_m(&self, route: &Route) -> f64 {
        let curvature = route.max_curvature() * self.turn_radius_m;
        let curvature_m = if curvature > MAX_CURVATURE { self.turn_radius_m * (curvature - 1.0) } else { 0.0 };
        let missing_m = (self.length_m - route.length_m() - MAX_LENGTH_ERROR * self.length_m).max(0.0);
        self.map.intrusion_m(route) + curvature_m + missing_m
    }
}

#[cfg(test)]
mod tests {
    use scenarios::{Map, Range};

    use super::*;

    fn lengthened(goal: Pose, length_m: f64) -> Route {
        let all = Range::new(-1e4, 1e4);
        let world = Map { x_m: all, y_m: all, z_m: all };
        let map = ObstacleMap { obstacles: &[], map: &world, margin_m: 10.0 };
        let start = Pose { position_m: [0.0, 0.0], heading_rad: 0.0 };
        let route = Route::along(&DubinsPath::all(start, goal, 100.0)[0], 100.0);
        let to = Lengthening {
            ends: [start, goal],
            map: &map,
            turn_radius_m: 100.0,
            length_m,
            max_length_m: 1.3 * length_m,
        };
        to.of(&route)
    }

    fn ahead(x: f64) -> Pose {
        Pose { position_m: [x, 0.0], heading_rad: 0.0 }
    }

    fn assert_flyable(route: &Route, goal: Pose, length_m: f64) {
        let end = route.at(route.length_m()).position_m;
        assert!((end[0] - goal.position_m[0]).hypot(end[1] - goal.position_m[1]) < 1.0, "{end:?}");
        assert!((route.length_m() - length_m).abs() < 0.03 * length_m, "{} m", route.length_m());
        assert!(route.max_curvature() < 1.5 / 100.0, "{}", route.max_curvature());
    }

    #[test]
    fn a_long_route_gets_a_bump() {
        let route = lengthened(ahead(3000.0), 3200.0);
        assert_flyable(&route, ahead(3000.0), 3200.0);
    }

    #[test]
    fn a_short_route_gets_circles() {
        for length_m in [2000.0, 5000.0] {
            assert_flyable(&lengthened(ahead(300.0), length_m), ahead(300.0), length_m);
        }
    }

    /// The route to a goal at the start has no length, and no direction.
    #[test]
    fn a_goal_at_the_start_gets_a_wide_circle() {
        assert_flyable(&lengthened(ahead(0.0), 1000.0), ahead(0.0), 1000.0);
    }

    #[test]
    fn a_route_back_gets_wider_turns_or_a_circle() {
        let back = Pose { position_m: [0.0, 250.0], heading_rad: std::f64::consts::PI };
        assert_flyable(&lengthened(back, 1150.0), back, 1150.0);
    }
}
