//! Planner `fleet-scp`: sequential convex programming whose plans hold between the nodes.
//!
//! As in the papers, the subproblem of each vehicle is linearised about its last trajectory, and all are solved in
//! parallel. The differences:
//!
//! - the dynamics are multiple-shooting constraints, not the trapezoid rule;
//! - avoidance rows are placed at the closest approach of two vehicles, or of a vehicle and an obstacle, not at the
//!   nodes, and two vehicles share the missing distance;
//! - the initial guess is nearly flyable: Dubins paths around obstacles, with a roundabout where many vehicles meet;
//! - the common time bound is released in the search phase;
//! - where the plan does not settle, the vehicles that are left with violations get another initial guess, by other turns, and
//!   the others keep their trajectories;
//! - unless the scenario gives their number, the intervals are as long as the vehicle's agility allows;
//! - the plan of a vehicle that arrives before the others goes on: it holds, clear of all, until the last one has arrived;
//!   if one cannot, all arrive at the same time;
//! - a plan is accepted only when the motion that its controls lead to, integrated in small steps, keeps every limit at
//!   all times.

mod acceptance;
mod agility;
mod avoidance_rows;
mod climb;
mod closest_approach;
mod conflict_detection;
mod detour;
mod dubins;
mod grid;
mod high_ground;
mod holding;
mod initial_guess;
mod initial_route;
mod intersample_bounds;
mod lengthening;
mod motion;
mod refined_motion;
mod roundabout;
mod route;
mod schedule;
mod scp_solver;
mod speed;

use std::time::{Duration, Instant};

use scenarios::{FleetRules, Plan, PlanStatus, Scenario, Transcription, World};

use super::options::Options;
use super::plan;
use crate::convex::{Program, Solution};
use crate::planner::{Planner, PlanningMode, Progress};
use holding::Blocked;
use scp_solver::{Coarse, FleetSolution, NoSolution, ScpSolver};

/// The planner, for the registry.
pub const PLANNER: Planner = Planner {
    name: NAME,
    summary: "Sequential convex programming that holds between the nodes: shooting, rows at closest approach",
    handles: "fixed-wing fleets among cylinders and around high ground of a terrain",
    unsupported_reason,
    mode: PlanningMode::BeforeFlight(plan),
};

const NAME: &str = "fleet-scp";

/// Plans for the whole fleet. `progress` receives every iteration.
pub fn plan(scenario: &Scenario, seed: u64, progress: Progress<'_>) -> Plan {
    plan_and_inspect(scenario, seed, progress, &|_, _| {})
}

/// [`plan()`], with `inspect` called for the subproblems of every iteration and their solutions.
pub fn plan_and_inspect(
    scenario: &Scenario,
    seed: u64,
    progress: Progress<'_>,
    inspect: &dyn Fn(&[Program], &[Solution]),
) -> Plan {
    let begin = Instant::now();
    let scenario = &*high_ground::as_cylinders(scenario);
    let options = Options::fleet(&scenario.planner);
    let max_iterations = options.max_iterations;
    let together = arriving_together(scenario);
    let mut solver = ScpSolver::new(scenario, options.clone());
    let mut history = Vec::new();
    let (mut solution, mut blocked) = (None, None);
    while solution.is_none() && history.len() < max_iterations {
        if solver.has_stalled() {
            solver.reroute();
        }
        let iteration = solver.advance(inspect);
        progress(&iteration);
        history.push(iteration);
        match solver.solution() {
            Some(Ok(found)) => solution = Some(found),
            Some(Err(NoSolution::Blocked(vehicle))) => {
                blocked = Some(vehicle);
                solver = ScpSolver::new(&together, options.clone());
            }
            Some(Err(NoSolution::Violated(_))) | None => {}
        }
    }
    let status = match &solution {
        Some(_) => (PlanStatus::Solved, None),
        None => (PlanStatus::NoPlan, Some(failure_reason(&solver, history.len(), blocked.as_ref()))),
    };
    let FleetSolution { trajectories, holds } = solution.unwrap_or_default();
    let mut plan = plan::assemble(scenario, NAME, seed, &trajectories, history, status, Duration::ZERO);
    plan::go_on(&mut plan, &holds);
    plan.timings.wall_s = begin.elapsed().as_secs_f64();
    plan
}

/// The scenario with all arriving at the same time: what a fleet does in which an aircraft that has arrived cannot wait for
/// the others beyond its goal.
fn arriving_together(scenario: &Scenario) -> Scenario {
    let fleet = FleetRules { simultaneous_arrival: true, ..scenario.fleet.clone() };
    Scenario { fleet, ..scenario.clone() }
}

fn failure_reason(solver: &ScpSolver, iterations: usize, blocked: Option<&Blocked>) -> String {
    let reason = solver.checked().err();
    let reason = reason.map_or("the flight time has not settled".to_string(), |reason| reason.to_string());
    let cure = solver.coarsest().map_or(String::new(), |coarse| {
        let Coarse { vehicle, interval_s, intervals } = coarse;
        format!("; intervals of {interval_s:.1} s are long for {vehicle}: set `planner.intervals` to {intervals}, or omit it")
    });
    let before = blocked.map_or(String::new(), |blocked| format!("{blocked}; with a common arrival, "));
    format!("{before}after {iterations} iterations {reason}{cure}")
}

fn unsupported_reason(scenario: &Scenario) -> Option<String> {
    if scenario.planner.transcription == Some(Transcription::Trapezoid) && scenario.planner.name == NAME {
        return Some("its dynamics are `shooting`, not `trapezoid`".to_string());
    }
    let world = World { terrain: None, ..scenario.world.clone() };
    let above_ground = Scenario { world, ..scenario.clone() };
    super::unsupported_reason(&above_ground).or_else(|| high_ground::unsupported_reason(scenario))
}
