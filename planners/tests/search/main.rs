//! Searches over the whole map: what they find is short, clear and can be flown.

#[expect(dead_code, reason = "of the arenas' planners none is needed here")]
#[path = "../horizon/arena.rs"]
mod arena;

use arena::{LIMITS, random, trap};
use planners::free_space::FreeSpace;
use planners::free_space::vector::{Point, distance, dot, interpolate, minus, norm};
use planners::search::sparse_astar::{self, search};
use planners::search::tree::{self, grow};
use planners::search::{length_m, timing};

const CLEARANCE_M: f64 = 0.4;

fn grid(axes: usize) -> sparse_astar::Rules {
    sparse_astar::Rules {
        spacing_m: 1.0,
        leg: [1.0, 2.5],
        turn_cosine: 0.5,
        longest_m: 120.0,
        axes,
        budget: 2_000_000,
        is_guided: true,
    }
}

fn rules_of_a_tree(rewire_m: Option<f64>, axes: usize) -> tree::Rules {
    tree::Rules { step_m: 2.0, goal_share: 0.05, samples: 3000, rewire_m, axes }
}

fn is_clear(space: &FreeSpace, path: &[Point]) -> bool {
    path.windows(2).all(|ends| {
        let points = (0..=200).map(|i| interpolate(ends[0], ends[1], f64::from(i) / 200.0));
        points.map(|point| space.distance_m(point)).fold(f64::INFINITY, f64::min) >= CLEARANCE_M - 1e-9
    })
}

#[test]
fn sparse_astar_finds_what_dijkstra_finds_with_less() {
    for arena in [trap(), random(1, false), random(3, false)] {
        let guided = search(&arena.space, arena.start, arena.goal, CLEARANCE_M, &grid(2)).unwrap();
        let rules = sparse_astar::Rules { is_guided: false, ..grid(2) };
        let plain = search(&arena.space, arena.start, arena.goal, CLEARANCE_M, &rules).unwrap();
        assert!((length_m(&guided.path) - length_m(&plain.path)).abs() < 1e-9);
        assert!(guided.expanded < plain.expanded);
        assert!(is_clear(&arena.space, &guided.path));
    }
}

#[test]
fn sparse_astar_keeps_its_limits() {
    let arena = trap();
    let found = search(&arena.space, arena.start, arena.goal, CLEARANCE_M, &grid(2)).unwrap();
    for corner in found.path.windows(3) {
        let (u, w) = (minus(corner[1], corner[0]), minus(corner[2], corner[1]));
        assert!(dot(u, w) >= (0.5 - 1e-9) * norm(u) * norm(w));
    }
    let legs = found.path.windows(2).map(|ends| distance(ends[0], ends[1]));
    assert!(legs.take(found.path.len() - 2).all(|leg_m| (1.0 - 1e-9..=2.5 + 1e-9).contains(&leg_m)));
    let short = sparse_astar::Rules { longest_m: length_m(&found.path) - 0.1, ..grid(2) };
    assert_eq!(search(&arena.space, arena.start, arena.goal, CLEARANCE_M, &short), None);
}

#[test]
fn sparse_astar_in_space_is_clear() {
    let arena = random(2, true);
    let rules = sparse_astar::Rules { leg: [1.0, 1.8], ..grid(3) };
    let found = search(&arena.space, arena.start, arena.goal, CLEARANCE_M, &rules).unwrap();
    assert!(is_clear(&arena.space, &found.path));
}

#[test]
fn trees_are_clear_between_their_nodes_and_reproducible() {
    for (arena, axes) in [(trap(), 2), (random(2, true), 3)] {
        for seed in 0..10 {
            let found = [None, Some(4.0)].map(|rewire_m| {
                let rules = rules_of_a_tree(rewire_m, axes);
                let mut stream = scenarios::stream(seed, "tree");
                grow(&arena.space, arena.start, arena.goal, CLEARANCE_M, &rules, &mut stream).unwrap()
            });
            assert!(found.iter().all(|path| is_clear(&arena.space, path)));
            assert!(length_m(&found[1]) < length_m(&found[0]), "seed {seed}");
            let mut stream = scenarios::stream(seed, "tree");
            let rules = rules_of_a_tree(None, axes);
            let again = grow(&arena.space, arena.start, arena.goal, CLEARANCE_M, &rules, &mut stream);
            assert_eq!(again.as_ref(), Some(&found[0]));
        }
    }
}

#[test]
fn timed_paths_keep_speed_acceleration_and_corners() {
    let arena = trap();
    for seed in 0..10 {
        let mut stream = scenarios::stream(seed, "tree");
        let rules = rules_of_a_tree(None, 2);
        let path = grow(&arena.space, arena.start, arena.goal, CLEARANCE_M + 0.1, &rules, &mut stream).unwrap();
        let motion = timing::motion(&path, LIMITS, 0.1);
        assert!(motion.is_clear(0.0, &arena.space, CLEARANCE_M - 0.05), "seed {seed}");
        let (end_s, end) = *motion.last();
        assert_eq!((end.position, end.velocity), (arena.goal, [0.0; 3]));
        let step_s = 1e-3;
        for i in 0..(end_s / step_s) as usize {
            let [now, next] = [i, i + 1].map(|i| motion.state_at(i as f64 * step_s));
            assert!(norm(now.velocity) <= LIMITS.speed_mps + 1e-9);
            let change_mps2 = distance(now.velocity, next.velocity) / step_s;
            assert!(change_mps2 <= LIMITS.acceleration_mps2 + 1e-6, "{change_mps2}");
            let moved_m = distance(now.position, next.position);
            assert!(moved_m <= LIMITS.speed_mps * step_s + 1e-9, "{moved_m}");
        }
        assert!(end_s >= length_m(&path) / LIMITS.speed_mps - 0.5 * path.len() as f64);
    }
}

#[test]
fn a_straight_path_is_accelerate_cruise_brake() {
    let motion = timing::motion(&[[0.0; 3], [4.0, 0.0, 0.0], [9.0, 0.0, 0.0]], LIMITS, 0.1);
    // 1 s up, 1 s down over 1.5 m each, 6 m at 3 m/s
    assert!((motion.last().0 - 4.0).abs() < 1e-9);
}
