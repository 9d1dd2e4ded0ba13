use planners::free_space::Point;
use planners::horizon::counter_rng::CounterRng;
use planners::horizon::evaluate::SimdLevel;
use planners::horizon::optimiser::{Budget, Solution, optimise};
use planners::horizon::particle_batch::Fitness;
use planners::horizon::problem::{
    Attraction, ControlGrid, Cost, EvaluationOptions, HorizonProblem, Repulsion, VIOLATION_WEIGHTS,
};
use planners::horizon::sampler::{SamplerKind, SwarmSettings};
use planners::multirotor::PointMassState;
use planners::roadmap::{CostMap, RoadmapKind};

use crate::arena::{Arena, LIMITS, random, swarm, trap};

const ATTRACTION: Attraction = Attraction { gain: 0.1, is_along_horizon: false };

const SAMPLERS: [(&str, SamplerKind); 5] = [
    ("pso", SamplerKind::ParticleSwarm(SwarmSettings::STANDARD)),
    ("fpso", SamplerKind::ParticleSwarm(SwarmSettings::FEASIBILITY_DRIVEN)),
    ("cem", SamplerKind::CrossEntropy),
    ("mppi", SamplerKind::PathIntegral),
    ("cma-es", SamplerKind::CmaEs),
];

const START_VELOCITY: Point = Point::new(-2.0, 0.5, 0.0);

const OPTIONS: EvaluationOptions =
    EvaluationOptions { projects_controls: true, stop_after_step: Some(6), costs_infeasible: false };

fn problem<'a>(arena: &'a Arena, cost: Cost<'a>, options: EvaluationOptions) -> HorizonProblem<'a> {
    let is_planar = arena.node_altitudes_m.len() == 1;
    HorizonProblem {
        start: PointMassState { position: arena.start, velocity: START_VELOCITY },
        applied_acceleration: Point::zeros(),
        goal: arena.goal,
        space: &arena.space,
        limits: LIMITS,
        grid: ControlGrid { steps: 12, axes: if is_planar { 2 } else { 3 } },
        step_s: 0.25,
        clearance_m: 0.4,
        cost,
        smoothness_weight: 1e-3,
        violation_weights: VIOLATION_WEIGHTS,
        stage_weight: 0.1,
        costs_final_speed: false,
        options,
    }
}

fn search(arena: &Arena, sampler: SamplerKind, particles: usize, simd_level: SimdLevel) -> Solution {
    let mut map = CostMap::new(RoadmapKind::Visibility, arena.goal, 0.4, arena.node_altitudes_m.clone());
    map.update(&arena.space);
    let problem = problem(arena, Cost::CostMap { map: &map, repulsion: None }, OPTIONS);
    let budget = Budget { particles, max_iterations: 30, stall_iterations: None };
    optimise(&problem, sampler, budget, &[], CounterRng::new(11), simd_level)
}

#[test]
fn results_do_not_depend_on_vector_instructions_and_threads() {
    let pool = |threads| rayon::ThreadPoolBuilder::new().num_threads(threads).build().unwrap();
    let (one, three) = (pool(1), pool(3));
    for arena in [trap(), random(2, true)] {
        for (name, sampler) in SAMPLERS {
            // enough particles for several threads
            let portable = one.install(|| search(&arena, sampler, 600, SimdLevel::Portable));
            let detected = three.install(|| search(&arena, sampler, 600, SimdLevel::detect()));
            assert!(portable == detected, "{name}");
            assert!(portable.fitness.is_feasible(), "{name}");
        }
    }
}

#[test]
fn samplers_come_close_to_a_long_search() {
    let arena = trap();
    let long = search(&arena, swarm(true), 2000, SimdLevel::detect()).fitness.cost;
    for (name, sampler) in SAMPLERS {
        let found = search(&arena, sampler, 80, SimdLevel::detect());
        assert!(found.fitness.cost < 1.05 * long, "{name}: {} for {long}", found.fitness.cost);
        assert_eq!(found.iterations, 30);
    }
}

#[test]
fn projected_controls_keep_the_norm_bounds() {
    for arena in [trap(), random(4, true)] {
        let axes = if arena.node_altitudes_m.len() == 1 { 2 } else { 3 };
        let found = search(&arena, swarm(false), 40, SimdLevel::detect());
        let mut velocity = START_VELOCITY;
        for control in found.controls.chunks_exact(axes) {
            let mut acceleration = Point::zeros();
            acceleration.as_mut_slice()[..axes].copy_from_slice(control);
            assert!(acceleration.norm() <= LIMITS.acceleration_mps2 + 1e-9);
            velocity += 0.25 * acceleration;
            assert!(velocity.norm() <= LIMITS.speed_mps + 1e-9);
        }
    }
}

#[test]
fn particles_beyond_the_norm_bounds_are_infeasible() {
    let arena = trap();
    let field = Repulsion { gain: 0.1, reach_m: 1.0, is_squared: true, is_by_all: false };
    let cost = Cost::PotentialField { attraction: ATTRACTION, repulsion: field };
    let options = EvaluationOptions { projects_controls: false, stop_after_step: None, costs_infeasible: false };
    let problem = problem(&arena, cost, options);
    let budget = Budget { particles: 4, max_iterations: 1, stall_iterations: None };
    let too_fast = vec![2.0; 24];
    // all particles are the same
    let found = optimise(&problem, swarm(false), budget, &vec![too_fast; 4], CounterRng::new(1), SimdLevel::detect());
    assert!(found.fitness.violation > 1.0 && found.fitness.cost == f64::INFINITY);
    assert_eq!((found.first_feasible, found.feasible_fraction), (None, 0.0));
}

#[test]
fn feasible_beats_infeasible_and_nan_is_worst() {
    let [cheap, expensive] = [1.0, 2.0].map(|cost| Fitness { violation: 0.0, cost });
    let [bad, worse] = [0.1, 0.2].map(|violation| Fitness { violation, cost: 0.0 });
    let broken = Fitness { violation: f64::NAN, cost: 0.0 };
    for (better, than) in [(cheap, expensive), (expensive, bad), (bad, worse), (worse, Fitness::WORST), (worse, broken)]
    {
        assert!(better.beats(than) && !than.beats(better), "{better:?} {than:?}");
    }
    assert!(!broken.is_feasible());
}

#[test]
fn a_stalled_search_ends() {
    let arena = trap();
    let field = Repulsion { gain: 0.1, reach_m: 1.0, is_squared: false, is_by_all: false };
    let problem = problem(&arena, Cost::PotentialField { attraction: ATTRACTION, repulsion: field }, OPTIONS);
    let budget = Budget { particles: 40, max_iterations: 2000, stall_iterations: Some(10) };
    let found = optimise(&problem, swarm(true), budget, &[], CounterRng::new(3), SimdLevel::detect());
    assert!(found.iterations < 1000 && found.fitness.is_feasible());
}

/// The cost of one given particle.
fn cost_of(arena: &Arena, cost: Cost<'_>, controls: &[f64]) -> f64 {
    let problem = problem(arena, cost, OPTIONS);
    let budget = Budget { particles: 4, max_iterations: 1, stall_iterations: None };
    let seeds = vec![controls.to_vec(); 4];
    let found = optimise(&problem, swarm(false), budget, &seeds, CounterRng::new(1), SimdLevel::detect());
    assert!(found.fitness.is_feasible());
    found.fitness.cost
}

/// All obstacles within range repel at least as much as the nearest of them; with a short range nothing else is within it.
#[test]
fn repulsion_by_all_obstacles_is_at_least_that_of_the_nearest() {
    let arena = trap();
    let still = vec![0.0; 24];
    let cost = |reach_m: f64, is_by_all: bool| {
        let repulsion = Repulsion { gain: 5.0, reach_m, is_squared: true, is_by_all };
        cost_of(&arena, Cost::PotentialField { attraction: ATTRACTION, repulsion }, &still)
    };
    assert!(cost(30.0, true) > cost(30.0, false) + 1e-3);
    assert_eq!(cost(1e-3, true).to_bits(), cost(1e-3, false).to_bits());
}

/// Along the horizon of a vehicle that flies towards the goal, the attraction is larger than at its end.
#[test]
fn attraction_along_the_horizon_is_the_mean_over_the_steps() {
    let arena = trap();
    let repulsion = Repulsion { gain: 0.0, reach_m: 1.0, is_squared: true, is_by_all: false };
    let towards: Vec<f64> = (arena.goal - arena.start).normalize().as_slice()[..2].repeat(12);
    let cost = |is_along_horizon: bool| {
        let attraction = Attraction { is_along_horizon, ..ATTRACTION };
        cost_of(&arena, Cost::PotentialField { attraction, repulsion }, &towards)
    };
    assert!(cost(true) > cost(false));
}

/// The history ends with the cost of the result and never increases; without the best particle put back the swarm
/// searches differently.
#[test]
fn convergence_is_monotonic_with_and_without_the_best_particle_put_back() {
    let arena = trap();
    let field = Repulsion { gain: 0.1, reach_m: 1.0, is_squared: true, is_by_all: false };
    let problem = problem(&arena, Cost::PotentialField { attraction: ATTRACTION, repulsion: field }, OPTIONS);
    let budget = Budget { particles: 40, max_iterations: 30, stall_iterations: None };
    let costs = [true, false].map(|keeps_best| {
        let sampler = SamplerKind::ParticleSwarm(SwarmSettings { keeps_best, ..SwarmSettings::STANDARD });
        let found = optimise(&problem, sampler, budget, &[], CounterRng::new(3), SimdLevel::detect());
        assert_eq!(found.convergence.len(), 30);
        let history: Vec<f64> = found.convergence.iter().map(|cost| cost.unwrap_or(f64::INFINITY)).collect();
        assert!(history.windows(2).all(|pair| pair[1] <= pair[0]));
        assert_eq!(history[29], found.fitness.cost);
        found.fitness.cost
    });
    assert_ne!(costs[0], costs[1]);
}
