//! Planner `parallel-scp`: decoupled sequential convex programming in which every vehicle avoids the last trajectories
//! of all others; the subproblems of one iteration are solved in parallel (Wang, Xu, Long 2020, section 2; pdSCP of Xu
//! et al. 2022).

use std::time::Instant;

use scenarios::{Plan, Scenario};

use super::decoupled::{Avoidance, FleetProblem, trajectories};
use super::plan;
use super::time_bound::TimeBound;
use crate::convex::{Program, Solution};
use crate::planner::{Planner, PlanningMode, Progress};

/// Half-width of the trust region below which the time bound is no longer released, m.
const FREEZE_BELOW_M: f64 = 100.0;

/// The planner, for the registry.
pub const PLANNER: Planner = Planner {
    name: NAME,
    summary: "Decoupled sequential convex programming, every vehicle avoids every other (Wang, Xu, Long 2020)",
    handles: "fixed-wing fleets among cylinders",
    unsupported_reason: super::unsupported_reason,
    mode: PlanningMode::BeforeFlight(plan),
};

const NAME: &str = "parallel-scp";

/// Plans for the whole fleet. `progress` receives every iteration.
pub fn plan(scenario: &Scenario, seed: u64, progress: Progress<'_>) -> Plan {
    plan_and_inspect(scenario, seed, progress, &|_, _| {})
}

/// [`plan()`], with `inspect` called for every subproblem and its solution, from several threads.
pub fn plan_and_inspect(
    scenario: &Scenario,
    seed: u64,
    progress: Progress<'_>,
    inspect: &(dyn Fn(&Program, &Solution) + Sync),
) -> Plan {
    let begin = Instant::now();
    let fleet = FleetProblem::new(scenario, seed);
    let avoidance = Avoidance { avoids: &|_, _| true, obstacles: true };
    let mut last = fleet.straight_lines();
    let mut trust_region = fleet.options.trust_region;
    let mut time_bound = TimeBound::new(fleet.options.time_bound_release);
    let mut history = Vec::new();
    let mut converged = false;
    while !converged && history.len() < fleet.options.max_iterations {
        let started = Instant::now();
        let results = fleet.solve_all(&last, avoidance, trust_region, time_bound.bound_s(), inspect);
        let iteration = fleet.summarise(&last, &results, trust_region, started);
        let has_settled = fleet.has_converged(&last, results.iter().map(|result| &result.trajectory));
        last = trajectories(results);
        converged = has_settled && fleet.arrives_together(&last);
        if scenario.fleet.simultaneous_arrival {
            if trust_region[0] < FREEZE_BELOW_M {
                time_bound.freeze();
            }
            time_bound.update(&last);
        }
        trust_region *= fleet.options.shrink;
        progress(&iteration);
        history.push(iteration);
    }
    let status =
        plan::status(scenario, &history, converged, fleet.options.max_iterations, fleet.excess_spread_s(&last));
    plan::assemble(scenario, NAME, seed, &last, history, status, begin.elapsed())
}
