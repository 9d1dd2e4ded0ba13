//! Planner `slung-lgr`: optimises along one route per homotopy class, and keeps the best candidate.

use std::time::{Duration, Instant};

use rayon::prelude::*;
use scenarios::{Alternative, Iteration, Plan, PlanDiagnostics, PlanStatus, PlanTimings, PlannedEvent, Scenario};

use super::envelope::{Envelope, envelope};
use super::optimise::{Candidate, MeshIteration, Options, optimise};
use super::problem::Problem;
use super::route::{Route, routes};
use super::{problem_builder, solution};
use crate::nlp::Status;
use crate::planner::{Planner, PlanningMode, Progress};

/// The planner, for the registry.
pub const PLANNER: Planner = Planner {
    name: NAME,
    summary: "Legendre-Gauss-Radau collocation with the switchable envelope circle (Kang, Huang, Wen 2020)",
    handles: "a quadrotor with a slung load among convex prisms",
    unsupported_reason: problem_builder::unsupported_reason,
    mode: PlanningMode::BeforeFlight(plan),
};

const NAME: &str = "slung-lgr";

/// Maximum number of candidate routes.
const MAX_ROUTES: usize = 4;

/// The shortest routes around the obstacles, at most four.
pub fn candidate_routes(problem: &Problem) -> Vec<Route> {
    let [x, y, _] = problem.start.position_m;
    let [goal_x, goal_y, _] = problem.goal_m;
    let distance_m = problem.limits.clearance_m + problem.vehicle.radius_m;
    routes([x, y], [goal_x, goal_y], &problem.obstacles, distance_m, MAX_ROUTES)
}

fn plan(scenario: &Scenario, seed: u64, progress: Progress<'_>) -> Plan {
    let begin = Instant::now();
    let (problem, options) = (problem_builder::problem(scenario), problem_builder::options(scenario));
    let routes = candidate_routes(&problem);
    let candidates = optimised(&problem, &routes, &options);
    let elapsed = begin.elapsed();
    let Some(best) = best(&candidates) else {
        let reason = "no path between the obstacles leads from start to goal".to_owned();
        return without_trajectory(scenario, seed, reason, elapsed);
    };
    let history: Vec<Iteration> = best.mesh_iterations.iter().map(|mesh| iteration(&problem, mesh)).collect();
    history.iter().for_each(progress);
    let (status, reason) = status(best);
    let trajectory = solution::trajectory(&problem, best, &scenario.vehicles[0].name);
    Plan {
        status,
        reason,
        objective: Some(problem.reported(best.last().objective)),
        history,
        diagnostics: diagnostics(&problem, best, &candidates),
        timings: timings(elapsed),
        ..Plan::new(&scenario.name, NAME, seed, vec![trajectory.into()])
    }
}

/// A candidate along each route. If none is solved and a load is to be picked up, other guesses of when are tried in turn.
fn optimised<'a>(problem: &Problem, routes: &'a [Route], options: &Options) -> Vec<Candidate<'a>> {
    let along_all = |problem: &Problem| -> Vec<Candidate<'a>> {
        routes.par_iter().map(|route| optimise(problem, route, options)).collect()
    };
    let mut candidates = along_all(problem);
    for other in problem.other_lift_offs() {
        if candidates.iter().any(Candidate::is_solved) {
            break;
        }
        candidates.extend(along_all(&other));
    }
    candidates
}

/// Switches of the envelope and of the cable, and the alternatives that were not chosen.
fn diagnostics(problem: &Problem, best: &Candidate, candidates: &[Candidate]) -> PlanDiagnostics {
    let mut events = envelope_events(&envelope(problem, best));
    events.extend(solution::events(problem, best));
    events.sort_by(|a, b| a.at_s.total_cmp(&b.at_s));
    let others = candidates.iter().filter(|candidate| !std::ptr::eq(*candidate, best));
    let alternative = |candidate: &Candidate| Alternative {
        name: route_name(candidate.route, problem),
        status: status(candidate).0,
        objective: Some(problem.reported(candidate.last().objective)),
        path_m: solution::path_m(problem, candidate),
    };
    PlanDiagnostics { events, alternatives: others.map(alternative).collect() }
}

/// Switches of the envelope's radius (Kang, Huang, Wen 2020, eq. 14) and of the bound that the constraints use (eq. 19).
fn envelope_events(envelope: &Envelope) -> Vec<PlannedEvent> {
    let exact = ["the load is back inside the body's circle", "the load swings out of the body's circle"];
    let bound = [
        "the bound of the load's reach by R-functions is back inside the body's circle",
        "the bound of the load's reach by R-functions exceeds the body's circle",
    ];
    let event = |texts: [&str; 2], &(at_s, is_load): &(f64, bool)| PlannedEvent {
        at_s,
        what: texts[usize::from(is_load)].to_owned(),
    };
    let exact = envelope.switches.iter().map(|switch| event(exact, switch));
    exact.chain(envelope.r_function_switches.iter().map(|switch| event(bound, switch))).collect()
}

/// Name of a route by the sides on which it passes the obstacles: `left of block, right of box`.
pub fn route_name(route: &Route, problem: &Problem) -> String {
    let side = |(&obstacle, &on_right): (&usize, &bool)| {
        format!("{} of {}", if on_right { "right" } else { "left" }, problem.obstacle_names[obstacle])
    };
    let sides: Vec<String> = route.obstacles.iter().zip(&route.on_right).map(side).collect();
    if sides.is_empty() { "straight".to_owned() } else { sides.join(", ") }
}

/// The cheapest solved candidate; if there is none, the one with the smallest constraint violation.
fn best<'a, 'b>(candidates: &'a [Candidate<'b>]) -> Option<&'a Candidate<'b>> {
    let rank = |candidate: &Candidate| {
        let last = candidate.last();
        if candidate.is_solved() { (0, last.objective) } else { (1, last.violation) }
    };
    candidates.iter().min_by(|a, b| {
        let ((class_a, a), (class_b, b)) = (rank(a), rank(b));
        class_a.cmp(&class_b).then(a.total_cmp(&b))
    })
}

fn status(candidate: &Candidate) -> (PlanStatus, Option<String>) {
    let last = candidate.last();
    let failure_reason = match last.status {
        Status::Solved if candidate.is_refined => return (PlanStatus::Solved, None),
        Status::Solved => {
            format!("the mesh is still too coarse after {} refinements", candidate.mesh_iterations.len() - 1)
        }
        Status::IterationLimit => format!("the optimiser did not converge within {} iterations", last.iterations),
        Status::Stalled => format!("the line search failed; constraints are violated by {:.1e}", last.violation),
        Status::NotFinite => "a value or a derivative is not finite".to_owned(),
    };
    (PlanStatus::NotConverged, Some(failure_reason))
}

/// One entry of the history per mesh.
fn iteration(problem: &Problem, mesh: &MeshIteration) -> Iteration {
    Iteration {
        objective: problem.reported(mesh.objective),
        dt_s: mesh.max_interval_s,
        defect_m: mesh.quality.error,
        slack: mesh.violation,
        separation_m: None,
        clearance_m: None,
        change_m: 0.0,
        trust_region_m: 0.0,
        solver_iterations: mesh.iterations,
        unsolved: usize::from(mesh.status != Status::Solved),
        wall_s: mesh.wall_s,
        distributed_s: mesh.wall_s,
    }
}

fn without_trajectory(scenario: &Scenario, seed: u64, reason: String, elapsed: Duration) -> Plan {
    Plan { timings: timings(elapsed), ..Plan::no_plan(&scenario.name, NAME, seed, reason) }
}

fn timings(elapsed: Duration) -> PlanTimings {
    PlanTimings { wall_s: elapsed.as_secs_f64(), distributed_s: elapsed.as_secs_f64() }
}
