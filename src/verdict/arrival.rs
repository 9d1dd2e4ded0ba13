//! Do the vehicles reach their goals, together if they must, and in time?
//!
//! In flight the arrival is the closest approach to the goal over continuous time, looked for from 10 s before the
//! planned arrival to the end of the log. The simulator coasts beyond the plan's end, so that a late arrival can be
//! seen; a vehicle that is closest at the very end of its log has not arrived.

use scenarios::{CheckSpec, Plan, Scenario};

use crate::verdict::Check;
use crate::verdict::compare::is_larger;
use crate::verdict::evidence::{Decide, Evidence, Measurement};
use crate::verdict::flown::{FlownMotions, FlownVehicle};
use crate::verdict::motion::Motion;

/// Largest distance from a goal to the last node.
pub fn check_node_goals(spec: &CheckSpec, scenario: &Scenario, plan: Evidence<'_, Plan>) -> Check {
    goal_answer(spec, scenario, plan, |plan| {
        let last = |index: usize| {
            let trajectory = &plan.trajectories[index];
            let last = trajectory.times_s().len().checked_sub(1)?;
            Some((trajectory.nodes().position_m(last), trajectory.times_s()[last]))
        };
        farthest_end(scenario, last)
    })
}

/// Largest distance from a goal to the end of the continuous plan.
pub fn check_planned_goals(spec: &CheckSpec, scenario: &Scenario, motions: Evidence<'_, [Motion]>) -> Check {
    goal_answer(spec, scenario, motions, |motions| {
        farthest_end(scenario, |index| motions[index].knots().last().map(|knot| (knot.position_m, knot.t_s)))
    })
}

/// Largest distance from a goal at the closest approach in flight.
pub fn check_flown_goals(spec: &CheckSpec, scenario: &Scenario, flown: Evidence<'_, FlownMotions<'_>>) -> Check {
    goal_answer(spec, scenario, flown, |flown| {
        let mut farthest: Option<(f64, Measurement)> = None;
        for vehicle in &flown.vehicles {
            let approach = vehicle.approach.ok_or_else(|| never_near(vehicle))?;
            if farthest.as_ref().is_none_or(|(distance_m, _)| is_larger(approach.upper_m, *distance_m)) {
                farthest = Some((approach.upper_m, Measurement::approach(&approach).with(vehicle.name)));
            }
        }
        farthest.map(|(_, measured)| measured).ok_or_else(|| "there is no vehicle".to_owned())
    })
}

/// Difference between the earliest and the latest end of a trajectory.
pub fn check_planned_arrival(spec: &CheckSpec, scenario: &Scenario, plan: Evidence<'_, Plan>) -> Check {
    arrival_answer(spec, scenario, plan, |plan| {
        let ends = plan
            .trajectories
            .iter()
            .map(|trajectory| trajectory.end_s().map(|end_s| (end_s, trajectory.vehicle())).ok_or_else(String::new));
        spread(ends)
    })
}

/// Difference between the earliest and the latest arrival in flight.
pub fn check_flown_arrival(spec: &CheckSpec, scenario: &Scenario, flown: Evidence<'_, FlownMotions<'_>>) -> Check {
    arrival_answer(spec, scenario, flown, |flown| {
        spread(flown.vehicles.iter().map(|vehicle| {
            let arrival_s = vehicle.arrival_s().ok_or_else(|| never_near(vehicle))?;
            Ok((arrival_s, vehicle.name))
        }))
    })
}

/// Time that the plan takes.
pub fn check_planned_duration(spec: &CheckSpec, scenario: &Scenario, plan: Evidence<'_, Plan>) -> Check {
    match plan.map(Plan::flight_time_s) {
        Err(reason) => spec.fail(reason),
        Ok(None) => spec.fail("the plan has no trajectory"),
        Ok(Some(duration_s)) => spec.at_most(Measurement::value(duration_s), scenario.simulation.max_duration_s),
    }
}

/// Time until the last vehicle has arrived; to the end of its log for one that does not arrive.
pub fn check_flown_duration(spec: &CheckSpec, scenario: &Scenario, flown: Evidence<'_, FlownMotions<'_>>) -> Check {
    match flown {
        Err(reason) => spec.fail(reason),
        Ok(flown) => spec.at_most(Measurement::value(duration_s(flown)), scenario.simulation.max_duration_s),
    }
}

/// Time until the last vehicle has arrived; to the end of its log for one that does not arrive, s.
pub fn duration_s(flown: &FlownMotions<'_>) -> f64 {
    flown.vehicles.iter().map(|vehicle| vehicle.arrival_s().unwrap_or(vehicle.log_end_s)).fold(0.0, f64::max)
}

fn goal_answer<T: ?Sized>(
    spec: &CheckSpec,
    scenario: &Scenario,
    evidence: Evidence<'_, T>,
    measure: impl Fn(&T) -> Result<Measurement, String>,
) -> Check {
    match evidence.map(measure) {
        Err(reason) => spec.fail(reason),
        Ok(Err(reason)) => spec.fail(reason),
        Ok(Ok(measured)) => spec.at_most(measured, scenario.limits().goal_m),
    }
}

fn arrival_answer<T: ?Sized>(
    spec: &CheckSpec,
    scenario: &Scenario,
    evidence: Evidence<'_, T>,
    measure: impl Fn(&T) -> Result<Measurement, String>,
) -> Check {
    if !scenario.fleet.simultaneous_arrival {
        return spec.skip("the vehicles may arrive at different times");
    }
    match evidence.map(measure) {
        Err(reason) => spec.fail(reason),
        Ok(Err(reason)) => spec.fail(reason),
        Ok(Ok(measured)) => spec.at_most(measured, scenario.limits().arrival_spread_s),
    }
}

fn farthest_end(scenario: &Scenario, end: impl Fn(usize) -> Option<([f64; 3], f64)>) -> Result<Measurement, String> {
    let mut farthest: Option<(f64, f64, &str)> = None;
    for (index, vehicle) in scenario.vehicles.iter().enumerate() {
        let (position_m, t_s) = end(index).ok_or_else(|| format!("the trajectory of {} has no end", vehicle.name))?;
        let goal_m = vehicle.goal.position_m();
        let distance_m = (0..3).map(|axis| (position_m[axis] - goal_m[axis]).powi(2)).sum::<f64>().sqrt();
        if farthest.is_none_or(|(worst_m, ..)| is_larger(distance_m, worst_m)) {
            farthest = Some((distance_m, t_s, &vehicle.name));
        }
    }
    let (distance_m, t_s, vehicle) = farthest.ok_or("there is no vehicle")?;
    Ok(Measurement::value(distance_m).at(t_s).with(vehicle))
}

fn spread<'a>(arrivals: impl Iterator<Item = Result<(f64, &'a str), String>>) -> Result<Measurement, String> {
    let arrivals: Vec<(f64, &str)> = arrivals.collect::<Result<_, _>>()?;
    let earliest = arrivals.iter().min_by(|a, b| a.0.total_cmp(&b.0)).ok_or("there is no vehicle")?;
    let latest = arrivals.iter().max_by(|a, b| a.0.total_cmp(&b.0)).ok_or("there is no vehicle")?;
    Ok(Measurement::value(latest.0 - earliest.0).at(latest.0).with(earliest.1).with(latest.1))
}

fn never_near(vehicle: &FlownVehicle<'_>) -> String {
    let FlownVehicle { name, log_end_s, approach, .. } = vehicle;
    match approach {
        None => format!("{name} never came near its goal: its log ends at {log_end_s:.3} s"),
        Some(approach) => format!(
            "{name} has not arrived: it is still coming nearer, {:.3} m from its goal, when its log ends at {log_end_s:.3} s",
            approach.upper_m
        ),
    }
}
