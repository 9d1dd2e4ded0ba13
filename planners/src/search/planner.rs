//! The planners of the registry: a path of straight legs, timed so that it can be flown.

use std::time::Instant;

use scenarios::multirotor::Trajectory;
use scenarios::{Plan, PlanStatus, PlanTimings, Scenario, stream};

use super::sparse_astar::{self, search};
use super::timing;
use super::tree::{self, grow};
use crate::free_space::FreeSpace;
use crate::free_space::vector::{Point, distance};
use crate::horizon::brief;
use crate::horizon::reference::nodes;
use crate::planner::{Answers, Planner, Progress};

const HANDLES: &str = "one multirotor among known obstacles that stand still";

/// Sparse A*.
pub const SPARSE_ASTAR: Planner = Planner {
    name: "sparse-astar",
    summary: "A* on a grid with limits on turns and lengths (Szczerba et al. 2000), timed within the vehicle's limits",
    handles: HANDLES,
    refuses,
    answers: Answers::Ahead(|scenario, seed, _: Progress<'_>| plan(scenario, seed, "sparse-astar", by_grid)),
};

/// RRT.
pub const RRT: Planner = Planner {
    name: "rrt",
    summary: "rapidly exploring random tree (LaValle 1998), timed within the vehicle's limits",
    handles: HANDLES,
    refuses,
    answers: Answers::Ahead(|scenario, seed, _: Progress<'_>| plan(scenario, seed, "rrt", |ask| by_tree(ask, false))),
};

/// RRT*.
pub const RRT_STAR: Planner = Planner {
    name: "rrt-star",
    summary: "the same with rewiring (Karaman, Frazzoli 2011)",
    handles: HANDLES,
    refuses,
    answers: Answers::Ahead(|scenario, seed, _: Progress<'_>| {
        plan(scenario, seed, "rrt-star", |ask| by_tree(ask, true))
    }),
};

/// Share of the margin by which a motion may leave its path at corners; the path keeps all of it.
const CORNER_SHARE: f64 = 0.5;

fn refuses(scenario: &Scenario) -> Option<String> {
    brief::refuses(scenario).or_else(|| (scenario.vehicles.len() > 1).then(|| "it plans for one vehicle".to_owned()))
}

/// What a search is asked.
struct Ask {
    space: FreeSpace,
    start: Point,
    goal: Point,
    clearance_m: f64,
    axes: usize,
    seed: u64,
}

fn plan(scenario: &Scenario, seed: u64, name: &str, find: impl Fn(&Ask) -> Option<Vec<Point>>) -> Plan {
    let begin = Instant::now();
    let vehicle = &scenario.vehicles[0];
    let is_planar = scenario.is_planar();
    let ask = Ask {
        space: FreeSpace::of(&scenario.world, is_planar),
        start: vehicle.start.position_m(),
        goal: vehicle.goal.position_m(),
        clearance_m: brief::clearance_m(scenario, 0),
        axes: if is_planar { 2 } else { 3 },
        seed,
    };
    let path = find(&ask);
    let trajectory = path.as_ref().map(|path| {
        let motion = timing::motion(path, brief::limits(scenario, 0), CORNER_SHARE * brief::margin_m(scenario));
        Trajectory::through(&vehicle.name, &nodes(&motion, 0.0))
    });
    Plan {
        status: if trajectory.is_some() { PlanStatus::Solved } else { PlanStatus::NoPlan },
        reason: trajectory.is_none().then(|| "no path was found from start to goal".to_owned()),
        objective: path.map(|path| super::length_m(&path)),
        timings: PlanTimings { wall_s: begin.elapsed().as_secs_f64(), distributed_s: 0.0 },
        ..Plan::new(&scenario.name, name, seed, trajectory.into_iter().map(Into::into).collect())
    }
}

fn by_grid(ask: &Ask) -> Option<Vec<Point>> {
    let rules = sparse_astar::Rules {
        spacing_m: 0.5,
        leg: [2.0, 4.0],
        turn_cosine: 0.5,
        longest_m: 4.0 * distance(ask.start, ask.goal),
        axes: ask.axes,
        budget: 1_000_000,
        is_guided: true,
    };
    search(&ask.space, ask.start, ask.goal, ask.clearance_m, &rules).map(|found| found.path)
}

fn by_tree(ask: &Ask, rewires: bool) -> Option<Vec<Point>> {
    let rules = tree::Rules {
        step_m: 2.0,
        goal_share: 0.05,
        samples: if rewires { 4_000 } else { 20_000 },
        rewire_m: rewires.then_some(4.0),
        axes: ask.axes,
    };
    grow(&ask.space, ask.start, ask.goal, ask.clearance_m, &rules, &mut stream(ask.seed, "tree"))
}
