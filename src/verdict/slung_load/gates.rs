//! Gates: a gate is passed if, at some instant, the quadrotor is inside its window and the load inside the load's window.
//!
//! The depth inside both windows is maximised over continuous time by branch and bound: within an interval of time it cannot
//! grow by more than the faster of the two bodies moves.

use std::collections::BinaryHeap;

use scenarios::slung_load::Trajectory;
use scenarios::{CheckSpec, Gate, Scenario, Vehicle};
use sim::slung_load::SlungLoadState;

use super::motion::SlungLoadMotion;
use super::search_interval::SearchInterval;
use crate::verdict::compare::{is_larger, is_smaller};
use crate::verdict::evidence::{CheckResult, Decide, Evidence, Measurement};
use crate::verdict::missing_evidence::MissingEvidence;

/// The search stops when the bounds are this close, m.
const RESOLUTION_M: f64 = 1e-6;
/// Largest number of intervals searched; beyond it the bounds stay apart and the check may be undecided.
const MAX_INTERVALS: usize = 100_000;

/// A vehicle and the gates that it has to pass, in any order.
pub struct Gates<'a> {
    vehicle: &'a str,
    gates: &'a [Gate],
}

/// Largest depth in a gate's windows, with bounds. The deviation of the true motion from the curves is subtracted.
#[derive(Clone, Copy, Debug)]
struct Deepest {
    lower_m: f64,
    upper_m: f64,
    /// The deviation subtracted from both, m.
    deviation_m: f64,
    at_s: f64,
}

impl<'a> Gates<'a> {
    /// The gates of the scenario, for one of its vehicles.
    pub fn new(scenario: &'a Scenario, vehicle: &'a Vehicle) -> Self {
        Self { vehicle: &vehicle.name, gates: &scenario.world.gates }
    }

    /// At the planner's nodes.
    pub fn check_nodes(&self, spec: &CheckSpec, trajectory: Evidence<'_, Trajectory>) -> CheckResult {
        self.check_shallowest(spec, trajectory, deepest_node)
    }

    /// Over continuous time.
    pub fn check(&self, spec: &CheckSpec, motion: Evidence<'_, SlungLoadMotion>) -> CheckResult {
        self.check_shallowest(spec, motion, deepest)
    }

    /// The gate that is passed least deeply decides.
    fn check_shallowest<T>(
        &self,
        spec: &CheckSpec,
        evidence: Evidence<'_, T>,
        deepest: fn(&Gate, &T) -> Option<Deepest>,
    ) -> CheckResult {
        if self.gates.is_empty() {
            return Ok(spec.skip("there are no gates"));
        }
        let evidence = evidence?;
        let mut worst: Option<(Deepest, &str)> = None;
        for gate in self.gates {
            let deepest =
                deepest(gate, evidence).ok_or_else(|| MissingEvidence::NoGateDepth { gate: gate.name.clone() })?;
            if worst.is_none_or(|(worst, _)| is_smaller(deepest.lower_m, worst.lower_m)) {
                worst = Some((deepest, &gate.name));
            }
        }
        let (deepest, gate) = worst.expect("at least one gate");
        let measured =
            Measurement::bounds(deepest.lower_m, deepest.upper_m + 2.0 * deepest.deviation_m).at(deepest.at_s);
        Ok(spec.at_least(measured.with(self.vehicle).with(gate), 0.0))
    }
}

fn depth_m(gate: &Gate, body: &SlungLoadState) -> f64 {
    gate.margin_m(body.position_m.into(), body.load_position_m.into())
}

fn deepest_node(gate: &Gate, trajectory: &Trajectory) -> Option<Deepest> {
    let at = |node: usize| {
        let depth_m = depth_m(gate, &SlungLoadState::from(&trajectory.states[node]));
        Deepest { lower_m: depth_m, upper_m: depth_m, deviation_m: 0.0, at_s: trajectory.times_s[node] }
    };
    let nodes = trajectory.planner_nodes().into_iter().map(at);
    nodes.reduce(|best, next| if is_larger(next.lower_m, best.lower_m) { next } else { best })
}

/// `None` if the motion has no segment, or no finite position.
fn deepest(gate: &Gate, motion: &SlungLoadMotion) -> Option<Deepest> {
    let mut best: Option<Deepest> = None;
    let mut measured = |segment: usize, fraction: [f64; 2]| {
        let middle = f64::midpoint(fraction[0], fraction[1]);
        let deviation = motion.deviation(segment);
        let deviation_m = deviation.quadrotor_m.max(deviation.load_m);
        let depth_m = depth_m(gate, &motion.at(segment, middle)) - deviation_m;
        if best.map_or(!depth_m.is_nan(), |best| depth_m > best.lower_m) {
            best =
                Some(Deepest { lower_m: depth_m, upper_m: depth_m, deviation_m, at_s: motion.time_s(segment, middle) });
        }
        let speeds = motion.speeds(segment);
        let moved_m =
            speeds.quadrotor_mps.max(speeds.load_mps) * motion.duration_s(segment) * (fraction[1] - fraction[0]) / 2.0;
        let interval = SearchInterval { bound: depth_m + moved_m, segment, fraction, of: () };
        (best, Some(interval).filter(|interval| best.is_some_and(|best| interval.bound > best.lower_m + RESOLUTION_M)))
    };
    let mut intervals: BinaryHeap<SearchInterval<()>> =
        motion.segments().filter_map(|segment| measured(segment, [0.0, 1.0]).1).collect();
    let mut searched = intervals.len();
    while let Some(interval) = intervals.pop() {
        let halves = interval.halves().map(|half| measured(interval.segment, half));
        let best = halves[1].0?;
        searched += 2;
        if interval.bound <= best.lower_m + RESOLUTION_M || searched >= MAX_INTERVALS {
            return Some(Deepest { upper_m: interval.bound.max(best.lower_m + RESOLUTION_M), ..best });
        }
        intervals.extend(halves.into_iter().filter_map(|(_, half)| half));
    }
    best.map(|best| Deepest { upper_m: best.lower_m + RESOLUTION_M, ..best })
}
