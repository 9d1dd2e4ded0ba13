use planners::free_space::FreeSpace;
use planners::free_space::vector::{Point, distance};
use planners::horizon::cost_map::{CostMap, Ways};
use rand::RngExt;

use crate::arena::{Arena, random, trap};

const CLEARANCE_M: f64 = 0.4;

fn map(arena: &Arena, ways: Ways) -> CostMap {
    let mut map = CostMap::new(ways, arena.goal, CLEARANCE_M, arena.levels_m.clone());
    map.update(&arena.space);
    map
}

fn arenas() -> Vec<Arena> {
    let random = (0..6).flat_map(|seed| [random(seed, false), random(seed, true)]);
    random.chain([trap()]).collect()
}

/// Shortest ways from all nodes to the first, by relaxing every edge until nothing changes.
fn relaxed(nodes: &[Point], edges: &[[Point; 2]]) -> Vec<f64> {
    let mut left_m = vec![f64::INFINITY; nodes.len()];
    left_m[0] = 0.0;
    let index = |point: &Point| nodes.iter().position(|node| node == point).expect("an edge ends in nodes");
    let edges: Vec<(usize, usize)> = edges.iter().map(|[a, b]| (index(a), index(b))).collect();
    for _ in 0..nodes.len() {
        for &(i, j) in &edges {
            let length_m = distance(nodes[i], nodes[j]);
            left_m[i] = left_m[i].min(left_m[j] + length_m);
            left_m[j] = left_m[j].min(left_m[i] + length_m);
        }
    }
    left_m
}

#[test]
fn costs_are_those_of_relaxing_every_edge() {
    for arena in [random(1, false), trap()] {
        for ways in [Ways::Visibility, Ways::Voronoi] {
            let map = map(&arena, ways);
            let roadmap = map.roadmap();
            let expected = relaxed(roadmap.nodes(), &roadmap.edges().collect::<Vec<_>>());
            for (found, expected) in roadmap.cost_to_go_m().iter().zip(expected) {
                assert!((found - expected).abs() < 1e-9 || found == &expected, "{found} {expected}");
            }
        }
    }
}

#[test]
fn every_edge_keeps_the_clearance() {
    for arena in arenas() {
        for ways in [Ways::Visibility, Ways::Voronoi] {
            let map = map(&arena, ways);
            assert!(map.roadmap().nodes().len() > 4);
            for [from, to] in map.roadmap().edges() {
                for i in 0..=20 {
                    let point = planners::free_space::vector::interpolate(from, to, f64::from(i) / 20.0);
                    assert!(arena.space.distance_m(point) >= CLEARANCE_M - 1e-9);
                }
            }
        }
    }
}

#[test]
fn a_map_that_grows_is_the_map_of_all() {
    for arena in arenas() {
        let whole = map(&arena, Ways::Visibility);
        let mut growing = CostMap::new(Ways::Visibility, arena.goal, CLEARANCE_M, arena.levels_m.clone());
        for count in [0, 1, 5, 6, arena.space.standing.len()] {
            let known = FreeSpace { standing: arena.space.standing[..count].to_vec(), ..arena.space.clone() };
            growing.update(&known);
        }
        assert_eq!(growing.roadmap().nodes(), whole.roadmap().nodes());
        assert_eq!(growing.roadmap().cost_to_go_m(), whole.roadmap().cost_to_go_m());
    }
}

#[test]
fn costs_of_points_are_those_of_trying_every_node() {
    for arena in arenas() {
        for ways in [Ways::Visibility, Ways::Voronoi] {
            let map = map(&arena, ways);
            let (roadmap, space) = (map.roadmap(), &arena.space);
            let outlook = map.outlook(space, arena.start);
            let mut hints = Vec::new();
            let mut stream = scenarios::stream(5, "points");
            for _ in 0..100 {
                let mut draw = |range: [f64; 2]| stream.random_range(range[0]..range[1]);
                let [x, y, _] = space.frame_m;
                let point = [draw(x), draw(y), draw([1.0, 5.0])];
                if space.distance_m(point) < CLEARANCE_M {
                    continue;
                }
                let all = roadmap.nodes().iter().zip(roadmap.cost_to_go_m());
                let seen = all.filter(|(node, _)| space.is_clear(point, **node, CLEARANCE_M - 1e-9));
                let seen: Vec<_> = seen.map(|(node, left_m)| (distance(point, *node), *left_m)).collect();
                let best_within = |reach_m: f64| {
                    let near = seen.iter().filter(|(away_m, left_m)| *away_m <= reach_m && left_m.is_finite());
                    near.map(|(away_m, left_m)| away_m + left_m).reduce(f64::min)
                };
                let reach_m = if ways == Ways::Voronoi { 4.0 } else { f64::INFINITY };
                let expected = best_within(reach_m).or_else(|| best_within(f64::INFINITY));
                let found = map.cost_to_go(point, space).map(|left| left.length_m);
                assert_eq!(found, expected);
                assert_eq!(outlook.cost_to_go(point, &mut hints).map(|left| left.length_m), expected);
            }
        }
    }
}

/// Around one box the shortest way touches its corner.
#[test]
fn visibility_is_short_and_voronoi_is_clear() {
    let arena = trap();
    let [short, clear] = [Ways::Visibility, Ways::Voronoi].map(|ways| {
        let map = map(&arena, ways);
        let route = map.route(arena.start, &arena.space);
        let length_m: f64 = route.windows(2).map(|ends| distance(ends[0], ends[1])).sum();
        let inner = &route[1..route.len() - 1];
        let room_m = inner.iter().map(|point| arena.space.distance_m(*point)).sum::<f64>() / inner.len() as f64;
        (length_m, room_m)
    });
    assert!(short.0 < clear.0 && short.1 < clear.1, "{short:?} {clear:?}");
    assert!(
        (short.0 - map(&arena, Ways::Visibility).cost_to_go(arena.start, &arena.space).unwrap().length_m).abs() < 1e-9
    );
}
