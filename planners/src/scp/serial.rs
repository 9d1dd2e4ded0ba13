//! Planner `serial-scp`: the vehicles are planned in order of priority, each against those planned before it (spSCP of
//! Xu et al. 2022).
//!
//! In each round of an outer loop the sequence of every vehicle runs to convergence, and the common time bound is
//! updated after the round; the bound therefore lags and creeps up. The loop ends when all vehicles arrive together.

use std::time::Instant;

use scenarios::{Plan, Scenario};

use super::decoupled::{Avoidance, FleetProblem, SubproblemResult};
use super::iterate::Iterate;
use super::plan;
use super::priority::Priority;
use super::time_bound::TimeBound;
use crate::planner::{Planner, PlanningMode, Progress};

/// The planner, for the registry.
pub const PLANNER: Planner = Planner {
    name: NAME,
    summary: "Decoupled sequential convex programming, one vehicle after the other (spSCP of Xu et al. 2022)",
    handles: "fixed-wing fleets among cylinders",
    unsupported_reason: super::unsupported_reason,
    mode: PlanningMode::BeforeFlight(plan),
};

const NAME: &str = "serial-scp";

/// Plans for the whole fleet. `progress` receives every round of the outer loop; its distributed time is the sum over
/// all vehicles, because each waits for those before it.
pub fn plan(scenario: &Scenario, seed: u64, progress: Progress<'_>) -> Plan {
    let begin = Instant::now();
    let fleet = FleetProblem::new(scenario, seed);
    let mut last = fleet.straight_lines();
    let lengths_m: Vec<f64> = last.iter().map(length_m).collect();
    let priority = Priority::new(&lengths_m, seed);
    let mut time_bound = TimeBound::new(fleet.options.time_bound_release);
    let max_rounds = fleet.options.coordination.max_rounds;
    let mut history = Vec::new();
    let mut converged = false;
    while !converged && history.len() < max_rounds {
        let started = Instant::now();
        let before = last.clone();
        let (results, all_converged) = round(&fleet, &priority, &mut last, time_bound.bound_s());
        let mut iteration = fleet.summarise(&before, &results, fleet.options.trust_region, started);
        iteration.distributed_s = results.iter().map(|result| result.wall_s).sum();
        converged = all_converged && fleet.arrives_together(&last);
        if scenario.fleet.simultaneous_arrival {
            time_bound.update(&last);
        }
        progress(&iteration);
        history.push(iteration);
    }
    let status = plan::status(scenario, &history, converged, max_rounds, fleet.excess_spread_s(&last));
    plan::assemble(scenario, NAME, seed, &last, history, status, begin.elapsed())
}

/// One round: the sequences of all vehicles in turn. Returns the last result of each, with iterations and time summed
/// over its sequence, and whether all sequences converged.
fn round(
    fleet: &FleetProblem,
    priority: &Priority,
    trajectories: &mut [Iterate],
    bound_s: f64,
) -> (Vec<SubproblemResult>, bool) {
    let mut all_converged = true;
    let mut results: Vec<Option<SubproblemResult>> = vec![None; trajectories.len()];
    for &i in priority.order() {
        let (result, converged) = own_sequence(fleet, priority, i, trajectories, bound_s);
        all_converged &= converged;
        trajectories[i] = result.trajectory.clone();
        results[i] = Some(result);
    }
    (results.into_iter().flatten().collect(), all_converged)
}

/// The sequence of vehicle i against those of higher priority. Returns its last result and whether it converged.
fn own_sequence(
    fleet: &FleetProblem,
    priority: &Priority,
    i: usize,
    others: &[Iterate],
    bound_s: f64,
) -> (SubproblemResult, bool) {
    let avoidance = Avoidance { avoids: &|i, j| priority.avoids(i, j), obstacles: true };
    let mut last = others.to_vec();
    let mut trust_region = fleet.options.trust_region;
    let mut result = fleet.solve(i, &last, avoidance, trust_region, bound_s);
    for _ in 1..fleet.options.max_iterations {
        let converged = fleet.has_converged(&last[i..=i], std::iter::once(&result.trajectory));
        last[i] = result.trajectory.clone();
        if converged {
            return (result, true);
        }
        trust_region *= fleet.options.shrink;
        let next = fleet.solve(i, &last, avoidance, trust_region, bound_s);
        result = SubproblemResult {
            solver_iterations: result.solver_iterations + next.solver_iterations,
            wall_s: result.wall_s + next.wall_s,
            ..next
        };
    }
    (result, false)
}

/// Length of a straight line, m: the vehicle with the longest line has the highest priority.
fn length_m(line: &Iterate) -> f64 {
    (line.states[line.intervals()] - line.states[0]).fixed_rows::<3>(0).norm()
}
