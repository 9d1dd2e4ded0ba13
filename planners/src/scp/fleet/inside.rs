//! States between the nodes.
//!
//! Bounds in the subproblem hold at the nodes. Between two of them a state may swing out by a little (a speed that
//! rises and falls within an interval); by as much as it did on the last trajectory the bounds of both nodes move in.

use scenarios::Range;

use super::super::dynamics::State;
use super::super::shooting::Knots;
#[cfg(test)]
use super::super::shooting::SUBSTEPS;
use super::track::Track;
use crate::convex::STAGE_LEN;

/// Room beyond the last swing, as a share of it: the next swing will not be quite the same.
const SPARE: f64 = 0.3;

/// The states that have bounds: all but the heading.
const BOUNDED: [usize; 5] = [0, 1, 2, 3, 5];

/// Bounds of every node, moved in by what the last trajectory swung out between them.
pub fn tightened(bounds: &[Range; STAGE_LEN], track: &Track) -> Vec<[Range; STAGE_LEN]> {
    let mut tightened = vec![*bounds; track.intervals.len() + 1];
    for (k, knots) in track.intervals.iter().enumerate() {
        for i in BOUNDED {
            let [below, above] = swing(knots, i).map(|swing| (1.0 + SPARE) * swing);
            for node in &mut tightened[k..=k + 1] {
                node[i].min = node[i].min.max(bounds[i].min + below);
                node[i].max = node[i].max.min(bounds[i].max - above);
            }
        }
    }
    tightened
}

/// By how much a component goes below and above its values at the ends of an interval.
fn swing(knots: &Knots, i: usize) -> [f64; 2] {
    let (begin, end) = (knots[0][i], knots[knots.len() - 1][i]);
    let extremes = extremes(knots, i);
    [begin.min(end) - extremes.min, extremes.max - begin.max(end)]
}

/// Smallest and largest value of a component over an interval: of the parabolas through three neighbouring states.
pub fn extremes(knots: &Knots, i: usize) -> Range {
    let mut found = Range::new(f64::INFINITY, f64::NEG_INFINITY);
    let mut consider = |value: f64| found = Range::new(found.min.min(value), found.max.max(value));
    knots.iter().for_each(|state: &State| consider(state[i]));
    for three in knots.windows(3) {
        let (a, b, c) = (three[0][i], three[1][i], three[2][i]);
        let (slope, bend) = (0.5 * (c - a), 0.5 * (a + c) - b);
        let peak = -0.5 * slope / bend;
        if peak.abs() < 1.0 {
            consider(b + 0.5 * slope * peak);
        }
    }
    found
}

#[cfg(test)]
mod tests {
    use super::*;

    /// A speed that rises by 0.5 m/s in the midst of the interval.
    fn knots() -> Knots {
        let last = SUBSTEPS as f64;
        std::array::from_fn(|m| {
            let u = m as f64 / last;
            State::new(0.0, 0.0, 400.0, 38.0 + 2.0 * u * (1.0 - u), 0.0, 0.0)
        })
    }

    #[test]
    fn extremes_lie_between_the_instants() {
        let speed = extremes(&knots(), 3);
        assert!((speed.max - 38.5).abs() < 1e-12 && (speed.min - 38.0).abs() < 1e-12, "{speed:?}");
    }

    #[test]
    fn bounds_move_in_where_the_state_swung_out() {
        let bounds = [Range::new(-1000.0, 1000.0); STAGE_LEN];
        let calm = [State::zeros(); SUBSTEPS + 1];
        let track = Track { intervals: vec![calm, knots(), calm, calm], dt_s: 5.0 };
        let tightened = tightened(&bounds, &track);
        let moved = |node: usize| 1000.0 - tightened[node][3].max;
        assert_eq!([moved(0), moved(3), moved(4)], [0.0; 3]);
        assert!(moved(1) > 0.5 && moved(1) < 0.7 && moved(1) == moved(2), "{}", moved(1));
        assert!(tightened.iter().all(|node| node[3].min == -1000.0));
    }
}
