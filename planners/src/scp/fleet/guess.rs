//! Where the sequence starts: everybody on a shortest way that could be flown, at a speed that brings all there together.

use rayon::prelude::*;
use scenarios::fixed_wing::{GRAVITY_MPS2, Limits};
use scenarios::{Scenario, Vehicle};

use super::super::dynamics::{Control, State};
use super::super::initial_guess::boundary_states;
use super::super::iterate::Iterate;
use super::detour::{self, Ground};
use super::route::Route;
use super::speed::Profile;

/// Turns of the first guess are wider than those of the slowest flight by this factor.
const EASY_TURN: f64 = 1.15;

/// Where in the range of speeds somebody flies who has to lose time by a detour: near the lower end, with room to both
/// sides.
const WAITING: f64 = 0.25;

/// What is known of every vehicle before the first subproblem.
#[derive(Clone, Debug)]
pub struct Start {
    /// The vehicle's way.
    pub route: Route,
    /// Flight time that is aimed at, s.
    pub flight_time_s: f64,
}

/// Shortest ways, lengthened for those that would arrive before the last although they fly slowly.
pub fn starts(scenario: &Scenario, margin_m: f64) -> Vec<Start> {
    let ground = Ground { obstacles: &scenario.world.cylinders, map: &scenario.world.map, margin_m };
    let planned = scenario.vehicles.par_iter().map(|vehicle| {
        let limits = limits(scenario, vehicle);
        let turn_radius_m = EASY_TURN * turn_radius_m(limits, vehicle.start.speed_mps);
        let shortest = Route::shortest(vehicle, turn_radius_m);
        let route = detour::around(shortest, &ground, turn_radius_m);
        let flight_time_s = profile(vehicle, limits, &route, limits.speed_mps.max).duration_s();
        Start { route, flight_time_s }
    });
    let mut starts: Vec<Start> = planned.collect();
    if scenario.fleet.simultaneous_arrival {
        let last_s = starts.iter().map(|start| start.flight_time_s).fold(0.0, f64::max);
        starts.par_iter_mut().zip(&scenario.vehicles).for_each(|(start, vehicle)| {
            start.flight_time_s = last_s;
            stretch(start, vehicle, limits(scenario, vehicle), &ground);
        });
    }
    starts
}

/// Trajectory of a start, with the states that hold it at both ends: the goal's heading is that of the scenario, up to
/// full turns.
pub fn trajectory(
    scenario: &Scenario,
    vehicle: &Vehicle,
    start: &Start,
    intervals: usize,
    ramp: f64,
) -> (Iterate, [State; 2]) {
    let limits = limits(scenario, vehicle);
    let profile = profile(vehicle, limits, &start.route, cruise_mps(start, vehicle, limits));
    let dt_s = start.flight_time_s / intervals as f64;
    let [from, to] = boundary_states(vehicle);
    let mut states: Vec<State> = Vec::with_capacity(intervals + 1);
    for k in 0..=intervals {
        let share = k as f64 / intervals as f64;
        let t_s = share * profile.duration_s();
        let pose = start.route.at(profile.distance_m(t_s));
        let [x, y] = pose.position_m;
        let before = states.last().map_or(start.route.start_heading_rad(), |state| state[4]);
        let heading = before + wrapped(pose.heading_rad - before);
        let climb = (to[2] - from[2]) / start.route.length_m();
        states.push(State::new(
            x,
            y,
            from[2] + share * (to[2] - from[2]),
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

/// Load factors that the states ask for, inside the limits.
fn control(states: &[State], k: usize, dt_s: f64, limits: &Limits) -> Control {
    let (before, after) = (&states[k.saturating_sub(1)], &states[(k + 1).min(states.len() - 1)]);
    let span_s = dt_s * ((k + 1).min(states.len() - 1) - k.saturating_sub(1)) as f64;
    let rate = |i: usize| (after[i] - before[i]) / span_s;
    let inside = |value: f64, range: scenarios::Range| value.clamp(range.min, range.max);
    Control::new(
        inside(rate(3) / GRAVITY_MPS2, limits.n_x),
        inside(states[k][3] * rate(4) / GRAVITY_MPS2, limits.n_y),
        inside(1.0, limits.n_z),
    )
}

/// Makes the route long enough for the flight time at a speed that can be flown.
fn stretch(start: &mut Start, vehicle: &Vehicle, limits: &Limits, ground: &Ground) {
    let slow_mps = limits.speed_mps.min + WAITING * limits.speed_mps.width();
    let slow = profile(vehicle, limits, &start.route, slow_mps);
    let missing_s = start.flight_time_s - slow.duration_s();
    if missing_s > 0.0 {
        let length_m = start.route.length_m() + missing_s * slow_mps;
        let turn_radius_m = EASY_TURN * turn_radius_m(limits, slow_mps);
        let longest_m = start.flight_time_s * (limits.speed_mps.max - 0.1 * limits.speed_mps.width());
        let shapes: [&[f64]; 4] = [&[1.0], &[-1.0], &[1.0, -1.0], &[-1.0, 1.0]];
        let routes = shapes.into_iter().map(|sides| {
            let longer = start.route.lengthened(length_m, sides);
            detour::around(longer, ground, turn_radius_m)
        });
        let rank = |route: &Route| (route.length_m() > longest_m, ground.cut_m(route), route.length_m());
        let best = routes.min_by(|a, b| rank(a).partial_cmp(&rank(b)).expect("lengths are numbers"));
        start.route = best.expect("there are four shapes");
    }
}

/// Cruising speed at which the route takes the flight time, inside the limits.
fn cruise_mps(start: &Start, vehicle: &Vehicle, limits: &Limits) -> f64 {
    let (mut low, mut high) = (limits.speed_mps.min, limits.speed_mps.max);
    while high - low > 1e-6 {
        let middle = 0.5 * (low + high);
        let too_slow = profile(vehicle, limits, &start.route, middle).duration_s() > start.flight_time_s;
        (low, high) = if too_slow { (middle, high) } else { (low, middle) };
    }
    0.5 * (low + high)
}

fn profile(vehicle: &Vehicle, limits: &Limits, route: &Route, cruise_mps: f64) -> Profile {
    let ends_mps = [vehicle.start.speed_mps, vehicle.goal.speed_mps];
    let limit = limits.n_x.max.min(-limits.n_x.min).max(0.01);
    Profile::cruising(route.length_m(), ends_mps, cruise_mps, GRAVITY_MPS2 * limit)
}

fn turn_radius_m(limits: &Limits, speed_mps: f64) -> f64 {
    let sharpest = limits.n_y.max.min(-limits.n_y.min).max(0.01);
    speed_mps * speed_mps / (GRAVITY_MPS2 * sharpest)
}

fn limits<'a>(scenario: &'a Scenario, vehicle: &Vehicle) -> &'a Limits {
    &scenario.fixed_wing_model(vehicle).planning_limits
}

/// Into (-π, π].
fn wrapped(angle_rad: f64) -> f64 {
    angle_rad - std::f64::consts::TAU * (angle_rad / std::f64::consts::TAU).round()
}
