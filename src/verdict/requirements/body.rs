//! A moving body: bounds of its position, velocity and acceleration over any interval of time.

use crate::verdict::bernstein;
use crate::verdict::motion::{Motion, Segment};
use crate::verdict::requirements::interval::Interval;

/// Of a cubic Hermite with |p - H| ≤ h⁴/384 M: |p' - H'| ≤ √3 h³/216 M and |p'' - H''| ≤ h²/12 M.
const VELOCITY_FACTOR: f64 = 384.0 * 1.733 / 216.0;
const ACCELERATION_FACTOR: f64 = 384.0 / 12.0;

/// Bounds over an interval of time, world frame.
#[derive(Clone, Debug)]
pub struct Enclosure {
    /// Position, m.
    pub position: [Interval; 3],
    /// Velocity, m/s.
    pub velocity: [Interval; 3],
    /// Acceleration, m/s².
    pub acceleration: [Interval; 3],
    /// How far the true motion may be from the curve: m, m/s, m/s².
    pub errors: [f64; 3],
    /// Whether the curve or its velocity may jump inside the interval, so that slopes do not bound its change.
    pub jumps: bool,
}

/// A motion with bounds of its segments in a tree.
pub struct Body<'a> {
    motion: &'a Motion,
    /// Of the segments from index `n` on, and of the union of the nodes `2 i` and `2 i + 1` at `i`.
    tree: Vec<Option<Enclosure>>,
}

impl<'a> Body<'a> {
    /// The body that moves like this.
    pub fn new(motion: &'a Motion) -> Self {
        let n = motion.segment_count();
        let mut tree: Vec<Option<Enclosure>> = vec![None; n];
        tree.extend(motion.segments().map(|segment| Some(Enclosure::of(&segment))));
        for index in (1..n).rev() {
            tree[index] = union(tree[2 * index].as_ref(), tree[2 * index + 1].as_ref());
        }
        Self { motion, tree }
    }

    /// Its name.
    pub fn name(&self) -> &str {
        self.motion.vehicle()
    }

    /// Beginning and end of its motion, s.
    pub fn lifetime_s(&self) -> [f64; 2] {
        [self.motion.knots()[0].t_s, self.motion.end_s()]
    }

    /// Bounds over [`from_s`, `to_s`], which must lie in its lifetime.
    pub fn over(&self, [from_s, to_s]: [f64; 2]) -> Enclosure {
        if from_s == to_s {
            return self.at(from_s);
        }
        let knots = self.motion.knots();
        let first = knots.partition_point(|knot| knot.t_s <= from_s).max(1) - 1;
        let last = (knots.partition_point(|knot| knot.t_s < to_s).max(1) - 1).min(self.motion.segment_count() - 1);
        let part = |index: usize| Enclosure::during(&self.motion.segment(index), [from_s, to_s]);
        let first = first.min(last);
        let ends = if first == last { Some(part(first)) } else { union(Some(&part(first)), Some(&part(last))) };
        let inner = if first + 1 < last { self.between(first + 1, last) } else { None };
        union(ends.as_ref(), inner.as_ref()).expect("an interval has a segment")
    }

    /// Points whose convex hull holds the curve over [`from_s`, `to_s`], m: the control points within one segment, else the
    /// corners of a box.
    pub fn hull_m(&self, [from_s, to_s]: [f64; 2]) -> Vec<[f64; 3]> {
        let knots = self.motion.knots();
        let first = (knots.partition_point(|knot| knot.t_s <= from_s).max(1) - 1).min(self.motion.segment_count() - 1);
        let segment = self.motion.segment(first);
        if segment.lasts() && from_s < to_s && segment.t_s[0] <= from_s && to_s <= segment.t_s[1] {
            return segment.during(from_s, to_s).points_m.to_vec();
        }
        let position = self.over([from_s, to_s]).position;
        let end = |axis: usize, is_max: bool| if is_max { position[axis].max } else { position[axis].min };
        (0..8).map(|corner| std::array::from_fn(|axis| end(axis, (corner >> axis) & 1 == 1))).collect()
    }

    /// Bounds of the segments with indices in [`from`, `to`).
    fn between(&self, from: usize, to: usize) -> Option<Enclosure> {
        let n = self.motion.segment_count();
        let (mut left, mut right, mut found) = (from + n, to + n, None);
        while left < right {
            if left % 2 == 1 {
                found = union(found.as_ref(), self.tree[left].as_ref());
                left += 1;
            }
            if right % 2 == 1 {
                right -= 1;
                found = union(found.as_ref(), self.tree[right].as_ref());
            }
            (left, right) = (left / 2, right / 2);
        }
        found
    }

    fn at(&self, t_s: f64) -> Enclosure {
        let state = self.motion.state(t_s).expect("an instant of its lifetime");
        let knots = self.motion.knots();
        let after = knots.partition_point(|knot| knot.t_s < t_s).max(1);
        let segment = Enclosure::of(&self.motion.segment(after - 1));
        let position = state.position_m.map(Interval::point);
        let velocity = state.velocity_mps.map(Interval::point);
        let is_known = segment.acceleration[0] != Interval::EMPTY;
        let acceleration = if is_known { segment.acceleration } else { [Interval::point(0.0); 3] };
        Enclosure { position, velocity, acceleration, jumps: false, ..segment }
    }
}

impl Enclosure {
    fn of(segment: &Segment) -> Self {
        Self::during(segment, segment.t_s)
    }

    /// Over the part of [`from_s`, `to_s`] that is in the segment. Derivatives are those of the whole segment, so that their
    /// rounding does not grow as the part becomes short.
    fn during(segment: &Segment, [from_s, to_s]: [f64; 2]) -> Self {
        let points = &segment.points_m;
        let deviation_m = segment.deviation_m;
        if !segment.lasts() {
            let position = std::array::from_fn(|axis| Interval::hull(points.iter().map(|point| point[axis])));
            // Position or velocity may jump. The velocities are those of the segments before and after.
            return Self {
                position,
                velocity: [Interval::EMPTY; 3],
                acceleration: [Interval::EMPTY; 3],
                errors: [deviation_m, 0.0, 0.0],
                jumps: true,
            };
        }
        let duration_s = segment.t_s[1] - segment.t_s[0];
        let part = [from_s, to_s].map(|t_s| ((t_s - segment.t_s[0]) / duration_s).clamp(0.0, 1.0));
        let axis_points = |axis: usize| points.map(|point| point[axis]);
        let velocity = |axis: usize| {
            let [a, b, c, d] = axis_points(axis);
            [b - a, c - b, d - c].map(|difference| 3.0 * difference / duration_s)
        };
        let acceleration = |axis: usize| {
            let [a, b, c] = velocity(axis);
            [b - a, c - b].map(|difference| 2.0 * difference / duration_s)
        };
        let magnitude_m = points.iter().flatten().fold(0.0_f64, |largest, value| largest.max(value.abs()));
        let rounding_m = 1e-15 * magnitude_m;
        let errors = [
            deviation_m,
            (VELOCITY_FACTOR * deviation_m + 12.0 * rounding_m) / duration_s,
            (ACCELERATION_FACTOR * deviation_m + 50.0 * rounding_m) / duration_s.powi(2),
        ];
        Self {
            position: std::array::from_fn(|axis| hull_of(&axis_points(axis), part)),
            velocity: std::array::from_fn(|axis| hull_of(&velocity(axis), part)),
            acceleration: std::array::from_fn(|axis| hull_of(&acceleration(axis), part)),
            errors,
            jumps: false,
        }
    }
}

/// Bounds of the polynomial with these Bernstein coefficients over a part of [0, 1].
fn hull_of<const N: usize>(coefficients: &[f64; N], [begin, end]: [f64; 2]) -> Interval {
    let (until, _) = bernstein::split(coefficients, end);
    let (_, part) = bernstein::split(&until, if end > 0.0 { begin / end } else { 0.0 });
    Interval::hull(part)
}

fn union(a: Option<&Enclosure>, b: Option<&Enclosure>) -> Option<Enclosure> {
    let (Some(a), Some(b)) = (a, b) else { return a.or(b).cloned() };
    let both = |a: &[Interval; 3], b: &[Interval; 3]| std::array::from_fn(|axis| a[axis].union(b[axis]));
    Some(Enclosure {
        position: both(&a.position, &b.position),
        velocity: both(&a.velocity, &b.velocity),
        acceleration: both(&a.acceleration, &b.acceleration),
        errors: std::array::from_fn(|order| a.errors[order].max(b.errors[order])),
        jumps: a.jumps || b.jumps,
    })
}
