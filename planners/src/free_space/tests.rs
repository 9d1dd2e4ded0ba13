use pulp::Scalar256b;
use rand::RngExt;

use super::simd_distance::distance_lower_bound_m;
use super::{Displacement, FreeSpace, MovingObstacle, Obstacle, Point, interpolate, segment_clear};
use crate::simd::Lanes;

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
    let mut coordinate = |_: usize| stream.random_range(-3.0..5.0);
    let mut point = || Point::from(std::array::from_fn::<f64, 3, _>(&mut coordinate));
    let mut segments: Vec<[Point; 2]> = (0..count).map(|_| [point(), point()]).collect();
    if is_level {
        segments.iter_mut().for_each(|[p, q]| q.z = p.z);
    }
    segments
}

/// Smallest distance of many points on a segment.
fn sampled_distance_m(obstacle: &Obstacle, [p, q]: [Point; 2]) -> f64 {
    let points = (0..=4000).map(|i| interpolate(p, q, f64::from(i) / 4000.0));
    points.map(|point| obstacle.distance_m(point)).fold(f64::INFINITY, f64::min)
}

#[test]
fn distance_to_a_prism_is_the_distance_to_its_nearest_point() {
    let obstacle = Obstacle::prism(&[[0.0, 0.0], [2.0, 0.0], [2.0, 1.0], [0.0, 1.0]], [0.0, 1.0]);
    for (point, expected) in [
        ([3.0, 0.5, 0.5], 1.0),
        ([1.0, 0.5, 3.0], 2.0),
        ([5.0, 0.5, 5.0], 5.0),
        ([-1.0, -2.0, -2.0], 3.0),
        ([1.0, 0.4, 0.5], -0.4),
        ([1.0, 0.5, 0.9], -0.1),
    ] {
        assert!((obstacle.distance_m(point.into()) - expected).abs() < 1e-12, "{point:?}");
    }
}

#[test]
fn distances_of_level_segments_agree_with_sampling() {
    for obstacle in shapes() {
        for segment in segments(200, true) {
            let (exact, sampled) =
                (obstacle.distance_lower_bound_m(segment[0], segment[1]), sampled_distance_m(&obstacle, segment));
            assert!(exact <= sampled + 1e-9, "{exact} {sampled}");
            // the penetration depth of a segment is at least that of each of its points
            assert!(sampled <= 0.0 || exact >= sampled - 2e-3, "{exact} {sampled}");
            assert_eq!(exact > 0.0, sampled > 0.0, "{exact} {sampled}");
        }
    }
}

#[test]
fn sloping_segments_are_bounded_from_below_and_decided_by_bisection() {
    for obstacle in shapes() {
        for segment in segments(200, false) {
            let (bound, sampled) =
                (obstacle.distance_lower_bound_m(segment[0], segment[1]), sampled_distance_m(&obstacle, segment));
            assert!(bound <= sampled + 1e-9);
            assert!(!segment_clear(&obstacle, segment[0], segment[1], sampled + 1e-6));
            if sampled > 0.02 {
                assert!(segment_clear(&obstacle, segment[0], segment[1], sampled - 0.01), "{sampled}");
            }
        }
    }
}

#[test]
fn distances_of_four_segments_are_those_of_each() {
    let simd = Scalar256b;
    for obstacle in shapes() {
        for four in segments(400, false).chunks_exact(4) {
            let point =
                |end: usize| [0, 1, 2].map(|axis| Lanes::new(simd, [0, 1, 2, 3].map(|lane| four[lane][end][axis])));
            let found = distance_lower_bound_m(&obstacle, &point(0), &point(1), 1e3).to_array();
            for (segment, found) in four.iter().zip(found) {
                let expected = obstacle.distance_lower_bound_m(segment[0], segment[1]);
                assert!((found - expected).abs() < 1e-9, "{found} {expected}");
            }
            let near = distance_lower_bound_m(&obstacle, &point(0), &point(1), 0.5).to_array();
            for (segment, near) in four.iter().zip(near) {
                let expected = obstacle.distance_lower_bound_m(segment[0], segment[1]);
                assert!(near <= expected + 1e-9 && (near >= 0.5 || (near - expected).abs() < 1e-9));
            }
        }
    }
}

#[test]
fn bounding_circles_reject_no_near_segment() {
    for obstacle in shapes() {
        for [p, q] in segments(500, false) {
            assert!(obstacle.may_be_within(p, q, 0.5) || obstacle.distance_lower_bound_m(p, q) >= 0.5);
        }
    }
}

#[test]
fn clearance_applies_to_the_bounds() {
    let space = FreeSpace::empty([[0.0, 4.0], [0.0, 2.0], UNBOUNDED]);
    assert_eq!(space.distance_m(Point::new(1.0, 1.5, 9.0)), 0.5);
    assert!(space.is_clear([0.5, 0.5, 0.0].into(), [3.5, 1.5, 0.0].into(), 0.5));
    assert!(!space.is_clear([0.5, 0.5, 0.0].into(), [3.5, 1.6, 0.0].into(), 0.5));
    assert!(!space.is_clear([0.5, 0.5, f64::NAN].into(), [f64::NAN, 1.0, 0.0].into(), 0.5));
}

#[test]
fn moving_obstacles_are_at_their_displacement() {
    let mut space = FreeSpace::empty([UNBOUNDED; 3]);
    let wall = Obstacle::cylinder([0.0, 0.0], 0.5, UNBOUNDED);
    space.moving_obstacles.push(MovingObstacle::at_constant_velocity(wall.clone(), Point::x()));
    let (here, there) = (Point::new(0.0, 3.0, 0.0), Point::new(0.0, -3.0, 0.0));
    assert!(!space.is_clear_of_moving((here, -1.0), (there, 1.0), 0.1));
    assert!(space.is_clear_of_moving((here, 1.0), (there, 3.0), 0.1));
    let displacement = Displacement::PiecewiseLinear(vec![(0.0, Point::zeros()), (2.0, 4.0 * Point::x())]);
    let obstacle = MovingObstacle { shape: wall, displacement };
    assert_eq!([-1.0, 0.5, 3.0].map(|time_s| obstacle.displacement_m(time_s).x), [0.0, 1.0, 4.0]);
    assert!((obstacle.displacement_m(2.0) - 4.0 * Point::x()).norm() < 1e-15);
}
