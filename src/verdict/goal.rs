//! Goals: the position in which a vehicle ends and, of fixed wings, its velocity.
//!
//! The parts of a goal have tolerances of different units, so that they are compared as fractions of their tolerances; the
//! check reports the worst one. Headings are compared modulo a full turn. Velocities are over ground. Of a vehicle
//! that hovers the position alone is asked here: whether it has come to rest is a check of its own.
//!
//! A vehicle that hovers arrives where its plan ends. A fixed wing cannot stop: its plan may go on beyond the goal, so that it
//! stays clear of the others until the last one has arrived ([`arrival_node`]).

use nalgebra::Vector3;
use scenarios::{AppliedLimits, CheckSpec, Family, Plan, Scenario, Trajectory, Vehicle};
use sim::Sample;

use crate::verdict::arrival::not_arrived;
use crate::verdict::compare::{exceeds, is_worse};
use crate::verdict::evidence::{CheckResult, Decide, Measurement};
use crate::verdict::flown::FlownMotions;
use crate::verdict::missing_evidence::MissingEvidence;
use crate::verdict::motion::{Knot, Motion};
use crate::verdict::reconstruction::max_turn_deg;
use crate::verdict::tube::EndError;
use crate::verdict::{Check, LimitKey};

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

fn node_knot(trajectory: &Trajectory, node: usize) -> Knot {
    let nodes = trajectory.nodes();
    let (position_m, velocity_mps) = (nodes.position_m(node), nodes.velocity_mps(node));
    Knot { t_s: trajectory.times_s()[node], position_m, velocity_mps }
}

/// The nodes of arrival.
///
/// - `error`: of the end of the vehicle with this index
pub fn check_nodes(
    spec: &CheckSpec,
    scenario: &Scenario,
    plan: &Plan,
    error: impl Fn(usize, &Knot) -> EndError,
) -> CheckResult {
    check_worst(spec, scenario, |index| {
        let (vehicle, trajectory) = (&scenario.vehicles[index], &plan.trajectories[index]);
        let node = arrival_node(scenario, vehicle, trajectory).ok_or_else(|| ends_early(scenario, index))?;
        let end = node_knot(trajectory, node);
        Ok(End::at(vehicle, &end, error(index, &end)))
    })
}

/// The continuous plan at arrival.
///
/// - `error`: of the end of the vehicle with this index
pub fn check_planned(
    spec: &CheckSpec,
    scenario: &Scenario,
    plan: &Plan,
    motions: &[Motion],
    error: impl Fn(usize, &Knot) -> EndError,
) -> CheckResult {
    check_worst(spec, scenario, |index| {
        let vehicle = &scenario.vehicles[index];
        let end = arrival_knot(scenario, vehicle, &plan.trajectories[index], &motions[index]);
        let end = end.ok_or_else(|| ends_early(scenario, index))?;
        Ok(End::at(vehicle, end, error(index, end)))
    })
}

/// The closest approaches in flight.
///
/// - `error`: of the end of the plan of the vehicle with this index
pub fn check_flown(
    spec: &CheckSpec,
    scenario: &Scenario,
    flown: &FlownMotions<'_>,
    error: impl Fn(usize) -> EndError,
) -> CheckResult {
    check_worst(spec, scenario, |index| {
        let vehicle = &flown.vehicles[index];
        let approach = vehicle.approach.ok_or_else(|| not_arrived(vehicle))?;
        let velocity_mps = velocity_mps(vehicle.judged, approach.at_s).unwrap_or([f64::NAN; 3]);
        let distance_m = [approach.lower_m, approach.upper_m];
        Ok(End { t_s: approach.at_s, distance_m, velocity_mps, error: error(index) })
    })
}

/// Where and how fast a vehicle ends.
struct End {
    t_s: f64,
    /// Bounds of the distance from the goal, m.
    distance_m: [f64; 2],
    velocity_mps: [f64; 3],
    error: EndError,
}

impl End {
    fn at(vehicle: &Vehicle, &Knot { t_s, position_m, velocity_mps }: &Knot, error: EndError) -> Self {
        let distance_m = (Vector3::from(position_m) - Vector3::from(vehicle.goal.position_m())).norm();
        Self { t_s, distance_m: [distance_m; 2], velocity_mps, error }
    }

    /// What is asked of the end of a vehicle.
    fn parts(&self, family: Family, vehicle: &Vehicle, limits: &AppliedLimits) -> Vec<Part> {
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
struct Part {
    name: &'static str,
    unit: &'static str,
    /// Bounds of the difference from the goal, in `unit`.
    off: [f64; 2],
    tolerance: f64,
    key: LimitKey,
}

impl Part {
    /// Whether it is worse than another one, as fractions of their tolerances.
    fn is_worse(&self, other: &Self) -> bool {
        let [own, others] = [self, other].map(|part| part.off.map(|off| off / part.tolerance));
        is_worse(own, others, 1.0)
    }
}

/// The check of the part, of any vehicle, that uses most of its tolerance.
///
/// - `end`: of the vehicle with this index
fn check_worst(
    spec: &CheckSpec,
    scenario: &Scenario,
    end: impl Fn(usize) -> Result<End, MissingEvidence>,
) -> CheckResult {
    let (family, limits) = (scenario.family(), scenario.limits());
    let mut worst: Option<(Part, f64, &str)> = None;
    for (index, vehicle) in scenario.vehicles.iter().enumerate() {
        let end = end(index)?;
        for part in end.parts(family, vehicle, &limits) {
            if worst.as_ref().is_none_or(|(worst, ..)| part.is_worse(worst)) {
                worst = Some((part, end.t_s, &vehicle.name));
            }
        }
    }
    let (part, t_s, vehicle) = worst.ok_or(MissingEvidence::NoVehicle)?;
    Ok(check_part(spec, family, &part, t_s, vehicle))
}

fn check_part(spec: &CheckSpec, family: Family, part: &Part, t_s: f64, vehicle: &str) -> Check {
    let [lower, upper] = part.off;
    let measured = if lower == upper { Measurement::value(upper) } else { Measurement::bounds(lower, upper) };
    let measured = measured.at(t_s).with(vehicle);
    let measured = if family.hovers() { measured } else { measured.with_reason(format!("it is the {}", part.name)) };
    let spec = CheckSpec { unit: part.unit, ..*spec };
    Check { limit_key: Some(part.key), ..spec.at_most(measured, part.tolerance) }
}

fn ends_early(scenario: &Scenario, index: usize) -> MissingEvidence {
    MissingEvidence::EndsEarly { vehicle: scenario.vehicles[index].name.clone() }
}

/// Velocity at `t_s`, between two samples the interpolated one, m/s.
fn velocity_mps(samples: &[Sample], t_s: f64) -> Option<[f64; 3]> {
    let after = samples.partition_point(|sample| sample.t_s < t_s);
    let [before, after] = [samples.get(after.saturating_sub(1))?, samples.get(after).or(samples.last())?];
    let span_s = after.t_s - before.t_s;
    let fraction = if span_s > 0.0 { (t_s - before.t_s) / span_s } else { 0.0 };
    Some(std::array::from_fn(|axis| {
        before.velocity_mps[axis] + fraction * (after.velocity_mps[axis] - before.velocity_mps[axis])
    }))
}
