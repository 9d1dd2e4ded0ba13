//! Rollout of four particles at once over the horizon, with their violations.

use super::particle_batch::{ParticleBatch, PerParticle};
use super::problem::{EvaluationContext, HorizonProblem, Repulsion};
use crate::free_space::Point;
use crate::free_space::simd_distance::distance_lower_bound_m;
use crate::simd::{Lanes, Simd4};

/// Segments into which the stopping path is divided for the check against moving obstacles.
const STOP_SEGMENTS: usize = 4;

/// Distance below which the repulsion stays constant, m.
const MIN_REPULSION_DISTANCE_M: f64 = 1e-3;

/// Position, velocity or acceleration of four particles.
type Point4<S> = [Lanes<S>; 3];

/// Simulates the controls of `batch`, which are projected if the options say so, and stores path, final state, violation,
/// roughness and repulsion.
#[inline(always)]
pub fn roll_out<S: Simd4>(
    simd: S,
    problem: &HorizonProblem<'_>,
    context: &EvaluationContext<'_>,
    batch: &mut ParticleBatch,
) {
    let splat = |value: f64| Lanes::splat(simd, value);
    let zero = splat(0.0);
    let half_step_s = splat(0.5 * problem.step_s);
    let initial = [problem.start.position, problem.start.velocity, problem.applied_acceleration];
    let [mut position, mut velocity, mut previous] = initial.map(|vector| <[f64; 3]>::from(vector).map(splat));
    let (mut violation, mut roughness, mut repulsion) = (zero, zero, zero);
    store(&mut batch.path[0], &position);
    let (steps, axes) = (problem.grid.steps, problem.grid.axes);
    for step in 0..steps {
        let controls = &mut batch.controls[step * axes..(step + 1) * axes];
        let (acceleration, next_velocity) = accelerate(simd, problem, controls, &velocity, &mut violation);
        let mut next = position;
        for axis in 0..3 {
            next[axis] = (velocity[axis] + next_velocity[axis]).mul_add(half_step_s, position[axis]);
            let change = acceleration[axis] - previous[axis];
            roughness = change.mul_add(change, roughness);
        }
        let distance = step_distance(problem, context, &position, &next, step);
        let required = context.required_clearance_m[step];
        violation += splat(problem.violation_weights[0]) * (splat(required) - distance).max(zero);
        if let Some(field) = problem.cost.repulsion() {
            repulsion += if field.is_by_all {
                repulsion_by_all(problem, context, field, [&position, &next], step)
            } else {
                repulsive_potential(field, distance - splat(problem.clearance_m))
            };
        }
        (position, velocity, previous) = (next, next_velocity, acceleration);
        store(&mut batch.path[step + 1], &position);
        if problem.options.stop_after_step == Some(step + 1) && step + 1 < steps {
            let (stop_violation, _) = stop(problem, context, &position, &velocity, step + 1);
            violation += stop_violation;
        }
    }
    let (stop_violation, stop_position) = stop(problem, context, &position, &velocity, steps);
    if problem.options.stop_after_step.is_some() {
        violation += stop_violation;
    }
    store(&mut batch.stop_position, &stop_position);
    store(&mut batch.final_velocity, &velocity);
    batch.violation = violation.to_array();
    batch.roughness = roughness.to_array();
    batch.repulsion = repulsion.to_array();
}

/// Acceleration and next velocity of one step. Projects `controls` if the options say so, else adds the violations of the
/// norm bounds to `violation`.
#[inline(always)]
fn accelerate<S: Simd4>(
    simd: S,
    problem: &HorizonProblem<'_>,
    controls: &mut [PerParticle],
    velocity: &Point4<S>,
    violation: &mut Lanes<S>,
) -> (Point4<S>, Point4<S>) {
    let zero = violation.like(0.0);
    let step_s = zero.like(problem.step_s);
    let mut acceleration = [zero; 3];
    for axis in 0..controls.len() {
        acceleration[axis] = Lanes::new(simd, controls[axis]);
    }
    let mut next_velocity = *velocity;
    if problem.options.projects_controls {
        clamp_norm(&mut acceleration, problem.limits.acceleration_mps2);
        advance(&mut next_velocity, &acceleration, step_s);
        // v is in the ball, and projection onto a ball brings points nearer to those in it: |a| does not grow
        clamp_norm(&mut next_velocity, problem.limits.speed_mps);
        let rate = zero.like(1.0 / problem.step_s);
        for axis in 0..controls.len() {
            acceleration[axis] = (next_velocity[axis] - velocity[axis]) * rate;
            controls[axis] = acceleration[axis].to_array();
        }
    } else {
        advance(&mut next_velocity, &acceleration, step_s);
        let [_, speed_weight, acceleration_weight] = problem.violation_weights.map(|weight| zero.like(weight));
        *violation += speed_weight * norm_excess(&next_velocity, problem.limits.speed_mps);
        *violation += acceleration_weight * norm_excess(&acceleration, problem.limits.acceleration_mps2);
    }
    (acceleration, next_velocity)
}

/// Violation along the stopping path from the end of a step, and the position where it ends.
#[inline(always)]
fn stop<S: Simd4>(
    problem: &HorizonProblem<'_>,
    context: &EvaluationContext<'_>,
    position: &Point4<S>,
    velocity: &Point4<S>,
    step: usize,
) -> (Lanes<S>, Point4<S>) {
    let zero = position[0].like(0.0);
    let speed = norm(velocity);
    let time_s = speed * zero.like(1.0 / problem.limits.acceleration_mps2);
    let mut end = *position;
    advance(&mut end, velocity, zero.like(0.5) * time_s);
    let required = zero.like(context.required_clearance_m[step]);
    let mut distance = static_distance(problem, context, position, &end);
    let mut from = *position;
    for segment in 1..=STOP_SEGMENTS {
        if context.moving_obstacles.is_empty() {
            break;
        }
        let [since_s, until_s] = [segment - 1, segment]
            .map(|segment| problem.limits.stopping_time_s() * segment as f64 / STOP_SEGMENTS as f64);
        // p + v t (1 - t/(2 t_stop)) until the stop
        let passed_s = zero.like(until_s).min(time_s);
        let fraction = passed_s.over(time_s.max(zero.like(f64::MIN_POSITIVE)));
        let mut to = *position;
        advance(&mut to, velocity, passed_s * (-fraction).mul_add(zero.like(0.5), zero.like(1.0)));
        let begin_s = step as f64 * problem.step_s;
        for (obstacle, _) in &context.moving_obstacles {
            let [old, new] = [since_s, until_s].map(|time_s| obstacle.displacement_m(begin_s + time_s));
            let (p, q) = (relative(&from, old), relative(&to, new));
            distance = distance.min(distance_lower_bound_m(&obstacle.shape, &p, &q, problem.influence_distance_m()));
        }
        from = to;
    }
    (zero.like(problem.violation_weights[0]) * (required - distance).max(zero), end)
}

/// Lower bound of the distance to obstacles and bounds along a step, m.
#[inline(always)]
fn step_distance<S: Simd4>(
    problem: &HorizonProblem<'_>,
    context: &EvaluationContext<'_>,
    from: &Point4<S>,
    to: &Point4<S>,
    step: usize,
) -> Lanes<S> {
    let mut distance = static_distance(problem, context, from, to);
    for (obstacle, displacements) in &context.moving_obstacles {
        let (p, q) = (relative(from, displacements[step]), relative(to, displacements[step + 1]));
        distance = distance.min(distance_lower_bound_m(&obstacle.shape, &p, &q, problem.influence_distance_m()));
    }
    distance
}

/// Lower bound of the distance to static obstacles and bounds along a segment, m.
#[inline(always)]
fn static_distance<S: Simd4>(
    problem: &HorizonProblem<'_>,
    context: &EvaluationContext<'_>,
    from: &Point4<S>,
    to: &Point4<S>,
) -> Lanes<S> {
    let mut distance = frame_distance(problem, from, to);
    for obstacle in &context.static_obstacles {
        distance = distance.min(distance_lower_bound_m(obstacle, from, to, problem.influence_distance_m()));
    }
    distance
}

/// Distance to the bounds along a segment, m.
#[inline(always)]
fn frame_distance<S: Simd4>(problem: &HorizonProblem<'_>, from: &Point4<S>, to: &Point4<S>) -> Lanes<S> {
    let mut distance = from[0].like(f64::INFINITY);
    for axis in 0..3 {
        let [low, high] = problem.space.bounds_m[axis].map(|bound| from[axis].like(bound));
        distance = distance.min(from[axis].min(to[axis]) - low).min(high - from[axis].max(to[axis]));
    }
    distance
}

/// Sum of U_rep along a step over all obstacles and the frame.
#[inline(always)]
fn repulsion_by_all<S: Simd4>(
    problem: &HorizonProblem<'_>,
    context: &EvaluationContext<'_>,
    field: Repulsion,
    [from, to]: [&Point4<S>; 2],
    step: usize,
) -> Lanes<S> {
    let clearance = from[0].like(problem.clearance_m);
    let mut sum = repulsive_potential(field, frame_distance(problem, from, to) - clearance);
    let reach_m = problem.influence_distance_m();
    for obstacle in &context.static_obstacles {
        sum += repulsive_potential(field, distance_lower_bound_m(obstacle, from, to, reach_m) - clearance);
    }
    for (obstacle, displacements) in &context.moving_obstacles {
        let (p, q) = (relative(from, displacements[step]), relative(to, displacements[step + 1]));
        sum += repulsive_potential(field, distance_lower_bound_m(&obstacle.shape, &p, &q, reach_m) - clearance);
    }
    sum
}

/// U_rep (eq. 3) at a distance beyond the clearance:
///
/// ```text
/// U_rep = k_rep/2 (1/d - 1/d_n)²  for d < d_n, else 0
/// ```
///
/// without the square if the field is as printed.
#[inline(always)]
fn repulsive_potential<S: Simd4>(field: Repulsion, distance: Lanes<S>) -> Lanes<S> {
    let zero = distance.like(0.0);
    let bracket = distance.max(zero.like(MIN_REPULSION_DISTANCE_M)).recip() - zero.like(1.0 / field.reach_m);
    let bracket = bracket.max(zero);
    let strength = if field.is_squared { bracket * bracket } else { bracket };
    zero.like(0.5 * field.gain) * strength
}

#[inline(always)]
fn advance<S: Simd4>(point: &mut Point4<S>, rate: &Point4<S>, time_s: Lanes<S>) {
    for axis in 0..3 {
        point[axis] = rate[axis].mul_add(time_s, point[axis]);
    }
}

#[inline(always)]
fn norm<S: Simd4>(vector: &Point4<S>) -> Lanes<S> {
    let mut sum = vector[0] * vector[0];
    for axis in 1..3 {
        sum = vector[axis].mul_add(vector[axis], sum);
    }
    sum.sqrt()
}

#[inline(always)]
fn clamp_norm<S: Simd4>(vector: &mut Point4<S>, max: f64) {
    let norm = norm(vector);
    let max = norm.like(max);
    let factor = norm.is_above(max).select(max.over(norm), norm.like(1.0));
    for axis in 0..3 {
        vector[axis] = vector[axis] * factor;
    }
}

#[inline(always)]
fn norm_excess<S: Simd4>(vector: &Point4<S>, max: f64) -> Lanes<S> {
    let norm = norm(vector);
    (norm - norm.like(max)).max(norm.like(0.0))
}

#[inline(always)]
fn relative<S: Simd4>(point: &Point4<S>, displacement: Point) -> Point4<S> {
    let mut relative = *point;
    for axis in 0..3 {
        relative[axis] = point[axis] - point[axis].like(displacement[axis]);
    }
    relative
}

#[inline(always)]
fn store<S: Simd4>(components: &mut [PerParticle; 3], point: &Point4<S>) {
    for axis in 0..3 {
        components[axis] = point[axis].to_array();
    }
}
