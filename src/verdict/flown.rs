//! The part of a flight that is judged, and when each vehicle arrived.

use rayon::prelude::*;
use scenarios::{Plan, Scenario, Trajectory, Vehicle};
use sim::{Flight, Sample, VehicleLog};

use crate::verdict::closest::{self, ClosestApproach};
use crate::verdict::end::planned_arrival_s;
use crate::verdict::missing_evidence::MissingEvidence;
use crate::verdict::motion::{Knot, Motion};

/// An arrival is searched for from this long before the planned one to the end of the log, or to this long after it if the
/// plan goes on, s.
const ARRIVAL_WINDOW_S: f64 = 10.0;
/// A closest approach this close to the end of the search is no arrival, since the vehicle was still approaching, s.
const SEARCH_END_S: f64 = 1e-6;

/// A flight whose logs can be matched with the vehicles.
///
/// A fixed wing is judged until its planned end, or until it arrives if that is later; one that does not arrive is judged
/// until the end of its log. A vehicle that hovers is judged until the planned end of the last one. The coasting after that is
/// not part of the mission.
#[derive(Clone, Debug)]
pub struct FlownMotions<'a> {
    /// The motion of every vehicle while it is judged.
    pub motions: Vec<Motion>,
    /// Every vehicle's log, in the same order.
    pub vehicles: Vec<FlownVehicle<'a>>,
}

/// One vehicle's log.
#[derive(Clone, Debug)]
pub struct FlownVehicle<'a> {
    /// Its name.
    pub name: &'a str,
    /// The steps that are judged.
    pub judged: &'a [Sample],
    /// The steps during which it follows the plan.
    pub tracked: &'a [Sample],
    /// End of the judged steps, s.
    pub judged_end_s: f64,
    /// End of the log, s.
    pub log_end_s: f64,
    /// Closest approach to the goal, from 10 s before the planned arrival on; `None` if the log ends before.
    pub approach: Option<ClosestApproach>,
    /// Until when that is searched for, s.
    search_end_s: f64,
}

impl<'a> FlownMotions<'a> {
    /// Matches the logs with the vehicles of a flyable plan.
    ///
    /// # Errors
    ///
    /// The logs are not those of the scenario's vehicles, or a log cannot be judged.
    pub fn new(scenario: &'a Scenario, plan: &Plan, flight: &'a Flight) -> Result<Self, MissingEvidence> {
        let (logs, vehicles) = (flight.vehicles.len(), scenario.vehicles.len());
        if logs != vehicles {
            return Err(MissingEvidence::LogCount { logs, vehicles });
        }
        let matched = scenario.vehicles.par_iter().zip(&plan.trajectories).zip(&flight.vehicles);
        let parts = matched.map(|((vehicle, trajectory), log)| {
            judged_part(scenario, vehicle, trajectory, log, plan.flight_time_s().unwrap_or(0.0))
        });
        let mut flown = Self { motions: Vec::new(), vehicles: Vec::new() };
        for part in parts.collect::<Vec<_>>() {
            let (motion, vehicle) = part?;
            flown.motions.push(motion);
            flown.vehicles.push(vehicle);
        }
        Ok(flown)
    }
}

impl FlownMotions<'_> {
    /// The end of the mission, s: until then some vehicle is judged.
    pub fn mission_end_s(&self) -> f64 {
        self.vehicles.iter().map(|vehicle| vehicle.judged_end_s).fold(0.0, f64::max)
    }
}

impl FlownVehicle<'_> {
    /// Time of its arrival, s; `None` if it did not arrive.
    pub fn arrival_s(&self) -> Option<f64> {
        self.approach.map(|approach| approach.at_s).filter(|&at_s| at_s < self.search_end_s - SEARCH_END_S)
    }
}

fn judged_part<'a>(
    scenario: &Scenario,
    vehicle: &'a Vehicle,
    trajectory: &Trajectory,
    log: &'a VehicleLog,
    plan_end_s: f64,
) -> Result<(Motion, FlownVehicle<'a>), MissingEvidence> {
    if log.vehicle != vehicle.name {
        return Err(MissingEvidence::LogOrder { found: log.vehicle.clone(), expected: vehicle.name.clone() });
    }
    let mut motion = Motion::new(&vehicle.name, log.samples.iter().map(knot).collect())?.sampled();
    let hovers = trajectory.family().hovers();
    let planned_end_s = trajectory.end_s().unwrap_or(0.0);
    let planned_arrival_s = planned_arrival_s(scenario, vehicle, trajectory).unwrap_or(0.0);
    let goes_on = planned_arrival_s < planned_end_s;
    let search_end_s = if goes_on { planned_arrival_s + ARRIVAL_WINDOW_S } else { motion.end_s() };
    let search_s = [planned_arrival_s - ARRIVAL_WINDOW_S, search_end_s.min(motion.end_s())];
    let mut flown = FlownVehicle {
        name: &vehicle.name,
        judged: &log.samples,
        tracked: until(&log.samples, planned_end_s),
        judged_end_s: motion.end_s(),
        log_end_s: motion.end_s(),
        approach: if hovers {
            hovering(&motion, planned_end_s, vehicle.goal.position_m())
        } else {
            closest::to_point(&motion, search_s, vehicle.goal.position_m())
        },
        search_end_s: search_s[1],
    };
    let mission_end_s = if hovers { plan_end_s } else { planned_end_s };
    let judged_end_s = flown.arrival_s().unwrap_or(flown.log_end_s).max(mission_end_s);
    motion.end_at(judged_end_s);
    flown.judged = until(&log.samples, judged_end_s);
    flown.judged_end_s = judged_end_s;
    Ok((motion, flown))
}

/// The arrival of a vehicle that hovers at its goal: the end of its plan. `None` if the log ends before.
fn hovering(motion: &Motion, planned_end_s: f64, goal_m: [f64; 3]) -> Option<ClosestApproach> {
    let position_m = motion.position_m(planned_end_s)?;
    let distance_m = (0..3).map(|axis| (position_m[axis] - goal_m[axis]).powi(2)).sum::<f64>().sqrt();
    Some(ClosestApproach { lower_m: distance_m, upper_m: distance_m, at_s: planned_end_s, who: [0, 0] })
}

/// The samples up to the first one at or beyond `t_s`.
fn until(samples: &[Sample], t_s: f64) -> &[Sample] {
    let beyond = samples.partition_point(|sample| sample.t_s < t_s);
    &samples[..(beyond + 1).min(samples.len())]
}

/// A sample of a log as a knot.
pub fn knot(sample: &Sample) -> Knot {
    Knot { t_s: sample.t_s, position_m: sample.position_m, velocity_mps: sample.velocity_mps }
}
