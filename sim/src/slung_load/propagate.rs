use nalgebra::Vector4;
use scenarios::slung_load::{Cable, Control};

use super::dynamics::Plant;
use super::state::SlungLoadState;
use crate::runge_kutta;

/// Quadrotor and load at one instant.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Knot {
    /// Time, s.
    pub t_s: f64,
    /// State.
    pub state: SlungLoadState,
    /// Thrusts of the rotors, N.
    pub thrust_n: Vector4<f64>,
    /// Tension of the cable, N: 0 if it is slack, negative where a taut cable would have to push.
    pub tension_n: f64,
}

/// Integrates the equations of motion over one interval, in air at rest, with the cable in its planned state.
///
/// - `controls`: at the two ends of the interval, linear in time between them (first-order hold)
/// - `times_s`: of the two ends of the interval, in increasing order
/// - `max_step_s`: maximum distance between two knots, which are equidistant, s, > 0
///
/// The Runge-Kutta method is of order 6, with one step per knot: with steps of 10 ms the error over an interval is
/// below 1e-9 m. Returns the knots from the start to the end of the interval, both included.
pub fn propagate(
    plant: &Plant,
    start: &SlungLoadState,
    controls: [&Control; 2],
    cable: Cable,
    times_s: [f64; 2],
    max_step_s: f64,
) -> Vec<Knot> {
    let [from, to] = controls.map(|control| Vector4::from(control.thrust_n));
    let duration_s = times_s[1] - times_s[0];
    let steps = (duration_s / max_step_s).ceil().max(1.0);
    let step_s = duration_s / steps;
    let thrust_at = |fraction: f64| from + (to - from) * fraction;
    let knot = |t_s: f64, state: SlungLoadState, fraction: f64| {
        let thrust_n = thrust_at(fraction);
        let tension_n = match cable {
            Cable::Taut => plant.tension_n(&state, thrust_n.sum()),
            Cable::Slack => 0.0,
        };
        Knot { t_s, state, thrust_n, tension_n }
    };
    let mut knots = vec![knot(times_s[0], *start, 0.0)];
    let mut numbers = start.to_numbers();
    for step in 0..steps as usize {
        let rate =
            |numbers: &_, fraction: f64| plant.rate(numbers, &thrust_at((step as f64 + fraction) / steps), cable);
        let state = SlungLoadState::from_numbers(&runge_kutta::advanced(&numbers, step_s, rate));
        numbers = state.to_numbers();
        let is_last = step + 1 == steps as usize;
        let t_s = if is_last { times_s[1] } else { times_s[0] + (step + 1) as f64 * step_s };
        knots.push(knot(t_s, state, (step + 1) as f64 / steps));
    }
    knots
}
