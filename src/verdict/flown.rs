//! The flight as the judge looks at it: which part of it counts, and when each vehicle arrived.

use rayon::prelude::*;
use scenarios::{Plan, Scenario, Trajectory, Vehicle};
use sim::{Flight, Sample, VehicleLog};

use crate::verdict::closest::{self, ClosestApproach};
use crate::verdict::motion::{Knot, Motion};

/// An arrival is looked for from this long before the planned one to the end of the log, s.
const ARRIVAL_WINDOW_S: f64 = 10.0;
/// A closest approach within this of the log's end is no arrival: the vehicle was still on its way, s.
const LOG_END_S: f64 = 1e-6;

/// A flight whose logs can be matched with the vehicles.
///
/// A vehicle is judged until its planned end, or until it arrives if that is later; a vehicle that does not arrive,
/// until its log ends. The coasting after that is no part of the mission.
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
    /// End of the log, s.
    pub log_end_s: f64,
    /// Closest approach to the goal, from 10 s before the planned arrival on; `None` if the log ends before.
    pub approach: Option<ClosestApproach>,
}

impl<'a> FlownMotions<'a> {
    /// Matches the logs with the vehicles of a flyable plan. Refuses with the reason if they cannot be.
    pub fn new(scenario: &'a Scenario, plan: &Plan, flight: &'a Flight) -> Result<Self, String> {
        let (logs, vehicles) = (flight.vehicles.len(), scenario.vehicles.len());
        if logs != vehicles {
            return Err(format!("the flight has the logs of {logs} vehicles, the scenario has {vehicles} vehicles"));
        }
        let matched = scenario.vehicles.par_iter().zip(&plan.trajectories).zip(&flight.vehicles);
        let parts = matched.map(|((vehicle, trajectory), log)| part_that_counts(vehicle, trajectory, log));
        let mut flown = Self { motions: Vec::new(), vehicles: Vec::new() };
        for part in parts.collect::<Vec<_>>() {
            let (motion, vehicle) = part?;
            flown.motions.push(motion);
            flown.vehicles.push(vehicle);
        }
        Ok(flown)
    }
}

impl FlownVehicle<'_> {
    /// When it arrived, s; `None` if it did not.
    pub fn arrival_s(&self) -> Option<f64> {
        self.approach.map(|approach| approach.at_s).filter(|&at_s| at_s < self.log_end_s - LOG_END_S)
    }
}

fn part_that_counts<'a>(
    vehicle: &'a Vehicle,
    trajectory: &Trajectory,
    log: &'a VehicleLog,
) -> Result<(Motion, FlownVehicle<'a>), String> {
    if log.vehicle != vehicle.name {
        return Err(format!("the log of {} stands where that of {} belongs", log.vehicle, vehicle.name));
    }
    let mut motion = Motion::new(&vehicle.name, log.samples.iter().map(knot).collect())?.sampled();
    let planned_end_s = trajectory.end_s().unwrap_or(0.0);
    let window_s = planned_end_s - ARRIVAL_WINDOW_S;
    let mut flown = FlownVehicle {
        name: &vehicle.name,
        judged: &log.samples,
        tracked: until(&log.samples, planned_end_s),
        log_end_s: motion.end_s(),
        approach: match trajectory {
            Trajectory::FixedWing(_) => closest::to_point(&motion, window_s, vehicle.goal.position_m()),
            Trajectory::SlungLoad(_) | Trajectory::Multirotor(_) => {
                hovering(&motion, planned_end_s, vehicle.goal.position_m())
            }
        },
    };
    let judged_end_s = flown.arrival_s().unwrap_or(flown.log_end_s).max(planned_end_s);
    motion.end_at(judged_end_s);
    flown.judged = until(&log.samples, judged_end_s);
    Ok((motion, flown))
}

/// A vehicle that hovers at its goal has arrived when its plan ends; `None` if the log ends before.
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

fn knot(sample: &Sample) -> Knot {
    Knot { t_s: sample.t_s, position_m: sample.position_m, velocity_mps: sample.velocity_mps }
}
