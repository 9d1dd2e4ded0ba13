//! Acceptance test of a plan: its own flow must keep every constraint at all times.

use std::fmt;

use rayon::prelude::*;
use scenarios::{Range, Scenario};

use super::super::dynamics::State;
use super::super::interval::Interval;
use super::super::iterate::Iterate;
use super::super::shooting;
use super::avoidance_rows::AvoidanceConstraints;
use super::conflict_detection::{FleetMotion, ObstacleConflict};
use super::intersample_bounds::{BOUNDED_STATES, extremes};
use crate::convex::STAGE_LEN;

/// Largest accepted violation of a limit, as a fraction of its range: rounding of the solver.
const LIMIT_TOLERANCE: f64 = 1e-6;
/// Largest accepted distance between the end of an interval's flow and the next node, m.
const MAX_DEFECT_M: f64 = 0.1;
/// Largest accepted distance from the plan's end when its controls are integrated open loop from the start, m.
const MAX_ROLLOUT_ERROR_M: f64 = 1.0;
/// Largest accepted distance of the ends of the plan from start and goal, m.
const MAX_END_ERROR_M: f64 = 0.01;

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
pub fn first_violation(
    scenario: &Scenario,
    constraints: &AvoidanceConstraints,
    trajectories: &[Iterate],
    bounds: &[[Range; STAGE_LEN]],
    boundary: &[[State; 2]],
) -> Option<ConstraintViolation> {
    let motion = FleetMotion::new(trajectories);
    separation(scenario, &motion, constraints)
        .or_else(|| clearance(scenario, &motion, constraints))
        .or_else(|| arrival(scenario, trajectories))
        .or_else(|| ends(scenario, trajectories, boundary))
        .or_else(|| dynamics(scenario, trajectories, &motion))
        .or_else(|| rollout(scenario, trajectories))
        .or_else(|| limits(scenario, trajectories, bounds, &motion))
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

fn ends(scenario: &Scenario, trajectories: &[Iterate], boundary: &[[State; 2]]) -> Option<ConstraintViolation> {
    let errors_m = trajectories.iter().zip(boundary).enumerate().flat_map(|(vehicle, (trajectory, [start, goal]))| {
        let ends = [(0, start, 0.0), (trajectory.intervals(), goal, trajectory.flight_time_s())];
        ends.map(|(k, expected, at_s)| (vehicle, at_s, (trajectory.states[k] - expected).fixed_rows::<3>(0).norm()))
    });
    let (vehicle, at_s, amount) = errors_m.max_by(|a, b| a.2.total_cmp(&b.2))?;
    let parties = vec![scenario.vehicles[vehicle].name.clone()];
    (!within(amount, MAX_END_ERROR_M)).then_some(ConstraintViolation {
        constraint: "start or goal",
        parties,
        at_s,
        amount,
        unit: "m",
    })
}

fn dynamics(scenario: &Scenario, trajectories: &[Iterate], motion: &FleetMotion) -> Option<ConstraintViolation> {
    let mut worst: Option<ConstraintViolation> = None;
    for (vehicle, (trajectory, motion)) in trajectories.iter().zip(&motion.vehicles).enumerate() {
        for (k, knots) in motion.intervals.iter().enumerate() {
            let defect = trajectory.states[k + 1] - knots[knots.len() - 1];
            let defect_m = defect.fixed_rows::<3>(0).norm();
            if !within(defect_m, MAX_DEFECT_M) && worst.as_ref().is_none_or(|worst| !within(defect_m, worst.amount)) {
                worst = Some(ConstraintViolation {
                    constraint: "dynamics",
                    parties: vec![scenario.vehicles[vehicle].name.clone()],
                    at_s: (k + 1) as f64 * trajectory.dt_s,
                    amount: defect_m,
                    unit: "m",
                });
            }
        }
    }
    worst
}

fn rollout(scenario: &Scenario, trajectories: &[Iterate]) -> Option<ConstraintViolation> {
    let end_error_m = |trajectory: &Iterate| {
        let end = (0..trajectory.intervals()).fold(trajectory.states[0], |state, k| {
            let interval = trajectory.interval(k);
            let knots = shooting::flow(&Interval { states: [state, interval.states[1]], ..interval });
            knots[knots.len() - 1]
        });
        (trajectory.states[trajectory.intervals()] - end).fixed_rows::<3>(0).norm()
    };
    let errors_m: Vec<f64> = trajectories.par_iter().map(end_error_m).collect();
    let (vehicle, amount) = errors_m.into_iter().enumerate().max_by(|a, b| a.1.total_cmp(&b.1))?;
    let (parties, at_s) = (vec![scenario.vehicles[vehicle].name.clone()], trajectories[vehicle].flight_time_s());
    (!within(amount, MAX_ROLLOUT_ERROR_M)).then_some(ConstraintViolation {
        constraint: "rollout",
        parties,
        at_s,
        amount,
        unit: "m",
    })
}

fn limits(
    scenario: &Scenario,
    trajectories: &[Iterate],
    bounds: &[[Range; STAGE_LEN]],
    motion: &FleetMotion,
) -> Option<ConstraintViolation> {
    let mut worst: Option<ConstraintViolation> = None;
    for (vehicle, trajectory) in trajectories.iter().enumerate() {
        let mut consider = |quantity: usize, range: Range, values: Range, k: usize| {
            let excess = (values.max - range.max).max(range.min - values.min);
            let fraction = excess / range.width();
            let is_accepted = fraction <= LIMIT_TOLERANCE || !range.width().is_finite();
            if !is_accepted && worst.as_ref().is_none_or(|worst| excess > worst.amount) {
                worst = Some(ConstraintViolation {
                    constraint: NAMES[quantity],
                    parties: vec![scenario.vehicles[vehicle].name.clone()],
                    at_s: k as f64 * trajectory.dt_s,
                    amount: excess,
                    unit: UNITS[quantity],
                });
            }
        };
        for (k, knots) in motion.vehicles[vehicle].intervals.iter().enumerate() {
            for quantity in BOUNDED_STATES {
                consider(quantity, bounds[vehicle][quantity], extremes(knots, quantity), k);
            }
        }
        for (k, control) in trajectory.controls.iter().enumerate() {
            for i in 0..3 {
                consider(6 + i, bounds[vehicle][6 + i], Range::new(control[i], control[i]), k);
            }
        }
    }
    worst
}

const NAMES: [&str; STAGE_LEN] = ["x", "y", "altitude", "speed", "heading", "flight-path angle", "n_x", "n_y", "n_z"];
const UNITS: [&str; STAGE_LEN] = ["m", "m", "m", "m/s", "rad", "rad", "-", "-", "-"];

/// `value <= limit`; false for NaN.
fn within(value: f64, limit: f64) -> bool {
    value <= limit
}

#[cfg(test)]
mod tests {
    use super::super::super::dynamics::Control;
    use super::*;

    /// The smallest shipped fleet, with all vehicles on straight flights east that obey the equations of motion.
    fn fleet() -> (Scenario, Vec<Iterate>) {
        let path = std::path::Path::new(env!("CARGO_MANIFEST_DIR")).join("../scenarios/fixed-wing/rendezvous-2.toml");
        let mut scenario = scenarios::load(&path).expect("a shipped scenario");
        scenario.world.cylinders.truncate(1);
        scenario.world.cylinders[0].center_m = [1000.0, 2000.0];
        let straight = |y_m: f64| {
            let at = |k: usize| State::new(35.0 * 5.0 * k as f64, y_m, 400.0, 35.0, 0.0, 0.0);
            Iterate {
                states: (0..=10).map(at).collect(),
                controls: vec![Control::new(0.0, 0.0, 1.0); 11],
                dt_s: 5.0,
                ramp: 0.25,
            }
        };
        (scenario, vec![straight(0.0), straight(150.0)])
    }

    fn violation(scenario: &Scenario, trajectories: &[Iterate]) -> Option<ConstraintViolation> {
        let (_, expected) = fleet();
        let boundary: Vec<[State; 2]> =
            expected.iter().map(|trajectory| [trajectory.states[0], trajectory.states[10]]).collect();
        let bounds = |vehicle| {
            let limits = &scenario.fixed_wing_model(vehicle).planning_limits;
            super::super::super::subproblem::node_bounds(limits, &scenario.world.map)
        };
        let bounds: Vec<_> = scenario.vehicles.iter().map(bounds).collect();
        first_violation(scenario, &AvoidanceConstraints::new(scenario, 0.5), trajectories, &bounds, &boundary)
    }

    #[test]
    fn a_plan_that_keeps_every_constraint_is_accepted() {
        let (scenario, trajectories) = fleet();
        assert_eq!(violation(&scenario, &trajectories), None);
    }

    #[test]
    fn every_kind_of_violation_is_found() {
        type Mutation = fn(&mut Scenario, &mut Vec<Iterate>);
        let cases: [(&str, Mutation); 9] = [
            ("separation", |scenario, _| scenario.fleet.separation_m = Some(151.0)),
            ("clearance", |scenario, _| scenario.world.cylinders[0].center_m = [875.0, 551.0]),
            ("simultaneous arrival", |_, trajectories| trajectories[1].dt_s += 1e-3),
            ("start or goal", |_, trajectories| trajectories[0].states.iter_mut().for_each(|state| state[1] -= 0.1)),
            ("dynamics", |_, trajectories| trajectories[0].states[4][0] += 0.2),
            ("dynamics", |_, trajectories| trajectories[0].states[4][2] = f64::NAN),
            ("rollout", |_, trajectories| trajectories[0].controls.iter_mut().for_each(|control| control[0] = 1e-4)),
            ("speed", |scenario, _| {
                let model = scenario.models.fixed_wing.values_mut().next().expect("a model");
                model.planning_limits.speed_mps.max = 34.9;
            }),
            ("n_z", |scenario, _| {
                let model = scenario.models.fixed_wing.values_mut().next().expect("a model");
                model.planning_limits.n_z.max = 0.99;
            }),
        ];
        for (constraint, mutate) in cases {
            let (mut scenario, mut trajectories) = fleet();
            mutate(&mut scenario, &mut trajectories);
            let found = violation(&scenario, &trajectories).unwrap_or_else(|| panic!("{constraint} was not found"));
            assert_eq!(found.constraint, constraint, "{found}");
            assert!(!found.parties.is_empty() && found.amount != 0.0, "{found:?}");
        }
    }

    #[test]
    fn separation_is_checked_between_the_nodes() {
        let (mut scenario, mut trajectories) = fleet();
        scenario.fleet.separation_m = Some(50.0);
        // the second vehicle flies the opposite way: they pass each other between two nodes
        let states: Vec<State> = trajectories[0].states.iter().rev().copied().collect();
        trajectories[1].states =
            states.iter().map(|s| State::new(s[0] - 87.5, 20.0, 400.0, 35.0, std::f64::consts::PI, 0.0)).collect();
        let at_nodes = (0..=10).map(|k| (trajectories[0].states[k] - trajectories[1].states[k]).norm());
        assert!(at_nodes.fold(f64::INFINITY, f64::min) > 80.0);
        let found = violation(&scenario, &trajectories).expect("they pass at 20 m");
        assert_eq!(found.constraint, "separation");
        assert!((found.amount - 30.0).abs() < 1e-6, "{found}");
    }
}
