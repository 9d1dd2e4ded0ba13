//! What a particle is worth: four of them fly at once, then those that are feasible are charged.

use super::cost_map::CostMap;
use super::flight::fly;
use super::group::{Fitness, Group};
use super::question::{Cost, Question, Surroundings};
use crate::free_space::vector::{Point, distance, dot};
use crate::lanes::{Vector, WIDTH};

/// Cost of a particle that sees no way to the goal, m, on top of the distance as the crow flies.
const BLIND_M: f64 = 1e4;

/// The machine's instructions for four numbers.
#[derive(Clone, Copy, Debug)]
pub enum Machine {
    /// AVX2: four numbers in one register.
    #[cfg(target_arch = "x86_64")]
    V3(pulp::x86::V3),
    /// Whatever the compiler makes of four numbers: slower, with the same result to the last digit.
    Portable,
}

impl Machine {
    /// The best that is there.
    pub fn detect() -> Self {
        #[cfg(target_arch = "x86_64")]
        if let Some(simd) = pulp::x86::V3::try_new() {
            return Self::V3(simd);
        }
        Self::Portable
    }

    /// Flies and charges four particles.
    pub fn evaluate(self, question: &Question<'_>, surroundings: &Surroundings<'_>, group: &mut Group) {
        match self {
            #[cfg(target_arch = "x86_64")]
            Self::V3(simd) => fly_with(simd, question, surroundings, group),
            Self::Portable => fly_with(pulp::Scalar256b, question, surroundings, group),
        }
        for lane in 0..WIDTH {
            let violation = group.violation[lane];
            let is_costed = violation <= 0.0 || question.rules.costs_infeasible;
            let cost = if is_costed { cost(question, surroundings, group, lane) } else { f64::INFINITY };
            group.fitness[lane] = Fitness { violation, cost };
        }
    }
}

fn fly_with<S: Vector>(simd: S, question: &Question<'_>, surroundings: &Surroundings<'_>, group: &mut Group) {
    simd.vectorize(Fly { simd, question, surroundings, group });
}

struct Fly<'a, S: Vector> {
    simd: S,
    question: &'a Question<'a>,
    surroundings: &'a Surroundings<'a>,
    group: &'a mut Group,
}

impl<S: Vector> pulp::WithSimd for Fly<'_, S> {
    type Output = ();

    #[inline(always)]
    fn with_simd<T: pulp::Simd>(self, _: T) {
        fly(self.simd, self.question, self.surroundings, self.group);
    }
}

/// Cost of one particle (eq. 10, 16, 17), m.
fn cost(question: &Question<'_>, surroundings: &Surroundings<'_>, group: &mut Group, lane: usize) -> f64 {
    let smoothness = question.smoothness * group.roughness[lane];
    let arrival = if question.charges_speed {
        let velocity = group.end_velocity.map(|quad| quad[lane]);
        dot(velocity, velocity) / (2.0 * question.limits.acceleration_mps2)
    } else {
        0.0
    };
    smoothness
        + arrival
        + match question.cost {
            Cost::Map { map, repulsion } => {
                let repulsion = if repulsion.is_some() { group.repulsion[lane] } else { 0.0 };
                by_map(question, surroundings, map, group, lane) + repulsion
            }
            Cost::Field { attraction, .. } => {
                let left_m = distance(end(question, group, lane), question.goal);
                0.5 * attraction * left_m * left_m + group.repulsion[lane]
            }
        }
}

/// The way left from the end, and the mean over the horizon of the way left by the same node.
fn by_map(
    question: &Question<'_>,
    surroundings: &Surroundings<'_>,
    map: &CostMap,
    group: &mut Group,
    lane: usize,
) -> f64 {
    let end = end(question, group, lane);
    let left = surroundings.outlook.as_ref().and_then(|outlook| outlook.cost_to_go(end, &mut group.hints));
    let Some(left) = left else {
        return BLIND_M + distance(end, question.goal);
    };
    let node = map.roadmap().nodes()[left.node];
    let from_node_m = map.roadmap().cost_to_go_m()[left.node];
    let steps = question.grid.steps;
    let to_node_m: f64 = (1..=steps).map(|sample| distance(group.position(sample, lane), node)).sum();
    left.length_m + question.stage_weight * (to_node_m / steps as f64 + from_node_m)
}

/// Where the horizon ends: with the stopping rule, where the vehicle comes to rest.
fn end(question: &Question<'_>, group: &Group, lane: usize) -> Point {
    if question.rules.stops_after.is_some() {
        group.stop.map(|quad| quad[lane])
    } else {
        group.position(question.grid.steps, lane)
    }
}
