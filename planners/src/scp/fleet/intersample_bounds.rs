//! State bounds between the nodes.
//!
//! The bounds of a subproblem hold at the nodes. Between two nodes a state may overshoot (a speed that rises and falls
//! within an interval). The bounds of both nodes are tightened by the overshoot of the last trajectory.

use scenarios::Range;

use super::super::dynamics::State;
use super::super::shooting::Knots;
#[cfg(test)]
use super::super::shooting::SUBSTEPS;
use super::motion::VehicleMotion;
use crate::convex::STAGE_LEN;

/// Margin on the last overshoot, as a fraction of it: the next overshoot will differ.
const OVERSHOOT_MARGIN: f64 = 0.3;

/// Indices of the states that have bounds: all but the heading.
pub const BOUNDED_STATES: [usize; 5] = [0, 1, 2, 3, 5];

/// The bounds of every node, tightened by the overshoot of the last trajectory.
pub fn tightened(bounds: &[Range; STAGE_LEN], motion: &VehicleMotion) -> Vec<[Range; STAGE_LEN]> {
    let mut tightened = vec![*bounds; motion.intervals.len() + 1];
    for (k, knots) in motion.intervals.iter().enumerate() {
        for i in BOUNDED_STATES {
            let [below, above] = overshoot(knots, i).map(|overshoot| (1.0 + OVERSHOOT_MARGIN) * overshoot);
            for node in &mut tightened[k..=k + 1] {
                node[i].min = node[i].min.max(bounds[i].min + below);
                node[i].max = node[i].max.min(bounds[i].max - above);
            }
        }
    }
    tightened
}

/// Distances by which a component falls below and rises above its values at the ends of an interval.
fn overshoot(knots: &Knots, i: usize) -> [f64; 2] {
    let (begin, end) = (knots[0][i], knots[knots.len() - 1][i]);
    let extremes = extremes(knots, i);
    [begin.min(end) - extremes.min, extremes.max - begin.max(end)]
}

/// Smallest and largest value of a component over an interval, by the parabolas through three neighbouring states.
pub fn extremes(knots: &Knots, i: usize) -> Range {
    let mut found = Range::new(f64::INFINITY, f64::NEG_INFINITY);
    let mut consider = |value: f64| found = Range::new(found.min.min(value), found.max.max(value));
    knots.iter().for_each(|state: &State| consider(state[i]));
    for three in knots.windows(3) {
        let (a, b, c) = (three[0][i], three[1][i], three[2][i]);
        let (slope, curvature) = (0.5 * (c - a), 0.5 * (a + c) - b);
        let peak = -0.5 * slope / curvature;
        if peak.abs() < 1.0 {
            consider(b + 0.5 * slope * peak);
        }
    }
    found
}

#[cfg(test)]
mod tests {
    use super::*;

    /// A speed that rises by 0.5 m/s in the middle of the interval.
    fn knots() -> Knots {
        let last = SUBSTEPS as f64;
        std::array::from_fn(|m| {
            let u = m as f64 / last;
            State::new(0.0, 0.0, 400.0, 38.0 + 2.0 * u * (1.0 - u), 0.0, 0.0)
        })
    }

    #[test]
    fn extremes_between_the_samples_are_found() {
        let speed = extremes(&knots(), 3);
        assert!((speed.max - 38.5).abs() < 1e-12 && (speed.min - 38.0).abs() < 1e-12, "{speed:?}");
    }

    #[test]
    fn bounds_are_tightened_by_the_overshoot() {
        let bounds = [Range::new(-1000.0, 1000.0); STAGE_LEN];
        let constant = [State::zeros(); SUBSTEPS + 1];
        let motion = VehicleMotion { intervals: vec![constant, knots(), constant, constant], dt_s: 5.0 };
        let tightened = tightened(&bounds, &motion);
        let moved = |node: usize| 1000.0 - tightened[node][3].max;
        assert_eq!([moved(0), moved(3), moved(4)], [0.0; 3]);
        assert!(moved(1) > 0.5 && moved(1) < 0.7 && moved(1) == moved(2), "{}", moved(1));
        assert!(tightened.iter().all(|node| node[3].min == -1000.0));
    }
}
