//! Terminal conditions: quadrotor and load end at the goal, at rest.

use nalgebra::Vector3;
use scenarios::slung_load::{State, Trajectory};
use scenarios::{CheckSpec, Scenario, Vehicle};
use sim::slung_load::SlungLoadState;

use super::FlownMotion;
use super::planned::PlannedMotion;
use crate::verdict::evidence::{CheckResult, Decide, Measurement};
use crate::verdict::missing_evidence::MissingEvidence;

/// Times that differ by less are the same, s: rounding.
const SAME_TIME_S: f64 = 1e-6;

/// A vehicle and the required end of its motion.
pub struct TerminalConditions<'a> {
    vehicle: &'a str,
    goal: SlungLoadState,
    goal_m: f64,
    rest_mps: f64,
}

impl<'a> TerminalConditions<'a> {
    /// Those of a vehicle of the scenario.
    pub fn new(scenario: &Scenario, vehicle: &'a Vehicle) -> Self {
        let model = scenario.slung_load_model(vehicle);
        Self {
            vehicle: &vehicle.name,
            goal: SlungLoadState::from(&State::at(&vehicle.goal, model.cable_length_m)),
            goal_m: scenario.limits().goal_m,
            rest_mps: scenario.limits().rest_mps,
        }
    }

    /// Distance of the last node from the goal, of quadrotor or load, whichever is larger.
    pub fn check_node_goal(&self, spec: &CheckSpec, trajectory: &Trajectory) -> CheckResult {
        let last = trajectory.states.len().checked_sub(1);
        self.check_goal(
            spec,
            last.map(|last| (SlungLoadState::from(&trajectory.states[last]), trajectory.times_s[last])),
        )
    }

    /// The same at the end of the continuous plan.
    pub fn check_planned_goal(&self, spec: &CheckSpec, planned: &PlannedMotion) -> CheckResult {
        self.check_goal(spec, planned_end(planned))
    }

    /// The same in flight at `end_s`, the end of the plan.
    pub fn check_flown_goal(&self, spec: &CheckSpec, flown: &FlownMotion<'_>, end_s: f64) -> CheckResult {
        self.check_goal(spec, flown_end(flown, end_s))
    }

    /// Speed relative to the goal's at the end of the continuous plan, of quadrotor or load, whichever is larger.
    pub fn check_planned_rest(&self, spec: &CheckSpec, planned: &PlannedMotion) -> CheckResult {
        self.check_rest(spec, planned_end(planned))
    }

    /// The same in flight at `end_s`, the end of the plan.
    pub fn check_flown_rest(&self, spec: &CheckSpec, flown: &FlownMotion<'_>, end_s: f64) -> CheckResult {
        self.check_rest(spec, flown_end(flown, end_s))
    }

    fn check_goal(&self, spec: &CheckSpec, end: Option<(SlungLoadState, f64)>) -> CheckResult {
        let difference_m = |body: &SlungLoadState| {
            [body.position_m - self.goal.position_m, body.load_position_m - self.goal.load_position_m]
        };
        self.check_larger(spec, end, difference_m, self.goal_m)
    }

    fn check_rest(&self, spec: &CheckSpec, end: Option<(SlungLoadState, f64)>) -> CheckResult {
        let difference_mps = |body: &SlungLoadState| {
            [body.velocity_mps - self.goal.velocity_mps, body.load_velocity_mps - self.goal.load_velocity_mps]
        };
        self.check_larger(spec, end, difference_mps, self.rest_mps)
    }

    /// - `end`: the state and the time, s, at the end of the motion
    /// - `difference`: of quadrotor and load from the goal
    fn check_larger(
        &self,
        spec: &CheckSpec,
        end: Option<(SlungLoadState, f64)>,
        difference: impl Fn(&SlungLoadState) -> [Vector3<f64>; 2],
        limit: f64,
    ) -> CheckResult {
        let early = || MissingEvidence::EndsEarly { vehicle: self.vehicle.to_owned() };
        let (body, t_s) = end.ok_or_else(early)?;
        let [quadrotor, load] = difference(&body).map(|difference| difference.norm());
        let (value, name) = if quadrotor >= load { (quadrotor, "quadrotor") } else { (load, "load") };
        // Every comparison with NaN is false.
        let value = if quadrotor.is_nan() { quadrotor } else { value };
        let measured = Measurement::value(value).at(t_s).with(self.vehicle).with_reason(format!("it is the {name}"));
        Ok(spec.at_most(measured, limit))
    }
}

fn planned_end(planned: &PlannedMotion) -> Option<(SlungLoadState, f64)> {
    planned.knots.last().map(|knot| (knot.state, knot.t_s))
}

/// Quadrotor and load at the first sample at or beyond `end_s`.
fn flown_end(flown: &FlownMotion<'_>, end_s: f64) -> Option<(SlungLoadState, f64)> {
    let sample = flown.motion.samples().iter().find(|sample| sample.t_s >= end_s - SAME_TIME_S)?;
    Some((sample.body, sample.t_s))
}
