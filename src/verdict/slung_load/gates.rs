//! Is every gate passed: is there an instant at which the quadrotor is in its window and the load in the load's?
//!
//! How deep inside they are at the best instant, over continuous time, by branch and bound: within a span of time the
//! depth grows by no more than the faster of the two moves.

use std::collections::BinaryHeap;

use scenarios::slung_load::Trajectory;
use scenarios::{CheckSpec, Gate, Scenario, Vehicle};
use sim::slung_load::SlungLoadState;

use super::motion::SlungLoadMotion;
use super::search_interval::SearchInterval;
use crate::verdict::Check;
use crate::verdict::compare::{is_larger, is_smaller};
use crate::verdict::evidence::{Decide, Evidence, Measurement};

/// Distance between the bounds that counts as close enough, m.
const RESOLUTION_M: f64 = 1e-6;
/// Most spans looked at: beyond them the bounds stay apart, and the check becomes undecided rather than wrong.
const MOST_SPANS: usize = 100_000;

/// A vehicle and the gates that it has to pass, in whatever order.
pub struct Gates<'a> {
    vehicle: &'a str,
    gates: &'a [Gate],
}

/// How deep in a gate's windows they are at most, with bounds, deviations of the true motion from the curves taken off.
#[derive(Clone, Copy, Debug)]
struct Deepest {
    lower_m: f64,
    upper_m: f64,
    /// What both are less than the depth of the curves, m.
    deviation_m: f64,
    at_s: f64,
}

impl<'a> Gates<'a> {
    /// Of a vehicle of the scenario.
    pub fn of(scenario: &'a Scenario, vehicle: &'a Vehicle) -> Self {
        Self { vehicle: &vehicle.name, gates: &scenario.world.gates }
    }

    /// At the planner's own nodes.
    pub fn check_nodes(&self, spec: &CheckSpec, trajectory: Evidence<'_, Trajectory>) -> Check {
        self.answer(spec, trajectory, deepest_node)
    }

    /// Over continuous time.
    pub fn check(&self, spec: &CheckSpec, motion: Evidence<'_, SlungLoadMotion>) -> Check {
        self.answer(spec, motion, deepest)
    }

    /// The gate in which they are least deep decides.
    fn answer<T>(
        &self,
        spec: &CheckSpec,
        evidence: Evidence<'_, T>,
        deepest: fn(&Gate, &T) -> Option<Deepest>,
    ) -> Check {
        if self.gates.is_empty() {
            return spec.skip("there are no gates");
        }
        let evidence = match evidence {
            Err(reason) => return spec.fail(reason),
            Ok(evidence) => evidence,
        };
        let mut worst: Option<(Deepest, &str)> = None;
        for gate in self.gates {
            let Some(deepest) = deepest(gate, evidence) else {
                return spec.fail(format!("there was no time at which gate {} could have been passed", gate.name));
            };
            if worst.is_none_or(|(worst, _)| is_smaller(deepest.lower_m, worst.lower_m)) {
                worst = Some((deepest, &gate.name));
            }
        }
        let (deepest, gate) = worst.expect("a gate");
        let measured =
            Measurement::bounds(deepest.lower_m, deepest.upper_m + 2.0 * deepest.deviation_m).at(deepest.at_s);
        spec.at_least(measured.with(self.vehicle).with(gate), 0.0)
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

/// `None` where nothing is known of any time.
fn deepest(gate: &Gate, motion: &SlungLoadMotion) -> Option<Deepest> {
    let mut best: Option<Deepest> = None;
    let mut measured = |segment: usize, share: [f64; 2]| {
        let middle = f64::midpoint(share[0], share[1]);
        let deviation = motion.deviation(segment);
        let deviation_m = deviation.quadrotor_m.max(deviation.load_m);
        let depth_m = depth_m(gate, &motion.at(segment, middle)) - deviation_m;
        if best.map_or(!depth_m.is_nan(), |best| depth_m > best.lower_m) {
            best =
                Some(Deepest { lower_m: depth_m, upper_m: depth_m, deviation_m, at_s: motion.time_s(segment, middle) });
        }
        let speeds = motion.speeds(segment);
        let moved_m =
            speeds.quadrotor_mps.max(speeds.load_mps) * motion.duration_s(segment) * (share[1] - share[0]) / 2.0;
        let span = SearchInterval { bound: depth_m + moved_m, segment, share, of: () };
        (best, Some(span).filter(|span| best.is_some_and(|best| span.bound > best.lower_m + RESOLUTION_M)))
    };
    let mut spans: BinaryHeap<SearchInterval<()>> =
        motion.segments().filter_map(|segment| measured(segment, [0.0, 1.0]).1).collect();
    let mut looked_at = spans.len();
    while let Some(span) = spans.pop() {
        let halves = span.halves().map(|half| measured(span.segment, half));
        let best = halves[1].0?;
        looked_at += 2;
        if span.bound <= best.lower_m + RESOLUTION_M || looked_at >= MOST_SPANS {
            return Some(Deepest { upper_m: span.bound.max(best.lower_m + RESOLUTION_M), ..best });
        }
        spans.extend(halves.into_iter().filter_map(|(_, half)| half));
    }
    best.map(|best| Deepest { upper_m: best.lower_m + RESOLUTION_M, ..best })
}
