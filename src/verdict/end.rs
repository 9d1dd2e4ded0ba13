//! What is asked of the end of a vehicle, and where a plan arrives.
//!
//! A vehicle that hovers arrives where its plan ends. A fixed wing cannot stop: its plan may go on beyond the goal, so that it
//! stays clear of the others until the last one has arrived.

use nalgebra::Vector3;
use scenarios::{AppliedLimits, Family, Scenario, Trajectory, Vehicle};

use crate::verdict::LimitKey;
use crate::verdict::compare::{exceeds, is_worse};
use crate::verdict::motion::{Knot, Motion};
use crate::verdict::reconstruction::max_turn_deg;
use crate::verdict::tube::EndError;

/// The node at which a vehicle arrives: the last one, unless that misses the goal and an earlier one meets all parts of it.
/// `None` without nodes.
pub fn arrival_node(scenario: &Scenario, vehicle: &Vehicle, trajectory: &Trajectory) -> Option<usize> {
    let last = trajectory.times_s().len().checked_sub(1)?;
    let (family, limits) = (trajectory.family(), scenario.limits());
    if family.hovers() {
        return Some(last);
    }
    let meets_goal = |node: &usize| {
        let end = End::at(vehicle, &node_knot(trajectory, *node), EndError::default());
        end.parts(family, vehicle, &limits).iter().all(|part| !exceeds(part.off[1], part.tolerance))
    };
    Some(if meets_goal(&last) { last } else { (0..last).find(meets_goal).unwrap_or(last) })
}

/// Planned time of arrival, s. `None` without nodes.
pub fn planned_arrival_s(scenario: &Scenario, vehicle: &Vehicle, trajectory: &Trajectory) -> Option<f64> {
    arrival_node(scenario, vehicle, trajectory).map(|node| trajectory.times_s()[node])
}

/// Where a plan's motion arrives. `None` if it ends before.
pub fn arrival_knot<'a>(
    scenario: &Scenario,
    vehicle: &Vehicle,
    trajectory: &Trajectory,
    motion: &'a Motion,
) -> Option<&'a Knot> {
    let node = arrival_node(scenario, vehicle, trajectory)?;
    if node + 1 == trajectory.times_s().len() {
        return motion.knots().last();
    }
    motion.knots().iter().find(|knot| knot.t_s >= trajectory.times_s()[node])
}

/// A node as a knot.
pub fn node_knot(trajectory: &Trajectory, node: usize) -> Knot {
    let nodes = trajectory.nodes();
    let (position_m, velocity_mps) = (nodes.position_m(node), nodes.velocity_mps(node));
    Knot { t_s: trajectory.times_s()[node], position_m, velocity_mps }
}

/// Where and how fast a vehicle ends.
#[derive(Clone, Debug)]
pub struct End {
    /// When, s.
    pub t_s: f64,
    /// Bounds of the distance from the goal, m.
    pub distance_m: [f64; 2],
    /// Over ground, m/s.
    pub velocity_mps: [f64; 3],
    /// How far the true end may be from it.
    pub error: EndError,
}

impl End {
    /// At a knot.
    pub fn at(vehicle: &Vehicle, &Knot { t_s, position_m, velocity_mps }: &Knot, error: EndError) -> Self {
        let distance_m = (Vector3::from(position_m) - Vector3::from(vehicle.goal.position_m())).norm();
        Self { t_s, distance_m: [distance_m; 2], velocity_mps, error }
    }

    /// What is asked of the end of a vehicle.
    pub fn parts(&self, family: Family, vehicle: &Vehicle, limits: &AppliedLimits) -> Vec<Part> {
        let position = Part {
            name: "position",
            unit: "m",
            off: widened(self.distance_m, self.error.position_m),
            tolerance: limits.goal_m,
            key: LimitKey::Verdict("goal_m"),
        };
        if family.hovers() {
            return vec![position];
        }
        [position].into_iter().chain(self.velocity_parts(vehicle, limits)).collect()
    }

    /// Heading, flight-path angle and speed.
    fn velocity_parts(&self, vehicle: &Vehicle, limits: &AppliedLimits) -> [Part; 3] {
        let (goal, [vx, vy, vz], error_mps) = (&vehicle.goal, self.velocity_mps, self.error.velocity_mps);
        let horizontal_mps = vx.hypot(vy);
        let speed_mps = horizontal_mps.hypot(vz);
        let turned_deg = (vy.atan2(vx).to_degrees() - goal.heading_deg).rem_euclid(360.0);
        let climb_deg = vz.atan2(horizontal_mps).to_degrees();
        let part = |name, unit, (off, error): (f64, f64), tolerance, field| Part {
            name,
            unit,
            off: widened([off; 2], error),
            tolerance,
            key: LimitKey::Verdict(field),
        };
        let heading = (turned_deg.min(360.0 - turned_deg), max_turn_deg(error_mps, horizontal_mps));
        let flight_path = ((climb_deg - goal.flight_path_deg).abs(), max_turn_deg(error_mps, speed_mps));
        let speed = ((speed_mps - goal.speed_mps).abs(), error_mps);
        [
            part("heading", "deg", heading, limits.goal_heading_deg, "goal_heading_deg"),
            part("flight-path angle", "deg", flight_path, limits.goal_flight_path_deg, "goal_flight_path_deg"),
            part("speed", "m/s", speed, limits.goal_speed_mps, "goal_speed_mps"),
        ]
    }
}

/// The bounds of a magnitude that is only known up to an error.
fn widened([lower, upper]: [f64; 2], error: f64) -> [f64; 2] {
    [if error > lower { 0.0 } else { lower - error }, upper + error]
}

/// One quantity of a goal.
pub struct Part {
    /// For people.
    pub name: &'static str,
    /// Of its values.
    pub unit: &'static str,
    /// Bounds of the difference from the goal, in `unit`.
    pub off: [f64; 2],
    /// The most that is allowed, in `unit`.
    pub tolerance: f64,
    /// The field of the tolerance.
    pub key: LimitKey,
}

impl Part {
    /// Whether it is worse than another one, as fractions of their tolerances.
    pub fn is_worse(&self, other: &Self) -> bool {
        let [own, others] = [self, other].map(|part| part.off.map(|off| off / part.tolerance));
        is_worse(own, others, 1.0)
    }
}

#[cfg(test)]
mod tests;
