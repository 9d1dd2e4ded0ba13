//! Acceptance test of a plan: its own flow must keep every constraint at all times.

use std::fmt;

use rayon::prelude::*;
use scenarios::{Range, Scenario};

use super::super::dynamics::State;
use super::super::iterate::Iterate;
use super::super::subproblem;
use super::avoidance_rows::AvoidanceConstraints;
use super::conflict_detection::{FleetMotion, ObstacleConflict};
use super::intersample_bounds::BOUNDED_STATES;
use super::refined_motion::{RefinedMotion, velocity_mps};
use crate::convex::STAGE_LEN;

/// Largest accepted violation of a limit, as a fraction of its range: rounding of the solver.
const LIMIT_TOLERANCE: f64 = 1e-6;
/// Largest accepted [defect](super::refined_motion::NodeDefect), m, if the scenario accepts no less.
const MAX_DEFECT_M: f64 = 0.1;
/// Largest accepted distance from the plan's end when its controls are integrated open loop from the start, as a fraction
/// of what the scenario accepts.
pub const MAX_ROLLOUT_FRACTION: f64 = 0.8;
/// Largest accepted distance of the ends of the plan from start and goal, m and m/s.
const MAX_END_ERROR: f64 = 0.001;
/// Largest accepted violation of a physical limit, as a fraction of the planned range.
const ROUNDING: f64 = 1e-12;

/// The worst violation of one kind of constraint.
#[derive(Clone, Debug, PartialEq)]
pub struct ConstraintViolation {
    /// The constraint.
    pub constraint: &'static str,
    /// Names of the vehicles and the obstacle involved.
    pub parties: Vec<String>,
    /// Time of the largest violation, s.
    pub at_s: f64,
    /// Amount of the violation, in `unit`.
    pub amount: f64,
    /// Unit of `amount`.
    pub unit: &'static str,
}

impl fmt::Display for ConstraintViolation {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        let Self { constraint, parties, at_s, amount, unit } = self;
        write!(f, "{constraint} of {} is violated by {amount:.3} {unit} at {at_s:.1} s", parties.join(" and "))
    }
}

/// The worst violation of the first kind of constraint that a plan violates; `None` if the plan can be flown.
///
/// The planner's own flow is tested first, then the motion in small steps.
pub fn first_violation(
    scenario: &Scenario,
    constraints: &AvoidanceConstraints,
    trajectories: &[Iterate],
    bounds: &[[Range; STAGE_LEN]],
    boundary: &[[State; 2]],
) -> Option<ConstraintViolation> {
    let limits = Limits { scenario, planned: bounds };
    let distances = |motion: &FleetMotion| {
        separation(scenario, motion, constraints).or_else(|| clearance(scenario, motion, constraints))
    };
    let motion = FleetMotion::new(trajectories);
    distances(&motion)
        .or_else(|| arrival(scenario, trajectories))
        .or_else(|| duration(scenario, trajectories))
        .or_else(|| ends(scenario, trajectories, boundary))
        .or_else(|| limits.controls(trajectories))
        .or_else(|| limits.states(&motion))
        .or_else(|| {
            let refined: Vec<RefinedMotion> = trajectories.par_iter().map(RefinedMotion::new).collect();
            dynamics(scenario, &refined).or_else(|| rollout(scenario, &refined)).or_else(|| {
                let vehicles = refined.into_iter().map(|refined| refined.motion).collect();
                let motion = FleetMotion::of_vehicles(vehicles);
                distances(&motion).or_else(|| limits.states(&motion))
            })
        })
}

fn separation(
    scenario: &Scenario,
    motion: &FleetMotion,
    constraints: &AvoidanceConstraints,
) -> Option<ConstraintViolation> {
    let separation_m = constraints.separation_m;
    let conflicts = motion.conflicts(separation_m);
    let worst = conflicts.iter().min_by(|a, b| a.approach.distance_m.total_cmp(&b.approach.distance_m))?;
    Some(ConstraintViolation {
        constraint: "separation",
        parties: worst.vehicles.map(|vehicle| scenario.vehicles[vehicle].name.clone()).into(),
        at_s: worst.at_s,
        amount: separation_m - worst.approach.distance_m,
        unit: "m",
    })
}

fn clearance(
    scenario: &Scenario,
    motion: &FleetMotion,
    constraints: &AvoidanceConstraints,
) -> Option<ConstraintViolation> {
    let conflicts = motion.obstacle_conflicts(constraints.cylinders, constraints.clearance_m);
    let distance_m = |at: &ObstacleConflict| at.approach.distance_m - constraints.cylinders[at.obstacle].radius_m;
    let worst = conflicts.iter().min_by(|a, b| distance_m(a).total_cmp(&distance_m(b)))?;
    Some(ConstraintViolation {
        constraint: "clearance",
        parties: vec![
            scenario.vehicles[worst.vehicle].name.clone(),
            constraints.cylinders[worst.obstacle].name.clone(),
        ],
        at_s: (worst.interval as f64 + worst.approach.fraction) * motion.vehicles[worst.vehicle].dt_s,
        amount: constraints.clearance_m - distance_m(worst),
        unit: "m",
    })
}

fn arrival(scenario: &Scenario, trajectories: &[Iterate]) -> Option<ConstraintViolation> {
    if !scenario.fleet.simultaneous_arrival {
        return None;
    }
    let by_time = |a: &&Iterate, b: &&Iterate| a.dt_s.total_cmp(&b.dt_s);
    let first = trajectories.iter().min_by(by_time)?;
    let last = trajectories.iter().max_by(by_time)?;
    let spread_s = last.flight_time_s() - first.flight_time_s();
    let name = |of: &Iterate| {
        trajectories.iter().position(|one| std::ptr::eq(one, of)).map(|i| scenario.vehicles[i].name.clone())
    };
    (spread_s != 0.0).then(|| ConstraintViolation {
        constraint: "simultaneous arrival",
        parties: [first, last].into_iter().filter_map(name).collect(),
        at_s: first.flight_time_s(),
        amount: spread_s,
        unit: "s",
    })
}

/// The longest flight against the time that is simulated.
fn duration(scenario: &Scenario, trajectories: &[Iterate]) -> Option<ConstraintViolation> {
    let max_s = scenario.simulation.max_duration_s;
    let times_s = trajectories.iter().map(Iterate::flight_time_s).enumerate();
    let (vehicle, time_s) = times_s.max_by(|a, b| a.1.total_cmp(&b.1))?;
    (!within(time_s, max_s)).then(|| ConstraintViolation {
        constraint: "simulation.max_duration_s",
        parties: vec![scenario.vehicles[vehicle].name.clone()],
        at_s: time_s,
        amount: time_s - max_s,
        unit: "s",
    })
}

/// Position, m, and velocity, m/s, of both ends against start and goal.
fn ends(scenario: &Scenario, trajectories: &[Iterate], boundary: &[[State; 2]]) -> Option<ConstraintViolation> {
    let errors = trajectories.iter().zip(boundary).enumerate().flat_map(|(vehicle, (trajectory, [start, goal]))| {
        let ends = [(0, start, 0.0), (trajectory.intervals(), goal, trajectory.flight_time_s())];
        ends.into_iter().flat_map(move |(k, expected, at_s)| {
            let state = &trajectory.states[k];
            let position_m = (state - expected).fixed_rows::<3>(0).norm();
            let speed_mps = (velocity_mps(state) - velocity_mps(expected)).norm();
            [(vehicle, at_s, position_m, "m"), (vehicle, at_s, speed_mps, "m/s")]
        })
    });
    let (vehicle, at_s, amount, unit) = errors.max_by(|a, b| a.2.total_cmp(&b.2))?;
    let parties = vec![scenario.vehicles[vehicle].name.clone()];
    (!within(amount, MAX_END_ERROR)).then_some(ConstraintViolation {
        constraint: "start or goal",
        parties,
        at_s,
        amount,
        unit,
    })
}

fn dynamics(scenario: &Scenario, motions: &[RefinedMotion]) -> Option<ConstraintViolation> {
    let defects = motions.iter().map(|motion| motion.defect).enumerate();
    let (vehicle, defect) = defects.max_by(|a, b| a.1.amount_m.total_cmp(&b.1.amount_m))?;
    let max_m = MAX_DEFECT_M.min(scenario.limits().dynamics_m);
    (!within(defect.amount_m, max_m)).then(|| ConstraintViolation {
        constraint: "dynamics",
        parties: vec![scenario.vehicles[vehicle].name.clone()],
        at_s: defect.at_s,
        amount: defect.amount_m,
        unit: "m",
    })
}

fn rollout(scenario: &Scenario, motions: &[RefinedMotion]) -> Option<ConstraintViolation> {
    let errors_m = motions.iter().map(|motion| motion.rollout_error_m).enumerate();
    let (vehicle, amount) = errors_m.max_by(|a, b| a.1.total_cmp(&b.1))?;
    let max_m = MAX_ROLLOUT_FRACTION * scenario.limits().rollout_m;
    (!within(amount, max_m)).then(|| ConstraintViolation {
        constraint: "rollout",
        parties: vec![scenario.vehicles[vehicle].name.clone()],
        at_s: motions[vehicle].motion.end_s(),
        amount,
        unit: "m",
    })
}

/// The limits of every vehicle. The planner promises the planned ones at all times, up to its solver's rounding; the
/// physical ones have no such tolerance.
struct Limits<'a> {
    scenario: &'a Scenario,
    planned: &'a [[Range; STAGE_LEN]],
}

impl Limits<'_> {
    fn states(&self, motion: &FleetMotion) -> Option<ConstraintViolation> {
        let mut worst = None;
        for (vehicle, motion) in motion.vehicles.iter().enumerate() {
            let physical = self.physical(vehicle);
            for k in 0..motion.intervals.len() {
                for quantity in BOUNDED_STATES {
                    let values = motion.extremes(k, quantity);
                    self.consider(&mut worst, vehicle, quantity, &physical, values, k as f64 * motion.dt_s);
                }
            }
        }
        worst
    }

    fn controls(&self, trajectories: &[Iterate]) -> Option<ConstraintViolation> {
        let mut worst = None;
        for (vehicle, trajectory) in trajectories.iter().enumerate() {
            let physical = self.physical(vehicle);
            for (k, control) in trajectory.controls.iter().enumerate() {
                for i in 0..3 {
                    let value = Range::new(control[i], control[i]);
                    self.consider(&mut worst, vehicle, 6 + i, &physical, value, k as f64 * trajectory.dt_s);
                }
            }
        }
        worst
    }

    fn physical(&self, vehicle: usize) -> [Range; STAGE_LEN] {
        let model = self.scenario.fixed_wing_model(&self.scenario.vehicles[vehicle]);
        subproblem::node_bounds(&model.limits, &self.scenario.world.map.inset(model.body_radius_m))
    }

    fn consider(
        &self,
        worst: &mut Option<ConstraintViolation>,
        vehicle: usize,
        quantity: usize,
        physical: &[Range; STAGE_LEN],
        values: Range,
        at_s: f64,
    ) {
        let beyond = |range: Range| (values.max - range.max).max(range.min - values.min);
        let planned = self.planned[vehicle][quantity];
        let (excess, width) = (beyond(planned), planned.width());
        let is_kept = within(excess, LIMIT_TOLERANCE * width) && within(beyond(physical[quantity]), ROUNDING * width);
        let is_unlimited = !width.is_finite() && excess.is_finite();
        if !is_kept && !is_unlimited && worst.as_ref().is_none_or(|worst| !within(excess, worst.amount)) {
            *worst = Some(ConstraintViolation {
                constraint: NAMES[quantity],
                parties: vec![self.scenario.vehicles[vehicle].name.clone()],
                at_s,
                amount: excess,
                unit: UNITS[quantity],
            });
        }
    }
}

const NAMES: [&str; STAGE_LEN] = ["x", "y", "altitude", "speed", "heading", "flight-path angle", "n_x", "n_y", "n_z"];
const UNITS: [&str; STAGE_LEN] = ["m", "m", "m", "m/s", "rad", "rad", "-", "-", "-"];

/// `value <= limit`; false for NaN.
fn within(value: f64, limit: f64) -> bool {
    value <= limit
}

#[cfg(test)]
mod tests;
