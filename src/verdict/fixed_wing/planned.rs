//! The plan as a continuous motion: its controls integrated with the nonlinear equations, restarted at every node.

use nalgebra::Vector3;
use rayon::prelude::*;
use scenarios::fixed_wing::Trajectory;
use scenarios::{Plan, Scenario};
use sim::fixed_wing::{self, propagate, rollout};

use crate::verdict::compare::{exceeds, is_larger};
use crate::verdict::missing_evidence::MissingEvidence;
use crate::verdict::motion::{Knot, Motion};

/// Largest integration step, and largest time between two knots, s.
const MAX_STEP_S: f64 = 0.05;
/// Largest step of the open-loop integration, s.
const OPEN_LOOP_STEP_S: f64 = 0.25;
/// A defect is accumulated over at least this time, s, so that dense rows do not hide it.
pub const WINDOW_S: f64 = 1.0;
/// Smallest time between the beginnings of two windows, s.
const WINDOW_STRIDE_S: f64 = 0.2;

/// The motions that result from a plan's controls, and how far they are from its nodes.
#[derive(Clone, Debug)]
pub struct PlannedMotions {
    /// One per vehicle. At every node the motion jumps from where the interval before it ends to the node itself.
    pub motions: Vec<Motion>,
    /// Per vehicle, the largest defect: of the motion restarted at a node, over one interval or a window of at least 1 s.
    pub defects: Vec<NodeError>,
    /// Per vehicle, the largest error of the open-loop integration, which is not restarted at the nodes.
    pub open_loop_errors: Vec<NodeError>,
}

/// How far a motion is from a node.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct NodeError {
    /// Distance, m.
    pub error_m: f64,
    /// Time of the node, s.
    pub t_s: f64,
}

impl NodeError {
    /// The larger of two; NaN is the largest.
    pub fn larger(self, other: Self) -> Self {
        if is_larger(other.error_m, self.error_m) { other } else { self }
    }
}

impl PlannedMotions {
    /// Integrates a flyable plan.
    ///
    /// # Errors
    ///
    /// The plan takes longer than is simulated, or its controls lead to values that cannot be judged.
    pub fn new(scenario: &Scenario, plan: &Plan) -> Result<Self, MissingEvidence> {
        let max_s = scenario.simulation.max_duration_s;
        if let Some(duration_s) = plan.flight_time_s().filter(|&duration_s| exceeds(duration_s, max_s)) {
            return Err(MissingEvidence::PlanTooLong { duration_s, max_s });
        }
        let vehicles: Vec<_> =
            plan.trajectories.par_iter().map(|trajectory| integrated(trajectory.fixed_wing())).collect();
        let mut planned = Self { motions: Vec::new(), defects: Vec::new(), open_loop_errors: Vec::new() };
        for vehicle in vehicles {
            let (motion, defect, open_loop_error) = vehicle?;
            planned.motions.push(motion);
            planned.defects.push(defect);
            planned.open_loop_errors.push(open_loop_error);
        }
        Ok(planned)
    }
}

/// One vehicle's motion, its largest defect, and the largest error of the open-loop integration.
fn integrated(trajectory: &Trajectory) -> Result<(Motion, NodeError, NodeError), MissingEvidence> {
    let intervals: Vec<Vec<Knot>> = (1..trajectory.times_s.len()).map(|end| interval(trajectory, end)).collect();
    let own = intervals
        .iter()
        .enumerate()
        .filter_map(|(begin, knots)| knots.last().map(|end| defect(trajectory, [begin, begin + 1], end)));
    let defects = own.chain(window_starts(trajectory).flat_map(|begin| window_defects(trajectory, begin)));
    let largest = defects.reduce(NodeError::larger).ok_or(MissingEvidence::NoInterval)?;
    let motion = through(trajectory, &intervals)?;
    Ok((motion, largest, open_loop_error(trajectory)?))
}

/// The motion between the rows of a trajectory, restarted at each of them.
///
/// # Errors
///
/// The controls lead to values that cannot be judged.
pub fn between_rows(trajectory: &Trajectory) -> Result<Motion, MissingEvidence> {
    let intervals: Vec<Vec<Knot>> = (1..trajectory.times_s.len()).map(|end| interval(trajectory, end)).collect();
    through(trajectory, &intervals)
}

fn through(trajectory: &Trajectory, intervals: &[Vec<Knot>]) -> Result<Motion, MissingEvidence> {
    Ok(Motion::new(&trajectory.vehicle, intervals.concat())?.sampled())
}

/// The distance of the end of a motion from a node: the larger of |Δp| and |Δv| times the duration.
///
/// - `begin`, `node`: where the motion began and where it should end
fn defect(trajectory: &Trajectory, [begin, node]: [usize; 2], end: &Knot) -> NodeError {
    let (state, t_s) = (&trajectory.states[node], trajectory.times_s[node]);
    let position_m = distance(end.position_m, state.position_m());
    let velocity_m = distance(end.velocity_mps, state.velocity_mps()) * (t_s - trajectory.times_s[begin]);
    NodeError { error_m: if is_larger(velocity_m, position_m) { velocity_m } else { position_m }, t_s }
}

/// The nodes at which windows begin.
fn window_starts(trajectory: &Trajectory) -> impl Iterator<Item = usize> {
    let mut last_s = f64::NEG_INFINITY;
    trajectory.times_s.iter().enumerate().filter_map(move |(node, &t_s)| {
        let begins = t_s >= last_s + WINDOW_STRIDE_S;
        last_s = if begins { t_s } else { last_s };
        begins.then_some(node)
    })
}

/// The defects at the nodes of a window but the first, whose is that of its interval.
fn window_defects(trajectory: &Trajectory, begin: usize) -> Vec<NodeError> {
    let begin_s = trajectory.times_s[begin];
    let until = trajectory.times_s.iter().skip(begin).position(|&t_s| t_s >= begin_s + WINDOW_S);
    let last = until.map_or(trajectory.times_s.len() - 1, |nodes| begin + nodes);
    if last <= begin + 1 {
        return Vec::new();
    }
    let window = Trajectory {
        vehicle: String::new(),
        interpolation: trajectory.interpolation,
        times_s: trajectory.times_s[begin..=last].to_vec(),
        states: vec![trajectory.states[begin]],
        controls: trajectory.controls[begin..=last].to_vec(),
    };
    let knots = rollout(&window, MAX_STEP_S);
    at_nodes(&knots, &window.times_s)
        .enumerate()
        .skip(2)
        .map(|(node, end)| defect(trajectory, [begin, begin + node], &end))
        .collect()
}

/// The largest distance of the open-loop motion from a node.
fn open_loop_error(trajectory: &Trajectory) -> Result<NodeError, MissingEvidence> {
    let knots = rollout(trajectory, OPEN_LOOP_STEP_S);
    let ends = at_nodes(&knots, &trajectory.times_s).zip(&trajectory.states);
    let errors =
        ends.map(|(end, state)| NodeError { error_m: distance(end.position_m, state.position_m()), t_s: end.t_s });
    errors.reduce(NodeError::larger).ok_or(MissingEvidence::NoInterval)
}

/// The knots at the times of nodes, which are among those of all knots.
fn at_nodes<'a>(knots: &'a [fixed_wing::Knot], times_s: &'a [f64]) -> impl Iterator<Item = Knot> + 'a {
    let mut next = knots.iter();
    times_s.iter().filter_map(move |t_s| next.find(|knot| knot.t_s == *t_s).map(knot))
}

fn distance(a: [f64; 3], b: [f64; 3]) -> f64 {
    (Vector3::from(a) - Vector3::from(b)).norm()
}

/// The motion from the node before `end` to the time of the node `end`.
fn interval(trajectory: &Trajectory, end: usize) -> Vec<Knot> {
    let begin = end - 1;
    let (t0_s, t1_s) = (trajectory.times_s[begin], trajectory.times_s[end]);
    let controls = [trajectory.controls[begin], trajectory.controls[end]];
    // Two steps at least: their third derivatives tell the error of the cubics between the knots.
    let step_s = MAX_STEP_S.min((t1_s - t0_s) / 2.0);
    let flown = propagate(&trajectory.states[begin], controls, t0_s, t1_s - t0_s, step_s);
    let mut knots: Vec<Knot> = flown.iter().map(knot).collect();
    if let Some(last) = knots.last_mut() {
        // t0 + (t1 - t0) may round to beyond t1.
        last.t_s = t1_s;
    }
    knots
}

fn knot(knot: &fixed_wing::Knot) -> Knot {
    Knot { t_s: knot.t_s, position_m: knot.position_m.into(), velocity_mps: knot.velocity_mps.into() }
}
