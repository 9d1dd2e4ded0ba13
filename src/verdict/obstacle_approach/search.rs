//! Branch and bound for the closest approach of a motion to obstacles.
//!
//! Within an interval of time a distance cannot decrease by more than vehicle and obstacle move. Where that bound admits a
//! smaller distance than the best so far, the interval is halved: first runs of segments, then a segment itself. The
//! search allocates nothing.

use scenarios::Map;
use sim::Obstacles;

use crate::verdict::compare::is_smaller;
use crate::verdict::extreme::Extreme;
use crate::verdict::map_bounds::extremes_m;
use crate::verdict::motion::{Motion, Segment};

/// What rounding may leave of a distance that is computed twice, m. A run of segments is given up only beyond it, so that
/// runs change no result.
const ROUNDING_M: f64 = 1e-9;

/// The closest approach of a vehicle to an obstacle, at a point of its curve.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Approach {
    /// Distance from the surface of the vehicle, m.
    pub distance_m: f64,
    /// Its time, s.
    pub at_s: f64,
    /// Index of the vehicle.
    pub vehicle: usize,
    /// Index of the obstacle; `None` for the frame of the map.
    pub obstacle: Option<usize>,
}

/// When the search ends.
#[derive(Clone, Copy)]
pub struct Effort {
    /// How close the bounds have to be, m, for a smallest distance, m. The difference of the two must not decrease with
    /// the distance.
    pub resolution_m: fn(f64) -> f64,
    /// Whether to use that the signed distance to a convex body is convex: fewer intervals, but other ones.
    pub uses_convexity: bool,
    /// Largest number of intervals; beyond it the bounds stay apart.
    pub max_intervals: usize,
}

/// Lengths of a motion up to each of its knots, m: an upper bound, by the control polygons. Jumps count.
#[derive(Clone, Debug, Default)]
pub struct PathLengths(Vec<f64>);

impl PathLengths {
    /// Measures `motion`, in the memory of an earlier one.
    pub fn measure(&mut self, motion: &Motion) {
        self.0.clear();
        let mut length_m = 0.0;
        self.0.push(length_m);
        for segment in motion.segments() {
            length_m += segment.points_m.windows(2).map(|pair| distance_m(pair[0], pair[1])).sum::<f64>();
            self.0.push(length_m);
        }
    }

    /// The way between two knots, m.
    fn between_m(&self, first: usize, last: usize) -> f64 {
        self.0[last] - self.0[first]
    }
}

/// A vehicle on its way.
#[derive(Clone, Copy)]
pub struct Body<'a> {
    /// Index of the vehicle.
    pub vehicle: usize,
    /// Its motion.
    pub motion: &'a Motion,
    /// Lengths of the motion.
    pub lengths: &'a PathLengths,
    /// Radius of the vehicle plus the deviation of its motion from the curve, m.
    pub reach_m: f64,
}

/// The smallest distance of all vehicles so far.
pub struct Search<'a> {
    obstacles: &'a Obstacles,
    effort: Effort,
    best: Option<Approach>,
    intervals: usize,
    /// Smallest lower bound of the intervals that were given up, m.
    given_up_m: f64,
}

impl<'a> Search<'a> {
    /// Nothing has been searched.
    pub fn new(obstacles: &'a Obstacles, effort: Effort) -> Self {
        Self { obstacles, effort, best: None, intervals: 0, given_up_m: f64::INFINITY }
    }

    /// Considers every obstacle.
    pub fn add_obstacles(&mut self, body: Body<'_>) {
        for obstacle in 0..self.obstacles.count() {
            let ends = [0, body.motion.segment_count()].map(|knot| self.run_end(body, obstacle, knot));
            self.in_run(body, obstacle, ends);
        }
    }

    /// The closest approach, and the lower bound of its distance, m. `None` without vehicles.
    pub fn found(&self) -> Option<(Approach, f64)> {
        let best = self.best?;
        let lower_m = best.distance_m - (self.effort.resolution_m)(best.distance_m);
        Some((best, lower_m.min(self.given_up_m)))
    }

    /// Considers the frame of the map, to which the distance is an extreme of a coordinate.
    pub fn add_frame(&mut self, map: &Map, body: Body<'_>) {
        for (axis, range) in map.axes().into_iter().enumerate() {
            for Extreme { value, t_s, .. } in extremes_m(body.motion, axis) {
                self.consider(range.margin(value) - body.reach_m, t_s, body, None);
            }
        }
    }

    fn consider(&mut self, distance_m: f64, at_s: f64, body: Body<'_>, obstacle: Option<usize>) {
        if self.best.is_none_or(|best| is_smaller(distance_m, best.distance_m)) {
            self.best = Some(Approach { distance_m, at_s, vehicle: body.vehicle, obstacle });
        }
    }

    /// The segments between the knots of the ends of a run, halved unless they are farther away than the best.
    fn in_run(&mut self, body: Body<'_>, obstacle: usize, [a, b]: [RunEnd; 2]) {
        let knots = body.motion.knots();
        let length_m = body.lengths.between_m(a.knot, b.knot)
            + self.obstacles.speed_mps(obstacle) * (knots[b.knot].t_s - knots[a.knot].t_s);
        // Nowhere on a path of this length can the distance be smaller, given those at its ends.
        if (a.distance_m + b.distance_m - length_m) / 2.0 > self.upper_m() + ROUNDING_M {
            return;
        }
        if b.knot - a.knot == 1 {
            let segment = body.motion.segment(a.knot);
            if segment.lasts() {
                let part = Part { from: 0.0, to: 1.0, ends_m: [a.distance_m, b.distance_m] };
                self.in_segment(body, obstacle, &SegmentBounds::new(segment), part);
            }
            return;
        }
        let middle = self.run_end(body, obstacle, a.knot.midpoint(b.knot));
        self.in_run(body, obstacle, [a, middle]);
        self.in_run(body, obstacle, [middle, b]);
    }

    fn run_end(&self, body: Body<'_>, obstacle: usize, knot: usize) -> RunEnd {
        let at = &body.motion.knots()[knot];
        RunEnd { knot, distance_m: self.obstacles.distance_m(obstacle, at.t_s, at.position_m) - body.reach_m }
    }

    /// Measures the distance at the middle of a part of a segment, and in its halves if they could contain a smaller one.
    fn in_segment(&mut self, body: Body<'_>, obstacle: usize, bounds: &SegmentBounds, part: Part) {
        let segment = &bounds.segment;
        let middle = f64::midpoint(part.from, part.to);
        let t_s = segment.instant_s(middle);
        let position_m = segment.during(segment.t_s[0], t_s).points_m[3];
        let distance_m = self.obstacles.distance_m(obstacle, t_s, position_m) - body.reach_m;
        self.consider(distance_m, t_s, body, Some(obstacle));
        let speed_mps = bounds.speed_mps + self.obstacles.speed_mps(obstacle);
        let duration_s = segment.t_s[1] - segment.t_s[0];
        let mut lower_m = distance_m - speed_mps * duration_s * (part.to - part.from) / 2.0;
        if self.effort.uses_convexity && self.obstacles.is_convex(obstacle) {
            lower_m = lower_m.max(bounds.convex_lower_m(part, distance_m));
        }
        let upper_m = self.upper_m();
        self.intervals += 1;
        if lower_m < upper_m - (self.effort.resolution_m)(upper_m) {
            if self.intervals >= self.effort.max_intervals {
                self.given_up_m = self.given_up_m.min(lower_m);
                return;
            }
            let [begin_m, end_m] = part.ends_m;
            self.in_segment(body, obstacle, bounds, Part { to: middle, ends_m: [begin_m, distance_m], ..part });
            self.in_segment(body, obstacle, bounds, Part { from: middle, ends_m: [distance_m, end_m], ..part });
        }
    }

    fn upper_m(&self) -> f64 {
        self.best.map_or(f64::INFINITY, |best| best.distance_m)
    }
}

/// A knot and the distance there.
#[derive(Clone, Copy)]
struct RunEnd {
    knot: usize,
    distance_m: f64,
}

/// A part of a segment, as fractions of it, and the distances at its ends.
#[derive(Clone, Copy)]
struct Part {
    from: f64,
    to: f64,
    ends_m: [f64; 2],
}

/// A segment, and bounds of its derivatives.
struct SegmentBounds {
    segment: Segment,
    /// Of the speed, m/s: the derivative of a cubic lies in the convex hull of the differences of its control points.
    speed_mps: f64,
    /// Of the second derivative by the fraction of the segment, m.
    second_m: f64,
}

impl SegmentBounds {
    fn new(segment: Segment) -> Self {
        let duration_s = segment.t_s[1] - segment.t_s[0];
        let speed_mps = |pair: &[[f64; 3]]| distance_m(pair[0], pair[1]) * 3.0 / duration_s;
        let speed_mps = segment.points_m.windows(2).map(speed_mps).fold(0.0, f64::max);
        let bend_m = |three: &[[f64; 3]]| {
            let centre_m = std::array::from_fn(|axis| (three[0][axis] + three[2][axis]) / 2.0);
            12.0 * distance_m(three[1], centre_m)
        };
        let second_m = segment.points_m.windows(3).map(bend_m).fold(0.0, f64::max);
        Self { segment, speed_mps, second_m }
    }

    /// Lower bound of the distance to a convex body on a part, from those at its ends and its middle, m.
    ///
    /// ```text
    /// d(x) >= 2 d(m) - max(d(a), d(b)) - 3 e              e = w²/8 max|p''|, the curve's distance from its chord
    /// ```
    ///
    /// The signed distance to a convex body is a convex function. On the chord from a to b with the middle m, a point x and
    /// its mirror image x' have d(m) <= (d(x) + d(x')) / 2, and d(x') <= max(d(a), d(b)).
    fn convex_lower_m(&self, part: Part, middle_m: f64) -> f64 {
        let width = part.to - part.from;
        let chord_m = width * width / 8.0 * self.second_m;
        2.0 * middle_m - part.ends_m[0].max(part.ends_m[1]) - 3.0 * chord_m
    }
}

fn distance_m(a: [f64; 3], b: [f64; 3]) -> f64 {
    (0..3).map(|axis| (b[axis] - a[axis]).powi(2)).sum::<f64>().sqrt()
}
