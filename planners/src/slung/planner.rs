//! Planner `slung-lgr`: every way round the obstacles is optimised, the best is kept.

use std::time::{Duration, Instant};

use rayon::prelude::*;
use scenarios::{Account, Alternative, Iteration, Plan, PlanStatus, PlanTimings, PlannedEvent, Scenario};

use super::answer;
use super::envelope::envelope;
use super::optimise::{Candidate, Round, optimise};
use super::problem::Problem;
use super::question;
use super::route::{Route, routes};
use crate::nlp::Status;
use crate::planner::{Answers, Planner, Progress};

/// The planner, for the registry.
pub const PLANNER: Planner = Planner {
    name: NAME,
    summary: "Legendre-Gauss-Radau collocation with the switchable envelope circle (Kang, Huang, Wen 2020)",
    handles: "a quadrotor with a slung load among convex prisms",
    refuses: question::refuses,
    answers: Answers::Ahead(plan),
};

const NAME: &str = "slung-lgr";

/// Most ways round the obstacles that are tried.
const MOST_ROUTES: usize = 4;

/// The routes that are tried.
pub fn candidate_routes(problem: &Problem) -> Vec<Route> {
    let [x, y, _] = problem.start.position_m;
    let [goal_x, goal_y, _] = problem.goal_m;
    let distance_m = problem.limits.clearance_m + problem.body.radius_m;
    routes([x, y], [goal_x, goal_y], &problem.obstacles, distance_m, MOST_ROUTES)
}

fn plan(scenario: &Scenario, seed: u64, progress: Progress<'_>) -> Plan {
    let begin = Instant::now();
    let (problem, options) = (question::problem(scenario), question::options(scenario));
    let routes = candidate_routes(&problem);
    let candidates: Vec<Candidate> = routes.par_iter().map(|route| optimise(&problem, route, &options)).collect();
    let elapsed = begin.elapsed();
    let Some(best) = best(&candidates) else {
        let reason = "no way between the obstacles leads from start to goal".to_owned();
        return without_trajectory(scenario, seed, reason, elapsed);
    };
    let history: Vec<Iteration> = best.rounds.iter().map(|round| iteration(&problem, round)).collect();
    history.iter().for_each(progress);
    let (status, reason) = status(best);
    let trajectory = answer::trajectory(&problem, best, &scenario.vehicles[0].name);
    Plan {
        schema: 1,
        scenario: scenario.name.clone(),
        planner: NAME.to_owned(),
        seed,
        status,
        reason,
        objective: Some(problem.reported(best.last().objective)),
        trajectories: vec![trajectory.into()],
        history,
        account: account(&problem, best, &candidates),
        timings: timings(elapsed),
    }
}

/// When the envelope and the cable switch, and the ways that were not taken.
fn account(problem: &Problem, best: &Candidate, candidates: &[Candidate]) -> Account {
    let mut events: Vec<PlannedEvent> = envelope(problem, best)
        .switches
        .into_iter()
        .map(|(at_s, is_load)| {
            let what = if is_load {
                "the load swings out of the body's circle"
            } else {
                "the load is back inside the body's circle"
            };
            PlannedEvent { at_s, what: what.to_owned() }
        })
        .collect();
    events.extend(answer::switches(problem, best));
    events.sort_by(|a, b| a.at_s.total_cmp(&b.at_s));
    let others = candidates.iter().filter(|candidate| !std::ptr::eq(*candidate, best));
    let alternative = |candidate: &Candidate| Alternative {
        name: name_of(candidate.route, problem),
        status: status(candidate).0,
        objective: Some(problem.reported(candidate.last().objective)),
        path_m: answer::path_m(problem, candidate),
    };
    Account { events, alternatives: others.map(alternative).collect() }
}

/// `left of block, right of box`.
pub fn name_of(route: &Route, problem: &Problem) -> String {
    let side = |(&obstacle, &on_right): (&usize, &bool)| {
        format!("{} of {}", if on_right { "right" } else { "left" }, problem.obstacle_names[obstacle])
    };
    let sides: Vec<String> = route.obstacles.iter().zip(&route.on_right).map(side).collect();
    if sides.is_empty() { "straight".to_owned() } else { sides.join(", ") }
}

/// The cheapest of those that were solved; if none was, the one that violates its rows least.
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
    let complaint = match last.status {
        Status::Solved if candidate.is_refined => return (PlanStatus::Solved, None),
        Status::Solved => format!("the mesh is still too coarse after {} refinements", candidate.rounds.len() - 1),
        Status::IterationLimit => format!("the optimiser had not come to rest after {} iterations", last.iterations),
        Status::Stalled => format!("the optimiser found no further step; rows are violated by {:.1e}", last.violation),
        Status::NotFinite => "a value or a derivative is not a number".to_owned(),
    };
    (PlanStatus::NotConverged, Some(complaint))
}

/// One entry of the history per mesh.
fn iteration(problem: &Problem, round: &Round) -> Iteration {
    Iteration {
        objective: problem.reported(round.objective),
        dt_s: round.longest_s,
        defect_m: round.quality.error,
        slack: round.violation,
        separation_m: None,
        clearance_m: None,
        change_m: 0.0,
        trust_region_m: 0.0,
        solver_iterations: round.iterations,
        unsolved: usize::from(round.status != Status::Solved),
        wall_s: round.wall_s,
        distributed_s: round.wall_s,
    }
}

fn without_trajectory(scenario: &Scenario, seed: u64, reason: String, elapsed: Duration) -> Plan {
    Plan {
        schema: 1,
        scenario: scenario.name.clone(),
        planner: NAME.to_owned(),
        seed,
        status: PlanStatus::NoPlan,
        reason: Some(reason),
        objective: None,
        trajectories: Vec::new(),
        history: Vec::new(),
        account: Account::default(),
        timings: timings(elapsed),
    }
}

fn timings(elapsed: Duration) -> PlanTimings {
    PlanTimings { wall_s: elapsed.as_secs_f64(), distributed_s: elapsed.as_secs_f64() }
}
