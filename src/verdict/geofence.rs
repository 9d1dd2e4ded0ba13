//! The smallest margin to a geofence over continuous time.
//!
//! The search is branch and bound. A piece of the curve lies in the convex hull of its control points, over which the
//! geofence bounds the margin from below; pieces that could contain a smaller margin are halved.

use scenarios::Geofence;

use crate::verdict::compare::is_smaller;
use crate::verdict::extreme::Extreme;
use crate::verdict::motion::{Motion, Segment};

/// The search stops when the bounds are this close, m.
const RESOLUTION_M: f64 = 1e-6;
/// Largest number of pieces that are halved; beyond it the bounds stay apart and the check may be undecided.
const MAX_HALVINGS: usize = 1_000_000;

/// The margin lies within `error` of `value`, m; positive where flight is allowed.
pub fn smallest_margin(fence: &Geofence, motion: &Motion) -> Extreme {
    let mut search = Search { fence, nearest: None, given_up_m: f64::INFINITY, halvings: 0 };
    for segment in motion.segments() {
        search.consider(segment.points_m[0], segment.t_s[0], segment.deviation_m);
        search.consider(segment.points_m[3], segment.t_s[1], segment.deviation_m);
    }
    motion.segments().filter(Segment::lasts).for_each(|segment| search.search(segment));
    search.found().unwrap_or(Extreme { value: f64::NAN, error: 0.0, t_s: motion.end_s() })
}

/// A margin on the curve.
#[derive(Clone, Copy)]
struct Nearest {
    margin_m: f64,
    deviation_m: f64,
    t_s: f64,
}

impl Nearest {
    /// The smallest margin that the true motion may have there, m.
    fn possible_m(&self) -> f64 {
        self.margin_m - self.deviation_m
    }
}

struct Search<'a> {
    fence: &'a Geofence,
    nearest: Option<Nearest>,
    /// Lower bound over the pieces that were not searched to the end, m.
    given_up_m: f64,
    halvings: usize,
}

impl Search<'_> {
    fn consider(&mut self, position_m: [f64; 3], t_s: f64, deviation_m: f64) {
        let found = Nearest { margin_m: self.fence.margin_m(position_m), deviation_m, t_s };
        if self.nearest.is_none_or(|nearest| is_smaller(found.possible_m(), nearest.possible_m())) {
            self.nearest = Some(found);
        }
    }

    fn search(&mut self, segment: Segment) {
        let mut pieces = vec![segment];
        while let Some(piece) = pieces.pop() {
            let lower_m = self.fence.margin_bounds_m(&piece.points_m).min - piece.deviation_m;
            if self.nearest.is_some_and(|nearest| lower_m >= nearest.possible_m() - RESOLUTION_M) {
                continue;
            }
            let [from_s, to_s] = piece.t_s;
            let middle_s = f64::midpoint(from_s, to_s);
            if self.halvings == MAX_HALVINGS || !(from_s < middle_s && middle_s < to_s) {
                self.given_up_m = self.given_up_m.min(lower_m);
                continue;
            }
            self.halvings += 1;
            let (before, after) = (piece.during(from_s, middle_s), piece.during(middle_s, to_s));
            self.consider(before.points_m[3], middle_s, piece.deviation_m);
            pieces.extend([after, before]);
        }
    }

    fn found(&self) -> Option<Extreme> {
        let nearest = self.nearest?;
        let lower_m = self.given_up_m.min(nearest.possible_m() - RESOLUTION_M);
        let upper_m = nearest.margin_m + nearest.deviation_m;
        let (value, error) = (f64::midpoint(lower_m, upper_m), (upper_m - lower_m) / 2.0);
        Some(Extreme { value, error, t_s: nearest.t_s })
    }
}
