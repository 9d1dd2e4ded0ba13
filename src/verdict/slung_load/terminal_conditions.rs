//! Do quadrotor and load reach their goal, and come to rest there?

use scenarios::slung_load::{State, Trajectory};
use scenarios::{CheckSpec, Scenario, Vehicle};
use sim::slung_load::SlungLoadState;

use super::FlownMotion;
use super::planned::PlannedMotion;
use crate::verdict::Check;
use crate::verdict::evidence::{Decide, Evidence, Measurement};

/// A vehicle and where its motion should end.
pub struct TerminalConditions<'a> {
    vehicle: &'a str,
    goal: SlungLoadState,
    goal_m: f64,
    rest_mps: f64,
}

impl<'a> TerminalConditions<'a> {
    /// Of a vehicle of the scenario.
    pub fn of(scenario: &Scenario, vehicle: &'a Vehicle) -> Self {
        let model = scenario.slung_load_model(vehicle);
        Self {
            vehicle: &vehicle.name,
            goal: SlungLoadState::from(&State::at(&vehicle.goal, model.cable_length_m)),
            goal_m: scenario.limits().goal_m,
            rest_mps: scenario.limits().rest_mps,
        }
    }

    /// Distance of the last node from the goal, of quadrotor or load, whichever is larger.
    pub fn check_node_goal(&self, spec: &CheckSpec, trajectory: Evidence<'_, Trajectory>) -> Check {
        self.goal(
            spec,
            trajectory.map(|trajectory| {
                let last = trajectory.states.len().checked_sub(1)?;
                Some((SlungLoadState::from(&trajectory.states[last]), trajectory.times_s[last]))
            }),
        )
    }

    /// The same at the end of the continuous plan.
    pub fn check_planned_goal(&self, spec: &CheckSpec, planned: Evidence<'_, PlannedMotion>) -> Check {
        self.goal(spec, planned.map(planned_end))
    }

    /// The same in flight, when the plan ends.
    pub fn check_flown_goal(&self, spec: &CheckSpec, flown: Evidence<'_, FlownMotion<'_>>, end_s: f64) -> Check {
        self.goal(spec, flown.map(|flown| flown_end(flown, end_s)))
    }

    /// Speed at the end of the continuous plan, relative to the goal's.
    pub fn check_planned_rest(&self, spec: &CheckSpec, planned: Evidence<'_, PlannedMotion>) -> Check {
        self.rest(spec, planned.map(planned_end))
    }

    /// The same in flight, when the plan ends.
    pub fn check_flown_rest(&self, spec: &CheckSpec, flown: Evidence<'_, FlownMotion<'_>>, end_s: f64) -> Check {
        self.rest(spec, flown.map(|flown| flown_end(flown, end_s)))
    }

    fn goal(&self, spec: &CheckSpec, end: Result<Option<(SlungLoadState, f64)>, &str>) -> Check {
        let distance_m = |body: &SlungLoadState| {
            [body.position_m - self.goal.position_m, body.load_position_m - self.goal.load_position_m]
                .map(|difference| difference.norm())
        };
        self.answer(spec, end, distance_m, self.goal_m)
    }

    fn rest(&self, spec: &CheckSpec, end: Result<Option<(SlungLoadState, f64)>, &str>) -> Check {
        let speed_mps = |body: &SlungLoadState| {
            [body.velocity_mps - self.goal.velocity_mps, body.load_velocity_mps - self.goal.load_velocity_mps]
                .map(|difference| difference.norm())
        };
        self.answer(spec, end, speed_mps, self.rest_mps)
    }

    fn answer(
        &self,
        spec: &CheckSpec,
        end: Result<Option<(SlungLoadState, f64)>, &str>,
        measure: impl Fn(&SlungLoadState) -> [f64; 2],
        limit: f64,
    ) -> Check {
        match end {
            Err(reason) => spec.fail(reason),
            Ok(None) => spec.fail("the motion ends before the plan does"),
            Ok(Some((body, t_s))) => {
                let [quadrotor, load] = measure(&body);
                let (value, who) = if quadrotor >= load { (quadrotor, "quadrotor") } else { (load, "load") };
                // Of two numbers of which one is none, none is the larger.
                let value = if quadrotor.is_nan() { quadrotor } else { value };
                let measured =
                    Measurement::value(value).at(t_s).with(self.vehicle).with_reason(format!("it is the {who}"));
                spec.at_most(measured, limit)
            }
        }
    }
}

fn planned_end(planned: &PlannedMotion) -> Option<(SlungLoadState, f64)> {
    planned.knots.last().map(|knot| (knot.body, knot.t_s))
}

/// Quadrotor and load at the first sample at or beyond `end_s`.
fn flown_end(flown: &FlownMotion<'_>, end_s: f64) -> Option<(SlungLoadState, f64)> {
    // A thousandth of a millisecond is rounding, not time.
    let instant = flown.motion.samples().iter().find(|instant| instant.t_s >= end_s - 1e-6)?;
    Some((instant.body, instant.t_s))
}
