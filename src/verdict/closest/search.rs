//! The search for a smallest distance over the segments of motions.

use scenarios::SeparationMeasure;

use crate::verdict::bernstein;
use crate::verdict::closest::{ClosestApproach, cylinder};
use crate::verdict::motion::{Motion, Segment};

/// Distance between the bounds that counts as close enough, m.
const RESOLUTION_M: f64 = 1e-9;
/// Rounding of a squared distance, as a share of the largest coefficient of its polynomial.
const ROUNDING: f64 = 16.0 * f64::EPSILON;

/// Which distance is sought of motions that are known up to a deviation.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum Bound {
    /// The smallest that is possible: deviations are taken off.
    Possible,
    /// The smallest that is certain: deviations are added.
    Certain,
    /// That of the curves.
    Curve,
}

impl Bound {
    /// How far something of a radius reaches from its curve, m.
    fn reach_m(self, radius_m: f64, deviation_m: f64) -> f64 {
        match self {
            Self::Possible => radius_m + deviation_m,
            Self::Certain => radius_m - deviation_m,
            Self::Curve => radius_m,
        }
    }

    /// The largest reach along a motion, m.
    pub fn max_reach_m(self, radius_m: f64, motion: &Motion) -> f64 {
        radius_m + if self == Self::Possible { motion.deviation_m() } else { 0.0 }
    }
}

/// Bounds of the smallest distance so far.
pub struct Search {
    bound: Bound,
    lower_m: f64,
    upper_m: f64,
    at: Option<(f64, [usize; 2], f64)>,
}

impl Search {
    /// Any distance counts.
    pub fn new(bound: Bound) -> Self {
        Self::below(f64::INFINITY, bound)
    }

    /// Only distances below this count, m.
    pub fn below(upper_m: f64, bound: Bound) -> Self {
        Self { bound, lower_m: upper_m, upper_m, at: None }
    }

    /// What is sought.
    pub fn bound(&self) -> Bound {
        self.bound
    }

    /// Can something that is `gap_m` or farther from the centre of a circle be nearer to the circle than the best?
    pub fn may_be_within(&self, gap_m: f64, radius_m: f64) -> bool {
        gap_m - radius_m < self.upper_m
    }

    /// One segment, by its control points relative to the centre of a circle.
    pub fn look(&mut self, relative_m: &[[f64; 3]; 4], span: &Segment, radius_m: f64, who: [usize; 2]) {
        let radius_m = self.bound.reach_m(radius_m, span.deviation_m);
        let reach_m = self.upper_m + radius_m;
        if reach_m <= 0.0 || squared_gap_to_box(relative_m) >= reach_m * reach_m {
            return;
        }
        let c = bernstein::squared_norm(relative_m);
        let rounding = ROUNDING * c.iter().copied().fold(0.0, f64::max);
        let tolerance = |best: f64| (RESOLUTION_M * best.sqrt()).max(RESOLUTION_M * RESOLUTION_M).max(rounding);
        let minimum = bernstein::minimise(&c, reach_m * reach_m, tolerance);
        self.lower_m = self.lower_m.min((minimum.lower - rounding).max(0.0).sqrt() - radius_m);
        if let Some(u) = minimum.at {
            self.upper_m = (minimum.upper + rounding).sqrt() - radius_m;
            self.at = Some((span.instant_s(u), who, span.deviation_m));
        }
    }

    /// Two vehicles, balls whose radii together are `radius_m`, by the control points of one relative to the other.
    pub fn look_at_pair(
        &mut self,
        relative_m: &[[f64; 3]; 4],
        span: &Segment,
        radius_m: f64,
        who: [usize; 2],
        measure: SeparationMeasure,
    ) {
        let scale = measure.scale();
        let scaled_m = relative_m.map(|point| [0, 1, 2].map(|axis| scale[axis] * point[axis]));
        let SeparationMeasure::Cylinder { radius_m: cylinder_m, height_m } = measure else {
            return self.look(&scaled_m, span, radius_m, who);
        };
        let radius_m = self.bound.reach_m(radius_m, span.deviation_m);
        let reach_m = self.upper_m + radius_m;
        if reach_m <= 0.0 || squared_gap_to_box(&scaled_m) >= reach_m * reach_m {
            return;
        }
        let raised_m = cylinder_m - height_m;
        let minimum = cylinder::minimise(relative_m, raised_m, reach_m, RESOLUTION_M);
        self.lower_m = self.lower_m.min(minimum.lower - radius_m);
        if let Some(u) = minimum.at {
            self.upper_m = minimum.upper - radius_m;
            self.at = Some((span.instant_s(u), who, span.deviation_m));
        }
    }

    /// The smallest distance; `None` if there was none.
    pub fn found(&self) -> Option<ClosestApproach> {
        let (at_s, who, deviation_m) = self.at?;
        let lower_m = self.lower_m.min(self.upper_m);
        let widening_m = if self.bound == Bound::Possible { 2.0 * deviation_m } else { 0.0 };
        Some(ClosestApproach { lower_m, upper_m: self.upper_m + widening_m, at_s, who })
    }
}

/// Distance from the origin to the smallest horizontal box around `points_m`, squared.
fn squared_gap_to_box(points_m: &[[f64; 3]; 4]) -> f64 {
    let axis_gap = |axis: usize| {
        let (mut low, mut high) = (f64::INFINITY, f64::NEG_INFINITY);
        for point in points_m {
            low = low.min(point[axis]);
            high = high.max(point[axis]);
        }
        low.max(-high).max(0.0)
    };
    let (x, y) = (axis_gap(0), axis_gap(1));
    x * x + y * y
}
