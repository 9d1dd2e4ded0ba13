//! The common part of the papers' planners: subproblems of single vehicles, with avoidance rows at the nodes against
//! the last trajectories of the others.

use std::time::Instant;

use rand::RngExt;
use rayon::prelude::*;
use scenarios::{Iteration, Range, Scenario};

use super::avoidance::{KeepOut, append_halfspaces};
use super::dynamics::State;
use super::initial_guess::{boundary_states, straight_lines};
use super::iterate::Iterate;
use super::options::Options;
use super::plan;
use super::subproblem::{self, Context};
use super::subproblem_solver::SubproblemSolver;
use super::time_bound::flight_time_spread_s;
use crate::convex::{HalfspaceConstraint, Program, STAGE_LEN, Solution, Status};

/// Relative gap and residuals to which the subproblems are solved.
pub const TOLERANCE: f64 = 1e-8;

/// Largest relative change of a step length in one iteration.
pub const MAX_TIME_CHANGE: f64 = 0.5;

/// Which vehicles and obstacles a vehicle avoids.
#[derive(Clone, Copy)]
pub struct Avoidance<'a> {
    /// Does the first vehicle avoid the second?
    pub avoids: &'a (dyn Fn(usize, usize) -> bool + Sync),
    /// Are obstacles avoided?
    pub obstacles: bool,
}

/// The data of a fleet that are constant over the iterations.
pub struct FleetProblem<'a> {
    /// The scenario.
    pub scenario: &'a Scenario,
    /// Planner options.
    pub options: Options,
    /// Bounds per vehicle and node.
    pub bounds: Vec<Vec<[Range; STAGE_LEN]>>,
    /// Initial and final state of every vehicle.
    pub boundary: Vec<[State; 2]>,
    /// Solver of the subproblems.
    solver: SubproblemSolver,
    /// Unit normal of every pair (i < j) for nodes at which the two coincide: for i; that of j is its opposite.
    tie_breaks: Vec<[f64; 2]>,
}

/// The result of one subproblem.
#[derive(Clone, Debug)]
pub struct SubproblemResult {
    /// The new trajectory.
    pub trajectory: Iterate,
    /// Number of interior-point iterations.
    pub solver_iterations: usize,
    /// Did the solver reach its tolerance?
    pub is_solved: bool,
    /// Largest remaining violation, in scaled units, without that of the bound on dt: the arrival is measured by the spread
    /// of the flight times.
    pub slack: f64,
    /// Wall time, s.
    pub wall_s: f64,
}

impl SubproblemResult {
    /// The result of a `solution` of `program` about `last`, which took `wall_s`.
    fn new(last: &Iterate, program: &Program, solution: &Solution, wall_s: f64) -> Self {
        Self {
            trajectory: subproblem::updated(last, &solution.z),
            solver_iterations: solution.iterations,
            is_solved: solution.status == Status::Solved,
            slack: program.max_stage_violation(&solution.z),
            wall_s,
        }
    }
}

impl<'a> FleetProblem<'a> {
    /// The fleet of a scenario. `seed` determines the normals between vehicles that coincide.
    pub fn new(scenario: &'a Scenario, seed: u64) -> Self {
        let n = scenario.vehicles.len();
        let mut rng = scenarios::stream(seed, "scp/tie-break");
        let mut unit = || {
            let (sin, cos) = (rng.random::<f64>() * std::f64::consts::TAU).sin_cos();
            [cos, sin]
        };
        let options = Options::new(&scenario.planner);
        let limits = |vehicle| &scenario.fixed_wing_model(vehicle).planning_limits;
        let bounds =
            |vehicle| vec![subproblem::node_bounds(limits(vehicle), &scenario.world.map); options.intervals + 1];
        Self {
            scenario,
            bounds: scenario.vehicles.iter().map(bounds).collect(),
            solver: SubproblemSolver::new(options.solver, options.solver_start, TOLERANCE),
            options,
            boundary: scenario.vehicles.iter().map(boundary_states).collect(),
            tie_breaks: (0..n * n).map(|_| unit()).collect(),
        }
    }

    /// The initial trajectories.
    pub fn straight_lines(&self) -> Vec<Iterate> {
        straight_lines(self.scenario, self.options.intervals)
    }

    /// Solves the subproblems of all vehicles in parallel. `inspect` receives every subproblem with its solution.
    pub fn solve_all(
        &self,
        last: &[Iterate],
        avoidance: Avoidance,
        trust_region: State,
        dt_bound_s: f64,
        inspect: &(dyn Fn(&Program, &Solution) + Sync),
    ) -> Vec<SubproblemResult> {
        let program = |i| {
            let started = Instant::now();
            let halfspaces = self.halfspaces(i, last, avoidance, trust_region[0]);
            (self.program(i, last, halfspaces, trust_region, dt_bound_s), started.elapsed().as_secs_f64())
        };
        let (programs, assembly_s): (Vec<Program>, Vec<f64>) = (0..last.len()).into_par_iter().map(program).unzip();
        let solutions = self.solver.solve_timed(&programs);
        let results = programs.par_iter().zip(solutions).zip(assembly_s).zip(last);
        let result = |(((program, (solution, solve_s)), assembly_s), last): (_, &Iterate)| {
            inspect(program, &solution);
            SubproblemResult::new(last, program, &solution, assembly_s + solve_s)
        };
        results.map(result).collect()
    }

    /// Solves the subproblem of one vehicle.
    pub fn solve(
        &self,
        i: usize,
        last: &[Iterate],
        avoidance: Avoidance,
        trust_region: State,
        dt_bound_s: f64,
    ) -> SubproblemResult {
        let started = Instant::now();
        let halfspaces = self.halfspaces(i, last, avoidance, trust_region[0]);
        let program = self.program(i, last, halfspaces, trust_region, dt_bound_s);
        let solution = self.solver.solve(std::slice::from_ref(&program)).remove(0);
        SubproblemResult::new(&last[i], &program, &solution, started.elapsed().as_secs_f64())
    }

    /// The subproblem of a vehicle.
    pub fn program(
        &self,
        i: usize,
        last: &[Iterate],
        halfspaces: Vec<HalfspaceConstraint>,
        trust_region: State,
        dt_bound_s: f64,
    ) -> Program {
        let context = Context {
            options: &self.options,
            penalty: self.options.penalty,
            boundary: self.boundary[i],
            bounds: &self.bounds[i],
            trust_region,
            dt_bound_s,
            dt_change: MAX_TIME_CHANGE,
            control_change: subproblem::FREE_CONTROL_CHANGE,
        };
        subproblem::assemble(&context, &last[i], halfspaces)
    }

    /// Avoidance rows of vehicle i.
    pub fn halfspaces(
        &self,
        i: usize,
        last: &[Iterate],
        avoidance: Avoidance,
        trust_region_m: f64,
    ) -> Vec<HalfspaceConstraint> {
        let mut halfspaces = Vec::new();
        let margin_m = self.options.margin_m;
        let body_m = self.scenario.fixed_wing_model(&self.scenario.vehicles[i]).body_radius_m;
        let obstacles = self.scenario.world.cylinders.iter().filter(|_| avoidance.obstacles);
        for cylinder in obstacles {
            let keep_out = KeepOut {
                center_m: &|_| cylinder.center_m,
                radius_m: cylinder.radius_m + body_m + margin_m,
                tie_break: [0.0, 1.0],
            };
            append_halfspaces(&last[i], &keep_out, trust_region_m, &mut halfspaces);
        }
        let Some(separation_m) = self.scenario.horizontal_separation_m() else { return halfspaces };
        for (j, other) in last.iter().enumerate().filter(|(j, _)| *j != i && (avoidance.avoids)(i, *j)) {
            let keep_out = KeepOut {
                center_m: &|k| other.position_m(k),
                radius_m: separation_m + margin_m,
                tie_break: self.tie_break(i, j),
            };
            append_halfspaces(&last[i], &keep_out, trust_region_m, &mut halfspaces);
        }
        halfspaces
    }

    /// Normal from j to i where the two coincide.
    pub fn tie_break(&self, i: usize, j: usize) -> [f64; 2] {
        let normal = self.tie_breaks[i.min(j) * self.boundary.len() + i.max(j)];
        if i < j { normal } else { normal.map(|n| -n) }
    }

    /// Are all changes since `last` within the convergence thresholds?
    pub fn has_converged<'b>(&self, last: &[Iterate], now: impl Iterator<Item = &'b Iterate>) -> bool {
        last.iter().zip(now).all(|(last, now)| {
            let change = now.change(last);
            change.iter().zip(self.options.convergence.iter()).all(|(change, eps)| change <= eps)
        })
    }

    /// The spread of the flight times, s, if the vehicles have to arrive at one time and do not.
    pub fn excess_spread_s(&self, trajectories: &[Iterate]) -> Option<f64> {
        let spread_s = flight_time_spread_s(trajectories);
        let is_excess = spread_s > self.options.coordination.arrival_spread_s;
        (self.scenario.fleet.simultaneous_arrival && is_excess).then_some(spread_s)
    }

    /// Do all vehicles arrive at one time, if they have to?
    pub fn arrives_together(&self, trajectories: &[Iterate]) -> bool {
        self.excess_spread_s(trajectories).is_none()
    }

    /// The record of an iteration for the plan history.
    pub fn summarise(
        &self,
        last: &[Iterate],
        results: &[SubproblemResult],
        trust_region: State,
        started: Instant,
    ) -> Iteration {
        let max = |value: &dyn Fn(&SubproblemResult) -> f64| results.iter().map(value).fold(0.0, f64::max);
        let now: Vec<&Iterate> = results.iter().map(|result| &result.trajectory).collect();
        let change = last.iter().zip(&now).map(|(last, now)| now.change(last)).fold(State::zeros(), |a, b| a.sup(&b));
        Iteration {
            objective: max(&|result| result.trajectory.flight_time_s()),
            dt_s: max(&|result| result.trajectory.dt_s),
            defect_m: max(&|result| result.trajectory.defect_m(self.options.transcription)),
            slack: max(&|result| result.slack),
            separation_m: plan::node_separation_m(&now),
            clearance_m: plan::node_clearance_m(self.scenario, &now),
            change_m: change[0].max(change[1]),
            trust_region_m: trust_region[0],
            solver_iterations: results.iter().map(|result| result.solver_iterations).sum(),
            unsolved: results.iter().filter(|result| !result.is_solved).count(),
            wall_s: started.elapsed().as_secs_f64(),
            distributed_s: max(&|result| result.wall_s),
        }
    }
}

/// The trajectories of the results.
pub fn trajectories(results: Vec<SubproblemResult>) -> Vec<Iterate> {
    results.into_iter().map(|result| result.trajectory).collect()
}
