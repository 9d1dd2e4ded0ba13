//! Planner `parallel-scp`: decoupled sequential convex programming, everybody avoids everybody's last trajectory, the
//! subproblems of one iteration in parallel (Wang, Xu, Long 2020, section 2; pdSCP of Xu et al. 2022).

use std::time::Instant;

use rand::RngExt;
use rayon::prelude::*;
use scenarios::{Iteration, Plan, Scenario, Solver};

use super::avoidance::{KeepOut, append_planes};
use super::dynamics::State;
use super::initial_guess::{boundary_states, straight_lines};
use super::iterate::Iterate;
use super::options::Options;
use super::plan;
use super::subproblem::{self, Context};
use super::time_bound::TimeBound;
use crate::convex::{self, InteriorPoint, Plane, Program, Settings, Solution, Status};
use crate::planner::{Planner, Progress};

/// Relative gap and residuals to which the subproblems are solved.
const TOLERANCE: f64 = 1e-8;

/// Half-width of the trust region, m, below which the time bound is no longer released.
const FREEZE_BELOW_M: f64 = 100.0;

/// The planner, for the registry.
pub const PLANNER: Planner = Planner {
    name: NAME,
    summary: "Decoupled sequential convex programming, everybody avoids everybody (Wang, Xu, Long 2020)",
    handles: "fixed-wing fleets among cylinders",
    refuses: super::refuses,
    answer: plan,
};

const NAME: &str = "parallel-scp";

/// Plans for the whole fleet. `progress` sees every iteration as it ends, `inspect` every subproblem and its solution.
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
    let fleet = Fleet::new(scenario, seed);
    let mut trajectories = straight_lines(scenario, fleet.options.intervals);
    let mut trust_region = fleet.options.trust_region;
    let mut time_bound = TimeBound::new(fleet.options.time_bound_release);
    let mut history = Vec::new();
    let mut converged = false;
    while !converged && history.len() < fleet.options.max_iterations {
        let started = Instant::now();
        let answers = fleet.solve_subproblems(&trajectories, trust_region, time_bound.bound_s(), inspect);
        let iteration = fleet.summarise(&trajectories, &answers, trust_region, started);
        converged = fleet.has_converged(&trajectories, &answers);
        trajectories = answers.into_iter().map(|answer| answer.trajectory).collect();
        if scenario.fleet.simultaneous_arrival {
            if trust_region[0] < FREEZE_BELOW_M {
                time_bound.freeze();
            }
            time_bound.update(&trajectories);
        }
        trust_region *= fleet.options.shrink;
        progress(&iteration);
        history.push(iteration);
    }
    let status = plan::status(scenario, &history, converged, fleet.options.max_iterations);
    plan::assemble(scenario, NAME, seed, &trajectories, history, status, begin.elapsed())
}

/// What stays the same over the iterations.
struct Fleet<'a> {
    scenario: &'a Scenario,
    options: Options,
    bounds: Vec<[scenarios::Range; convex::STAGE]>,
    boundary: Vec<[State; 2]>,
    /// Unit normal of every pair (i < j) for nodes at which the two coincide; i takes it, j its opposite.
    tie_breaks: Vec<[f64; 2]>,
}

/// One vehicle's answer in one iteration.
struct Answer {
    trajectory: Iterate,
    solution: Solution,
    /// Largest violation that the penalty left, in scaled units.
    slack: f64,
    wall_s: f64,
}

impl<'a> Fleet<'a> {
    fn new(scenario: &'a Scenario, seed: u64) -> Self {
        let n = scenario.vehicles.len();
        let mut rng = scenarios::stream(seed, "scp/tie-break");
        let mut unit = || {
            let (sin, cos) = (rng.random::<f64>() * std::f64::consts::TAU).sin_cos();
            [cos, sin]
        };
        let limits = |vehicle| &scenario.fixed_wing_model(vehicle).planning_limits;
        Self {
            scenario,
            options: Options::new(&scenario.planner),
            bounds: scenario.vehicles.iter().map(|v| subproblem::node_bounds(limits(v), &scenario.world.map)).collect(),
            boundary: scenario.vehicles.iter().map(boundary_states).collect(),
            tie_breaks: (0..n * n).map(|_| unit()).collect(),
        }
    }

    fn solve_subproblems(
        &self,
        trajectories: &[Iterate],
        trust_region: State,
        dt_bound_s: f64,
        inspect: &(dyn Fn(&Program, &Solution) + Sync),
    ) -> Vec<Answer> {
        let answer = |i: usize| {
            let started = Instant::now();
            let context = Context {
                options: &self.options,
                boundary: self.boundary[i],
                bounds: self.bounds[i],
                trust_region,
                dt_bound_s,
            };
            let planes = self.planes(i, trajectories, trust_region[0]);
            let program = subproblem::assemble(&context, &trajectories[i], planes);
            let solution = self.solve(&program);
            inspect(&program, &solution);
            let slack = program.largest_violation(&solution.z);
            let trajectory = subproblem::updated(&trajectories[i], &solution.z);
            Answer { trajectory, solution, slack, wall_s: started.elapsed().as_secs_f64() }
        };
        (0..trajectories.len()).into_par_iter().map(answer).collect()
    }

    fn solve(&self, program: &Program) -> Solution {
        match self.options.solver {
            Solver::Block => {
                let settings = Settings { tolerance: TOLERANCE, ..Settings::default() };
                InteriorPoint::new(settings).solve(program)
            }
            Solver::Clarabel => convex::solve_with_clarabel(program, TOLERANCE),
        }
    }

    /// Avoidance rows of vehicle i: every obstacle, every other vehicle.
    fn planes(&self, i: usize, trajectories: &[Iterate], trust_region_m: f64) -> Vec<Plane> {
        let mut planes = Vec::new();
        let margin_m = self.options.margin_m;
        for cylinder in &self.scenario.world.cylinders {
            let keep_out = KeepOut {
                center_m: &|_| cylinder.center_m,
                radius_m: cylinder.radius_m + margin_m,
                tie_break: [0.0, 1.0],
            };
            append_planes(&trajectories[i], &keep_out, trust_region_m, &mut planes);
        }
        let Some(separation_m) = self.scenario.fleet.separation_m else { return planes };
        for (j, other) in trajectories.iter().enumerate().filter(|(j, _)| *j != i) {
            let keep_out = KeepOut {
                center_m: &|k| other.position_m(k),
                radius_m: separation_m + margin_m,
                tie_break: self.tie_break(i, j),
            };
            append_planes(&trajectories[i], &keep_out, trust_region_m, &mut planes);
        }
        planes
    }

    fn tie_break(&self, i: usize, j: usize) -> [f64; 2] {
        let normal = self.tie_breaks[i.min(j) * self.boundary.len() + i.max(j)];
        if i < j { normal } else { normal.map(|n| -n) }
    }

    fn has_converged(&self, last: &[Iterate], answers: &[Answer]) -> bool {
        last.iter().zip(answers).all(|(last, answer)| {
            let change = answer.trajectory.change(last);
            change.iter().zip(self.options.convergence.iter()).all(|(change, eps)| change <= eps)
        })
    }

    fn summarise(&self, last: &[Iterate], answers: &[Answer], trust_region: State, started: Instant) -> Iteration {
        let largest = |value: &dyn Fn(&Answer) -> f64| answers.iter().map(value).fold(0.0, f64::max);
        let now: Vec<&Iterate> = answers.iter().map(|answer| &answer.trajectory).collect();
        let change = last.iter().zip(&now).map(|(last, now)| now.change(last)).fold(State::zeros(), |a, b| a.sup(&b));
        Iteration {
            objective: largest(&|answer| answer.trajectory.flight_time_s()),
            dt_s: largest(&|answer| answer.trajectory.dt_s),
            defect_m: largest(&|answer| answer.trajectory.defect_m(self.options.transcription)),
            slack: largest(&|answer| answer.slack),
            separation_m: plan::node_separation_m(&now),
            clearance_m: plan::node_clearance_m(&now, &self.scenario.world.cylinders),
            change_m: change[0].max(change[1]),
            trust_region_m: trust_region[0],
            solver_iterations: answers.iter().map(|answer| answer.solution.iterations).sum(),
            unsolved: answers.iter().filter(|answer| answer.solution.status != Status::Solved).count(),
            wall_s: started.elapsed().as_secs_f64(),
            distributed_s: largest(&|answer| answer.wall_s),
        }
    }
}
