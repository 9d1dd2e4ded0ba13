use planners::free_space::{FreeSpace, Obstacle, Point, interpolate, path_length_m};
use planners::roadmap::{CostMap, RoadmapKind};
use rand::RngExt;

use crate::arena::{Arena, random, trap};

const CLEARANCE_M: f64 = 0.4;

const KINDS: [RoadmapKind; 3] = [RoadmapKind::Visibility, RoadmapKind::Voronoi, RoadmapKind::VoronoiVertices];

fn map(arena: &Arena, kind: RoadmapKind) -> CostMap {
    let mut map = CostMap::new(kind, arena.goal, CLEARANCE_M, arena.node_altitudes_m.clone());
    map.update(&arena.space);
    map
}

fn arenas() -> Vec<Arena> {
    let random = (0..6).flat_map(|seed| [random(seed, false), random(seed, true)]);
    random.chain([trap()]).collect()
}

/// Lengths of the shortest paths from all nodes to the first, by the Bellman-Ford algorithm.
fn bellman_ford(nodes: &[Point], edges: &[[Point; 2]]) -> Vec<f64> {
    let mut cost_to_go_m = vec![f64::INFINITY; nodes.len()];
    cost_to_go_m[0] = 0.0;
    let index = |point: &Point| nodes.iter().position(|node| node == point).expect("an edge ends in nodes");
    let edges: Vec<(usize, usize)> = edges.iter().map(|[a, b]| (index(a), index(b))).collect();
    for _ in 0..nodes.len() {
        for &(i, j) in &edges {
            let length_m = (nodes[i] - nodes[j]).norm();
            cost_to_go_m[i] = cost_to_go_m[i].min(cost_to_go_m[j] + length_m);
            cost_to_go_m[j] = cost_to_go_m[j].min(cost_to_go_m[i] + length_m);
        }
    }
    cost_to_go_m
}

#[test]
fn costs_agree_with_bellman_ford() {
    for arena in [random(1, false), trap()] {
        for kind in KINDS {
            let map = map(&arena, kind);
            let roadmap = map.roadmap();
            let expected = bellman_ford(roadmap.nodes(), &roadmap.edges().collect::<Vec<_>>());
            for (found, expected) in roadmap.cost_to_go_m().iter().zip(expected) {
                assert!((found - expected).abs() < 1e-9 || found == &expected, "{found} {expected}");
            }
        }
    }
}

#[test]
fn every_edge_keeps_the_clearance() {
    for arena in arenas() {
        for kind in KINDS {
            let map = map(&arena, kind);
            assert!(map.roadmap().nodes().len() > 4);
            for [from, to] in map.roadmap().edges() {
                for i in 0..=20 {
                    let point = interpolate(from, to, f64::from(i) / 20.0);
                    assert!(arena.space.distance_m(point) >= CLEARANCE_M - 1e-9);
                }
            }
        }
    }
}

#[test]
fn an_extended_map_equals_the_map_built_at_once() {
    for arena in arenas() {
        let whole = map(&arena, RoadmapKind::Visibility);
        let mut extended =
            CostMap::new(RoadmapKind::Visibility, arena.goal, CLEARANCE_M, arena.node_altitudes_m.clone());
        for count in [0, 1, 5, 6, arena.space.static_obstacles.len()] {
            let known =
                FreeSpace { static_obstacles: arena.space.static_obstacles[..count].to_vec(), ..arena.space.clone() };
            extended.update(&known);
        }
        assert_eq!(extended.roadmap().nodes(), whole.roadmap().nodes());
        assert_eq!(extended.roadmap().cost_to_go_m(), whole.roadmap().cost_to_go_m());
    }
}

#[test]
fn cost_to_go_is_the_best_over_all_nodes() {
    for arena in arenas() {
        for kind in KINDS {
            let map = map(&arena, kind);
            let (roadmap, space) = (map.roadmap(), &arena.space);
            let query = map.query_near(arena.start, space);
            let mut hints = Vec::new();
            let mut stream = scenarios::stream(5, "points");
            for _ in 0..100 {
                let mut draw = |range: [f64; 2]| stream.random_range(range[0]..range[1]);
                let [x, y, _] = space.bounds_m;
                let point = Point::new(draw(x), draw(y), draw([1.0, 5.0]));
                if space.distance_m(point) < CLEARANCE_M {
                    continue;
                }
                let all = roadmap.nodes().iter().zip(roadmap.cost_to_go_m());
                let visible = all.filter(|(node, _)| space.is_clear(point, **node, CLEARANCE_M - 1e-9));
                let visible: Vec<_> =
                    visible.map(|(node, cost_to_go_m)| ((point - node).norm(), *cost_to_go_m)).collect();
                let best_within = |max_link_m: f64| {
                    let near = visible.iter().filter(|(link_m, rest_m)| *link_m <= max_link_m && rest_m.is_finite());
                    near.map(|(link_m, rest_m)| link_m + rest_m).reduce(f64::min)
                };
                let preferred_m = if kind == RoadmapKind::Voronoi { 4.0 } else { f64::INFINITY };
                let expected = best_within(preferred_m).or_else(|| best_within(f64::INFINITY));
                let found = map.cost_to_go(point, space).map(|cost_to_go| cost_to_go.length_m);
                assert_eq!(found, expected);
                assert_eq!(query.cost_to_go(point, &mut hints).map(|cost_to_go| cost_to_go.length_m), expected);
            }
        }
    }
}

/// The visibility graph gives the shorter path, the Voronoi graph the one with more clearance.
#[test]
fn visibility_is_short_and_voronoi_is_clear() {
    let arena = trap();
    let [short, clear] = [RoadmapKind::Visibility, RoadmapKind::Voronoi].map(|kind| {
        let map = map(&arena, kind);
        let path = map.path_from(arena.start, &arena.space);
        let inner = &path[1..path.len() - 1];
        let clearance_m = inner.iter().map(|point| arena.space.distance_m(*point)).sum::<f64>() / inner.len() as f64;
        (path_length_m(&path), clearance_m)
    });
    assert!(short.0 < clear.0 && short.1 < clear.1, "{short:?} {clear:?}");
    assert!(
        (short.0 - map(&arena, RoadmapKind::Visibility).cost_to_go(arena.start, &arena.space).unwrap().length_m).abs()
            < 1e-9
    );
}

/// Theorem 1 of the paper, with the goal as one more node; and the corners of square rooms are known exactly.
#[test]
fn voronoi_vertices_are_linear_in_the_corners_and_equidistant_from_them() {
    for arena in [random(1, false), random(4, false), trap()] {
        let corners: usize = arena.space.static_obstacles.iter().map(|obstacle| obstacle.edges().len()).sum();
        let map = map(&arena, RoadmapKind::VoronoiVertices);
        assert!(map.roadmap().nodes().len() <= 1 + 2 * (corners + 4) - 5);
    }
    let z_m = 1.0;
    let block = |x: f64| {
        Obstacle::prism(&[[x, -1.0], [x + 1.0, -1.0], [x + 1.0, 1.0], [x, 1.0]], [f64::NEG_INFINITY, f64::INFINITY])
    };
    let mut space = FreeSpace::empty([[-10.0, 10.0], [-10.0, 10.0], [0.0, 2.0]]);
    space.static_obstacles = vec![block(-3.0), block(2.0)];
    let mut map = CostMap::new(RoadmapKind::VoronoiVertices, Point::new(0.0, 8.0, z_m), CLEARANCE_M, vec![z_m]);
    map.update(&space);
    // the middle of the gap is as far from the four corners that face it
    let middle = Point::new(0.0, 0.0, z_m);
    assert!(map.roadmap().nodes().iter().any(|node| (node - middle).norm() < 1e-9), "{:?}", map.roadmap().nodes());
}
