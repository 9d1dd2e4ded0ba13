//! Planner `coupled-scp`: one convex program over all vehicles, in which both vehicles of a pair move (cSCP of Xu et
//! al. 2022).
//!
//! The program lacks the stage structure that the customised interior-point method requires, so Clarabel solves it by
//! sparse factorisation. The time grows much faster than the fleet; see the table of `harness bench fleets`.

use std::time::Instant;

use scenarios::{Plan, Scenario};

use super::coupled_program::{CoupledProgram, PairConstraint};
use super::decoupled::{Avoidance, FleetProblem, SubproblemResult, TOLERANCE, trajectories};
use super::dynamics::State;
use super::iterate::Iterate;
use super::scaling::POSITION_M;
use super::{plan, subproblem};
use crate::planner::{Planner, PlanningMode, Progress};

/// The planner, for the registry.
pub const PLANNER: Planner = Planner {
    name: NAME,
    summary: "Sequential convex programming, one program over all vehicles (cSCP of Xu et al. 2022)",
    handles: "fixed-wing fleets among cylinders, up to some fifteen vehicles",
    unsupported_reason: super::unsupported_reason,
    mode: PlanningMode::BeforeFlight(plan),
};

const NAME: &str = "coupled-scp";

/// Plans for the whole fleet. `progress` receives every iteration.
pub fn plan(scenario: &Scenario, seed: u64, progress: Progress<'_>) -> Plan {
    let begin = Instant::now();
    let fleet = FleetProblem::new(scenario, seed);
    let mut last = fleet.straight_lines();
    let mut trust_region = fleet.options.trust_region;
    let mut history = Vec::new();
    let mut converged = false;
    while !converged && history.len() < fleet.options.max_iterations {
        let started = Instant::now();
        let results = solve(&fleet, &last, trust_region);
        let iteration = fleet.summarise(&last, &results, trust_region, started);
        converged = fleet.has_converged(&last, results.iter().map(|result| &result.trajectory));
        last = trajectories(results);
        trust_region *= fleet.options.shrink;
        progress(&iteration);
        history.push(iteration);
    }
    let status =
        plan::status(scenario, &history, converged, fleet.options.max_iterations, fleet.excess_spread_s(&last));
    plan::assemble(scenario, NAME, seed, &last, history, status, begin.elapsed())
}

/// The results of all vehicles from the coupled program. Its iterations count once, its time for every vehicle.
fn solve(fleet: &FleetProblem, last: &[Iterate], trust_region: State) -> Vec<SubproblemResult> {
    let started = Instant::now();
    let alone = Avoidance { avoids: &|_, _| false, obstacles: true };
    let program = |i| fleet.program(i, last, fleet.halfspaces(i, last, alone, trust_region[0]), trust_region, 0.0);
    let coupled = CoupledProgram {
        vehicles: (0..last.len()).map(program).collect(),
        pairs: pairs(fleet, last, trust_region[0]),
        shared_time: fleet.scenario.fleet.simultaneous_arrival,
    };
    let solution = coupled.solve(TOLERANCE);
    let wall_s = started.elapsed().as_secs_f64();
    let result = |(i, z): (usize, &Vec<f64>)| SubproblemResult {
        trajectory: subproblem::updated(&last[i], z),
        solver_iterations: if i == 0 { solution.iterations } else { 0 },
        is_solved: solution.is_solved,
        slack: solution.slack,
        wall_s,
    };
    solution.z.iter().enumerate().map(result).collect()
}

/// Rows of all pairs and nodes that can bind: each vehicle moves by at most sqrt(2) ρ.
///
/// ```text
/// n · C ((s_i[k] - sbar_i[k]) - (s_j[k] - sbar_j[k])) >= R - |C (sbar_i[k] - sbar_j[k])|
/// ```
fn pairs(fleet: &FleetProblem, last: &[Iterate], trust_region_m: f64) -> Vec<PairConstraint> {
    let Some(separation_m) = fleet.scenario.horizontal_separation_m() else { return Vec::new() };
    let required_m = separation_m + fleet.options.margin_m;
    let mut pairs = Vec::new();
    for (i, first) in last.iter().enumerate() {
        for (j, second) in last.iter().enumerate().skip(i + 1) {
            for stage in 0..=first.intervals() {
                let (a, b) = (first.position_m(stage), second.position_m(stage));
                let away = [a[0] - b[0], a[1] - b[1]];
                let distance_m = away[0].hypot(away[1]);
                if distance_m >= required_m + 2.0 * std::f64::consts::SQRT_2 * trust_region_m {
                    continue;
                }
                let normal = if distance_m > 0.0 { away.map(|a| a / distance_m) } else { fleet.tie_break(i, j) };
                pairs.push(PairConstraint {
                    vehicles: [i, j],
                    stage,
                    normal,
                    slack: (distance_m - required_m) / POSITION_M,
                });
            }
        }
    }
    pairs
}
