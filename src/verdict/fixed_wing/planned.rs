//! The plan as a continuous motion: its controls integrated with the nonlinear equations, restarted at every node.

use rayon::prelude::*;
use scenarios::fixed_wing::Trajectory;
use scenarios::{Plan, Scenario};
use sim::fixed_wing::{self, propagate, rollout};

use crate::verdict::compare::exceeds;
use crate::verdict::missing_evidence::MissingEvidence;
use crate::verdict::motion::{Knot, Motion};

/// Largest integration step, and largest time between two knots, s.
const MAX_STEP_S: f64 = 0.05;
/// Largest step of the open-loop integration, of which only the end is used, s.
const OPEN_LOOP_STEP_S: f64 = 0.25;

/// The motions that result from a plan's controls.
#[derive(Clone, Debug)]
pub struct PlannedMotions {
    /// One per vehicle. At every node the motion jumps from where the interval before it ends to the node itself.
    pub motions: Vec<Motion>,
    /// Per vehicle, the end of every interval.
    pub ends: Vec<Vec<Knot>>,
    /// Per vehicle, the end of the open-loop integration, which is not restarted at the nodes.
    pub open_loop_ends: Vec<Knot>,
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
        let mut planned = Self { motions: Vec::new(), ends: Vec::new(), open_loop_ends: Vec::new() };
        for vehicle in vehicles {
            let (motion, ends, open_loop_end) = vehicle?;
            planned.motions.push(motion);
            planned.ends.push(ends);
            planned.open_loop_ends.extend(open_loop_end);
        }
        Ok(planned)
    }
}

/// One vehicle's motion, the ends of its intervals, and the end of the open-loop integration.
fn integrated(trajectory: &Trajectory) -> Result<(Motion, Vec<Knot>, Option<Knot>), MissingEvidence> {
    let intervals: Vec<Vec<Knot>> = (1..trajectory.times_s.len()).map(|end| interval(trajectory, end)).collect();
    let ends = intervals.iter().filter_map(|knots| knots.last().copied()).collect();
    let motion = Motion::new(&trajectory.vehicle, intervals.concat())?.sampled();
    Ok((motion, ends, rollout(trajectory, OPEN_LOOP_STEP_S).last().map(knot)))
}

/// The motion from the node before `end` to the time of the node `end`.
fn interval(trajectory: &Trajectory, end: usize) -> Vec<Knot> {
    let begin = end - 1;
    let (t0_s, t1_s) = (trajectory.times_s[begin], trajectory.times_s[end]);
    let controls = [trajectory.controls[begin], trajectory.controls[end]];
    let flown = propagate(&trajectory.states[begin], controls, t0_s, t1_s - t0_s, MAX_STEP_S);
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
