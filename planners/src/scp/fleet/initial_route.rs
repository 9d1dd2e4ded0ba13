//! The initial route and speed of each vehicle: a short flyable path, flown so that all vehicles arrive together.

use rayon::prelude::*;
use scenarios::fixed_wing::{GRAVITY_MPS2, Limits};
use scenarios::{Scenario, Vehicle};

use super::super::dynamics::{Control, State};
use super::super::initial_guess::boundary_states;
use super::super::iterate::Iterate;
use super::agility::Agility;
use super::detour::{self, ObstacleMap};
use super::dubins::{DubinsPath, Pose};
use super::lengthening::Lengthening;
use super::route::Route;
use super::speed::{self, SpeedProfile};

/// Turn radius of the initial routes relative to the smallest radius at the initial speed.
const TURN_RADIUS_FACTOR: f64 = 1.15;

/// By how much the turns are wider after all paths with the tightest ones have been tried, in smallest radii.
const WIDER_RADIUS_FACTOR: f64 = 0.35;

/// What every further attempt adds to the common flight time, as a fraction.
const ATTEMPT_DELAY: f64 = 0.08;

/// Speed on a detour that delays the arrival, as a fraction of the speed range: near the lower limit, with margins on
/// both sides.
const DELAY_SPEED_FRACTION: f64 = 0.25;

/// Climb of the initial routes, as a fraction of the limit of the flight-path angle.
const CLIMB_FRACTION: f64 = 0.7;

/// Maximum number of times that the common flight time is raised.
const MAX_DELAYS: usize = 4;

/// Route and flight time of one vehicle.
#[derive(Clone, Debug)]
pub struct InitialRoute {
    /// Route over the ground.
    pub route: Route,
    /// Intended flight time, s.
    pub flight_time_s: f64,
}

/// Short routes around the obstacles, lengthened for vehicles that would arrive early even at low speed. Every vehicle has
/// another route in each of its attempts, and more time where all arrive together.
pub fn initial_routes(scenario: &Scenario, margin_m: f64, attempts: &[usize]) -> Vec<InitialRoute> {
    let map = ObstacleMap { obstacles: &scenario.world.cylinders, map: &scenario.world.map, margin_m };
    let shortest = scenario.vehicles.par_iter().zip(attempts);
    let shortest = shortest.map(|(vehicle, attempt)| short_route(vehicle, limits(scenario, vehicle), *attempt, &map));
    let shortest: Vec<InitialRoute> = shortest.collect();
    if !scenario.fleet.simultaneous_arrival {
        return shortest;
    }
    let last_s = |routes: &[InitialRoute]| routes.iter().map(|route| route.flight_time_s).fold(0.0, f64::max);
    let mut delayed_routes = Vec::new();
    let delays = attempts.iter().max().map_or(0.0, |attempt| ATTEMPT_DELAY * *attempt as f64);
    let mut together_s = (1.0 + delays) * last_s(&shortest);
    for _ in 0..MAX_DELAYS {
        let delayed = shortest.par_iter().zip(&scenario.vehicles);
        let delayed = delayed.map(|(route, vehicle)| {
            let limits = limits(scenario, vehicle);
            let route = delayed_route(route, together_s, vehicle, limits, &map);
            let fastest_s = profile(vehicle, limits, &route, limits.speed_mps.max).duration_s();
            InitialRoute { route, flight_time_s: fastest_s.max(together_s) }
        });
        let mut routes: Vec<InitialRoute> = delayed.collect();
        let needed_s = last_s(&routes);
        if needed_s <= together_s {
            return routes;
        }
        // a vehicle that has to fly a full circle delays all
        together_s = needed_s;
        routes.iter_mut().for_each(|route| route.flight_time_s = together_s);
        delayed_routes = routes;
    }
    delayed_routes
}

/// A short route that leaves room for the changes of altitude and speed, at full speed.
fn short_route(vehicle: &Vehicle, limits: &Limits, attempt: usize, map: &ObstacleMap) -> InitialRoute {
    let ends = poses(vehicle);
    let smallest_m = Agility::new(limits).turn_radius_m(vehicle.start.speed_mps);
    let (turn_radius_m, path) = attempt_path(ends, smallest_m, attempt);
    let mut route = detour::around(Route::along(&path, turn_radius_m), map, turn_radius_m);
    let length_m = min_length_m(vehicle, limits);
    if route.length_m() < length_m {
        let longer = Lengthening { ends, map, turn_radius_m, length_m, max_length_m: f64::INFINITY };
        route = longer.of(&route);
    }
    let flight_time_s = profile(vehicle, limits, &route, limits.speed_mps.max).duration_s();
    InitialRoute { route, flight_time_s }
}

/// The path of an attempt and its turn radius, m: first those of all words with the tightest turns, the shortest first, then
/// those with wider turns.
fn attempt_path([start, goal]: [Pose; 2], smallest_m: f64, attempt: usize) -> (f64, DubinsPath) {
    let mut remaining = attempt;
    let mut turn_radius_m = TURN_RADIUS_FACTOR * smallest_m;
    loop {
        let paths = DubinsPath::all(start, goal, turn_radius_m);
        match paths.get(remaining) {
            Some(path) => return (turn_radius_m, *path),
            None => remaining -= paths.len(),
        }
        turn_radius_m += WIDER_RADIUS_FACTOR * smallest_m;
    }
}

/// Smallest length in which altitude and speed can change from the start's to the goal's, m.
fn min_length_m(vehicle: &Vehicle, limits: &Limits) -> f64 {
    let [start, goal] = [&vehicle.start, &vehicle.goal];
    let climb_m = goal.z_m - start.z_m;
    let climb = if climb_m < 0.0 { limits.flight_path_deg.min } else { limits.flight_path_deg.max };
    let climbing_m = (climb_m / (CLIMB_FRACTION * climb.to_radians()).tan()).abs();
    let squares = (goal.speed_mps * goal.speed_mps - start.speed_mps * start.speed_mps).abs();
    let changing_speed_m = squares / (2.0 * speed::ACCELERATION_FRACTION * Agility::new(limits).acceleration_mps2());
    if climb_m == 0.0 { changing_speed_m } else { climbing_m.max(changing_speed_m) }
}

/// The trajectory along an initial route, with its initial and final state. The final heading is that of the scenario
/// up to full turns.
pub fn trajectory(
    scenario: &Scenario,
    vehicle: &Vehicle,
    initial: &InitialRoute,
    intervals: usize,
    ramp: f64,
) -> (Iterate, [State; 2]) {
    let limits = limits(scenario, vehicle);
    let profile = profile(vehicle, limits, &initial.route, cruise_mps(initial, vehicle, limits));
    let dt_s = initial.flight_time_s / intervals as f64;
    let [from, to] = boundary_states(vehicle);
    let mut states: Vec<State> = Vec::with_capacity(intervals + 1);
    for k in 0..=intervals {
        let fraction = k as f64 / intervals as f64;
        let t_s = fraction * profile.duration_s();
        let pose = initial.route.at(profile.distance_m(t_s));
        let [x, y] = pose.position_m;
        let before = states.last().map_or(initial.route.start_heading_rad(), |state| state[4]);
        let heading = before + wrapped(pose.heading_rad - before);
        let climb = (to[2] - from[2]) / initial.route.length_m();
        states.push(State::new(
            x,
            y,
            from[2] + fraction * (to[2] - from[2]),
            profile.speed_mps(t_s),
            heading,
            climb.atan(),
        ));
    }
    let mut goal = to;
    goal[4] = states[intervals][4] + wrapped(to[4] - states[intervals][4]);
    (states[0], states[intervals]) = (from, goal);
    let controls = (0..=intervals).map(|k| control(&states, k, dt_s, limits)).collect();
    (Iterate { states, controls, dt_s, ramp }, [from, goal])
}

/// Load factors of the motion through the states, clamped to the limits.
fn control(states: &[State], k: usize, dt_s: f64, limits: &Limits) -> Control {
    let (before, after) = (&states[k.saturating_sub(1)], &states[(k + 1).min(states.len() - 1)]);
    let span_s = dt_s * ((k + 1).min(states.len() - 1) - k.saturating_sub(1)) as f64;
    let rate = |i: usize| (after[i] - before[i]) / span_s;
    let clamped = |value: f64, range: scenarios::Range| value.clamp(range.min, range.max);
    Control::new(
        clamped(rate(3) / GRAVITY_MPS2, limits.n_x),
        clamped(states[k][3] * rate(4) / GRAVITY_MPS2, limits.n_y),
        clamped(1.0, limits.n_z),
    )
}

/// The route, lengthened so that it takes the given flight time within the speed limits.
fn delayed_route(
    initial: &InitialRoute,
    flight_time_s: f64,
    vehicle: &Vehicle,
    limits: &Limits,
    map: &ObstacleMap,
) -> Route {
    let slow_mps = limits.speed_mps.min + DELAY_SPEED_FRACTION * limits.speed_mps.width();
    let missing_s = flight_time_s - profile(vehicle, limits, &initial.route, slow_mps).duration_s();
    if missing_s <= 0.0 {
        return initial.route.clone();
    }
    let longer = Lengthening {
        ends: poses(vehicle),
        map,
        turn_radius_m: TURN_RADIUS_FACTOR * Agility::new(limits).turn_radius_m(slow_mps),
        length_m: initial.route.length_m() + missing_s * slow_mps,
        max_length_m: flight_time_s * (limits.speed_mps.max - 0.1 * limits.speed_mps.width()),
    };
    longer.of(&initial.route)
}

fn poses(vehicle: &Vehicle) -> [Pose; 2] {
    [&vehicle.start, &vehicle.goal].map(|waypoint| Pose {
        position_m: [waypoint.x_m, waypoint.y_m],
        heading_rad: waypoint.heading_deg.to_radians(),
    })
}

/// Cruising speed at which the route takes the intended flight time, within the limits.
fn cruise_mps(initial: &InitialRoute, vehicle: &Vehicle, limits: &Limits) -> f64 {
    let (mut low, mut high) = (limits.speed_mps.min, limits.speed_mps.max);
    while high - low > 1e-6 {
        let middle = 0.5 * (low + high);
        let too_slow = profile(vehicle, limits, &initial.route, middle).duration_s() > initial.flight_time_s;
        (low, high) = if too_slow { (middle, high) } else { (low, middle) };
    }
    0.5 * (low + high)
}

fn profile(vehicle: &Vehicle, limits: &Limits, route: &Route, cruise_mps: f64) -> SpeedProfile {
    let ends_mps = [vehicle.start.speed_mps, vehicle.goal.speed_mps];
    SpeedProfile::cruising(route.length_m(), ends_mps, cruise_mps, Agility::new(limits).acceleration_mps2())
}

fn limits<'a>(scenario: &'a Scenario, vehicle: &Vehicle) -> &'a Limits {
    &scenario.fixed_wing_model(vehicle).planning_limits
}

/// The angle wrapped to (-π, π].
fn wrapped(angle_rad: f64) -> f64 {
    angle_rad - std::f64::consts::TAU * (angle_rad / std::f64::consts::TAU).round()
}
