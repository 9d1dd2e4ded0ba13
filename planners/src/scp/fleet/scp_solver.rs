//! The sequence of convex programs: linearise about the last trajectories, add avoidance rows, solve, update.

use std::fmt;
use std::time::Instant;

use rayon::prelude::*;
use scenarios::{Iteration, Range, Scenario};

use super::super::dynamics::State;
use super::super::iterate::{Iterate, max_dt_s, max_flight_time_s};
use super::super::options::Options;
use super::super::plan::{node_clearance_m, node_separation_m};
use super::super::scaling::scaled_state;
use super::super::shooting;
use super::super::subproblem::{self, Context};
use super::super::subproblem_solver::SubproblemSolver;
use super::acceptance::{self, ConstraintViolation};
use super::agility::Agility;
use super::avoidance_rows::{AvoidanceConstraints, avoidance_rows};
use super::climb;
use super::conflict_detection::FleetMotion;
use super::holding::{self, Blocked};
use super::initial_guess::InitialGuess;
use super::intersample_bounds::Tightening;
use super::schedule::{MAX_VIOLATION, TrustRegionSchedule};
use crate::convex::{HalfspaceConstraint, Program, STAGE_LEN, Solution, Status};

/// Relative gap of the subproblems in the search phase and in the settling phase.
const TOLERANCES: [f64; 2] = [1e-5, 1e-8];

/// Relative difference below which step lengths are made equal: vehicles that arrive together share their nodes.
const EQUAL_DT_TOLERANCE: f64 = 1e-6;

/// Factor on the penalty after vehicles have been stuck: what they would have saved by their violations exceeded it.
const REROUTED_PENALTY_FACTOR: f64 = 5.0;

/// Length of an interval, relative to what the vehicle's agility asks for, above which it is too long.
const COARSE: f64 = 1.6;

/// A vehicle with intervals that are too long for it.
#[derive(Clone, Copy, Debug)]
pub struct Coarse<'a> {
    /// Name of the vehicle.
    pub vehicle: &'a str,
    /// Length of its intervals, s.
    pub interval_s: f64,
    /// Number of intervals that would be short enough.
    pub intervals: usize,
}

/// The motion of a fleet until the last vehicle has arrived.
#[derive(Default)]
pub struct FleetSolution {
    /// Until the arrival of each vehicle.
    pub trajectories: Vec<Iterate>,
    /// From then on; `None` for those that arrive last.
    pub holds: Vec<Option<Iterate>>,
}

/// Why trajectories are no solution.
#[derive(Clone, Debug)]
pub enum NoSolution {
    /// The first constraint that they violate.
    Violated(ConstraintViolation),
    /// They keep every constraint, but a vehicle cannot stay clear after its arrival.
    Blocked(Blocked),
}

impl fmt::Display for NoSolution {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        match self {
            Self::Violated(violation) => violation.fmt(f),
            Self::Blocked(blocked) => blocked.fmt(f),
        }
    }
}

/// The fleet between two iterations.
pub struct ScpSolver<'a> {
    scenario: &'a Scenario,
    options: Options,
    constraints: AvoidanceConstraints<'a>,
    /// Tightening of the bounds at the nodes, per vehicle.
    tightening: Vec<Tightening>,
    /// Planning limits of every vehicle, and what of the flight-path angle its plan needs.
    planned: Vec<[Range; STAGE_LEN]>,
    /// Planning limits of every vehicle.
    bounds: Vec<[Range; STAGE_LEN]>,
    /// Initial and final state of every vehicle.
    boundary: Vec<[State; 2]>,
    /// Factors on the trust region of every vehicle.
    scales: Vec<State>,
    trajectories: Vec<Iterate>,
    /// Penalty of the subproblems, s per scaled unit of violation.
    penalty: f64,
    /// Violation that the last subproblem of each vehicle was left with, in scaled units.
    violations: Vec<f64>,
    /// Number of routes that each vehicle has tried before its present one.
    attempts: Vec<usize>,
    /// The vehicles by number of intervals: subproblems of one shape are solved together.
    order: Vec<usize>,
    schedule: TrustRegionSchedule,
    /// One per tolerance of [`TOLERANCES`].
    solvers: [SubproblemSolver; 2],
}

impl<'a> ScpSolver<'a> {
    /// The solver at the initial guess.
    pub fn new(scenario: &'a Scenario, options: Options) -> Self {
        let constraints = AvoidanceConstraints::new(scenario, options.margin_m);
        let limits = |vehicle| &scenario.fixed_wing_model(vehicle).planning_limits;
        let map = |vehicle| scenario.world.map.inset(scenario.fixed_wing_model(vehicle).body_radius_m);
        let bounds = |vehicle| subproblem::node_bounds(limits(vehicle), &map(vehicle));
        let attempts = vec![0; scenario.vehicles.len()];
        let InitialGuess { trajectories, boundary } = InitialGuess::new(scenario, &constraints, &attempts);
        let scale = |vehicle| match scenario.planner.trust_region {
            Some(_) => State::repeat(1.0),
            None => Agility::new(limits(vehicle)).trust_region_scale(),
        };
        let bounds: Vec<_> = scenario.vehicles.iter().map(bounds).collect();
        Self {
            scenario,
            constraints,
            tightening: trajectories.iter().map(|trajectory| Tightening::new(trajectory.states.len())).collect(),
            planned: bounds.iter().zip(&trajectories).map(|(bounds, it)| climb::bounds_in_use(bounds, it)).collect(),
            bounds,
            boundary,
            scales: scenario.vehicles.iter().map(scale).collect(),
            order: by_intervals(&trajectories),
            schedule: schedule(scenario, &options, &trajectories),
            solvers: TOLERANCES.map(|tolerance| SubproblemSolver::new(options.solver, options.solver_start, tolerance)),
            penalty: options.penalty,
            violations: vec![0.0; trajectories.len()],
            attempts,
            options,
            trajectories,
        }
    }

    /// Begins to search again, at a higher penalty: vehicles whose subproblems are left with a violation have another
    /// initial route, the others begin with their present trajectories. Those that have to share their nodes with one whose
    /// route has another number of intervals begin anew.
    pub fn reroute(&mut self) {
        let is_stuck = |vehicle: &usize| self.violations[*vehicle] > MAX_VIOLATION;
        let mut rerouted: Vec<usize> = (0..self.violations.len()).filter(is_stuck).collect();
        rerouted.iter().for_each(|&vehicle| self.attempts[vehicle] += 1);
        let InitialGuess { trajectories, boundary } =
            InitialGuess::new(self.scenario, &self.constraints, &self.attempts);
        let shares_nodes = |vehicle: &usize| trajectories[*vehicle].intervals() == self.trajectories[0].intervals();
        if self.scenario.fleet.simultaneous_arrival && !rerouted.iter().all(shares_nodes) {
            rerouted = (0..trajectories.len()).collect();
        }
        for vehicle in rerouted {
            let trajectory = &trajectories[vehicle];
            self.tightening[vehicle] = Tightening::new(trajectory.states.len());
            self.planned[vehicle] = climb::bounds_in_use(&self.bounds[vehicle], trajectory);
            self.trajectories[vehicle] = trajectory.clone();
            self.boundary[vehicle] = boundary[vehicle];
        }
        self.order = by_intervals(&self.trajectories);
        self.schedule = schedule(self.scenario, &self.options, &self.trajectories);
        self.penalty = REROUTED_PENALTY_FACTOR * self.options.penalty;
    }

    /// One iteration. `inspect` receives the subproblems and their solutions.
    pub fn advance(&mut self, inspect: &dyn Fn(&[Program], &[Solution])) -> Iteration {
        let started = Instant::now();
        let motion = self.motion();
        let scale = self.scales.iter().map(|scale| scale[0]).fold(0.0, f64::max);
        self.tightening.iter_mut().zip(&motion.vehicles).for_each(|(tightening, motion)| tightening.observe(motion));
        let rows = avoidance_rows(&motion, &self.constraints, scale * self.schedule.trust_region()[0]);
        let programs = self.programs(&rows);
        let solutions = self.solvers[usize::from(!self.schedule.is_searching())].solve(&programs);
        inspect(&programs, &solutions);
        let violations = programs.par_iter().zip(&solutions);
        let violations = violations
            .map(|(program, solution)| [program.max_violation(&solution.z), program.max_stage_violation(&solution.z)]);
        let violations: Vec<[f64; 2]> = violations.collect();
        let violation = violations.iter().map(|[violation, _]| *violation).fold(0.0, f64::max);
        let last = self.trajectories.clone();
        for ((&vehicle, solution), [_, violation]) in self.order.iter().zip(&solutions).zip(violations) {
            let updated = subproblem::updated(&last[vehicle], &solution.z);
            self.trajectories[vehicle] = with_ends(updated, &self.boundary[vehicle]);
            self.violations[vehicle] = violation;
        }
        let iteration = self.summary(&last, &solutions, violation, started);
        self.schedule.observe(self.objective_s(), iteration.dt_s, violation);
        iteration
    }

    /// The solution, or why the trajectories are none; `None` in the search phase.
    pub fn solution(&self) -> Option<Result<FleetSolution, NoSolution>> {
        (!self.schedule.is_searching()).then(|| self.checked())
    }

    /// Has it settled without a solution?
    pub fn has_stalled(&self) -> bool {
        self.schedule.has_failed()
    }

    /// The trajectories with what follows on them, if they can be flown.
    ///
    /// # Errors
    ///
    /// Why they cannot.
    pub fn checked(&self) -> Result<FleetSolution, NoSolution> {
        let trajectories = self.synchronised();
        let Self { scenario, constraints, bounds, boundary, .. } = self;
        match acceptance::first_violation(scenario, constraints, &trajectories, bounds, boundary) {
            Some(violation) => Err(NoSolution::Violated(violation)),
            None => match holding::holds(scenario, constraints, &trajectories, bounds) {
                Ok(holds) => Ok(FleetSolution { trajectories, holds }),
                Err(blocked) => Err(NoSolution::Blocked(blocked)),
            },
        }
    }

    /// The trajectories, with equal step lengths where these differ only by the solver's tolerance.
    fn synchronised(&self) -> Vec<Iterate> {
        let max_s = max_dt_s(&self.trajectories);
        let joined = |trajectory: &Iterate| {
            let is_max = max_s - trajectory.dt_s < EQUAL_DT_TOLERANCE * max_s;
            Iterate { dt_s: if is_max { max_s } else { trajectory.dt_s }, ..trajectory.clone() }
        };
        self.trajectories.iter().map(joined).collect()
    }

    /// The vehicle whose intervals are longest for its agility, if they are too long for one.
    pub fn coarsest(&self) -> Option<Coarse<'_>> {
        let agility = |vehicle: usize| {
            Agility::new(&self.scenario.fixed_wing_model(&self.scenario.vehicles[vehicle]).planning_limits)
        };
        let excess = |vehicle: usize| self.trajectories[vehicle].dt_s / agility(vehicle).interval_s();
        let vehicle = (0..self.trajectories.len()).max_by(|a, b| excess(*a).total_cmp(&excess(*b)))?;
        let trajectory = &self.trajectories[vehicle];
        (excess(vehicle) > COARSE).then(|| Coarse {
            vehicle: &self.scenario.vehicles[vehicle].name,
            interval_s: trajectory.dt_s,
            intervals: agility(vehicle).intervals(trajectory.flight_time_s()),
        })
    }

    fn motion(&self) -> FleetMotion {
        let simultaneous = self.scenario.fleet.simultaneous_arrival;
        if simultaneous { FleetMotion::synchronised(&self.trajectories) } else { FleetMotion::new(&self.trajectories) }
    }

    /// The subproblems, in their order.
    fn programs(&self, rows: &[Vec<HalfspaceConstraint>]) -> Vec<Program> {
        let goes_on = !self.scenario.fleet.simultaneous_arrival;
        let program = |&i: &usize| {
            let bounds = self.tightening[i].applied_to(&self.planned[i], &self.trajectories[i], goes_on);
            let context = Context {
                options: &self.options,
                penalty: self.penalty,
                boundary: self.boundary[i],
                bounds: &bounds,
                trust_region: self.schedule.trust_region().component_mul(&self.scales[i]),
                dt_bound_s: self.schedule.bound_s(),
                dt_change: self.schedule.time_change(),
                control_change: self.schedule.control_change(),
            };
            let mut program = subproblem::assemble(&context, &self.trajectories[i], rows[i].clone());
            if !self.schedule.is_searching() {
                use_accurate_defects(&mut program, &self.trajectories[i]);
            }
            program
        };
        self.order.par_iter().map(program).collect()
    }

    /// The objective, s: the longest flight time if all arrive together, else the mean.
    fn objective_s(&self) -> f64 {
        let mean_s = self.trajectories.iter().map(Iterate::flight_time_s).sum::<f64>() / self.trajectories.len() as f64;
        if self.scenario.fleet.simultaneous_arrival { max_flight_time_s(&self.trajectories) } else { mean_s }
    }

    fn summary(&self, last: &[Iterate], solutions: &[Solution], violation: f64, started: Instant) -> Iteration {
        let now: Vec<&Iterate> = self.trajectories.iter().collect();
        let pairs = last.iter().zip(&now);
        let change = pairs.map(|(last, now)| now.change(last)).fold(State::zeros(), |a, b| a.sup(&b));
        let defects_m = self.trajectories.par_iter().map(|now| now.defect_m(self.options.transcription));
        let wall_s = started.elapsed().as_secs_f64();
        let iterations: Vec<usize> = solutions.iter().map(|solution| solution.iterations).collect();
        let (sum, max) = (iterations.iter().sum::<usize>(), iterations.iter().max().copied().unwrap_or(0));
        Iteration {
            objective: max_flight_time_s(&self.trajectories),
            dt_s: max_dt_s(&self.trajectories),
            defect_m: defects_m.collect::<Vec<_>>().into_iter().fold(0.0, f64::max),
            slack: violation,
            separation_m: node_separation_m(&now),
            clearance_m: node_clearance_m(self.scenario, &now),
            change_m: change[0].max(change[1]),
            trust_region_m: self.schedule.trust_region()[0],
            solver_iterations: sum,
            unsolved: solutions.iter().filter(|solution| solution.status != Status::Solved).count(),
            wall_s,
            // subproblems are solved in batches: the wall time is apportioned by iterations
            distributed_s: wall_s * rayon::current_num_threads() as f64 * max as f64 / sum.max(1) as f64,
        }
    }
}

/// The vehicles by number of intervals.
fn by_intervals(trajectories: &[Iterate]) -> Vec<usize> {
    let mut order: Vec<usize> = (0..trajectories.len()).collect();
    order.sort_by_key(|vehicle| trajectories[*vehicle].intervals());
    order
}

fn schedule(scenario: &Scenario, options: &Options, trajectories: &[Iterate]) -> TrustRegionSchedule {
    let simultaneous_dt_s = scenario.fleet.simultaneous_arrival.then(|| max_dt_s(trajectories));
    TrustRegionSchedule::new(options.trust_region, options.shrink, options.time_bound_release, simultaneous_dt_s)
}

/// The trajectory, with exactly the given start and goal: a distance from them becomes a defect of the dynamics.
fn with_ends(mut trajectory: Iterate, [start, goal]: &[State; 2]) -> Iterate {
    let last = trajectory.intervals();
    (trajectory.states[0], trajectory.states[last]) = (*start, *goal);
    trajectory
}

/// Replaces the defects of the flow with derivatives by those of the accurate one: its derivatives are accurate enough.
fn use_accurate_defects(program: &mut Program, trajectory: &Iterate) {
    for (k, constraint) in program.dynamics.iter_mut().enumerate() {
        let interval = trajectory.interval(k);
        constraint.rhs = scaled_state(&(shooting::accurate_end(&interval) - interval.states[1]));
    }
}
