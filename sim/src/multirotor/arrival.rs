use nalgebra::Vector3;
use scenarios::in_loop::Node;
use scenarios::{AppliedLimits, Scenario, Vehicle};

use super::state::MultirotorState;

/// The arrival of vehicles that are planned for in the loop: from when on all rest at their goals, as far as it is known.
///
/// A vehicle rests at its goal if it is within the tolerances of position and speed, and its reference leads nowhere else: no
/// node that remains is beyond the tolerance of position. From then on it must stay within that tolerance for the coast. A
/// vehicle that leaves it, crashes, or accepts a reference that does, has not arrived, and the flight goes on.
pub(super) struct Arrival<'a> {
    scenario: &'a Scenario,
    limits: AppliedLimits,
    /// The step since which all vehicles have been at their goals.
    since: Option<usize>,
}

impl<'a> Arrival<'a> {
    /// Nobody has arrived.
    pub fn new(scenario: &'a Scenario) -> Self {
        Self { scenario, limits: scenario.limits(), since: None }
    }

    /// Takes note of a step. A vehicle whose start is its goal has arrived one step after the beginning, so that there is a
    /// flight.
    ///
    /// - `truths`: true states of the vehicles; `None` once crashed
    /// - `accepted`: nodes of the reference of a vehicle, in force or pending
    pub fn update<'n>(
        &mut self,
        (step, t_s): (usize, f64),
        truths: &[Option<MultirotorState>],
        accepted: impl Fn(usize) -> &'n [Node],
    ) {
        let max_speed_mps = if self.since.is_some() { f64::INFINITY } else { self.limits.rest_mps };
        let mut vehicles = self.scenario.vehicles.iter().zip(truths).enumerate();
        let are_there = step > 0
            && vehicles.all(|(index, (vehicle, truth))| {
                let Some(truth) = truth else { return false };
                self.is_near(vehicle, truth.position_m)
                    && truth.velocity_mps.norm() <= max_speed_mps
                    && !self.leads_on(vehicle, accepted(index), t_s)
            });
        self.since = are_there.then(|| self.since.unwrap_or(step));
    }

    /// Since which step all vehicles have been at their goals.
    pub fn since(&self) -> Option<usize> {
        self.since
    }

    /// The last step of the flight, if all vehicles stay: at least one after the arrival.
    pub fn last_step(&self) -> Option<usize> {
        let settings = &self.scenario.simulation;
        self.since.map(|step| step + ((settings.coast_s / settings.step_s).ceil() as usize).max(1))
    }

    /// Whether a reference has a node after `t_s` beyond the tolerance of the goal.
    fn leads_on(&self, vehicle: &Vehicle, nodes: &[Node], t_s: f64) -> bool {
        nodes.iter().any(|node| node.t_s > t_s && !self.is_near(vehicle, node.position_m.into()))
    }

    fn is_near(&self, vehicle: &Vehicle, position_m: Vector3<f64>) -> bool {
        (position_m - Vector3::from(vehicle.goal.position_m())).norm() <= self.limits.goal_m
    }
}
