//! From instant to instant: what a planner in the loop remembers, and what it flies when the search finds nothing.

use rand::Rng;

use super::cost_map::{CostMap, Ways};
use super::draw::Draws;
use super::evaluate::Machine;
use super::motion::{Motion, State, sagitta_m};
use super::optimise::{Budget, Found, optimise};
use super::question::{Cost, Grid, Limits, Question, Repulsion, Rules};
use super::sampler::Method;
use crate::free_space::FreeSpace;
use crate::free_space::vector::{Point, shortened};

/// Difference of rounding between two ways to compute a distance, m.
const ROUNDING_M: f64 = 1e-9;

/// How a pilot plans.
#[derive(Clone, Debug, PartialEq)]
pub struct Options {
    /// How it searches.
    pub method: Method,
    /// How long.
    pub budget: Budget,
    /// What the search is charged with.
    pub charge: Charge,
    /// The grid of the horizon.
    pub grid: Grid,
    /// Sampling time T, s.
    pub step_s: f64,
    /// Limits that it keeps.
    pub limits: Limits,
    /// Distance from everything that it keeps, m.
    pub clearance_m: f64,
    /// Weight of the squared changes of acceleration, m per (m/s²)².
    pub smoothness: f64,
    /// Weight of the mean cost to go over the horizon, -.
    pub stage_weight: f64,
    /// The last plan, shifted, is the first particle.
    pub starts_warm: bool,
    /// Controls are projected onto the norm bounds.
    pub is_projected: bool,
    /// Every horizon can be ended by a stop in free space.
    pub stops: bool,
    /// The cost of infeasible particles is computed too.
    pub costs_infeasible: bool,
    /// Distance within which everything is known, m; infinite if the whole map is.
    pub known_within_m: f64,
}

/// What the search is charged with.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum Charge {
    /// A cost map (eq. 10), with repulsion (eq. 16) where there is one.
    Map(Ways, Option<Repulsion>),
    /// Attraction with that gain, and repulsion (eq. 17).
    Field(f64, Repulsion),
}

/// Plans for one vehicle.
#[derive(Debug)]
pub struct Pilot<R> {
    options: Options,
    goal: Point,
    map: CostMap,
    stream: R,
    machine: Machine,
}

/// What a pilot decides.
#[derive(Clone, Debug, PartialEq)]
pub enum Decision {
    /// A new motion, which ends at rest.
    Fly(Motion),
    /// The motion in force is flown on to its end.
    Keep,
}

/// A decision, and what the search found on the way to it.
#[derive(Clone, Debug, PartialEq)]
pub struct Replan {
    /// What is to be done.
    pub decision: Decision,
    /// What the search found.
    pub found: Found,
}

impl<R: Rng> Pilot<R> {
    /// For a vehicle on its way to `goal`; cost maps have their nodes at `levels_m`.
    pub fn new(options: Options, goal: Point, levels_m: Vec<f64>, stream: R) -> Self {
        let ways = match options.charge {
            Charge::Map(ways, _) => ways,
            Charge::Field(..) => Ways::Visibility,
        };
        let map = CostMap::new(ways, goal, options.clearance_m, levels_m);
        Self { options, goal, map, stream, machine: Machine::detect() }
    }

    /// The cost map.
    pub fn map(&self) -> &CostMap {
        &self.map
    }

    /// Plans from `start` at time 0, where also `space` and `flown` begin: the rest of the motion in force, for the case
    /// that nothing better is found.
    pub fn replan(&mut self, start: State, flown: &Motion, applied: Point, space: &FreeSpace) -> Replan {
        let start = State { velocity: shortened(start.velocity, self.options.limits.speed_mps), ..start };
        if matches!(self.options.charge, Charge::Map(..)) {
            self.map.update(space);
        }
        let draws = Draws::new(self.stream.next_u64());
        let question = self.question(start, applied, space);
        let seeds = self.seeds(flown);
        let found = optimise(&question, self.options.method, self.options.budget, &seeds, draws, self.machine);
        Replan { decision: self.decide(&question, &found, flown), found }
    }

    fn question<'a>(&'a self, start: State, applied: Point, space: &'a FreeSpace) -> Question<'a> {
        let options = &self.options;
        let cost = match options.charge {
            Charge::Map(_, repulsion) => Cost::Map { map: &self.map, repulsion },
            Charge::Field(attraction, repulsion) => Cost::Field { attraction, repulsion },
        };
        let mut question = Question {
            start,
            applied,
            goal: self.goal,
            space,
            limits: options.limits,
            grid: options.grid,
            step_s: options.step_s,
            clearance_m: options.clearance_m,
            cost,
            smoothness: options.smoothness,
            stage_weight: options.stage_weight,
            charges_speed: false,
            rules: Rules {
                is_projected: options.is_projected,
                stops_after: options.stops.then(|| self.steps_in_known_space()),
                costs_infeasible: options.costs_infeasible,
            },
        };
        question.charges_speed = !options.stops && question.is_near_goal();
        question
    }

    /// Steps after which a vehicle at full speed can still stop within what is known; the whole horizon at most.
    fn steps_in_known_space(&self) -> usize {
        let options = &self.options;
        let room_m = options.known_within_m - options.limits.stopping_distance_m() - options.clearance_m;
        let steps = (room_m / (options.limits.speed_mps * options.step_s)).floor();
        (steps.max(1.0) as usize).min(options.grid.steps)
    }

    /// First particles: the motion in force.
    fn seeds(&self, flown: &Motion) -> Vec<Vec<f64>> {
        let Grid { steps, axes } = self.options.grid;
        if !self.options.starts_warm {
            return Vec::new();
        }
        let accelerations = flown.mean_accelerations(0.0, self.options.step_s, steps);
        vec![accelerations.iter().flat_map(|acceleration| acceleration[..axes].to_vec()).collect()]
    }

    /// What is flown: the best particle if it is feasible, else the motion in force while that is clear, else a stop
    /// here, else the particle that violates least.
    ///
    /// Acceptance does not rest on the swarm's arithmetic alone: the motion is looked at once more, arc by arc.
    fn decide(&self, question: &Question<'_>, found: &Found, flown: &Motion) -> Decision {
        let options = &self.options;
        let best = self.motion(question, found);
        let is_safe =
            |motion: &Motion, clearance_m: f64| motion.is_clear(0.0, question.space, clearance_m - ROUNDING_M);
        if found.fitness.is_feasible() && (!options.stops || is_safe(&best, self.reachable_m(question))) {
            return Decision::Fly(best);
        }
        if is_safe(flown, question.clearance_m) {
            return Decision::Keep;
        }
        let mut halt = Motion::from(question.start);
        halt.brake(options.limits.acceleration_mps2, options.step_s);
        let is_halt_better = !options.stops || is_safe(&halt, question.clearance_m);
        Decision::Fly(if is_halt_better { halt } else { best })
    }

    /// The clearance that a motion from here can have, m.
    fn reachable_m(&self, question: &Question<'_>) -> f64 {
        let here = question.start.position;
        let now_m = question.space.distance_m(here).min(question.space.distance_to_moving_m(here, 0.0));
        // a step that begins mid-way on an arc may fall short by the arc's height
        question.clearance_m.min(now_m - sagitta_m(question.limits.acceleration_mps2, question.step_s))
    }

    /// The motion that a particle stands for: so far as all is known, then to a stop.
    fn motion(&self, question: &Question<'_>, found: &Found) -> Motion {
        let Grid { steps, axes } = question.grid;
        let mut motion = Motion::from(question.start);
        for step in 0..question.rules.stops_after.unwrap_or(steps) {
            let mut acceleration = [0.0; 3];
            acceleration[..axes].copy_from_slice(&found.controls[step * axes..(step + 1) * axes]);
            motion.accelerate(acceleration, question.step_s);
        }
        motion.brake(question.limits.acceleration_mps2, question.step_s);
        motion
    }
}
