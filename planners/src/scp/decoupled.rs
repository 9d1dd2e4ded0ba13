//! What the papers' planners have in common: a fleet whose vehicles are planned one by one or all at once, each against
//! the others' last trajectories, with rows at the nodes.

use std::time::Instant;

use rand::RngExt;
use rayon::prelude::*;
use scenarios::{Iteration, Range, Scenario, Solver};

use super::avoidance::{KeepOut, append_planes};
use super::dynamics::State;
use super::initial_guess::{boundary_states, straight_lines};
use super::iterate::Iterate;
use super::options::Options;
use super::plan;
use super::subproblem::{self, Context};
use crate::convex::{self, HalfspaceConstraint, InteriorPoint, Program, STAGE_LEN, Settings, Solution, Status};

/// Relative gap and residuals to which the subproblems are solved.
pub const TOLERANCE: f64 = 1e-8;

/// Largest relative change of a step length in one iteration.
pub const TIME_CHANGE: f64 = 0.5;

/// Who has to avoid what.
#[derive(Clone, Copy)]
pub struct Avoidance<'a> {
    /// Must the first keep away from the second?
    pub avoids: &'a (dyn Fn(usize, usize) -> bool + Sync),
    /// Are there obstacles?
    pub obstacles: bool,
}

/// What stays the same over the iterations.
pub struct Fleet<'a> {
    /// The question.
    pub scenario: &'a Scenario,
    /// Planner options.
    pub options: Options,
    /// Bounds per vehicle and node.
    pub bounds: Vec<Vec<[Range; STAGE_LEN]>>,
    /// States at both ends of every vehicle's way.
    pub boundary: Vec<[State; 2]>,
    /// Unit normal of every pair (i < j) for nodes at which the two coincide; i takes it, j its opposite.
    tie_breaks: Vec<[f64; 2]>,
}

/// One vehicle's answer in one iteration.
#[derive(Clone, Debug)]
pub struct Answer {
    /// The new trajectory.
    pub trajectory: Iterate,
    /// Interior-point iterations.
    pub solver_iterations: usize,
    /// Did the solver reach its tolerance?
    pub is_solved: bool,
    /// Largest violation that the penalty left, in scaled units.
    pub slack: f64,
    /// Time that it took, s.
    pub wall_s: f64,
}

impl<'a> Fleet<'a> {
    /// The fleet of a scenario. `seed`: of the normals between vehicles that coincide.
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
            options,
            boundary: scenario.vehicles.iter().map(boundary_states).collect(),
            tie_breaks: (0..n * n).map(|_| unit()).collect(),
        }
    }

    /// Where every sequence starts.
    pub fn straight_lines(&self) -> Vec<Iterate> {
        straight_lines(self.scenario, self.options.intervals)
    }

    /// Everybody's answer to the last trajectories, in parallel. `inspect` sees every subproblem with its solution.
    pub fn answers(
        &self,
        last: &[Iterate],
        avoidance: Avoidance,
        trust_region: State,
        dt_bound_s: f64,
        inspect: &(dyn Fn(&Program, &Solution) + Sync),
    ) -> Vec<Answer> {
        let answer = |i| self.answer(i, last, avoidance, trust_region, dt_bound_s, inspect);
        (0..last.len()).into_par_iter().map(answer).collect()
    }

    /// One vehicle's answer.
    pub fn answer(
        &self,
        i: usize,
        last: &[Iterate],
        avoidance: Avoidance,
        trust_region: State,
        dt_bound_s: f64,
        inspect: &(dyn Fn(&Program, &Solution) + Sync),
    ) -> Answer {
        let started = Instant::now();
        let planes = self.planes(i, last, avoidance, trust_region[0]);
        let program = self.program(i, last, planes, trust_region, dt_bound_s);
        let solution = self.solve(&program);
        inspect(&program, &solution);
        Answer {
            trajectory: subproblem::updated(&last[i], &solution.z),
            solver_iterations: solution.iterations,
            is_solved: solution.status == Status::Solved,
            slack: program.max_violation(&solution.z),
            wall_s: started.elapsed().as_secs_f64(),
        }
    }

    /// The subproblem of a vehicle.
    pub fn program(
        &self,
        i: usize,
        last: &[Iterate],
        planes: Vec<HalfspaceConstraint>,
        trust_region: State,
        dt_bound_s: f64,
    ) -> Program {
        let context = Context {
            options: &self.options,
            boundary: self.boundary[i],
            bounds: &self.bounds[i],
            trust_region,
            dt_bound_s,
            dt_change: TIME_CHANGE,
        };
        subproblem::assemble(&context, &last[i], planes)
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

    /// Avoidance rows of vehicle i.
    pub fn planes(
        &self,
        i: usize,
        last: &[Iterate],
        avoidance: Avoidance,
        trust_region_m: f64,
    ) -> Vec<HalfspaceConstraint> {
        let mut planes = Vec::new();
        let margin_m = self.options.margin_m;
        let obstacles = self.scenario.world.cylinders.iter().filter(|_| avoidance.obstacles);
        for cylinder in obstacles {
            let keep_out = KeepOut {
                center_m: &|_| cylinder.center_m,
                radius_m: cylinder.radius_m + margin_m,
                tie_break: [0.0, 1.0],
            };
            append_planes(&last[i], &keep_out, trust_region_m, &mut planes);
        }
        let Some(separation_m) = self.scenario.fleet.separation_m else { return planes };
        for (j, other) in last.iter().enumerate().filter(|(j, _)| *j != i && (avoidance.avoids)(i, *j)) {
            let keep_out = KeepOut {
                center_m: &|k| other.position_m(k),
                radius_m: separation_m + margin_m,
                tie_break: self.tie_break(i, j),
            };
            append_planes(&last[i], &keep_out, trust_region_m, &mut planes);
        }
        planes
    }

    /// Normal from j to i where the two coincide.
    pub fn tie_break(&self, i: usize, j: usize) -> [f64; 2] {
        let normal = self.tie_breaks[i.min(j) * self.boundary.len() + i.max(j)];
        if i < j { normal } else { normal.map(|n| -n) }
    }

    /// Has nobody moved by more than the convergence thresholds?
    pub fn is_at_rest<'b>(&self, last: &[Iterate], now: impl Iterator<Item = &'b Iterate>) -> bool {
        last.iter().zip(now).all(|(last, now)| {
            let change = now.change(last);
            change.iter().zip(self.options.convergence.iter()).all(|(change, eps)| change <= eps)
        })
    }

    /// An iteration as the plan's history tells it.
    pub fn summarise(&self, last: &[Iterate], answers: &[Answer], trust_region: State, started: Instant) -> Iteration {
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
            solver_iterations: answers.iter().map(|answer| answer.solver_iterations).sum(),
            unsolved: answers.iter().filter(|answer| !answer.is_solved).count(),
            wall_s: started.elapsed().as_secs_f64(),
            distributed_s: largest(&|answer| answer.wall_s),
        }
    }
}

/// The trajectories of a round of answers.
pub fn trajectories(answers: Vec<Answer>) -> Vec<Iterate> {
    answers.into_iter().map(|answer| answer.trajectory).collect()
}
