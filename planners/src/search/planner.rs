//! The registered planners: a path of straight legs, timed within the vehicle's limits.

use std::time::Instant;

use scenarios::multirotor::Trajectory;
use scenarios::{PathTiming, Plan, PlanTimings, Scenario, stream};

use super::rrt::{self, RrtSettings};
use super::sparse_astar::{self, SparseAstarSettings};
use super::{PathProblem, timing};
use crate::free_space::{FreeSpace, Point, path_length_m};
use crate::multirotor::reference::nodes_from_motion;
use crate::multirotor::{self, PlanningLimits, PointMassMotion};
use crate::planner::{Planner, PlanningMode, Progress, ignored_via_point};

/// Sparse A*.
pub const SPARSE_ASTAR: Planner = planner(
    "sparse-astar",
    "A* on a grid with limits on turns and lengths (Szczerba et al. 2000), timed within the vehicle's limits",
    |scenario, seed, _| plan(scenario, seed, "sparse-astar", sparse_astar_path),
);

/// RRT.
pub const RRT: Planner = planner(
    "rrt",
    "rapidly exploring random tree (LaValle 1998), timed within the vehicle's limits",
    |scenario, seed, _| plan(scenario, seed, "rrt", |problem| rrt_path(problem, seed, 20_000, None)),
);

/// RRT*.
pub const RRT_STAR: Planner =
    planner("rrt-star", "the same with rewiring (Karaman, Frazzoli 2011)", |scenario, seed, _| {
        plan(scenario, seed, "rrt-star", |problem| rrt_path(problem, seed, 4_000, Some(4.0)))
    });

const fn planner(name: &'static str, summary: &'static str, plan: fn(&Scenario, u64, Progress<'_>) -> Plan) -> Planner {
    Planner {
        name,
        summary,
        handles: "one multirotor among known obstacles that stand still",
        unsupported_reason,
        mode: PlanningMode::BeforeFlight(plan),
    }
}

/// Fraction of the margin by which the timed motion may cut the path's corners. The path itself keeps the whole margin.
const CORNER_MARGIN_FRACTION: f64 = 0.5;

fn unsupported_reason(scenario: &Scenario) -> Option<String> {
    multirotor::unsupported_reason(scenario)
        .or_else(|| ignored_via_point(scenario))
        .or_else(|| (scenario.vehicles.len() > 1).then(|| "it plans for one vehicle".to_owned()))
}

fn plan(scenario: &Scenario, seed: u64, name: &str, find_path: impl Fn(&PathProblem) -> Option<Vec<Point>>) -> Plan {
    let begin = Instant::now();
    let vehicle = &scenario.vehicles[0];
    let is_planar = scenario.is_planar();
    let problem = PathProblem {
        space: FreeSpace::from_world(&scenario.world, is_planar),
        start: vehicle.start.position_m().into(),
        goal: vehicle.goal.position_m().into(),
        clearance_m: multirotor::clearance_m(scenario, 0),
        axes: if is_planar { 2 } else { 3 },
    };
    let path = find_path(&problem);
    let trajectory = path.as_ref().map(|path| {
        let motion = motion_along(scenario, path);
        Trajectory::through(&vehicle.name, &nodes_from_motion(&motion, 0.0))
    });
    let timings = PlanTimings { wall_s: begin.elapsed().as_secs_f64(), distributed_s: 0.0 };
    let plan = match trajectory {
        Some(trajectory) => Plan::new(&scenario.name, name, seed, vec![trajectory.into()]),
        None => Plan::no_plan(&scenario.name, name, seed, "no path was found from start to goal"),
    };
    Plan { objective: path.map(|path| path_length_m(&path)), timings, ..plan }
}

fn motion_along(scenario: &Scenario, path: &[Point]) -> PointMassMotion {
    let limits = PlanningLimits::of_vehicle(scenario, 0);
    match scenario.planner.search.as_ref().and_then(|search| search.timing).unwrap_or(PathTiming::WithinLimits) {
        PathTiming::WithinLimits => {
            timing::timed_motion(path, limits, CORNER_MARGIN_FRACTION * multirotor::margin_m(scenario))
        }
        PathTiming::ConstantSpeed => timing::motion_at_constant_speed(path, limits),
    }
}

fn sparse_astar_path(problem: &PathProblem) -> Option<Vec<Point>> {
    let settings = SparseAstarSettings {
        spacing_m: 0.5,
        leg_cells: [2.0, 4.0],
        cos_max_turn: 0.5,
        max_length_m: 4.0 * (problem.start - problem.goal).norm(),
        max_expansions: 1_000_000,
        uses_heuristic: true,
    };
    sparse_astar::search(problem, &settings).map(|found| found.path)
}

fn rrt_path(problem: &PathProblem, seed: u64, max_samples: usize, rewire_radius_m: Option<f64>) -> Option<Vec<Point>> {
    let settings = RrtSettings { step_m: 2.0, goal_bias: 0.05, max_samples, rewire_radius_m };
    rrt::search(problem, &settings, &mut stream(seed, "tree"))
}
