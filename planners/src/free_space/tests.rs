use pulp::Scalar256b;
use rand::RngExt;

use super::vector::{Point, distance, interpolate};
use super::{FreeSpace, Mover, Obstacle, Track, is_beside, sweep};
use crate::lanes::Lanes;

const UNBOUNDED: [f64; 2] = [f64::NEG_INFINITY, f64::INFINITY];

fn shapes() -> Vec<Obstacle> {
    let triangle = [[0.0, 0.0], [3.0, 0.5], [1.0, 2.0]];
    let hexagon: Vec<[f64; 2]> =
        (0..6).map(|i| f64::from(i) * std::f64::consts::TAU / 6.0).map(|angle| [angle.cos(), angle.sin()]).collect();
    vec![
        Obstacle::prism(&triangle, UNBOUNDED),
        Obstacle::prism(&triangle, [0.5, 2.0]),
        Obstacle::prism(&hexagon, [-1.0, 1.0]),
        Obstacle::cylinder([1.0, 1.0], 0.7, UNBOUNDED),
        Obstacle::cylinder([1.0, 1.0], 0.7, [0.0, 1.0]),
    ]
}

fn segments(count: usize, is_level: bool) -> Vec<[Point; 2]> {
    let mut stream = scenarios::stream(3, "segments");
    let mut draw = || stream.random_range(-3.0..5.0);
    let mut segments: Vec<[Point; 2]> =
        (0..count).map(|_| [[draw(), draw(), draw()], [draw(), draw(), draw()]]).collect();
    if is_level {
        segments.iter_mut().for_each(|[p, q]| q[2] = p[2]);
    }
    segments
}

/// Distance of the nearest of many points on a segment.
fn sampled(obstacle: &Obstacle, [p, q]: [Point; 2]) -> f64 {
    let points = (0..=4000).map(|i| interpolate(p, q, f64::from(i) / 4000.0));
    points.map(|point| obstacle.distance_m(point)).fold(f64::INFINITY, f64::min)
}

#[test]
fn distance_to_a_prism_is_that_to_its_nearest_point() {
    let obstacle = Obstacle::prism(&[[0.0, 0.0], [2.0, 0.0], [2.0, 1.0], [0.0, 1.0]], [0.0, 1.0]);
    for (point, expected) in [
        ([3.0, 0.5, 0.5], 1.0),
        ([1.0, 0.5, 3.0], 2.0),
        ([5.0, 0.5, 5.0], 5.0),
        ([-1.0, -2.0, -2.0], 3.0),
        ([1.0, 0.4, 0.5], -0.4),
        ([1.0, 0.5, 0.9], -0.1),
    ] {
        assert!((obstacle.distance_m(point) - expected).abs() < 1e-12, "{point:?}");
    }
}

#[test]
fn level_segments_have_the_distance_that_sampling_finds() {
    for obstacle in shapes() {
        for segment in segments(200, true) {
            let (exact, sampled) = (obstacle.least_distance_m(segment[0], segment[1]), sampled(&obstacle, segment));
            assert!(exact <= sampled + 1e-9, "{exact} {sampled}");
            // inside, depths by separating axes of a whole segment are no less than those of its points
            assert!(sampled <= 0.0 || exact >= sampled - 2e-3, "{exact} {sampled}");
            assert_eq!(exact > 0.0, sampled > 0.0, "{exact} {sampled}");
        }
    }
}

#[test]
fn sloping_segments_are_bounded_from_below_and_decided_by_division() {
    for obstacle in shapes() {
        for segment in segments(200, false) {
            let (bound, sampled) = (obstacle.least_distance_m(segment[0], segment[1]), sampled(&obstacle, segment));
            assert!(bound <= sampled + 1e-9);
            assert!(!is_beside(&obstacle, segment[0], segment[1], sampled + 1e-6));
            if sampled > 0.02 {
                assert!(is_beside(&obstacle, segment[0], segment[1], sampled - 0.01), "{sampled}");
            }
        }
    }
}

#[test]
fn four_segments_at_once_have_the_distances_that_each_has() {
    let simd = Scalar256b;
    for obstacle in shapes() {
        for four in segments(400, false).chunks_exact(4) {
            let point =
                |end: usize| [0, 1, 2].map(|axis| Lanes::new(simd, [0, 1, 2, 3].map(|lane| four[lane][end][axis])));
            let found = sweep::least_distance_m(&obstacle, &point(0), &point(1), 1e3).to_array();
            for (segment, found) in four.iter().zip(found) {
                let expected = obstacle.least_distance_m(segment[0], segment[1]);
                assert!((found - expected).abs() < 1e-9, "{found} {expected}");
            }
            let near = sweep::least_distance_m(&obstacle, &point(0), &point(1), 0.5).to_array();
            for (segment, near) in four.iter().zip(near) {
                let expected = obstacle.least_distance_m(segment[0], segment[1]);
                assert!(near <= expected + 1e-9 && (near >= 0.5 || (near - expected).abs() < 1e-9));
            }
        }
    }
}

#[test]
fn circles_reject_nothing_that_is_near() {
    for obstacle in shapes() {
        for [p, q] in segments(500, false) {
            assert!(obstacle.may_be_within(p, q, 0.5) || obstacle.least_distance_m(p, q) >= 0.5);
        }
    }
}

#[test]
fn the_frame_is_a_border() {
    let space = FreeSpace::empty([[0.0, 4.0], [0.0, 2.0], UNBOUNDED]);
    assert_eq!(space.distance_m([1.0, 1.5, 9.0]), 0.5);
    assert!(space.is_clear([0.5, 0.5, 0.0], [3.5, 1.5, 0.0], 0.5));
    assert!(!space.is_clear([0.5, 0.5, 0.0], [3.5, 1.6, 0.0], 0.5));
    assert!(!space.is_clear([0.5, 0.5, f64::NAN], [f64::NAN, 1.0, 0.0], 0.5));
}

#[test]
fn moving_obstacles_are_met_where_they_are_then() {
    let mut space = FreeSpace::empty([UNBOUNDED; 3]);
    let wall = Obstacle::cylinder([0.0, 0.0], 0.5, UNBOUNDED);
    space.moving.push(Mover::straight(wall.clone(), [1.0, 0.0, 0.0]));
    let (here, there) = ([0.0, 3.0, 0.0], [0.0, -3.0, 0.0]);
    assert!(!space.is_clear_of_moving((here, -1.0), (there, 1.0), 0.1));
    assert!(space.is_clear_of_moving((here, 1.0), (there, 3.0), 0.1));
    let track = Track::Known(vec![(0.0, [0.0; 3]), (2.0, [4.0, 0.0, 0.0])]);
    let mover = Mover { shape: wall, track };
    assert_eq!([-1.0, 0.5, 3.0].map(|time_s| mover.offset_m(time_s)[0]), [0.0, 1.0, 4.0]);
    assert!(distance(mover.offset_m(2.0), [4.0, 0.0, 0.0]) < 1e-15);
}
