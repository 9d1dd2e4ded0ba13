//! May the plan be called solved? Only if its own flow keeps every limit at all times.

use std::fmt;

use rayon::prelude::*;
use scenarios::{Range, Scenario};

use super::super::dynamics::State;
use super::super::interval::Interval;
use super::super::iterate::Iterate;
use super::super::shooting;
use super::inside::extremes;
use super::rows::Rules;
use super::traffic::{Passage, Traffic};
use crate::convex::STAGE_LEN;

/// Violations below this are a solver's rounding, as a share of a limit's range.
const ROUNDING: f64 = 1e-6;
/// Largest distance between the end of an interval's flow and the next node, m.
const DEFECT_M: f64 = 0.1;
/// Largest distance from the plan's end when its controls are flown from the start without correction, m.
const ROLLOUT_M: f64 = 1.0;
/// Largest distance of the ends of the plan from start and goal, m.
const END_M: f64 = 0.01;

/// States that have limits.
const LIMITED: [usize; 5] = [0, 1, 2, 3, 5];

/// What is wrong with a plan.
#[derive(Clone, Debug, PartialEq)]
pub struct Fault {
    /// The constraint.
    pub constraint: &'static str,
    /// Who, and which obstacle, by name.
    pub between: Vec<String>,
    /// When it is worst, s.
    pub at_s: f64,
    /// By how much it is violated, in `unit`.
    pub violation: f64,
    /// Unit of the violation.
    pub unit: &'static str,
}

impl fmt::Display for Fault {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        let Self { constraint, between, at_s, violation, unit } = self;
        write!(f, "{constraint} of {} is violated by {violation:.3} {unit} at {at_s:.1} s", between.join(" and "))
    }
}

/// The worst fault of a plan by kind, in the order in which they are looked for; none if it may be flown.
pub fn fault(
    scenario: &Scenario,
    rules: &Rules,
    trajectories: &[Iterate],
    bounds: &[[Range; STAGE_LEN]],
    boundary: &[[State; 2]],
) -> Option<Fault> {
    let traffic = Traffic::new(trajectories);
    separation(scenario, &traffic, rules)
        .or_else(|| clearance(scenario, &traffic, rules))
        .or_else(|| arrival(scenario, trajectories))
        .or_else(|| ends(scenario, trajectories, boundary))
        .or_else(|| dynamics(scenario, trajectories, &traffic))
        .or_else(|| rollout(scenario, trajectories))
        .or_else(|| limits(scenario, trajectories, bounds, &traffic))
}

fn separation(scenario: &Scenario, traffic: &Traffic, rules: &Rules) -> Option<Fault> {
    let separation_m = rules.separation_m;
    let encounters = traffic.encounters(separation_m);
    let worst = encounters.iter().min_by(|a, b| a.approach.distance_m.total_cmp(&b.approach.distance_m))?;
    Some(Fault {
        constraint: "separation",
        between: worst.who.map(|who| scenario.vehicles[who].name.clone()).into(),
        at_s: worst.at_s,
        violation: separation_m - worst.approach.distance_m,
        unit: "m",
    })
}

fn clearance(scenario: &Scenario, traffic: &Traffic, rules: &Rules) -> Option<Fault> {
    let passages = traffic.passages(rules.cylinders, rules.clearance_m);
    let distance_m = |at: &Passage| at.approach.distance_m - rules.cylinders[at.obstacle].radius_m;
    let worst = passages.iter().min_by(|a, b| distance_m(a).total_cmp(&distance_m(b)))?;
    Some(Fault {
        constraint: "clearance",
        between: vec![scenario.vehicles[worst.who].name.clone(), rules.cylinders[worst.obstacle].name.clone()],
        at_s: (worst.interval as f64 + worst.approach.share) * traffic.tracks[worst.who].dt_s,
        violation: rules.clearance_m - distance_m(worst),
        unit: "m",
    })
}

fn arrival(scenario: &Scenario, trajectories: &[Iterate]) -> Option<Fault> {
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
    (spread_s != 0.0).then(|| Fault {
        constraint: "simultaneous arrival",
        between: [first, last].into_iter().filter_map(name).collect(),
        at_s: first.flight_time_s(),
        violation: spread_s,
        unit: "s",
    })
}

fn ends(scenario: &Scenario, trajectories: &[Iterate], boundary: &[[State; 2]]) -> Option<Fault> {
    let missed = trajectories.iter().zip(boundary).enumerate().flat_map(|(who, (trajectory, [start, goal]))| {
        let ends = [(0, start, 0.0), (trajectory.intervals(), goal, trajectory.flight_time_s())];
        ends.map(|(k, wanted, at_s)| (who, at_s, (trajectory.states[k] - wanted).fixed_rows::<3>(0).norm()))
    });
    let (who, at_s, violation) = missed.max_by(|a, b| a.2.total_cmp(&b.2))?;
    let between = vec![scenario.vehicles[who].name.clone()];
    (!at_most(violation, END_M)).then_some(Fault { constraint: "start or goal", between, at_s, violation, unit: "m" })
}

fn dynamics(scenario: &Scenario, trajectories: &[Iterate], traffic: &Traffic) -> Option<Fault> {
    let mut worst: Option<Fault> = None;
    for (who, (trajectory, track)) in trajectories.iter().zip(&traffic.tracks).enumerate() {
        for (k, knots) in track.intervals.iter().enumerate() {
            let defect = trajectory.states[k + 1] - knots[knots.len() - 1];
            let defect_m = defect.fixed_rows::<3>(0).norm();
            if !at_most(defect_m, DEFECT_M) && worst.as_ref().is_none_or(|worst| !at_most(defect_m, worst.violation)) {
                worst = Some(Fault {
                    constraint: "dynamics",
                    between: vec![scenario.vehicles[who].name.clone()],
                    at_s: (k + 1) as f64 * trajectory.dt_s,
                    violation: defect_m,
                    unit: "m",
                });
            }
        }
    }
    worst
}

fn rollout(scenario: &Scenario, trajectories: &[Iterate]) -> Option<Fault> {
    let end_error_m = |trajectory: &Iterate| {
        let end = (0..trajectory.intervals()).fold(trajectory.states[0], |state, k| {
            let interval = trajectory.interval(k);
            let flown = shooting::flow(&Interval { states: [state, interval.states[1]], ..interval });
            flown[flown.len() - 1]
        });
        (trajectory.states[trajectory.intervals()] - end).fixed_rows::<3>(0).norm()
    };
    let errors_m: Vec<f64> = trajectories.par_iter().map(end_error_m).collect();
    let (who, violation) = errors_m.into_iter().enumerate().max_by(|a, b| a.1.total_cmp(&b.1))?;
    let (between, at_s) = (vec![scenario.vehicles[who].name.clone()], trajectories[who].flight_time_s());
    (!at_most(violation, ROLLOUT_M)).then_some(Fault { constraint: "rollout", between, at_s, violation, unit: "m" })
}

fn limits(
    scenario: &Scenario,
    trajectories: &[Iterate],
    bounds: &[[Range; STAGE_LEN]],
    traffic: &Traffic,
) -> Option<Fault> {
    let mut worst: Option<Fault> = None;
    for (who, trajectory) in trajectories.iter().enumerate() {
        let mut consider = |quantity: usize, range: Range, values: Range, k: usize| {
            let over = (values.max - range.max).max(range.min - values.min);
            let share = over / range.width();
            let tolerated = share <= ROUNDING || !range.width().is_finite();
            if !tolerated && worst.as_ref().is_none_or(|worst| over > worst.violation) {
                worst = Some(Fault {
                    constraint: NAMES[quantity],
                    between: vec![scenario.vehicles[who].name.clone()],
                    at_s: k as f64 * trajectory.dt_s,
                    violation: over,
                    unit: UNITS[quantity],
                });
            }
        };
        for (k, knots) in traffic.tracks[who].intervals.iter().enumerate() {
            for quantity in LIMITED {
                consider(quantity, bounds[who][quantity], extremes(knots, quantity), k);
            }
        }
        for (k, control) in trajectory.controls.iter().enumerate() {
            for i in 0..3 {
                consider(6 + i, bounds[who][6 + i], Range::new(control[i], control[i]), k);
            }
        }
    }
    worst
}

const NAMES: [&str; STAGE_LEN] = ["x", "y", "altitude", "speed", "heading", "flight-path angle", "n_x", "n_y", "n_z"];
const UNITS: [&str; STAGE_LEN] = ["m", "m", "m", "m/s", "rad", "rad", "-", "-", "-"];

/// Written so that a number that is none is never small enough.
fn at_most(value: f64, limit: f64) -> bool {
    value <= limit
}

#[cfg(test)]
mod tests {
    use super::super::super::dynamics::Control;
    use super::*;

    /// The smallest shipped fleet, with everybody on a straight flight east that obeys the equations of motion.
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

    fn judge(scenario: &Scenario, trajectories: &[Iterate]) -> Option<Fault> {
        let (_, flown_to) = fleet();
        let boundary: Vec<[State; 2]> = flown_to.iter().map(|to| [to.states[0], to.states[10]]).collect();
        let bounds = |vehicle| {
            let limits = &scenario.fixed_wing_model(vehicle).planning_limits;
            super::super::super::subproblem::node_bounds(limits, &scenario.world.map)
        };
        let bounds: Vec<_> = scenario.vehicles.iter().map(bounds).collect();
        fault(scenario, &Rules::new(scenario, 0.5), trajectories, &bounds, &boundary)
    }

    #[test]
    fn a_plan_that_keeps_everything_is_accepted() {
        let (scenario, trajectories) = fleet();
        assert_eq!(judge(&scenario, &trajectories), None);
    }

    #[test]
    fn every_kind_of_fault_is_found() {
        type Harm = fn(&mut Scenario, &mut Vec<Iterate>);
        let cases: [(&str, Harm); 9] = [
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
        for (constraint, harm) in cases {
            let (mut scenario, mut trajectories) = fleet();
            harm(&mut scenario, &mut trajectories);
            let fault = judge(&scenario, &trajectories).unwrap_or_else(|| panic!("{constraint} was not found"));
            assert_eq!(fault.constraint, constraint, "{fault}");
            assert!(!fault.between.is_empty() && fault.violation != 0.0, "{fault:?}");
        }
    }

    #[test]
    fn separation_between_the_nodes_counts() {
        let (mut scenario, mut trajectories) = fleet();
        scenario.fleet.separation_m = Some(50.0);
        // the second flies back the same way: they pass each other between two nodes
        let states: Vec<State> = trajectories[0].states.iter().rev().copied().collect();
        trajectories[1].states =
            states.iter().map(|s| State::new(s[0] - 87.5, 20.0, 400.0, 35.0, std::f64::consts::PI, 0.0)).collect();
        let at_nodes = (0..=10).map(|k| (trajectories[0].states[k] - trajectories[1].states[k]).norm());
        assert!(at_nodes.fold(f64::INFINITY, f64::min) > 80.0);
        let fault = judge(&scenario, &trajectories).expect("they come within 20 m");
        assert_eq!(fault.constraint, "separation");
        assert!((fault.violation - 30.0).abs() < 1e-6, "{fault}");
    }
}
