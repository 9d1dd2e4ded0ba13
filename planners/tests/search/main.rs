//! Searches over the whole map: their paths are short and clear, and the timed motions are within the limits.

#[expect(dead_code, reason = "the controllers of the arenas are not used here")]
#[path = "../horizon/arena.rs"]
mod arena;

use arena::{Arena, LIMITS, random, trap};
use planners::free_space::{Point, interpolate, path_length_m};
use planners::search::rrt::{self, RrtSettings};
use planners::search::sparse_astar::{self, SparseAstarSettings};
use planners::search::{PathProblem, timing};

const CLEARANCE_M: f64 = 0.4;

const ASTAR: SparseAstarSettings = SparseAstarSettings {
    spacing_m: 1.0,
    leg_cells: [1.0, 2.5],
    cos_max_turn: 0.5,
    max_length_m: 120.0,
    max_expansions: 2_000_000,
    uses_heuristic: true,
};

const RRT: RrtSettings = RrtSettings { step_m: 2.0, goal_bias: 0.05, max_samples: 3000, rewire_radius_m: None };

fn problem(arena: Arena, axes: usize) -> PathProblem {
    let Arena { space, start, goal, .. } = arena;
    PathProblem { space, start, goal, clearance_m: CLEARANCE_M, axes }
}

fn is_clear(problem: &PathProblem, path: &[Point]) -> bool {
    path.windows(2).all(|ends| {
        let points = (0..=200).map(|i| interpolate(ends[0], ends[1], f64::from(i) / 200.0));
        points.map(|point| problem.space.distance_m(point)).fold(f64::INFINITY, f64::min) >= CLEARANCE_M - 1e-9
    })
}

#[test]
fn sparse_astar_is_as_short_as_dijkstra_with_fewer_expansions() {
    for arena in [trap(), random(1, false), random(3, false)] {
        let problem = problem(arena, 2);
        let astar = sparse_astar::search(&problem, &ASTAR).unwrap();
        let settings = SparseAstarSettings { uses_heuristic: false, ..ASTAR };
        let dijkstra = sparse_astar::search(&problem, &settings).unwrap();
        assert!((path_length_m(&astar.path) - path_length_m(&dijkstra.path)).abs() < 1e-9);
        assert!(astar.expanded < dijkstra.expanded);
        assert!(is_clear(&problem, &astar.path));
    }
}

#[test]
fn sparse_astar_keeps_its_limits() {
    let problem = problem(trap(), 2);
    let found = sparse_astar::search(&problem, &ASTAR).unwrap();
    for corner in found.path.windows(3) {
        let (u, w) = (corner[1] - corner[0], corner[2] - corner[1]);
        assert!(u.dot(&w) >= (0.5 - 1e-9) * u.norm() * w.norm());
    }
    let legs = found.path.windows(2).map(|ends| (ends[0] - ends[1]).norm());
    assert!(legs.take(found.path.len() - 2).all(|leg_m| (1.0 - 1e-9..=2.5 + 1e-9).contains(&leg_m)));
    let short = SparseAstarSettings { max_length_m: path_length_m(&found.path) - 0.1, ..ASTAR };
    assert_eq!(sparse_astar::search(&problem, &short), None);
}

#[test]
fn sparse_astar_in_space_is_clear() {
    let problem = problem(random(2, true), 3);
    let settings = SparseAstarSettings { leg_cells: [1.0, 1.8], ..ASTAR };
    let found = sparse_astar::search(&problem, &settings).unwrap();
    assert!(is_clear(&problem, &found.path));
}

#[test]
fn trees_are_clear_between_their_nodes_and_reproducible() {
    for (arena, axes) in [(trap(), 2), (random(2, true), 3)] {
        let problem = problem(arena, axes);
        let search = |seed: u64, rewire_radius_m: Option<f64>| {
            let settings = RrtSettings { rewire_radius_m, ..RRT };
            rrt::search(&problem, &settings, &mut scenarios::stream(seed, "tree")).unwrap()
        };
        for seed in 0..10 {
            let [rrt, rrt_star] = [None, Some(4.0)].map(|radius_m| search(seed, radius_m));
            assert!(is_clear(&problem, &rrt) && is_clear(&problem, &rrt_star));
            assert!(path_length_m(&rrt_star) < path_length_m(&rrt), "seed {seed}");
            assert_eq!(search(seed, None), rrt);
        }
    }
}

#[test]
fn timed_paths_keep_speed_acceleration_and_corners() {
    let problem = PathProblem { clearance_m: CLEARANCE_M + 0.1, ..problem(trap(), 2) };
    for seed in 0..10 {
        let path = rrt::search(&problem, &RRT, &mut scenarios::stream(seed, "tree")).unwrap();
        let motion = timing::timed_motion(&path, LIMITS, 0.1);
        assert!(motion.is_clear(0.0, &problem.space, CLEARANCE_M - 0.05), "seed {seed}");
        let (end_s, end) = *motion.last();
        assert_eq!((end.position, end.velocity), (problem.goal, Point::zeros()));
        let step_s = 1e-3;
        for i in 0..(end_s / step_s) as usize {
            let [now, next] = [i, i + 1].map(|i| motion.state_at(i as f64 * step_s));
            assert!(now.velocity.norm() <= LIMITS.speed_mps + 1e-9);
            let change_mps2 = (now.velocity - next.velocity).norm() / step_s;
            assert!(change_mps2 <= LIMITS.acceleration_mps2 + 1e-6, "{change_mps2}");
            let moved_m = (now.position - next.position).norm();
            assert!(moved_m <= LIMITS.speed_mps * step_s + 1e-9, "{moved_m}");
        }
        assert!(end_s >= path_length_m(&path) / LIMITS.speed_mps - 0.5 * path.len() as f64);
    }
}

#[test]
fn a_straight_path_has_a_trapezoidal_speed_profile() {
    let motion = timing::timed_motion(&[0.0, 4.0, 9.0].map(|x| Point::new(x, 0.0, 0.0)), LIMITS, 0.1);
    // 1 s of acceleration and of braking over 1.5 m each, 6 m at 3 m/s
    assert!((motion.last().0 - 4.0).abs() < 1e-9);
}

/// Flown as planned: the largest speed on every leg, the length of the path over that speed in time, and accelerations that
/// no vehicle has.
#[test]
fn a_path_flown_as_planned_ignores_the_acceleration_limit() {
    let problem = problem(trap(), 2);
    let path = sparse_astar::search(&problem, &ASTAR).unwrap().path;
    let motion = timing::motion_at_constant_speed(&path, LIMITS);
    let (end_s, end) = *motion.last();
    assert!((end_s - path_length_m(&path) / LIMITS.speed_mps).abs() < 0.1);
    assert!((end.position - problem.goal).norm() < 1e-9 && end.velocity.norm() == 0.0);
    let accelerations = motion.knots().windows(2).map(|ends| {
        let [(from_s, from), (to_s, to)] = [ends[0], ends[1]];
        (to.velocity - from.velocity).norm() / (to_s - from_s)
    });
    assert!(accelerations.fold(0.0, f64::max) > 50.0 * LIMITS.acceleration_mps2);
    let speeds = motion.knots().iter().map(|(_, state)| state.velocity.norm());
    assert!(speeds.fold(0.0, f64::max) <= LIMITS.speed_mps + 1e-9);
    let continuous = |ends: &[(f64, planners::multirotor::PointMassState)]| {
        let mean = 0.5 * (ends[0].1.velocity + ends[1].1.velocity);
        (ends[0].1.position + mean * (ends[1].0 - ends[0].0) - ends[1].1.position).norm() < 1e-6
    };
    assert!(motion.knots().windows(2).all(continuous));
}
