//! The initial route and speed of each vehicle: a short flyable path, flown so that all vehicles arrive together.

use rayon::prelude::*;
use scenarios::fixed_wing::{GRAVITY_MPS2, Limits};
use scenarios::{Scenario, Vehicle};

use super::super::dynamics::{Control, State};
use super::super::initial_guess::boundary_states;
use super::super::iterate::Iterate;
use super::detour::{self, ObstacleMap};
use super::route::Route;
use super::speed::SpeedProfile;

/// Turn radius of the initial routes relative to the smallest radius at the initial speed.
const TURN_RADIUS_FACTOR: f64 = 1.15;

/// Speed on a detour that delays the arrival, as a fraction of the speed range: near the lower limit, with margins on
/// both sides.
const DELAY_SPEED_FRACTION: f64 = 0.25;

/// Route and flight time of one vehicle.
#[derive(Clone, Debug)]
pub struct InitialRoute {
    /// Route over the ground.
    pub route: Route,
    /// Intended flight time, s.
    pub flight_time_s: f64,
}

/// Short routes around the obstacles, lengthened for vehicles that would arrive early even at low speed.
pub fn initial_routes(scenario: &Scenario, margin_m: f64) -> Vec<InitialRoute> {
    let map = ObstacleMap { obstacles: &scenario.world.cylinders, map: &scenario.world.map, margin_m };
    let planned = scenario.vehicles.par_iter().map(|vehicle| {
        let limits = limits(scenario, vehicle);
        let turn_radius_m = TURN_RADIUS_FACTOR * turn_radius_m(limits, vehicle.start.speed_mps);
        let shortest = Route::shortest(vehicle, turn_radius_m);
        let route = detour::around(shortest, &map, turn_radius_m);
        let flight_time_s = profile(vehicle, limits, &route, limits.speed_mps.max).duration_s();
        InitialRoute { route, flight_time_s }
    });
    let mut routes: Vec<InitialRoute> = planned.collect();
    if scenario.fleet.simultaneous_arrival {
        let last_s = routes.iter().map(|route| route.flight_time_s).fold(0.0, f64::max);
        routes.par_iter_mut().zip(&scenario.vehicles).for_each(|(route, vehicle)| {
            route.flight_time_s = last_s;
            delay(route, vehicle, limits(scenario, vehicle), &map);
        });
    }
    routes
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

/// Lengthens the route so that it takes the intended flight time within the speed limits.
fn delay(initial: &mut InitialRoute, vehicle: &Vehicle, limits: &Limits, map: &ObstacleMap) {
    let slow_mps = limits.speed_mps.min + DELAY_SPEED_FRACTION * limits.speed_mps.width();
    let slow = profile(vehicle, limits, &initial.route, slow_mps);
    let missing_s = initial.flight_time_s - slow.duration_s();
    if missing_s > 0.0 {
        let length_m = initial.route.length_m() + missing_s * slow_mps;
        let turn_radius_m = TURN_RADIUS_FACTOR * turn_radius_m(limits, slow_mps);
        let max_length_m = initial.flight_time_s * (limits.speed_mps.max - 0.1 * limits.speed_mps.width());
        let shapes: [&[f64]; 4] = [&[1.0], &[-1.0], &[1.0, -1.0], &[-1.0, 1.0]];
        let routes = shapes.into_iter().map(|sides| {
            let longer = initial.route.lengthened(length_m, sides);
            detour::around(longer, map, turn_radius_m)
        });
        let rank = |route: &Route| (route.length_m() > max_length_m, map.intrusion_m(route), route.length_m());
        let best = routes.min_by(|a, b| rank(a).partial_cmp(&rank(b)).expect("lengths are numbers"));
        initial.route = best.expect("there are four shapes");
    }
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
    let limit = limits.n_x.max.min(-limits.n_x.min).max(0.01);
    SpeedProfile::cruising(route.length_m(), ends_mps, cruise_mps, GRAVITY_MPS2 * limit)
}

fn turn_radius_m(limits: &Limits, speed_mps: f64) -> f64 {
    let max_n_y = limits.n_y.max.min(-limits.n_y.min).max(0.01);
    speed_mps * speed_mps / (GRAVITY_MPS2 * max_n_y)
}

fn limits<'a>(scenario: &'a Scenario, vehicle: &Vehicle) -> &'a Limits {
    &scenario.fixed_wing_model(vehicle).planning_limits
}

/// The angle wrapped to (-π, π].
fn wrapped(angle_rad: f64) -> f64 {
    angle_rad - std::f64::consts::TAU * (angle_rad / std::f64::consts::TAU).round()
}
