//! Arrival: the time between the first and the last arrival, and the flight time.
//!
//! In flight the arrival is the closest approach to the goal over continuous time, searched for from 10 s before the planned
//! arrival to the end of the log. The simulator coasts beyond the end of the plan, so that a late arrival is in the log. A
//! vehicle that is closest to its goal at the very end of its log has not arrived.

use scenarios::{CheckSpec, Plan, Scenario};

use crate::verdict::Check;
use crate::verdict::evidence::{CheckResult, Decide, Evidence, Measurement};
use crate::verdict::flown::{FlownMotions, FlownVehicle};
use crate::verdict::missing_evidence::MissingEvidence;

/// Time between the first and the last end of a trajectory.
pub fn check_planned_arrival(spec: &CheckSpec, scenario: &Scenario, plan: Evidence<'_, Plan>) -> CheckResult {
    if !scenario.fleet.simultaneous_arrival {
        return Ok(any_time(spec));
    }
    let ends = plan?.trajectories.iter().map(|trajectory| {
        let early = || MissingEvidence::EndsEarly { vehicle: trajectory.vehicle().to_owned() };
        Ok((trajectory.end_s().ok_or_else(early)?, trajectory.vehicle()))
    });
    Ok(spec.at_most(spread(ends)?, scenario.limits().arrival_spread_s))
}

/// Time between the first and the last arrival in flight.
pub fn check_flown_arrival(
    spec: &CheckSpec,
    scenario: &Scenario,
    flown: Evidence<'_, FlownMotions<'_>>,
) -> CheckResult {
    if !scenario.fleet.simultaneous_arrival {
        return Ok(any_time(spec));
    }
    let arrivals = flown?.vehicles.iter().map(|vehicle| {
        let arrival_s = vehicle.arrival_s().ok_or_else(|| not_arrived(vehicle))?;
        Ok((arrival_s, vehicle.name))
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

fn any_time(spec: &CheckSpec) -> Check {
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
