//! Planner `serial-scp`: the vehicles are planned one after the other, each against those planned before it (spSCP of Xu
//! et al. 2022).
//!
//! An outer loop coordinates: in each of its rounds every vehicle's own sequence runs until it is at rest, in the order
//! of priority, and the common time bound is brought up to date after the round: so it lags, and creeps up. The loop ends
//! when all arrive together.

use std::time::Instant;

use scenarios::{Plan, Scenario};

use super::decoupled::{Answer, Avoidance, Fleet};
use super::iterate::Iterate;
use super::plan;
use super::priority::Priority;
use super::time_bound::{FLIGHT_TIME_SPREAD_S, TimeBound, flight_time_spread_s};
use crate::planner::{Planner, PlanningMode, Progress};

/// Most rounds of the outer loop: ours.
const ROUNDS: usize = 20;

/// The planner, for the registry.
pub const PLANNER: Planner = Planner {
    name: NAME,
    summary: "Decoupled sequential convex programming, one vehicle after the other (spSCP of Xu et al. 2022)",
    handles: "fixed-wing fleets among cylinders",
    unsupported_reason: super::unsupported_reason,
    mode: PlanningMode::BeforeFlight(plan),
};

const NAME: &str = "serial-scp";

/// Plans for the whole fleet. `progress` sees every round of the outer loop as it ends; its distributed time is the sum
/// over all vehicles, because each has to wait for those before it.
pub fn plan(scenario: &Scenario, seed: u64, progress: Progress<'_>) -> Plan {
    let begin = Instant::now();
    let fleet = Fleet::new(scenario, seed);
    let mut last = fleet.straight_lines();
    let flight_times_s: Vec<f64> = last.iter().map(way_m).collect();
    let priority = Priority::new(&flight_times_s, seed);
    let mut time_bound = TimeBound::new(fleet.options.time_bound_release);
    let mut history = Vec::new();
    let mut converged = false;
    while !converged && history.len() < ROUNDS {
        let started = Instant::now();
        let before = last.clone();
        let (answers, all_at_rest) = round(&fleet, &priority, &mut last, time_bound.bound_s());
        let mut iteration = fleet.summarise(&before, &answers, fleet.options.trust_region, started);
        iteration.distributed_s = answers.iter().map(|answer| answer.wall_s).sum();
        let together = !scenario.fleet.simultaneous_arrival || flight_time_spread_s(&last) <= FLIGHT_TIME_SPREAD_S;
        converged = all_at_rest && together;
        if scenario.fleet.simultaneous_arrival {
            time_bound.update(&last);
        }
        progress(&iteration);
        history.push(iteration);
    }
    let status = plan::status(scenario, &history, converged, ROUNDS);
    plan::assemble(scenario, NAME, seed, &last, history, status, begin.elapsed())
}

/// One round: everybody in turn until at rest. Returns everybody's last answer, with iterations and time summed up, and
/// whether all of them did come to rest.
fn round(fleet: &Fleet, priority: &Priority, trajectories: &mut [Iterate], bound_s: f64) -> (Vec<Answer>, bool) {
    let mut all_at_rest = true;
    let mut answers: Vec<Option<Answer>> = vec![None; trajectories.len()];
    for &i in priority.order() {
        let (answer, at_rest) = own_sequence(fleet, priority, i, trajectories, bound_s);
        all_at_rest &= at_rest;
        trajectories[i] = answer.trajectory.clone();
        answers[i] = Some(answer);
    }
    (answers.into_iter().flatten().collect(), all_at_rest)
}

/// The sequence of vehicle i against those above it, and whether it came to rest.
fn own_sequence(fleet: &Fleet, priority: &Priority, i: usize, others: &[Iterate], bound_s: f64) -> (Answer, bool) {
    let avoidance = Avoidance { avoids: &|i, j| priority.avoids(i, j), obstacles: true };
    let mut last = others.to_vec();
    let mut trust_region = fleet.options.trust_region;
    let mut answer = fleet.answer(i, &last, avoidance, trust_region, bound_s, &|_, _| {});
    for _ in 1..fleet.options.max_iterations {
        let at_rest = fleet.is_at_rest(&last[i..=i], std::iter::once(&answer.trajectory));
        last[i] = answer.trajectory.clone();
        if at_rest {
            return (answer, true);
        }
        trust_region *= fleet.options.shrink;
        let next = fleet.answer(i, &last, avoidance, trust_region, bound_s, &|_, _| {});
        answer = Answer {
            solver_iterations: answer.solver_iterations + next.solver_iterations,
            wall_s: answer.wall_s + next.wall_s,
            ..next
        };
    }
    (answer, false)
}

/// Length of a straight line, m: whose way is longest is planned first.
fn way_m(line: &Iterate) -> f64 {
    (line.states[line.intervals()] - line.states[0]).fixed_rows::<3>(0).norm()
}
