//! Four particles fly along their horizons at once.

use super::group::Group;
use super::question::{Question, Repulsion, Surroundings, VIOLATION};
use crate::free_space::sweep::least_distance_m;
use crate::lanes::{Lanes, Vector};

/// Pieces into which the way to a stop is divided where obstacles move.
const STOP_PIECES: usize = 4;

/// Distance at which repulsion stops growing, m.
const NEAREST_M: f64 = 1e-3;

/// Position or velocity of four particles.
type Point4<S> = [Lanes<S>; 3];

/// Flies the controls of `group`, which are projected where the rules say so, and writes down path, end and violations.
#[inline(always)]
pub fn fly<S: Vector>(simd: S, question: &Question<'_>, surroundings: &Surroundings<'_>, group: &mut Group) {
    let splat = |value: f64| Lanes::splat(simd, value);
    let (zero, step_s) = (splat(0.0), splat(question.step_s));
    let half_step_s = splat(0.5 * question.step_s);
    let [mut position, mut velocity, mut before] =
        [question.start.position.map(splat), question.start.velocity.map(splat), question.applied.map(splat)];
    let (mut violation, mut roughness, mut repulsion) = (zero, zero, zero);
    store(&mut group.path[0], &position);
    let (steps, axes) = (question.grid.steps, question.grid.axes);
    for step in 0..steps {
        let mut acceleration = [zero; 3];
        for axis in 0..axes {
            acceleration[axis] = Lanes::new(simd, group.controls[step * axes + axis]);
        }
        let mut next_velocity = velocity;
        if question.rules.is_projected {
            shorten(&mut acceleration, question.limits.acceleration_mps2);
            advance(&mut next_velocity, &acceleration, step_s);
            // v is in the ball, and projection onto a ball brings points nearer to those in it: |a| does not grow
            shorten(&mut next_velocity, question.limits.speed_mps);
            let rate = splat(1.0 / question.step_s);
            for axis in 0..axes {
                acceleration[axis] = (next_velocity[axis] - velocity[axis]) * rate;
                group.controls[step * axes + axis] = acceleration[axis].to_array();
            }
        } else {
            advance(&mut next_velocity, &acceleration, step_s);
            let [_, of_speed, of_acceleration] = VIOLATION.map(splat);
            violation += of_speed * excess(&next_velocity, question.limits.speed_mps);
            violation += of_acceleration * excess(&acceleration, question.limits.acceleration_mps2);
        }
        let mut next = position;
        for axis in 0..3 {
            next[axis] = (velocity[axis] + next_velocity[axis]).mul_add(half_step_s, position[axis]);
            let change = acceleration[axis] - before[axis];
            roughness = change.mul_add(change, roughness);
        }
        let distance = distance_on_step(question, surroundings, &position, &next, step);
        let required = surroundings.required_m[step];
        violation += splat(VIOLATION[0]) * (splat(required) - distance).max(zero);
        if let Some(field) = question.cost.repulsion() {
            repulsion += repel(field, distance - splat(question.clearance_m));
        }
        (position, velocity, before) = (next, next_velocity, acceleration);
        store(&mut group.path[step + 1], &position);
        if question.rules.stops_after == Some(step + 1) && step + 1 < steps {
            let (short, _) = stop(question, surroundings, &position, &velocity, step + 1);
            violation += short;
        }
    }
    let (short, end) = stop(question, surroundings, &position, &velocity, steps);
    if question.rules.stops_after.is_some() {
        violation += short;
    }
    store(&mut group.stop, &end);
    store(&mut group.end_velocity, &velocity);
    group.violation = violation.to_array();
    group.roughness = roughness.to_array();
    group.repulsion = repulsion.to_array();
}

/// Violation on the way to a stop from the end of a step, and where it ends.
#[inline(always)]
fn stop<S: Vector>(
    question: &Question<'_>,
    surroundings: &Surroundings<'_>,
    position: &Point4<S>,
    velocity: &Point4<S>,
    step: usize,
) -> (Lanes<S>, Point4<S>) {
    let zero = position[0].like(0.0);
    let speed = length(velocity);
    let time_s = speed * zero.like(1.0 / question.limits.acceleration_mps2);
    let mut end = *position;
    advance(&mut end, velocity, zero.like(0.5) * time_s);
    let required = zero.like(surroundings.required_m[step]);
    let mut distance = distance_at_rest(question, surroundings, position, &end);
    let mut from = *position;
    for piece in 1..=STOP_PIECES {
        if surroundings.moving.is_empty() {
            break;
        }
        let [since_s, until_s] =
            [piece - 1, piece].map(|piece| question.limits.stopping_time_s() * piece as f64 / STOP_PIECES as f64);
        // p + v t (1 - t/(2 t_stop)) until the stop
        let passed_s = zero.like(until_s).min(time_s);
        let share = passed_s.over(time_s.max(zero.like(f64::MIN_POSITIVE)));
        let mut to = *position;
        advance(&mut to, velocity, passed_s * (-share).mul_add(zero.like(0.5), zero.like(1.0)));
        let begin_s = step as f64 * question.step_s;
        for (mover, _) in &surroundings.moving {
            let (old, new) = (mover.offset_m(begin_s + since_s), mover.offset_m(begin_s + until_s));
            let (p, q) = (relative(&from, old), relative(&to, new));
            distance = distance.min(least_distance_m(&mover.shape, &p, &q, question.noticed_m()));
        }
        from = to;
    }
    (zero.like(VIOLATION[0]) * (required - distance).max(zero), end)
}

/// Bound from below of the distance to everything along a step, m.
#[inline(always)]
fn distance_on_step<S: Vector>(
    question: &Question<'_>,
    surroundings: &Surroundings<'_>,
    from: &Point4<S>,
    to: &Point4<S>,
    step: usize,
) -> Lanes<S> {
    let mut distance = distance_at_rest(question, surroundings, from, to);
    for (mover, displacements) in &surroundings.moving {
        let (p, q) = (relative(from, displacements[step]), relative(to, displacements[step + 1]));
        distance = distance.min(least_distance_m(&mover.shape, &p, &q, question.noticed_m()));
    }
    distance
}

/// The same for the frame and what stands still.
#[inline(always)]
fn distance_at_rest<S: Vector>(
    question: &Question<'_>,
    surroundings: &Surroundings<'_>,
    from: &Point4<S>,
    to: &Point4<S>,
) -> Lanes<S> {
    let mut distance = from[0].like(f64::INFINITY);
    for axis in 0..3 {
        let [low, high] = question.space.frame_m[axis].map(|limit| from[axis].like(limit));
        distance = distance.min(from[axis].min(to[axis]) - low).min(high - from[axis].max(to[axis]));
    }
    for obstacle in &surroundings.standing {
        distance = distance.min(least_distance_m(obstacle, from, to, question.noticed_m()));
    }
    distance
}

/// U_rep of eq. 3 at a distance beyond the clearance.
#[inline(always)]
fn repel<S: Vector>(field: Repulsion, distance: Lanes<S>) -> Lanes<S> {
    let zero = distance.like(0.0);
    let bracket = distance.max(zero.like(NEAREST_M)).recip() - zero.like(1.0 / field.reach_m);
    let bracket = bracket.max(zero);
    let strength = if field.is_squared { bracket * bracket } else { bracket };
    zero.like(0.5 * field.gain) * strength
}

#[inline(always)]
fn advance<S: Vector>(point: &mut Point4<S>, rate: &Point4<S>, time_s: Lanes<S>) {
    for axis in 0..3 {
        point[axis] = rate[axis].mul_add(time_s, point[axis]);
    }
}

#[inline(always)]
fn length<S: Vector>(vector: &Point4<S>) -> Lanes<S> {
    let mut sum = vector[0] * vector[0];
    for axis in 1..3 {
        sum = vector[axis].mul_add(vector[axis], sum);
    }
    sum.sqrt()
}

#[inline(always)]
fn shorten<S: Vector>(vector: &mut Point4<S>, most: f64) {
    let length = length(vector);
    let most = length.like(most);
    let factor = length.is_above(most).select(most.over(length), length.like(1.0));
    for axis in 0..3 {
        vector[axis] = vector[axis] * factor;
    }
}

#[inline(always)]
fn excess<S: Vector>(vector: &Point4<S>, most: f64) -> Lanes<S> {
    let length = length(vector);
    (length - length.like(most)).max(length.like(0.0))
}

#[inline(always)]
fn relative<S: Vector>(point: &Point4<S>, displacement: [f64; 3]) -> Point4<S> {
    let mut relative = *point;
    for axis in 0..3 {
        relative[axis] = point[axis] - point[axis].like(displacement[axis]);
    }
    relative
}

#[inline(always)]
fn store<S: Vector>(quads: &mut [[f64; 4]; 3], point: &Point4<S>) {
    for axis in 0..3 {
        quads[axis] = point[axis].to_array();
    }
}
