//! Evaluation of particles: the rollout of four at once, then the cost of those that are feasible.

use super::batch_rollout::roll_out;
use super::particle_batch::{Fitness, ParticleBatch};
use super::problem::{Attraction, Cost, EvaluationContext, HorizonProblem};
use crate::free_space::Point;
use crate::roadmap::CostMap;
use crate::simd::{Simd4, WIDTH};

/// Cost of a particle without a path to the goal, in addition to the straight distance, m.
const NO_PATH_PENALTY_M: f64 = 1e4;

/// Vector instructions of the processor. Results are equal to the bit on every level.
#[derive(Clone, Copy, Debug)]
pub enum SimdLevel {
    /// AVX2 and FMA: four numbers in one register.
    #[cfg(target_arch = "x86_64")]
    V3(pulp::x86::V3),
    /// No assumption; slower.
    Portable,
}

impl SimdLevel {
    /// The best level that the processor supports.
    pub fn detect() -> Self {
        #[cfg(target_arch = "x86_64")]
        if let Some(simd) = pulp::x86::V3::try_new() {
            return Self::V3(simd);
        }
        Self::Portable
    }
}

/// Computes paths, violations and fitness of four particles from their controls.
pub fn evaluate(
    problem: &HorizonProblem<'_>,
    context: &EvaluationContext<'_>,
    batch: &mut ParticleBatch,
    simd_level: SimdLevel,
) {
    match simd_level {
        #[cfg(target_arch = "x86_64")]
        SimdLevel::V3(simd) => roll_out_with(simd, problem, context, batch),
        SimdLevel::Portable => roll_out_with(pulp::Scalar256b, problem, context, batch),
    }
    for lane in 0..WIDTH {
        let violation = batch.violation[lane];
        let is_costed = violation <= 0.0 || problem.options.costs_infeasible;
        let cost = if is_costed { cost(problem, context, batch, lane) } else { f64::INFINITY };
        batch.fitness[lane] = Fitness { violation, cost };
    }
}

fn roll_out_with<S: Simd4>(
    simd: S,
    problem: &HorizonProblem<'_>,
    context: &EvaluationContext<'_>,
    batch: &mut ParticleBatch,
) {
    simd.vectorize(Rollout { simd, problem, context, batch });
}

struct Rollout<'a, S: Simd4> {
    simd: S,
    problem: &'a HorizonProblem<'a>,
    context: &'a EvaluationContext<'a>,
    batch: &'a mut ParticleBatch,
}

impl<S: Simd4> pulp::WithSimd for Rollout<'_, S> {
    type Output = ();

    #[inline(always)]
    fn with_simd<T: pulp::Simd>(self, _: T) {
        roll_out(self.simd, self.problem, self.context, self.batch);
    }
}

/// Cost of one particle (eq. 10, 16, 17), m.
fn cost(problem: &HorizonProblem<'_>, context: &EvaluationContext<'_>, batch: &mut ParticleBatch, lane: usize) -> f64 {
    let smoothness = problem.smoothness_weight * batch.roughness[lane];
    let final_speed = if problem.costs_final_speed {
        let velocity = Point::from(batch.final_velocity.map(|component| component[lane]));
        velocity.norm_squared() / (2.0 * problem.limits.acceleration_mps2)
    } else {
        0.0
    };
    smoothness
        + final_speed
        + match problem.cost {
            Cost::CostMap { map, repulsion } => {
                let repulsion = if repulsion.is_some() { batch.repulsion[lane] } else { 0.0 };
                map_cost(problem, context, map, batch, lane) + repulsion
            }
            Cost::PotentialField { attraction, .. } => {
                attractive_potential(problem, attraction, batch, lane) + batch.repulsion[lane]
            }
        }
}

/// U_att (eq. 2) at the end of the horizon, or its mean over the steps.
fn attractive_potential(
    problem: &HorizonProblem<'_>,
    Attraction { gain, is_along_horizon }: Attraction,
    batch: &ParticleBatch,
    lane: usize,
) -> f64 {
    let potential = |position: Point| {
        let to_goal_m = (position - problem.goal).norm();
        0.5 * gain * to_goal_m * to_goal_m
    };
    if !is_along_horizon {
        return potential(final_position(problem, batch, lane));
    }
    let steps = problem.grid.steps;
    (1..=steps).map(|sample| potential(batch.position(sample, lane))).sum::<f64>() / steps as f64
}

/// Cost-to-go of the final position, and the mean over the horizon of the cost-to-go by the same node (eq. 10), m.
fn map_cost(
    problem: &HorizonProblem<'_>,
    context: &EvaluationContext<'_>,
    map: &CostMap,
    batch: &mut ParticleBatch,
    lane: usize,
) -> f64 {
    let end = final_position(problem, batch, lane);
    let cost_to_go = context.cost_to_go.as_ref().and_then(|query| query.cost_to_go(end, &mut batch.hints));
    let Some(cost_to_go) = cost_to_go else {
        return NO_PATH_PENALTY_M + (end - problem.goal).norm();
    };
    let node = map.roadmap().nodes()[cost_to_go.node];
    let from_node_m = map.roadmap().cost_to_go_m()[cost_to_go.node];
    let steps = problem.grid.steps;
    let to_node_m: f64 = (1..=steps).map(|sample| (batch.position(sample, lane) - node).norm()).sum();
    cost_to_go.length_m + problem.stage_weight * (to_node_m / steps as f64 + from_node_m)
}

/// The position that the terminal cost applies to: where the vehicle comes to rest if a stop is required, else the end of
/// the horizon.
fn final_position(problem: &HorizonProblem<'_>, batch: &ParticleBatch, lane: usize) -> Point {
    if problem.options.stop_after_step.is_some() {
        batch.stop_position.map(|coordinate| coordinate[lane]).into()
    } else {
        batch.position(problem.grid.steps, lane)
    }
}
