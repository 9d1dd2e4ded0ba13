//! The receding-horizon controller: successive replans with warm start, acceptance and fallback.

use rand::Rng;

use super::counter_rng::CounterRng;
use super::deadlock_recovery::{DetourMap, ProgressMonitor, roadmap_motion};
use super::evaluate::SimdLevel;
use super::optimiser::{Budget, Solution, optimise};
use super::problem::{
    Attraction, CLEARANCE_TOLERANCE_M, ControlGrid, Cost, EvaluationOptions, HorizonProblem, Repulsion,
};
use super::sampler::SamplerKind;
use crate::free_space::{FreeSpace, Point};
use crate::multirotor::{PlanningLimits, PointMassMotion, PointMassState, sagitta_m};
use crate::roadmap::{CostMap, RoadmapKind};

/// Settings of a controller.
#[derive(Clone, Debug, PartialEq)]
pub struct ControllerSettings {
    /// Sampling method.
    pub sampler: SamplerKind,
    /// Limits of the search.
    pub budget: Budget,
    /// Cost of feasible particles.
    pub cost_model: CostModel,
    /// Steps and coordinates of the horizon.
    pub grid: ControlGrid,
    /// Sampling time T, s.
    pub step_s: f64,
    /// Norm bounds.
    pub limits: PlanningLimits,
    /// Required distance from obstacles and bounds, m.
    pub clearance_m: f64,
    /// Weights w_1, w_2, w_3 of the violations of distance, speed and acceleration (eq. 12).
    pub violation_weights: [f64; 3],
    /// Weight of the squared changes of acceleration, m per (m/s²)².
    pub smoothness_weight: f64,
    /// Weight of the mean cost-to-go over the horizon, -.
    pub stage_weight: f64,
    /// The shifted previous plan is the first particle.
    pub starts_warm: bool,
    /// Controls are projected onto the norm bounds.
    pub projects_controls: bool,
    /// Every horizon ends with a stop in known free space.
    pub requires_stop: bool,
    /// Without a required stop: the stopping distance at the end of a horizon that can reach the goal is part of the cost.
    pub brakes_at_goal: bool,
    /// The cost of infeasible particles is computed too.
    pub costs_infeasible: bool,
    /// Distance within which all static obstacles are known, m; infinite for a known map.
    pub known_radius_m: f64,
}

/// Cost of feasible particles.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum CostModel {
    /// A cost map (eq. 10), with an optional repulsion (eq. 16).
    CostMap {
        /// How the map's graph is built.
        roadmap: RoadmapKind,
        /// U_rep.
        repulsion: Option<Repulsion>,
    },
    /// A potential field without a map (eq. 17).
    PotentialField {
        /// U_att.
        attraction: Attraction,
        /// U_rep.
        repulsion: Repulsion,
    },
}

/// Plans for one vehicle.
#[derive(Debug)]
pub struct RecedingHorizonController<R> {
    settings: ControllerSettings,
    goal: Point,
    map: CostMap,
    progress: ProgressMonitor,
    detour_map: Option<DetourMap>,
    stream: R,
    simd_level: SimdLevel,
}

/// Decision of a replan.
#[derive(Clone, Debug, PartialEq)]
pub enum Decision {
    /// A new motion, which ends at rest.
    Fly(PointMassMotion),
    /// The motion in force is flown to its end.
    Keep,
}

/// A decision, and the result of the search that led to it.
#[derive(Clone, Debug, PartialEq)]
pub struct Replan {
    /// The decision.
    pub decision: Decision,
    /// The result of the search.
    pub solution: Solution,
    /// Whether the vehicle follows the roadmap out of a deadlock.
    pub follows_roadmap: bool,
    /// Whether the cost map has a path from the start to the goal; true if there was no search.
    pub has_path: bool,
}

impl<R: Rng> RecedingHorizonController<R> {
    /// For a vehicle on its way to `goal`. The cost map has its nodes at `node_altitudes_m`, m; `stream` gives the random
    /// keys of the replans.
    pub fn new(settings: ControllerSettings, goal: Point, node_altitudes_m: Vec<f64>, stream: R) -> Self {
        let kind = match settings.cost_model {
            CostModel::CostMap { roadmap, .. } => roadmap,
            CostModel::PotentialField { .. } => RoadmapKind::Visibility,
        };
        let map = CostMap::new(kind, goal, settings.clearance_m, node_altitudes_m);
        Self {
            settings,
            goal,
            map,
            progress: ProgressMonitor::new(),
            detour_map: None,
            stream,
            simd_level: SimdLevel::detect(),
        }
    }

    /// The cost map.
    pub fn map(&self) -> &CostMap {
        &self.map
    }

    /// Plans from `start` at time 0.
    ///
    /// - `in_force`: the remaining motion in force, the fallback, from time 0 on
    /// - `applied_acceleration`: the acceleration just before time 0, m/s²
    /// - `space`: the known world at time 0
    pub fn replan(
        &mut self,
        start: PointMassState,
        in_force: &PointMassMotion,
        applied_acceleration: Point,
        space: &FreeSpace,
    ) -> Replan {
        let start = PointMassState { velocity: start.velocity.cap_magnitude(self.settings.limits.speed_mps), ..start };
        if matches!(self.settings.cost_model, CostModel::CostMap { .. }) && self.map.update(space) {
            self.progress.reset();
        }
        // planners that do not require a stop have no recovery
        let cost_to_go = self.settings.requires_stop.then(|| self.map.cost_to_go(start.position, space));
        let known = cost_to_go.flatten();
        let is_deadlocked = known.is_some_and(|known| self.progress.is_deadlocked(known.length_m));
        if is_deadlocked {
            self.detour_map = DetourMap::around_resting(self.detour_map.take(), space, &self.map);
        }
        let rng = CounterRng::new(self.stream.next_u64());
        let problem = self.problem(start, applied_acceleration, space);
        let seeds = self.seeds(in_force);
        let solution = optimise(&problem, self.settings.sampler, self.settings.budget, &seeds, rng, self.simd_level);
        let recovery = is_deadlocked.then(|| self.recover(&problem, in_force)).flatten();
        let follows_roadmap = recovery.is_some();
        let decision = recovery.unwrap_or_else(|| self.decide(&problem, &solution, in_force));
        Replan { decision, solution, follows_roadmap, has_path: cost_to_go != Some(None) }
    }

    /// The motion in force while it lasts, else the next part of the roadmap, around vehicles that rest; `None` if neither is
    /// clear.
    fn recover(&self, problem: &HorizonProblem<'_>, in_force: &PointMassMotion) -> Option<Decision> {
        let lasts = in_force.last().0 > problem.step_s;
        if lasts && in_force.is_clear(0.0, problem.space, problem.clearance_m - CLEARANCE_TOLERANCE_M) {
            return Some(Decision::Keep);
        }
        let path_from = |point: Point| match &self.detour_map {
            Some(detour_map) => detour_map.path_from(point),
            None => self.map.path_from(point, problem.space),
        };
        roadmap_motion(problem, path_from, self.settings.known_radius_m).map(Decision::Fly)
    }

    fn problem<'a>(
        &'a self,
        start: PointMassState,
        applied_acceleration: Point,
        space: &'a FreeSpace,
    ) -> HorizonProblem<'a> {
        let settings = &self.settings;
        let cost = match settings.cost_model {
            CostModel::CostMap { repulsion, .. } => Cost::CostMap { map: &self.map, repulsion },
            CostModel::PotentialField { attraction, repulsion } => Cost::PotentialField { attraction, repulsion },
        };
        let mut problem = HorizonProblem {
            start,
            applied_acceleration,
            goal: self.goal,
            space,
            limits: settings.limits,
            grid: settings.grid,
            step_s: settings.step_s,
            clearance_m: settings.clearance_m,
            cost,
            violation_weights: settings.violation_weights,
            smoothness_weight: settings.smoothness_weight,
            stage_weight: settings.stage_weight,
            costs_final_speed: false,
            options: EvaluationOptions {
                projects_controls: settings.projects_controls,
                stop_after_step: settings.requires_stop.then(|| self.steps_in_known_space()),
                costs_infeasible: settings.costs_infeasible,
            },
        };
        problem.costs_final_speed =
            !settings.requires_stop && settings.brakes_at_goal && problem.is_goal_within_reach();
        problem
    }

    /// Number of steps at full speed after which the vehicle can still stop within known space; at least one, at most the
    /// whole horizon.
    fn steps_in_known_space(&self) -> usize {
        let settings = &self.settings;
        let distance_m = settings.known_radius_m - settings.limits.stopping_distance_m() - settings.clearance_m;
        let steps = (distance_m / (settings.limits.speed_mps * settings.step_s)).floor();
        (steps.max(1.0) as usize).min(settings.grid.steps)
    }

    /// The first particles: with warm start the controls of the motion in force.
    fn seeds(&self, in_force: &PointMassMotion) -> Vec<Vec<f64>> {
        let ControlGrid { steps, axes } = self.settings.grid;
        if !self.settings.starts_warm {
            return Vec::new();
        }
        let accelerations = in_force.mean_accelerations(0.0, self.settings.step_s, steps);
        vec![accelerations.iter().flat_map(|acceleration| acceleration.as_slice()[..axes].to_vec()).collect()]
    }

    /// Selects, in this order: the best particle if it is feasible, the motion in force if it is clear, an immediate stop
    /// if it is clear, the particle with the smallest violation. Without a required stop, the immediate stop takes the
    /// place of the last.
    ///
    /// With a required stop, the best particle's motion is checked again, arc by arc, independently of the sampler's
    /// evaluation.
    fn decide(&self, problem: &HorizonProblem<'_>, solution: &Solution, in_force: &PointMassMotion) -> Decision {
        let settings = &self.settings;
        let best = self.motion(problem, solution);
        let is_safe = |motion: &PointMassMotion, clearance_m: f64| {
            motion.is_clear(0.0, problem.space, clearance_m - CLEARANCE_TOLERANCE_M)
        };
        if solution.fitness.is_feasible()
            && (!settings.requires_stop || is_safe(&best, self.achievable_clearance_m(problem)))
        {
            return Decision::Fly(best);
        }
        if is_safe(in_force, problem.clearance_m) {
            return Decision::Keep;
        }
        let mut halt = PointMassMotion::from(problem.start);
        halt.brake(settings.limits.acceleration_mps2, settings.step_s);
        let prefers_halt = !settings.requires_stop || is_safe(&halt, problem.clearance_m);
        Decision::Fly(if prefers_halt { halt } else { best })
    }

    /// The largest clearance, up to the required one, that a motion from the start can keep, m.
    fn achievable_clearance_m(&self, problem: &HorizonProblem<'_>) -> f64 {
        // a step that begins within an arc may fall short by the arc's sagitta
        let sagitta_m = sagitta_m(problem.limits.acceleration_mps2, problem.step_s);
        problem.clearance_m.min(problem.start_clearance_m() - sagitta_m)
    }

    /// The motion of the best particle: its controls as far as space is known, then a stop.
    fn motion(&self, problem: &HorizonProblem<'_>, solution: &Solution) -> PointMassMotion {
        let ControlGrid { steps, axes } = problem.grid;
        let mut motion = PointMassMotion::from(problem.start);
        for step in 0..problem.options.stop_after_step.unwrap_or(steps) {
            let mut acceleration = Point::zeros();
            acceleration.as_mut_slice()[..axes].copy_from_slice(&solution.controls[step * axes..(step + 1) * axes]);
            motion.accelerate(acceleration, problem.step_s);
        }
        motion.brake(problem.limits.acceleration_mps2, problem.step_s);
        motion
    }
}
