//! Do body, cable and load keep clear of the obstacles, and does the envelope?
//!
//! The smallest signed distance over continuous time, by branch and bound. Within a span of time no point of a shape moves
//! farther from where it is in the middle than its largest speed allows, which bounds the distance from below; and nothing
//! is nearer than the [plane](super::behind) between the two, which is a bound of second order. Spans are halved until the
//! bounds meet. No sampling: an edge that is cut between two samples is found.

use std::cmp::Ordering;
use std::collections::BinaryHeap;

use scenarios::slung_load::Trajectory;
use scenarios::{Prism, Scenario, Vehicle};
use sim::slung_load::{Body, GROUND, OVERHANG_M, Part, Parts, Plane};

use super::behind;
use super::course::{Course, Deviation, Speeds};
use crate::verdict::Check;
use crate::verdict::compare::{exceeds, is_smaller};
use crate::verdict::question::{Evidence, Group, Measured, Question};

/// Distance between the bounds that counts as close enough, m.
const RESOLUTION_M: f64 = 1e-6;
/// Distance between the segments of the first round, in segments.
const STRIDE: usize = 16;
/// Most spans looked at: beyond them the bounds stay apart, and the check becomes undecided rather than wrong.
const MOST_SPANS: usize = 400_000;

/// What is kept clear of what.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
enum Shape {
    /// A part, from an obstacle by its index.
    Part(Part, usize),
    /// The envelope circle, from an obstacle by its index.
    Envelope(usize),
    /// The body, from the ground.
    AboveGround,
}

/// Vehicle and world, as far as distances are concerned.
pub struct Surroundings<'a> {
    vehicle: &'a str,
    parts: Parts,
    obstacles: Vec<Prism>,
    ground_m: Option<f64>,
}

/// A smallest distance with bounds, deviations of the true motion from the curves taken off.
#[derive(Clone, Copy, Debug)]
struct Closest {
    lower_m: f64,
    upper_m: f64,
    /// What both are less than the distance of the curves, m.
    deviation_m: f64,
    at_s: f64,
    shape: Shape,
}

impl<'a> Surroundings<'a> {
    /// Of a vehicle of the scenario.
    pub fn of(scenario: &Scenario, vehicle: &'a Vehicle) -> Self {
        Self {
            vehicle: &vehicle.name,
            parts: Parts::of(scenario.slung_load_model(vehicle)),
            obstacles: scenario.world.flat_obstacles(),
            ground_m: scenario.world.ground_m,
        }
    }

    /// Body, cable and load against every obstacle, the body against the ground as well; the limit is 0.
    pub fn check(&self, group: Group, course: Evidence<'_, Course>) -> Check {
        let shapes = self.parts();
        self.answer(group, "clearance", &shapes, course.map(|course| self.closest(course, &shapes)), 0.0)
    }

    /// The same at the planner's own nodes.
    pub fn check_nodes(&self, trajectory: Evidence<'_, Trajectory>) -> Check {
        let shapes = self.parts();
        let closest = trajectory.map(|trajectory| self.closest_node(trajectory, &shapes));
        self.answer(Group::Nodes, "clearance", &shapes, closest, 0.0)
    }

    /// The envelope circle against every obstacle, if the scenario asks for it.
    pub fn check_envelope(&self, group: Group, course: Evidence<'_, Course>, limit_m: Option<f64>) -> Check {
        let shapes = self.envelopes();
        let closest = course.map(|course| self.closest(course, &shapes));
        limit_m.map_or_else(|| no_envelope(group), |limit_m| self.answer(group, "envelope", &shapes, closest, limit_m))
    }

    /// The same at the planner's own nodes.
    pub fn check_envelope_nodes(&self, trajectory: Evidence<'_, Trajectory>, limit_m: Option<f64>) -> Check {
        let (group, shapes) = (Group::Nodes, self.envelopes());
        let closest = trajectory.map(|trajectory| self.closest_node(trajectory, &shapes));
        limit_m.map_or_else(|| no_envelope(group), |limit_m| self.answer(group, "envelope", &shapes, closest, limit_m))
    }

    fn parts(&self) -> Vec<Shape> {
        let parts = (0..self.obstacles.len()).flat_map(|i| Part::ALL.map(|part| Shape::Part(part, i)));
        parts.chain(self.ground_m.map(|_| Shape::AboveGround)).collect()
    }

    fn envelopes(&self) -> Vec<Shape> {
        (0..self.obstacles.len()).map(Shape::Envelope).collect()
    }

    fn answer(
        &self,
        group: Group,
        name: &'static str,
        shapes: &[Shape],
        closest: Result<Option<Closest>, &str>,
        limit_m: f64,
    ) -> Check {
        let question = Question::new(group, name, "m");
        if shapes.is_empty() {
            return question.skip("there are no obstacles");
        }
        match closest {
            Err(reason) => question.fail(reason),
            Ok(None) => question.fail("there was no time at which the vehicle could be compared with an obstacle"),
            Ok(Some(closest)) => {
                let (what, with) = match closest.shape {
                    Shape::Part(part, obstacle) => (part.name(), self.obstacles[obstacle].name.as_str()),
                    Shape::Envelope(obstacle) => ("envelope", self.obstacles[obstacle].name.as_str()),
                    Shape::AboveGround => (Part::Body.name(), GROUND),
                };
                let upper_m = closest.upper_m + 2.0 * closest.deviation_m;
                let measured = Measured::bounds(closest.lower_m, upper_m).at(closest.at_s);
                let measured = measured.with(self.vehicle).with(with).because(format!("it is the {what}"));
                question.at_least(measured, limit_m)
            }
        }
    }

    /// Smallest distance at the planner's own nodes.
    fn closest_node(&self, trajectory: &Trajectory, shapes: &[Shape]) -> Option<Closest> {
        let mut best: Option<Closest> = None;
        for node in trajectory.planner_nodes() {
            let body = Body::from(&trajectory.states[node]);
            for &shape in shapes {
                let distance_m = self.distance_m(shape, &body);
                if best.is_none_or(|best| is_smaller(distance_m, best.upper_m)) {
                    let at_s = trajectory.times_s[node];
                    best = Some(Closest { lower_m: distance_m, upper_m: distance_m, deviation_m: 0.0, at_s, shape });
                }
            }
        }
        best
    }

    /// Smallest distance of any of the shapes over the whole course. `None` without a segment.
    fn closest(&self, course: &Course, shapes: &[Shape]) -> Option<Closest> {
        let mut spans = BinaryHeap::new();
        let mut best: Option<Closest> = None;
        // In wide strides first, so that most of what lies between is known to be farther away at a glance.
        let segments: Vec<usize> = course.segments().collect();
        for segment in (0..STRIDE).flat_map(|first| segments.iter().copied().skip(first).step_by(STRIDE)) {
            let speeds = course.speeds(segment);
            spans.extend(
                shapes
                    .iter()
                    .filter_map(|&shape| self.measured(course, shape, segment, [0.0, 1.0], &speeds, &mut best)),
            );
        }
        let mut looked_at = spans.len();
        while let Some(span) = spans.pop() {
            let upper_m = best?.upper_m;
            let is_close = span.lower_m >= upper_m - RESOLUTION_M;
            if is_close || looked_at >= MOST_SPANS || span.lower_m.is_nan() {
                let lower_m = span.lower_m.min(upper_m - RESOLUTION_M);
                return best.map(|best| Closest { lower_m, ..best }.or_nan(span.lower_m));
            }
            let [from, to] = span.share;
            let middle = f64::midpoint(from, to);
            let speeds = course.speeds(span.segment);
            for half in [[from, middle], [middle, to]] {
                spans.extend(self.measured(course, span.shape, span.segment, half, &speeds, &mut best));
            }
            looked_at += 2;
        }
        // Nothing was left to look at: everything else is farther away than this, but for the resolution.
        best.map(|best| Closest { lower_m: best.upper_m - RESOLUTION_M, ..best })
    }

    /// Looks at the middle of a span, and bounds what it cannot be below. `None` if that is no closer than the best.
    fn measured(
        &self,
        course: &Course,
        shape: Shape,
        segment: usize,
        share: [f64; 2],
        speeds: &Speeds,
        best: &mut Option<Closest>,
    ) -> Option<Span> {
        let middle = f64::midpoint(share[0], share[1]);
        let body = course.at(segment, middle);
        let deviation_m = self.deviation_m(shape, course.deviation(segment));
        let moved_m = self.speed_mps(shape, speeds) * course.duration_s(segment) * (share[1] - share[0]) / 2.0;
        let is_far = |distance_m: f64, best: &Option<Closest>| {
            best.is_some_and(|best| distance_m - moved_m >= best.upper_m - RESOLUTION_M)
        };
        if is_far(self.at_least_m(shape, &body) - deviation_m, best) {
            return None;
        }
        let (distance_m, plane) = self.distance_and_plane(shape, &body);
        let distance_m = distance_m - deviation_m;
        let lower_m = match (shape, plane) {
            (Shape::Part(part, _), Some(plane)) if moved_m < OVERHANG_M && !distance_m.is_nan() => {
                let in_front_m = behind::in_front_m(&plane, &self.parts, part, course, segment, share);
                (distance_m - moved_m).max(in_front_m - deviation_m)
            }
            _ => distance_m - moved_m,
        };
        if best.is_none_or(|best| is_smaller(distance_m, best.upper_m)) {
            let at_s = course.time_s(segment, middle);
            *best = Some(Closest { lower_m: distance_m, upper_m: distance_m, deviation_m, at_s, shape });
        }
        let is_worth = best.is_none_or(|best| exceeds(best.upper_m - RESOLUTION_M, lower_m));
        is_worth.then_some(Span { lower_m, segment, share, shape })
    }

    fn at_least_m(&self, shape: Shape, body: &Body) -> f64 {
        match shape {
            Shape::Part(part, obstacle) => self.parts.at_least_m(part, body, &self.obstacles[obstacle]),
            Shape::Envelope(_) | Shape::AboveGround => self.distance_m(shape, body),
        }
    }

    fn distance_and_plane(&self, shape: Shape, body: &Body) -> (f64, Option<Plane>) {
        match shape {
            Shape::Part(part, obstacle) => self.parts.distance_and_plane(part, body, &self.obstacles[obstacle]),
            Shape::Envelope(_) | Shape::AboveGround => (self.distance_m(shape, body), None),
        }
    }

    fn distance_m(&self, shape: Shape, body: &Body) -> f64 {
        match shape {
            Shape::Part(part, obstacle) => self.parts.distance_m(part, body, &self.obstacles[obstacle]),
            Shape::Envelope(obstacle) => self.parts.envelope_distance_m(body, &self.obstacles[obstacle]),
            Shape::AboveGround => self.parts.height_m(body) - self.ground_m.unwrap_or(f64::NEG_INFINITY),
        }
    }

    /// How far a point of the shape may be from where the curves have it, m.
    fn deviation_m(&self, shape: Shape, Deviation { quadrotor_m, load_m, turn_rad }: Deviation) -> f64 {
        match shape {
            Shape::Part(Part::Body, _) | Shape::AboveGround => quadrotor_m + turn_rad * self.parts.body_radius_m(),
            Shape::Part(Part::Load, _) => load_m,
            Shape::Part(Part::Cable, _) => quadrotor_m.max(load_m),
            Shape::Envelope(_) => 2.0 * quadrotor_m + load_m,
        }
    }

    /// What no point of the shape's surface exceeds, m/s.
    fn speed_mps(&self, shape: Shape, speeds: &Speeds) -> f64 {
        let body_mps = speeds.quadrotor_mps + speeds.turn_radps * self.parts.body_radius_m();
        match shape {
            Shape::Part(Part::Body, _) | Shape::AboveGround => body_mps,
            Shape::Part(Part::Load, _) => speeds.load_mps,
            Shape::Part(Part::Cable, _) => speeds.quadrotor_mps.max(speeds.load_mps),
            Shape::Envelope(_) => speeds.quadrotor_mps + speeds.relative_mps,
        }
    }
}

impl Closest {
    fn or_nan(self, lower_m: f64) -> Self {
        if lower_m.is_nan() { Self { lower_m, upper_m: lower_m, ..self } } else { self }
    }
}

/// A span of a segment in which a shape may come closest. The one with the smallest lower bound comes first, a NaN before
/// all.
#[derive(Clone, Copy, Debug)]
struct Span {
    lower_m: f64,
    segment: usize,
    share: [f64; 2],
    shape: Shape,
}

impl Ord for Span {
    fn cmp(&self, other: &Self) -> Ordering {
        let key = |span: &Self| if span.lower_m.is_nan() { f64::NEG_INFINITY } else { span.lower_m };
        key(other).total_cmp(&key(self))
    }
}

impl PartialOrd for Span {
    fn partial_cmp(&self, other: &Self) -> Option<Ordering> {
        Some(self.cmp(other))
    }
}

impl PartialEq for Span {
    fn eq(&self, other: &Self) -> bool {
        self.cmp(other) == Ordering::Equal
    }
}

impl Eq for Span {}

fn no_envelope(group: Group) -> Check {
    Question::new(group, "envelope", "m").skip("the scenario asks for the true shapes only")
}

#[cfg(test)]
mod tests {
    use nalgebra::{UnitQuaternion, Vector3};
    use scenarios::Prism;
    use sim::slung_load::{Body, Part, Parts};

    use super::{Shape, Surroundings};
    use crate::verdict::random::Uniform;
    use crate::verdict::slung_load::course::{Course, Instant};

    fn model() -> scenarios::slung_load::Model {
        let text = include_str!("../../../scenarios/slung/rectangle.toml");
        let scenario = scenarios::parse("rectangle.toml", text).unwrap();
        scenario.slung_load_model(&scenario.vehicles[0]).clone()
    }

    fn surroundings(obstacles: Vec<Prism>) -> Surroundings<'static> {
        Surroundings { vehicle: "carrier", parts: Parts::of(&model()), obstacles, ground_m: None }
    }

    fn wall(z_m: Option<scenarios::Range>) -> Prism {
        Prism { name: "wall".into(), corners_m: vec![[0.5, 0.4], [-0.5, 0.4], [-0.5, -0.4], [0.5, -0.4]], z_m }
    }

    fn level(t_s: f64, position_m: Vector3<f64>, velocity_mps: Vector3<f64>) -> Instant {
        let load_position_m = position_m - Vector3::z() * 0.65;
        let (attitude, body_rate_radps) = (UnitQuaternion::identity(), Vector3::zeros());
        let load_velocity_mps = velocity_mps;
        Instant {
            t_s,
            body: Body { position_m, velocity_mps, attitude, body_rate_radps, load_position_m, load_velocity_mps },
        }
    }

    /// A level disc passes a corner of the wall along a straight line, its centre 1 m from it at the nearest.
    #[test]
    fn a_corner_is_passed_where_geometry_says() {
        for (steps, offset_s) in [(1, 0.0), (7, 0.3), (600, 0.123)] {
            let direction = Vector3::new(1.0, -1.0, 0.0).normalize() * 2.0;
            let nearest_m = Vector3::new(0.5, 0.4, 1.0) + Vector3::new(1.0, 1.0, 0.0).normalize();
            let at = |t_s: f64| level(t_s, nearest_m + direction * (t_s - 1.5 - offset_s), direction);
            let instants = (0..=steps).map(|step| at(4.0 * f64::from(step) / f64::from(steps))).collect();
            let surroundings = surroundings(vec![wall(None)]);
            let closest = surroundings.closest(&Course::new(instants), &surroundings.parts()).unwrap();
            let expected_m = 1.0 - model().body_radius_m();
            assert!(closest.lower_m <= expected_m + 1e-9 && expected_m <= closest.upper_m + 1e-6, "{closest:?}");
            assert!(closest.upper_m - closest.lower_m <= 1.1e-6, "{closest:?}");
            assert!((closest.at_s - 1.5 - offset_s).abs() < 2e-3, "{closest:?}");
        }
    }

    fn wild(uniform: &mut Uniform) -> Course {
        let mut t_s = 0.0;
        let instants = (0..12).map(|_| {
            let mut vector = |most: f64| Vector3::from_fn(|_, _| uniform.between(-most, most));
            let (position_m, velocity_mps) = (vector(2.0), vector(3.0));
            let (load_position_m, load_velocity_mps) = (position_m + vector(0.4), vector(3.0));
            let attitude = UnitQuaternion::from_scaled_axis(vector(1.2));
            let body_rate_radps = Vector3::zeros();
            let body = Body { position_m, velocity_mps, attitude, body_rate_radps, load_position_m, load_velocity_mps };
            t_s += uniform.between(0.05, 0.6);
            Instant { t_s, body }
        });
        Course::new(instants.collect())
    }

    /// A million instants of wild motions among two obstacles, one that ends below and above, one that does not.
    #[test]
    fn no_instant_of_wild_motions_is_nearer_than_the_bound() {
        let mut uniform = Uniform::seeded(11);
        let far = Prism { name: "far".into(), corners_m: vec![[2.6, 2.0], [1.7, 2.4], [1.8, 1.5]], z_m: None };
        for round in 0..25 {
            let surroundings = surroundings(vec![wall(Some(scenarios::Range::new(-0.2, 0.3))), far.clone()]);
            let course = wild(&mut uniform);
            for part in Part::ALL {
                let shapes = [Shape::Part(part, 0), Shape::Part(part, 1)];
                let closest = surroundings.closest(&course, &shapes).unwrap();
                let mut sampled_m = f64::INFINITY;
                for _ in 0..40_000 / 3 {
                    let segment = (uniform.between(0.0, 11.0) as usize).min(10);
                    let body = course.at(segment, uniform.between(0.0, 1.0));
                    sampled_m =
                        shapes.iter().map(|shape| surroundings.distance_m(*shape, &body)).fold(sampled_m, f64::min);
                }
                assert!(sampled_m >= closest.lower_m - 1e-9, "{round} {part:?}: {sampled_m} below {closest:?}");
                // Overlapping shapes have a depth, which is no distance; it is not bounded from both sides.
                let is_apart = closest.lower_m > 0.0;
                assert!(!is_apart || closest.upper_m - closest.lower_m <= 1.1e-6, "{round} {part:?}: {closest:?}");
            }
        }
    }
}
