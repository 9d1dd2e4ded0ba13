//! The motion of a vehicle as a continuous curve.

mod knots;

pub use knots::{Knot, KnotDefect};

use crate::verdict::bernstein;
use crate::verdict::missing_evidence::MissingEvidence;

/// An interval shorter than this, relative to the median one, has no differences but rounding.
const SHORT_INTERVAL: f64 = 1e-3;

/// A curve through knots: between two of them the cubic Hermite of their positions and velocities.
///
/// Knots are dense (at most 50 ms apart in a plan, one simulator step apart in a flight), so that the cubic is within
/// micrometres of the true motion. Two knots may share one time. The jump between them is not motion; `plan.dynamics`
/// measures it.
#[derive(Clone, Debug, PartialEq)]
pub struct Motion {
    vehicle: String,
    knots: Vec<Knot>,
    /// Of samples of a smooth motion: the interpolation error.
    deviation_m: f64,
    /// Of a reconstructed motion: how far the true one may be from each segment; empty otherwise.
    tube_m: Vec<f64>,
}

impl Motion {
    /// The motion of `vehicle` through `knots`.
    ///
    /// # Errors
    ///
    /// Fewer than two knots; decreasing times; values that are not finite or larger than 1e9.
    pub fn new(vehicle: &str, knots: Vec<Knot>) -> Result<Self, MissingEvidence> {
        if let Some(defect) = KnotDefect::find(&knots) {
            return Err(defect.of(vehicle));
        }
        Ok(Self { vehicle: vehicle.to_owned(), knots, deviation_m: 0.0, tube_m: Vec::new() })
    }

    /// The exact motion of the same vehicle through other knots, in the memory of this one.
    ///
    /// # Errors
    ///
    /// As for [`new`](Self::new); the motion is then unchanged.
    pub fn refill(&mut self, knots: &[Knot]) -> Result<(), KnotDefect> {
        if let Some(defect) = KnotDefect::find(knots) {
            return Err(defect);
        }
        self.knots.clear();
        self.knots.extend_from_slice(knots);
        self.tube_m.clear();
        self.deviation_m = 0.0;
        Ok(())
    }

    /// Treats the knots as samples of a smooth motion. Bounds of distances are widened by the interpolation error:
    ///
    /// ```text
    /// |p - cubic| <= h⁴/384 max|p''''|                                                  error of Hermite interpolation
    /// ```
    ///
    /// with twice the p'''' that the third derivatives of adjacent segments give. Where knots share a time, controls may have a
    /// kink: the third derivatives on both sides of it say nothing about p''''.
    pub fn sampled(mut self) -> Self {
        let jerk = |pair: &[Knot]| {
            let segment = Segment::between(&pair[0], &pair[1]);
            segment.lasts().then(|| (segment.t_s[1] - segment.t_s[0], segment.jerk_mps3()))
        };
        let jerks: Vec<Option<(f64, [f64; 3])>> = self.without_short_intervals().windows(2).map(jerk).collect();
        let deviation_m = |pair: &[Option<(f64, [f64; 3])>]| {
            let ((one_s, one), (other_s, other)) = pair[0].zip(pair[1])?;
            let change = (0..3).map(|axis| (one[axis] - other[axis]).powi(2)).sum::<f64>().sqrt();
            Some(2.0 / 384.0 * one_s.max(other_s).powi(4) / one_s.min(other_s) * change)
        };
        self.deviation_m = jerks.windows(2).filter_map(deviation_m).fold(0.0, f64::max);
        self
    }

    /// The knots without those that follow another one within a thousandth of the median interval: differences over such
    /// intervals are rounding. Knots that share a time stay.
    fn without_short_intervals(&self) -> Vec<Knot> {
        let mut intervals_s: Vec<f64> = self.knots.windows(2).map(|pair| pair[1].t_s - pair[0].t_s).collect();
        intervals_s.retain(|interval_s| *interval_s > 0.0);
        intervals_s.sort_by(f64::total_cmp);
        let short_s = SHORT_INTERVAL * intervals_s.get(intervals_s.len() / 2).copied().unwrap_or(0.0);
        let mut kept: Vec<Knot> = Vec::with_capacity(self.knots.len());
        for knot in &self.knots {
            let interval_s = kept.last().map_or(f64::INFINITY, |last| knot.t_s - last.t_s);
            if interval_s == 0.0 || interval_s > short_s {
                kept.push(*knot);
            }
        }
        kept
    }

    /// Surrounds the motion by a tube that holds the true motion.
    ///
    /// - `radius_m`: the radius of the tube around a segment
    pub fn within(mut self, radius_m: impl Fn(&Segment) -> f64) -> Self {
        self.tube_m = self.segments().map(|segment| radius_m(&segment)).collect();
        self
    }

    /// Largest distance of the true motion from the curve, m.
    pub fn deviation_m(&self) -> f64 {
        self.deviation_m + self.tube_m.iter().copied().fold(0.0, f64::max)
    }

    /// Radius of the tube around the segment `index`, m: 0 unless the motion was reconstructed. Hovering after it, the last.
    pub fn tube_m(&self, index: usize) -> f64 {
        self.tube_m.get(index).or(self.tube_m.last()).copied().unwrap_or(0.0)
    }

    /// Whether the motion was reconstructed, so that the true one is only known to be in a tube around it.
    pub fn is_reconstructed(&self) -> bool {
        !self.tube_m.is_empty()
    }

    /// Name of the vehicle.
    pub fn vehicle(&self) -> &str {
        &self.vehicle
    }

    /// The knots, in the order of time.
    pub fn knots(&self) -> &[Knot] {
        &self.knots
    }

    /// Time of the last knot, s.
    pub fn end_s(&self) -> f64 {
        self.knots[self.knots.len() - 1].t_s
    }

    /// Position at `t_s`, m; `None` before the first knot and after the last.
    pub fn position_m(&self, t_s: f64) -> Option<[f64; 3]> {
        if !(self.knots[0].t_s <= t_s && t_s <= self.end_s()) {
            return None;
        }
        let after = self.knots.partition_point(|knot| knot.t_s < t_s).max(1);
        let segment = self.segment(after - 1);
        Some(segment.during(segment.t_s[0], t_s).points_m[3])
    }

    /// State at `t_s`; `None` before the first knot and after the last.
    pub fn state(&self, t_s: f64) -> Option<Knot> {
        let position_m = self.position_m(t_s)?;
        let after = self.knots.partition_point(|knot| knot.t_s < t_s).max(1);
        let segment = self.segment(after - 1);
        let velocity_mps = if segment.lasts() { segment.velocity_mps(t_s) } else { self.knots[after].velocity_mps };
        Some(Knot { t_s, position_m, velocity_mps })
    }

    /// The motion, followed by rest in its last position until `end_s`.
    pub fn hovering_until(mut self, end_s: f64) -> Self {
        let last = self.knots[self.knots.len() - 1];
        if last.t_s < end_s {
            let at_rest = Knot { velocity_mps: [0.0; 3], ..last };
            self.knots.extend([at_rest, Knot { t_s: end_s, ..at_rest }]);
        }
        self
    }

    /// The end of the motion, from the last knot before `from_s` on, followed by straight flight at its last velocity until
    /// `to_s`, s.
    ///
    /// - `velocity_error_mps`: how far the true last velocity may be from that one
    pub fn coasting(&self, from_s: f64, to_s: f64, velocity_error_mps: f64) -> Self {
        let before = self.knots.partition_point(|knot| knot.t_s < from_s);
        let first = before.saturating_sub(1).min(self.knots.len() - 2);
        let mut coasting = Self {
            vehicle: self.vehicle.clone(),
            knots: self.knots[first..].to_vec(),
            deviation_m: self.deviation_m,
            tube_m: self.tube_m.get(first..).unwrap_or_default().to_vec(),
        };
        let last = self.knots[self.knots.len() - 1];
        if last.t_s < to_s {
            let after_s = to_s - last.t_s;
            let ahead_m = |axis: usize| last.position_m[axis] + last.velocity_mps[axis] * after_s;
            coasting.knots.push(Knot { t_s: to_s, position_m: [0, 1, 2].map(ahead_m), ..last });
            if self.is_reconstructed() {
                coasting.tube_m.push(self.tube_m(self.knots.len()) + velocity_error_mps * after_s);
            }
        }
        coasting
    }

    /// Drops the knots after the first one at or beyond `t_s`.
    pub fn end_at(&mut self, t_s: f64) {
        let kept = self.knots.partition_point(|knot| knot.t_s < t_s) + 1;
        self.knots.truncate(kept.max(2));
        self.tube_m.truncate(self.knots.len() - 1);
    }

    /// Number of segments: one between each two knots.
    pub fn segment_count(&self) -> usize {
        self.knots.len() - 1
    }

    /// The curve between the knots `index` and `index + 1`.
    pub fn segment(&self, index: usize) -> Segment {
        let deviation_m = self.deviation_m + self.tube_m(index);
        Segment { deviation_m, ..Segment::between(&self.knots[index], &self.knots[index + 1]) }
    }

    /// All segments, in the order of time.
    pub fn segments(&self) -> impl Iterator<Item = Segment> + '_ {
        (0..self.segment_count()).map(|index| self.segment(index))
    }
}

/// A cubic in Bernstein form over an interval of time.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Segment {
    /// Beginning and end, s.
    pub t_s: [f64; 2],
    /// Control points, m.
    pub points_m: [[f64; 3]; 4],
    /// How far the true motion may be from the curve, m.
    pub deviation_m: f64,
}

impl Segment {
    /// The cubic Hermite from `a` to `b`.
    pub fn between(a: &Knot, b: &Knot) -> Self {
        let third_s = (b.t_s - a.t_s) / 3.0;
        let leaving = std::array::from_fn(|axis| a.position_m[axis] + third_s * a.velocity_mps[axis]);
        let entering = std::array::from_fn(|axis| b.position_m[axis] - third_s * b.velocity_mps[axis]);
        Self { t_s: [a.t_s, b.t_s], points_m: [a.position_m, leaving, entering, b.position_m], deviation_m: 0.0 }
    }

    /// The part of the curve in [`from_s`, `to_s`], a subinterval of the segment.
    pub fn during(&self, from_s: f64, to_s: f64) -> Self {
        let [begin_s, end_s] = self.t_s;
        if from_s <= begin_s && to_s >= end_s {
            return *self;
        }
        let mut points_m = self.points_m;
        for axis in 0..3 {
            let whole = self.points_m.map(|point| point[axis]);
            let (until, _) = bernstein::split(&whole, (to_s - begin_s) / (end_s - begin_s));
            let (_, part) = bernstein::split(&until, (from_s - begin_s) / (to_s - begin_s));
            for (point, value) in points_m.iter_mut().zip(part) {
                point[axis] = value;
            }
        }
        Self { t_s: [from_s, to_s], points_m, ..*self }
    }

    /// Velocity at `t_s`, m/s. The segment must [last](Self::lasts).
    fn velocity_mps(&self, t_s: f64) -> [f64; 3] {
        let duration_s = self.t_s[1] - self.t_s[0];
        let u = (t_s - self.t_s[0]) / duration_s;
        std::array::from_fn(|axis| {
            let p = self.points_m.map(|point| point[axis]);
            let derivative = [p[1] - p[0], p[2] - p[1], p[3] - p[2]].map(|difference| 3.0 * difference / duration_s);
            bernstein::split(&derivative, u).0[2]
        })
    }

    /// Third derivative, constant over the segment, m/s³.
    fn jerk_mps3(&self) -> [f64; 3] {
        let duration_s = self.t_s[1] - self.t_s[0];
        let [p0, p1, p2, p3] = self.points_m;
        std::array::from_fn(|axis| 6.0 * (p3[axis] - p0[axis] + 3.0 * (p1[axis] - p2[axis])) / duration_s.powi(3))
    }

    /// Whether it takes time; otherwise it is a jump between two knots at the same time.
    pub fn lasts(&self) -> bool {
        self.t_s[0] < self.t_s[1]
    }

    /// The time at the fraction `u` of the interval, s.
    pub fn instant_s(&self, u: f64) -> f64 {
        if u == 1.0 { self.t_s[1] } else { self.t_s[0] + u * (self.t_s[1] - self.t_s[0]) }
    }
}

#[cfg(test)]
mod tests;
