//! The sequence of convex programs: linearise everybody's motion, ask for room where it is short, solve, move.

use std::time::Instant;

use rayon::prelude::*;
use scenarios::{Iteration, Range, Scenario};

use super::super::dynamics::State;
use super::super::iterate::Iterate;
use super::super::options::Options;
use super::super::plan::{node_clearance_m, node_separation_m};
use super::super::solve_all::AllSolver;
use super::super::subproblem::{self, Context};
use super::acceptance::{self, Fault};
use super::first_guess::FirstGuess;
use super::inside;
use super::rows::{Rows, Rules};
use super::schedule::Schedule;
use super::traffic::Traffic;
use crate::convex::{Program, STAGE_LEN, Solution, Status};

/// Relative gap of the subproblems while searching, and at the end.
const TOLERANCES: [f64; 2] = [1e-5, 1e-8];

/// Step lengths that differ by less than this, relatively, are made one: vehicles that arrive together share their nodes.
const SAME_STEP: f64 = 1e-6;

/// The fleet between two iterations.
pub struct Sequence<'a> {
    scenario: &'a Scenario,
    options: Options,
    rules: Rules<'a>,
    /// Planning limits of every vehicle.
    bounds: Vec<[Range; STAGE_LEN]>,
    /// States at both ends of every vehicle's way.
    boundary: Vec<[State; 2]>,
    trajectories: Vec<Iterate>,
    schedule: Schedule,
    /// One per tolerance.
    solvers: [AllSolver; 2],
}

impl<'a> Sequence<'a> {
    /// At the first guess.
    pub fn new(scenario: &'a Scenario, options: Options) -> Self {
        let rules = Rules::new(scenario, options.margin_m);
        let limits = |vehicle| &scenario.fixed_wing_model(vehicle).planning_limits;
        let bounds = |vehicle| subproblem::node_bounds(limits(vehicle), &scenario.world.map);
        let FirstGuess { trajectories, boundary } = FirstGuess::new(scenario, &options, &rules);
        let simultaneous_dt_s = scenario.fleet.simultaneous_arrival.then(|| longest_dt_s(&trajectories));
        let release = options.time_bound_release;
        Self {
            scenario,
            rules,
            bounds: scenario.vehicles.iter().map(bounds).collect(),
            boundary,
            schedule: Schedule::new(options.trust_region, options.shrink, release, simultaneous_dt_s),
            solvers: TOLERANCES.map(|tolerance| AllSolver::new(options.solver, tolerance)),
            options,
            trajectories,
        }
    }

    /// One iteration. `inspect` sees the subproblems and their solutions.
    pub fn advance(&mut self, inspect: &dyn Fn(&[Program], &[Solution])) -> Iteration {
        let started = Instant::now();
        let traffic = self.traffic();
        let trust_region_m = self.schedule.trust_region()[0];
        let programs = self.programs(&traffic, Rows::new(&traffic, &self.rules, trust_region_m));
        let solutions = self.solvers[usize::from(!self.schedule.is_searching())].solve(&programs);
        inspect(&programs, &solutions);
        let violations = programs.par_iter().zip(&solutions).map(|(program, at)| program.max_violation(&at.z));
        let violation = violations.collect::<Vec<_>>().into_iter().fold(0.0, f64::max);
        let moved = self.trajectories.par_iter().zip(&solutions).map(|(last, at)| subproblem::updated(last, &at.z));
        let moved = moved.collect();
        let last = std::mem::replace(&mut self.trajectories, moved);
        let iteration = self.summary(&last, &solutions, violation, started);
        self.schedule.observe(self.mean_or_longest_s(), iteration.dt_s, violation);
        iteration
    }

    /// May the trajectories be called a solution? Not while ways are being looked for, and not with a fault.
    pub fn is_accepted(&self) -> bool {
        !self.schedule.is_searching() && self.fault().is_none()
    }

    /// What is wrong with the trajectories; nothing if they may be flown.
    pub fn fault(&self) -> Option<Fault> {
        acceptance::fault(self.scenario, &self.rules, &self.together(), &self.bounds, &self.boundary)
    }

    /// The trajectories, with one step length for all whose step lengths differ by a solver's tolerance only.
    pub fn together(&self) -> Vec<Iterate> {
        let longest_s = longest_dt_s(&self.trajectories);
        let joined = |trajectory: &Iterate| {
            let is_longest = longest_s - trajectory.dt_s < SAME_STEP * longest_s;
            Iterate { dt_s: if is_longest { longest_s } else { trajectory.dt_s }, ..trajectory.clone() }
        };
        self.trajectories.iter().map(joined).collect()
    }

    fn traffic(&self) -> Traffic {
        let simultaneous = self.scenario.fleet.simultaneous_arrival;
        if simultaneous { Traffic::in_step(&self.trajectories) } else { Traffic::new(&self.trajectories) }
    }

    fn programs(&self, traffic: &Traffic, rows: Rows) -> Vec<Program> {
        let program = |(i, planes)| {
            let bounds = inside::tightened(&self.bounds[i], &traffic.tracks[i]);
            let context = Context {
                options: &self.options,
                boundary: self.boundary[i],
                bounds: &bounds,
                trust_region: self.schedule.trust_region(),
                dt_bound_s: self.schedule.bound_s(),
                dt_change: self.schedule.time_change(),
            };
            subproblem::assemble(&context, &self.trajectories[i], planes)
        };
        rows.planes.into_par_iter().enumerate().map(program).collect()
    }

    /// What is made small: the longest step length, or the mean one where everybody flies for himself, times K.
    fn mean_or_longest_s(&self) -> f64 {
        let mean_s = self.trajectories.iter().map(Iterate::flight_time_s).sum::<f64>() / self.trajectories.len() as f64;
        let longest_s = self.trajectories.iter().map(Iterate::flight_time_s).fold(0.0, f64::max);
        if self.scenario.fleet.simultaneous_arrival { longest_s } else { mean_s }
    }

    fn summary(&self, last: &[Iterate], solutions: &[Solution], violation: f64, started: Instant) -> Iteration {
        let now: Vec<&Iterate> = self.trajectories.iter().collect();
        let pairs = last.iter().zip(&now);
        let change = pairs.map(|(last, now)| now.change(last)).fold(State::zeros(), |a, b| a.sup(&b));
        let defects_m = self.trajectories.par_iter().map(|now| now.defect_m(self.options.transcription));
        let wall_s = started.elapsed().as_secs_f64();
        let iterations: Vec<usize> = solutions.iter().map(|solution| solution.iterations).collect();
        let (all, most) = (iterations.iter().sum::<usize>(), iterations.iter().max().copied().unwrap_or(0));
        Iteration {
            objective: self.trajectories.iter().map(Iterate::flight_time_s).fold(0.0, f64::max),
            dt_s: longest_dt_s(&self.trajectories),
            defect_m: defects_m.collect::<Vec<_>>().into_iter().fold(0.0, f64::max),
            slack: violation,
            separation_m: node_separation_m(&now),
            clearance_m: node_clearance_m(&now, self.rules.cylinders),
            change_m: change[0].max(change[1]),
            trust_region_m: self.schedule.trust_region()[0],
            solver_iterations: all,
            unsolved: solutions.iter().filter(|solution| solution.status != Status::Solved).count(),
            wall_s,
            // subproblems are solved many at a time: the slowest vehicle's part of the work, by its iterations
            distributed_s: wall_s * rayon::current_num_threads() as f64 * most as f64 / all.max(1) as f64,
        }
    }
}

fn longest_dt_s(trajectories: &[Iterate]) -> f64 {
    trajectories.iter().map(|trajectory| trajectory.dt_s).fold(0.0, f64::max)
}
