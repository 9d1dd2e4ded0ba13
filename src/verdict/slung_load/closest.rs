//! The smallest signed distance over continuous time, by branch and bound.
//!
//! Within an interval of time, two lower bounds hold. The largest speed of a shape limits how far its points move from where
//! they are at the middle of the interval (first order); and the distance is at least that from the
//! [separating plane](super::separating_plane) at the middle (second order). Intervals are halved until the bounds meet. An
//! edge that is touched between two samples is found, since nothing is sampled.

use std::collections::BinaryHeap;

use scenarios::slung_load::Trajectory;
use sim::slung_load::{OVERHANG_M, Part, SlungLoadState};

use super::motion::{SlungLoadMotion, Speeds};
use super::search_interval::SearchInterval;
use super::separating_plane;
use super::shape_pairs::{Shape, ShapePairs};
use crate::verdict::compare::{exceeds, is_smaller};

/// The search stops when the bounds are this close, m.
const RESOLUTION_M: f64 = 1e-6;
/// The first round searches every so many segments.
const STRIDE: usize = 16;
/// Largest number of intervals searched; beyond it the bounds stay apart and the check may be undecided.
const MAX_INTERVALS: usize = 400_000;

/// A smallest distance with bounds. The deviation of the true motion from the curves is subtracted.
#[derive(Clone, Copy, Debug)]
pub struct ClosestApproach {
    /// Lower bound, m.
    pub lower_m: f64,
    /// Upper bound, m.
    pub upper_m: f64,
    /// The deviation subtracted from both, m.
    pub deviation_m: f64,
    /// Its time, s.
    pub at_s: f64,
    /// What it is between.
    pub shape: Shape,
}

impl ShapePairs<'_> {
    /// Smallest distance at the planner's nodes.
    pub fn closest_node(&self, trajectory: &Trajectory, shapes: &[Shape]) -> Option<ClosestApproach> {
        let mut best: Option<ClosestApproach> = None;
        for node in trajectory.planner_nodes() {
            let body = SlungLoadState::from(&trajectory.states[node]);
            for &shape in shapes {
                let distance_m = self.distance_m(shape, &body);
                if best.is_none_or(|best| is_smaller(distance_m, best.upper_m)) {
                    let at_s = trajectory.times_s[node];
                    best = Some(ClosestApproach {
                        lower_m: distance_m,
                        upper_m: distance_m,
                        deviation_m: 0.0,
                        at_s,
                        shape,
                    });
                }
            }
        }
        best
    }

    /// Smallest distance of any of the shapes over the whole motion. `None` without a segment.
    pub fn closest(&self, motion: &SlungLoadMotion, shapes: &[Shape]) -> Option<ClosestApproach> {
        let closest = self.closest_by_distance(motion, shapes)?;
        let enclosed = self.enclosed_at_start(motion, shapes);
        Some(enclosed.filter(|it| is_smaller(it.lower_m, closest.lower_m)).unwrap_or(closest))
    }

    /// The start of body or load inside an obstacle whose distances have no sign, because its surface intersects itself or has
    /// small holes. Whoever enters one later passes its surface.
    fn enclosed_at_start(&self, motion: &SlungLoadMotion, shapes: &[Shape]) -> Option<ClosestApproach> {
        let segment = motion.segments().next()?;
        let body = motion.at(segment, 0.0);
        let is_enclosed = |shape: &&Shape| match shape {
            Shape::Solid(Part::Body, solid) => self.solids[*solid].encloses(body.position_m.into()),
            Shape::Solid(Part::Load, solid) => self.solids[*solid].encloses(body.load_position_m.into()),
            _ => false,
        };
        let shape = shapes.iter().find(is_enclosed)?;
        let distance_m = -self.distance_m(*shape, &body).abs() - RESOLUTION_M;
        let at_s = motion.time_s(segment, 0.0);
        Some(ClosestApproach { lower_m: distance_m, upper_m: distance_m, deviation_m: 0.0, at_s, shape: *shape })
    }

    fn closest_by_distance(&self, motion: &SlungLoadMotion, shapes: &[Shape]) -> Option<ClosestApproach> {
        let mut intervals = BinaryHeap::new();
        let mut best: Option<ClosestApproach> = None;
        // In wide strides first, so that most of what lies between is known to be farther away at a glance.
        let segments: Vec<usize> = motion.segments().collect();
        for segment in (0..STRIDE).flat_map(|first| segments.iter().copied().skip(first).step_by(STRIDE)) {
            let speeds = motion.speeds(segment);
            intervals.extend(
                shapes
                    .iter()
                    .filter_map(|&shape| self.measured(motion, shape, segment, [0.0, 1.0], &speeds, &mut best)),
            );
        }
        let mut searched = intervals.len();
        while let Some(interval) = intervals.pop() {
            let lower_m = -interval.bound;
            let upper_m = best?.upper_m;
            let is_close = lower_m >= upper_m - RESOLUTION_M;
            if is_close || searched >= MAX_INTERVALS || lower_m.is_nan() {
                let known_m = lower_m.min(upper_m - RESOLUTION_M);
                return best.map(|best| ClosestApproach { lower_m: known_m, ..best }.or_nan(lower_m));
            }
            let speeds = motion.speeds(interval.segment);
            for half in interval.halves() {
                intervals.extend(self.measured(motion, interval.of, interval.segment, half, &speeds, &mut best));
            }
            searched += 2;
        }
        // No interval is left: nothing is closer than this by more than the resolution.
        best.map(|best| ClosestApproach { lower_m: best.upper_m - RESOLUTION_M, ..best })
    }

    /// Measures the distance at the middle of an interval and bounds it from below over the interval. `None` if the bound is not
    /// below the best distance so far.
    fn measured(
        &self,
        motion: &SlungLoadMotion,
        shape: Shape,
        segment: usize,
        fraction: [f64; 2],
        speeds: &Speeds,
        best: &mut Option<ClosestApproach>,
    ) -> Option<SearchInterval<Shape>> {
        let middle = f64::midpoint(fraction[0], fraction[1]);
        let body = motion.at(segment, middle);
        let deviation_m = self.deviation_m(shape, motion.deviation(segment), speeds.reach_m);
        let moved_m = self.speed_mps(shape, speeds) * motion.duration_s(segment) * (fraction[1] - fraction[0]) / 2.0;
        let is_far = |distance_m: f64, best: &Option<ClosestApproach>| {
            best.is_some_and(|best| distance_m - moved_m >= best.upper_m - RESOLUTION_M)
        };
        if is_far(self.distance_lower_bound_m(shape, &body) - deviation_m, best) {
            return None;
        }
        let (distance_m, plane) = self.distance_and_plane(shape, &body);
        let distance_m = distance_m - deviation_m;
        let lower_m = match (shape, plane) {
            (Shape::Part(part, _), Some(plane)) if moved_m < OVERHANG_M && !distance_m.is_nan() => {
                let in_front_m = separating_plane::in_front_m(&plane, &self.parts, part, motion, segment, fraction);
                (distance_m - moved_m).max(in_front_m - deviation_m)
            }
            _ => distance_m - moved_m,
        };
        if best.is_none_or(|best| is_smaller(distance_m, best.upper_m)) {
            let at_s = motion.time_s(segment, middle);
            *best = Some(ClosestApproach { lower_m: distance_m, upper_m: distance_m, deviation_m, at_s, shape });
        }
        let is_worth = best.is_none_or(|best| exceeds(best.upper_m - RESOLUTION_M, lower_m));
        is_worth.then_some(SearchInterval { bound: -lower_m, segment, fraction, of: shape })
    }
}

impl ClosestApproach {
    fn or_nan(self, lower_m: f64) -> Self {
        if lower_m.is_nan() { Self { lower_m, upper_m: lower_m, ..self } } else { self }
    }
}

#[cfg(test)]
mod tests {
    use nalgebra::{UnitQuaternion, Vector3};
    use scenarios::Prism;
    use sim::slung_load::{Part, Parts, SlungLoadState};

    use crate::verdict::random::Uniform;
    use crate::verdict::slung_load::motion::{MotionSample, SlungLoadMotion};
    use crate::verdict::slung_load::shape_pairs::{Shape, ShapePairs};

    fn model() -> scenarios::slung_load::Model {
        let text = include_str!("../../../scenarios/slung/rectangle.toml");
        let scenario = scenarios::parse("rectangle.toml", text).unwrap();
        scenario.slung_load_model(&scenario.vehicles[0]).clone()
    }

    fn shape_pairs(obstacles: Vec<Prism>) -> ShapePairs<'static> {
        ShapePairs { vehicle: "carrier", parts: Parts::new(&model()), obstacles, solids: Vec::new(), ground_m: None }
    }

    fn wall(z_m: Option<scenarios::Range>) -> Prism {
        Prism { name: "wall".into(), corners_m: vec![[0.5, 0.4], [-0.5, 0.4], [-0.5, -0.4], [0.5, -0.4]], z_m }
    }

    fn level(t_s: f64, position_m: Vector3<f64>, velocity_mps: Vector3<f64>) -> MotionSample {
        let load_position_m = position_m - Vector3::z() * 0.65;
        let (attitude, body_rate_radps) = (UnitQuaternion::identity(), Vector3::zeros());
        let load_velocity_mps = velocity_mps;
        MotionSample {
            t_s,
            body: SlungLoadState {
                position_m,
                velocity_mps,
                attitude,
                body_rate_radps,
                load_position_m,
                load_velocity_mps,
            },
        }
    }

    /// A level disc passes a corner of the wall along a straight line; its centre comes within 1 m of the corner.
    #[test]
    fn a_corner_is_passed_where_geometry_says() {
        for (steps, offset_s) in [(1, 0.0), (7, 0.3), (600, 0.123)] {
            let direction = Vector3::new(1.0, -1.0, 0.0).normalize() * 2.0;
            let nearest_m = Vector3::new(0.5, 0.4, 1.0) + Vector3::new(1.0, 1.0, 0.0).normalize();
            let at = |t_s: f64| level(t_s, nearest_m + direction * (t_s - 1.5 - offset_s), direction);
            let samples = (0..=steps).map(|step| at(4.0 * f64::from(step) / f64::from(steps))).collect();
            let shape_pairs = shape_pairs(vec![wall(None)]);
            let closest = shape_pairs.closest(&SlungLoadMotion::new(samples), &shape_pairs.parts()).unwrap();
            let expected_m = 1.0 - model().body_radius_m();
            assert!(closest.lower_m <= expected_m + 1e-9 && expected_m <= closest.upper_m + 1e-6, "{closest:?}");
            assert!(closest.upper_m - closest.lower_m <= 1.1e-6, "{closest:?}");
            assert!((closest.at_s - 1.5 - offset_s).abs() < 2e-3, "{closest:?}");
        }
    }

    fn random_motion(uniform: &mut Uniform) -> SlungLoadMotion {
        let mut t_s = 0.0;
        let samples = (0..12).map(|_| {
            let mut vector = |most: f64| Vector3::from_fn(|_, _| uniform.between(-most, most));
            let (position_m, velocity_mps) = (vector(2.0), vector(3.0));
            let (load_position_m, load_velocity_mps) = (position_m + vector(0.4), vector(3.0));
            let attitude = UnitQuaternion::from_scaled_axis(vector(1.2));
            let body_rate_radps = Vector3::zeros();
            let body = SlungLoadState {
                position_m,
                velocity_mps,
                attitude,
                body_rate_radps,
                load_position_m,
                load_velocity_mps,
            };
            t_s += uniform.between(0.05, 0.6);
            MotionSample { t_s, body }
        });
        SlungLoadMotion::new(samples.collect())
    }

    /// A million samples of random motions among two obstacles, one of finite height and one of infinite height.
    #[test]
    fn random_motions_are_never_closer_than_the_lower_bound() {
        let mut uniform = Uniform::seeded(11);
        let far = Prism { name: "far".into(), corners_m: vec![[2.6, 2.0], [1.7, 2.4], [1.8, 1.5]], z_m: None };
        for round in 0..25 {
            let shape_pairs = shape_pairs(vec![wall(Some(scenarios::Range::new(-0.2, 0.3))), far.clone()]);
            let motion = random_motion(&mut uniform);
            for part in Part::ALL {
                let shapes = [Shape::Part(part, 0), Shape::Part(part, 1)];
                let closest = shape_pairs.closest(&motion, &shapes).unwrap();
                let mut sampled_m = f64::INFINITY;
                for _ in 0..40_000 / 3 {
                    let segment = (uniform.between(0.0, 11.0) as usize).min(10);
                    let body = motion.at(segment, uniform.between(0.0, 1.0));
                    sampled_m =
                        shapes.iter().map(|shape| shape_pairs.distance_m(*shape, &body)).fold(sampled_m, f64::min);
                }
                assert!(sampled_m >= closest.lower_m - 1e-9, "{round} {part:?}: {sampled_m} below {closest:?}");
                assert!(closest.upper_m - closest.lower_m <= 1.1e-6, "{round} {part:?}: {closest:?}");
            }
        }
    }

    /// A level quadrotor at rest; the load swings up beside it, at this angle from the body axis x.
    fn swing_up(heading: f64) -> SlungLoadMotion {
        let sample = |step: i32| {
            let elevation = -1.0 + 0.02 * f64::from(step);
            let (sin, cos) = elevation.sin_cos();
            let outward = Vector3::new(heading.cos(), heading.sin(), 0.0);
            let still = level(0.02 * f64::from(step), Vector3::z() * 2.0, Vector3::zeros());
            let load_position_m = still.body.position_m + (outward * cos + Vector3::z() * sin) * 0.65;
            let load_velocity_mps = (Vector3::z() * cos - outward * sin) * 0.65;
            MotionSample { body: SlungLoadState { load_position_m, load_velocity_mps, ..still.body }, ..still }
        };
        SlungLoadMotion::new((0..=100).map(sample).collect())
    }

    /// The rotors of the model stand on the diagonals and leave 64 mm between them.
    #[test]
    fn a_cable_may_pass_between_two_rotors_and_not_through_one() {
        let shape_pairs = shape_pairs(vec![]);
        let closest_m = |heading: f64| shape_pairs.closest(&swing_up(heading), &ShapePairs::own()).unwrap();
        let between = closest_m(0.0);
        assert!((between.lower_m - (0.225 / 2.0_f64.sqrt() - 0.127 - 0.005)).abs() < 2e-6, "{between:?}");
        let through = closest_m(std::f64::consts::FRAC_PI_4);
        assert!((through.lower_m + 0.005).abs() < 2e-6 && through.upper_m < 0.0, "{through:?}");
        assert!(matches!(through.shape, Shape::CableToRotor(_)) && (through.at_s - 1.0).abs() < 1e-3, "{through:?}");
    }

    #[test]
    fn a_load_that_falls_through_the_hub_between_two_samples_touches_it() {
        let at = |t_s: f64, above_m: f64| {
            let still = level(t_s, Vector3::z() * 2.0, Vector3::zeros());
            let (load_position_m, load_velocity_mps) = (Vector3::z() * (2.0 + above_m), Vector3::z() * -4.0);
            MotionSample { body: SlungLoadState { load_position_m, load_velocity_mps, ..still.body }, ..still }
        };
        let shape_pairs = shape_pairs(vec![]);
        let closest =
            shape_pairs.closest(&SlungLoadMotion::new(vec![at(0.0, 0.3), at(0.1, -0.1)]), &ShapePairs::own()).unwrap();
        assert!((closest.upper_m + 0.03).abs() < 2e-6 && (closest.at_s - 0.075).abs() < 1e-3, "{closest:?}");
    }
}
