//! What a viewer should open on: the instant that decided, and the part of space in which something happens.

use serde::Serialize;

use super::{Scene, Shape};
use crate::output::run::JudgedRun;
use crate::verdict::{Check, Status};

/// Width of an empty extent, m: that of a single point.
const MIN_WIDTH_M: f64 = 1.0;

/// An axis-aligned box, m.
#[derive(Clone, Copy, Debug, PartialEq, Serialize)]
pub struct Extent {
    /// Its lower corner.
    pub min_m: [f64; 3],
    /// Its upper corner.
    pub max_m: [f64; 3],
}

impl Extent {
    /// Middle of the box, m.
    pub fn centre_m(&self) -> [f64; 3] {
        std::array::from_fn(|axis| f64::midpoint(self.min_m[axis], self.max_m[axis]))
    }

    /// Lengths of the edges, m, each > 0.
    pub fn size_m(&self) -> [f64; 3] {
        std::array::from_fn(|axis| (self.max_m[axis] - self.min_m[axis]).max(MIN_WIDTH_M))
    }

    fn around(points: impl Iterator<Item = [f64; 3]>) -> Option<Self> {
        points.map(|point_m| Self { min_m: point_m, max_m: point_m }).reduce(|extent, point| Self {
            min_m: std::array::from_fn(|axis| extent.min_m[axis].min(point.min_m[axis])),
            max_m: std::array::from_fn(|axis| extent.max_m[axis].max(point.max_m[axis])),
        })
    }
}

/// The box around all planned and flown paths, starts and goals.
pub(super) fn action(scene: &Scene<'_>) -> Option<Extent> {
    let paths = ["planned", "flown", "planned_load", "flown_load", "ends"];
    let items = scene.items.iter().filter(|item| paths.contains(&item.path[0].as_str()));
    Extent::around(items.flat_map(|item| points_m(&item.shape)).copied())
}

fn points_m(shape: &Shape) -> impl Iterator<Item = &[f64; 3]> {
    let (strips, points) = match shape {
        Shape::Lines(lines) => (lines.strips.as_slice(), [].as_slice()),
        Shape::Points(points) => ([].as_slice(), points.positions_m.as_slice()),
        _ => ([].as_slice(), [].as_slice()),
    };
    strips.iter().flatten().chain(points).filter(|point| super::is_finite(point))
}

/// The check that decided, one with a worst instant: the first failure in the flight, or else in the plan; of a flight that
/// passed, the closest approach or the largest tracking error, whichever uses most of its limit.
pub(super) fn decisive<'a>(run: &JudgedRun<'a>) -> Option<&'a Check> {
    let timed = || run.verdict.checks.iter().filter(|check| time_s(check).is_some());
    let in_group = |group: &'static str| timed().filter(move |check| check.name.starts_with(group));
    let bad = |group: &'static str| {
        let failures = in_group(group).filter(|check| check.is_bad() && !check.advisory);
        failures.min_by(|a, b| time_s(a).unwrap_or(0.0).total_cmp(&time_s(b).unwrap_or(0.0)))
    };
    let closest = || {
        let key = in_group("flight.").filter(|check| check.status == Status::Pass && check.is_key());
        key.min_by(|a, b| slack(a).total_cmp(&slack(b)))
    };
    bad("flight.").or_else(|| bad("plan.")).or_else(closest)
}

/// The instant to open on, s: that of the decisive check, during the flight.
pub(super) fn instant_s(check: Option<&Check>, end_s: f64) -> f64 {
    check.and_then(time_s).unwrap_or(0.0).clamp(0.0, end_s.max(0.0))
}

fn time_s(check: &Check) -> Option<f64> {
    check.at_s.filter(|at_s| at_s.is_finite())
}

/// Margin relative to the limit, or in its own unit for a limit of zero.
fn slack(check: &Check) -> f64 {
    let limit = check.limit.map_or(1.0, f64::abs);
    check.margin.map_or(f64::INFINITY, |margin| margin / if limit > 0.0 { limit } else { 1.0 })
}

#[cfg(test)]
mod tests {
    use super::Extent;

    #[test]
    fn an_extent_holds_all_points_and_is_nowhere_empty() {
        let extent = Extent::around([[1.0, -2.0, 5.0], [-3.0, 4.0, 5.0]].into_iter()).unwrap();
        assert_eq!((extent.min_m, extent.max_m), ([-3.0, -2.0, 5.0], [1.0, 4.0, 5.0]));
        assert_eq!((extent.centre_m(), extent.size_m()), ([-1.0, 1.0, 5.0], [4.0, 6.0, 1.0]));
        assert_eq!(Extent::around(std::iter::empty()), None);
    }
}
