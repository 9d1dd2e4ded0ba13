use planners::free_space::vector::norm;
use planners::horizon::cost_map::{CostMap, Ways};
use planners::horizon::draw::Draws;
use planners::horizon::evaluate::Machine;
use planners::horizon::group::Fitness;
use planners::horizon::motion::State;
use planners::horizon::optimise::{Budget, Found, optimise};
use planners::horizon::question::{Cost, Grid, Question, Repulsion, Rules};
use planners::horizon::sampler::Method;

use crate::arena::{Arena, LIMITS, random, swarm, trap};

const METHODS: [(&str, Method); 5] = [
    ("pso", Method::Swarm(planners::horizon::sampler::Swarm::USUAL)),
    ("fpso", Method::Swarm(planners::horizon::sampler::Swarm::FEASIBILITY)),
    ("cem", Method::CrossEntropy),
    ("mppi", Method::PathIntegral),
    ("cma-es", Method::CmaEs),
];

fn rules() -> Rules {
    Rules { is_projected: true, stops_after: Some(6), costs_infeasible: false }
}

fn question<'a>(arena: &'a Arena, cost: Cost<'a>, rules: Rules) -> Question<'a> {
    let is_planar = arena.levels_m.len() == 1;
    Question {
        start: State { position: arena.start, velocity: [-2.0, 0.5, 0.0] },
        applied: [0.0; 3],
        goal: arena.goal,
        space: &arena.space,
        limits: LIMITS,
        grid: Grid { steps: 12, axes: if is_planar { 2 } else { 3 } },
        step_s: 0.25,
        clearance_m: 0.4,
        cost,
        smoothness: 1e-3,
        stage_weight: 0.1,
        charges_speed: false,
        rules,
    }
}

fn search(arena: &Arena, method: Method, particles: usize, machine: Machine) -> Found {
    let mut map = CostMap::new(Ways::Visibility, arena.goal, 0.4, arena.levels_m.clone());
    map.update(&arena.space);
    let question = question(arena, Cost::Map { map: &map, repulsion: None }, rules());
    let budget = Budget { particles, iterations: 30, stall: None };
    optimise(&question, method, budget, &[], Draws::new(11), machine)
}

#[test]
fn vector_instructions_and_threads_change_no_digit() {
    let pool = |threads| rayon::ThreadPoolBuilder::new().num_threads(threads).build().unwrap();
    let (one, three) = (pool(1), pool(3));
    for arena in [trap(), random(2, true)] {
        for (name, method) in METHODS {
            // many particles, so that threads share the work
            let portable = one.install(|| search(&arena, method, 600, Machine::Portable));
            let detected = three.install(|| search(&arena, method, 600, Machine::detect()));
            assert!(portable == detected, "{name}");
            assert!(portable.fitness.is_feasible(), "{name}");
        }
    }
}

#[test]
fn samplers_find_what_a_long_search_finds() {
    let arena = trap();
    let long = search(&arena, swarm(true), 2000, Machine::detect()).fitness.cost;
    for (name, method) in METHODS {
        let found = search(&arena, method, 80, Machine::detect());
        assert!(found.fitness.cost < 1.05 * long, "{name}: {} for {long}", found.fitness.cost);
        assert_eq!(found.iterations, 30);
    }
}

#[test]
fn projected_controls_keep_the_norm_bounds() {
    for arena in [trap(), random(4, true)] {
        let axes = if arena.levels_m.len() == 1 { 2 } else { 3 };
        let found = search(&arena, swarm(false), 40, Machine::detect());
        let mut velocity = [-2.0, 0.5, 0.0];
        for control in found.controls.chunks_exact(axes) {
            let mut acceleration = [0.0; 3];
            acceleration[..axes].copy_from_slice(control);
            assert!(norm(acceleration) <= LIMITS.acceleration_mps2 + 1e-9);
            (0..3).for_each(|axis| velocity[axis] += 0.25 * acceleration[axis]);
            assert!(norm(velocity) <= LIMITS.speed_mps + 1e-9);
        }
    }
}

#[test]
fn unprojected_particles_pay_for_what_they_violate() {
    let arena = trap();
    let field = Repulsion { gain: 0.1, reach_m: 1.0, is_squared: true };
    let cost = Cost::Field { attraction: 0.1, repulsion: field };
    let question = question(&arena, cost, Rules { is_projected: false, stops_after: None, costs_infeasible: false });
    let budget = Budget { particles: 4, iterations: 1, stall: None };
    let too_fast = vec![2.0; 24];
    // all particles are the same: nothing else can be found
    let found = optimise(&question, swarm(false), budget, &vec![too_fast; 4], Draws::new(1), Machine::detect());
    assert!(found.fitness.violation > 1.0 && found.fitness.cost == f64::INFINITY);
    assert_eq!((found.first_feasible, found.feasible_share), (None, 0.0));
}

#[test]
fn feasible_beats_infeasible_and_nan_beats_nothing() {
    let [good, dear] = [1.0, 2.0].map(|cost| Fitness { violation: 0.0, cost });
    let [bad, worse] = [0.1, 0.2].map(|violation| Fitness { violation, cost: 0.0 });
    let broken = Fitness { violation: f64::NAN, cost: 0.0 };
    for (better, than) in [(good, dear), (dear, bad), (bad, worse), (worse, Fitness::WORST), (worse, broken)] {
        assert!(better.beats(than) && !than.beats(better), "{better:?} {than:?}");
    }
    assert!(!broken.is_feasible());
}

#[test]
fn a_stalled_search_ends() {
    let arena = trap();
    let cost = Cost::Field { attraction: 0.1, repulsion: Repulsion { gain: 0.1, reach_m: 1.0, is_squared: false } };
    let question = question(&arena, cost, rules());
    let budget = Budget { particles: 40, iterations: 2000, stall: Some(10) };
    let found = optimise(&question, swarm(true), budget, &[], Draws::new(3), Machine::detect());
    assert!(found.iterations < 1000 && found.fitness.is_feasible());
}
