//! Arrival: the time between the first and the last arrival, and the flight time.
//!
//! The plan of a vehicle that can hover may go on at its goal while others are under way: it has arrived when it moves no
//! more, and in the loop, where the plan comes into being, when it stays within the tolerance of its goal from then on. A
//! fixed wing passes its goal: in flight its arrival is the closest approach to it over continuous time, searched for from
//! 10 s before the planned arrival to the end of the log, or to 10 s after it if the plan goes on beyond the goal. The simulator coasts beyond the end of the plan, so that a late
//! arrival is in the log. A vehicle that is closest to its goal at the very end of that time has not arrived.

use nalgebra::Vector3;
use scenarios::{CheckSpec, Plan, Scenario, Trajectory, Vehicle};

use crate::verdict::Check;
use crate::verdict::compare::exceeds;
use crate::verdict::end::planned_arrival_s;
use crate::verdict::evidence::{CheckResult, Decide, Evidence, Measurement};
use crate::verdict::flown::{FlownMotions, FlownVehicle};
use crate::verdict::missing_evidence::MissingEvidence;

/// A vehicle that stays this close to the end of its plan waits there, m.
const SETTLED_M: f64 = 0.01;

/// Time between the first and the last planned arrival.
pub fn check_planned_arrival(spec: &CheckSpec, scenario: &Scenario, plan: Evidence<'_, Plan>) -> CheckResult {
    if !scenario.fleet.simultaneous_arrival {
        return Ok(any_time(spec));
    }
    let ends = plan?.trajectories.iter().zip(&scenario.vehicles).map(|(trajectory, vehicle)| {
        let early = || MissingEvidence::EndsEarly { vehicle: vehicle.name.clone() };
        let arrival_s = planned_arrival_s(scenario, vehicle, trajectory).ok_or_else(early)?;
        Ok((settled_s(trajectory).unwrap_or(arrival_s), vehicle.name.as_str()))
    });
    Ok(spec.at_most(spread(ends)?, scenario.limits().arrival_spread_s))
}

/// Time between the first and the last arrival in flight.
pub fn check_flown_arrival(
    spec: &CheckSpec,
    scenario: &Scenario,
    plan: &Plan,
    flown: Evidence<'_, FlownMotions<'_>>,
    is_planned_in_loop: bool,
) -> CheckResult {
    if !scenario.fleet.simultaneous_arrival {
        return Ok(any_time(spec));
    }
    let tolerance_m = scenario.limits().goal_m;
    let flown = flown?.vehicles.iter().zip(&scenario.vehicles).zip(&plan.trajectories);
    let arrivals = flown.map(|((flown, vehicle), trajectory)| {
        let arrival_s = flown.arrival_s().ok_or_else(|| not_arrived(flown))?;
        let samples = flown.tracked.iter().map(|sample| (sample.t_s, sample.position_m));
        let reached_s = if is_planned_in_loop {
            reached_s(samples, vehicle, tolerance_m)
        } else {
            settled_s(trajectory).filter(|settled_s| *settled_s < arrival_s)
        };
        Ok((reached_s.unwrap_or(arrival_s), flown.name))
    });
    Ok(spec.at_most(spread(arrivals)?, scenario.limits().arrival_spread_s))
}

/// Planned flight time.
pub fn check_planned_duration(spec: &CheckSpec, scenario: &Scenario, plan: &Plan) -> CheckResult {
    let duration_s = plan.flight_time_s().ok_or(MissingEvidence::NoPlan)?;
    Ok(spec.at_most(Measurement::value(duration_s), scenario.simulation.max_duration_s))
}

/// [Duration](duration_s) of the flight.
pub fn check_flown_duration(spec: &CheckSpec, scenario: &Scenario, flown: &FlownMotions<'_>) -> Check {
    spec.at_most(Measurement::value(duration_s(flown)), scenario.simulation.max_duration_s)
}

/// Time until the last vehicle has arrived, s. A vehicle that does not arrive counts until the end of its log.
pub fn duration_s(flown: &FlownMotions<'_>) -> f64 {
    flown.vehicles.iter().map(|vehicle| vehicle.arrival_s().unwrap_or(vehicle.log_end_s)).fold(0.0, f64::max)
}

/// Time from which on a plan keeps a vehicle that can hover where it ends, s; `None` for others.
fn settled_s(trajectory: &Trajectory) -> Option<f64> {
    if !trajectory.family().hovers() {
        return None;
    }
    let nodes = trajectory.nodes();
    let end_m = Vector3::from(nodes.position_m(trajectory.times_s().len().checked_sub(1)?));
    let is_there = |row: &usize| (Vector3::from(nodes.position_m(*row)) - end_m).norm() <= SETTLED_M;
    let first = (0..trajectory.times_s().len()).rev().take_while(is_there).last()?;
    Some(trajectory.times_s()[first])
}

/// Time from which on a vehicle stays within `tolerance_m` of its goal, s; `None` if it does not at the end.
///
/// - `positions_m`: in the order of time, s
pub(super) fn reached_s(
    positions_m: impl Iterator<Item = (f64, [f64; 3])>,
    vehicle: &Vehicle,
    tolerance_m: f64,
) -> Option<f64> {
    let goal_m = Vector3::from(vehicle.goal.position_m());
    let (mut outside, mut reached_s) = (None, None);
    for (t_s, position_m) in positions_m {
        let beyond_m = (Vector3::from(position_m) - goal_m).norm() - tolerance_m;
        if exceeds(beyond_m, 0.0) {
            (outside, reached_s) = (Some((t_s, beyond_m)), None);
        } else if reached_s.is_none() {
            // Linear between the last position outside and the first one inside.
            let crossing_s = |(from_s, from_m): (f64, f64)| from_s + (t_s - from_s) * from_m / (from_m - beyond_m);
            reached_s = Some(outside.map_or(t_s, crossing_s));
        }
    }
    reached_s
}

pub(super) fn any_time(spec: &CheckSpec) -> Check {
    spec.skip("the vehicles may arrive at different times")
}

fn spread<'a>(
    arrivals: impl Iterator<Item = Result<(f64, &'a str), MissingEvidence>>,
) -> Result<Measurement, MissingEvidence> {
    let arrivals: Vec<(f64, &str)> = arrivals.collect::<Result<_, _>>()?;
    let earliest = arrivals.iter().min_by(|a, b| a.0.total_cmp(&b.0)).ok_or(MissingEvidence::NoVehicle)?;
    let latest = arrivals.iter().max_by(|a, b| a.0.total_cmp(&b.0)).ok_or(MissingEvidence::NoVehicle)?;
    Ok(Measurement::value(latest.0 - earliest.0).at(latest.0).with(earliest.1).with(latest.1))
}

/// Why a vehicle has no arrival.
pub fn not_arrived(vehicle: &FlownVehicle<'_>) -> MissingEvidence {
    let (name, log_end_s) = (vehicle.name.to_owned(), vehicle.log_end_s);
    match vehicle.approach {
        None => MissingEvidence::NeverNearGoal { vehicle: name, log_end_s },
        Some(approach) => MissingEvidence::NotArrived { vehicle: name, distance_m: approach.upper_m, log_end_s },
    }
}

#[cfg(test)]
mod tests {
    use std::path::Path;

    use super::reached_s;

    /// Along x to the goal at 2 m/s: 0.5 m before it at 9.75 s, between the positions at 9 and 10 s.
    #[test]
    fn the_goal_is_reached_between_the_last_position_outside_and_the_first_one_inside() {
        let file = Path::new(env!("CARGO_MANIFEST_DIR")).join("scenarios/multirotor/trap.toml");
        let vehicle = scenarios::load(&file).unwrap().vehicles.remove(0);
        let [x, y, z] = vehicle.goal.position_m();
        let path = |turns_back: bool| {
            (0..=12_u32).map(move |t_s| {
                let ahead_m = 2.0 * (10.0 - f64::from(t_s)).max(if turns_back && t_s == 11 { 2.0 } else { 0.0 });
                (f64::from(t_s), [x - ahead_m, y, z])
            })
        };
        let reached = reached_s(path(false), &vehicle, 0.5).unwrap();
        assert!((reached - 9.75).abs() < 1e-12, "{reached}");
        // It leaves again: the last time counts.
        let reached = reached_s(path(true), &vehicle, 0.5).unwrap();
        assert!((reached - (11.0 + 3.5 / 4.0)).abs() < 1e-12, "{reached}");
        assert_eq!(reached_s(path(false).take(10), &vehicle, 0.5), None);
        assert_eq!(reached_s(path(false).skip(11), &vehicle, 0.5), Some(11.0));
    }
}
