//! The registered planners, and the translation of observations for the controller.

use std::collections::{HashSet, VecDeque};

use rand::Rng;
use scenarios::in_loop::{self, InLoopPlanner, Observation, PlannerRemarks, ReplanDiagnostics, ReplanResult};
use scenarios::{Scenario, ViaPoint, stream};

use super::controller::{Decision, RecedingHorizonController, Replan};
use super::obstacle_prediction::predict;
use super::settings::{self, Variant};
use crate::free_space::{FreeSpace, Point, world};
use crate::multirotor::reference::{motion_from_nodes, nodes_from_motion};
use crate::multirotor::{self, PointMassMotion, PointMassState};
use crate::planner::{Planner, PlanningMode};

/// Receding horizon with the additions to the paper.
pub const RHC: Planner = planner(
    "rhc",
    "receding horizon that always ends in a stop in free space: warm start, projection, swarm or other samplers",
    |scenario, vehicle, seed| create(scenario, vehicle, seed, Variant::Default),
);

/// RHC-PSO.
pub const RHC_PSO: Planner = planner(
    "rhc-pso",
    "receding horizon by particle swarm with cost map, as in the paper",
    |scenario, vehicle, seed| create(scenario, vehicle, seed, Variant::Pso),
);

/// RHC-FPSO.
pub const RHC_FPSO: Planner = planner(
    "rhc-fpso",
    "the same with the feasibility-driven swarm of the paper (eq. 15)",
    |scenario, vehicle, seed| create(scenario, vehicle, seed, Variant::Fpso),
);

/// RHC-FPSO with the paper's update alone.
pub const RHC_FPSO_PLAIN: Planner = planner(
    "rhc-fpso-plain",
    "rhc-fpso without our additions: the best particle is not put back, and nothing brakes near the goal",
    |scenario, vehicle, seed| create(scenario, vehicle, seed, Variant::PlainFpso),
);

/// RHC-APF.
pub const RHC_APF: Planner = planner(
    "rhc-apf",
    "the same with an artificial potential field beside the cost map (eq. 16) or instead of it (eq. 17)",
    |scenario, vehicle, seed| create(scenario, vehicle, seed, Variant::Apf),
);

const fn planner(
    name: &'static str,
    summary: &'static str,
    create: fn(&Scenario, usize, u64) -> Box<dyn InLoopPlanner>,
) -> Planner {
    Planner {
        name,
        summary,
        handles: "multirotors among obstacles known, sensed or moving",
        unsupported_reason,
        mode: PlanningMode::InLoop(create),
    }
}

/// Distance in space between two vehicles with which the separation rule holds, m.
fn separation_m(scenario: &Scenario) -> Option<f64> {
    scenario.separation()?.spatial_m
}

fn unsupported_reason(scenario: &Scenario) -> Option<String> {
    let is_horizontal = scenario.separation().is_some_and(|rule| rule.spatial_m.is_none());
    multirotor::unsupported_reason(scenario).or_else(|| {
        let reason = "it keeps vehicles apart in space, not horizontally: set fleet.separation_shape to another shape";
        is_horizontal.then(|| reason.to_owned())
    })
}

fn create(scenario: &Scenario, vehicle: usize, seed: u64, variant: Variant) -> Box<dyn InLoopPlanner> {
    let own = &scenario.vehicles[vehicle];
    let settings = settings::controller_settings(scenario, vehicle, variant);
    let body_radius_m = multirotor::body_radius_m(scenario, vehicle);
    let clearance_m = settings.clearance_m;
    let altitudes_m = settings::node_altitudes_m(scenario, vehicle);
    let controller = |leg: String, target_m: [f64; 3]| {
        let stream = stream(seed, &format!("horizon/{leg}"));
        RecedingHorizonController::new(settings.clone(), target_m.into(), altitudes_m.clone(), stream)
    };
    let via = own.via.iter().enumerate();
    let to_via =
        via.map(|(index, via)| (controller(format!("{}/via-{index}", own.name), via.position_m()), Some(*via)));
    let mut legs: VecDeque<_> = to_via.chain([(controller(own.name.clone(), own.goal.position_m()), None)]).collect();
    let (controller, via) = legs.pop_front().expect("the leg to the goal");
    Box::new(HorizonPlanner {
        controller,
        via,
        legs,
        space: FreeSpace::empty(world::bounds_m(&scenario.world, scenario.is_planar())),
        known_names: HashSet::new(),
        min_neighbour_radius_m: separation_m(scenario).map_or(0.0, |separation_m| separation_m - body_radius_m),
        is_planar: scenario.is_planar(),
        name: own.name.clone(),
        clearance_m,
        without_path_since_s: None,
        // the tracker may use up the margin
        tracking_tolerance_m: if variant == Variant::Default { clearance_m - body_radius_m } else { 0.0 },
    })
}

/// A controller with the world that its vehicle knows so far.
struct HorizonPlanner<R> {
    /// To the via-point `via`, or to the goal.
    controller: RecedingHorizonController<R>,
    via: Option<ViaPoint>,
    /// The legs after that one.
    legs: VecDeque<(RecedingHorizonController<R>, Option<ViaPoint>)>,
    space: FreeSpace,
    /// Names of the static obstacles in `space`.
    known_names: HashSet<String>,
    /// Smallest radius of other vehicles, which ensures the fleet's separation, m.
    min_neighbour_radius_m: f64,
    /// Distance between measured position and reference up to which the reference is taken as the true state, m.
    tracking_tolerance_m: f64,
    /// Plans at constant altitude.
    is_planar: bool,
    /// Name of the vehicle.
    name: String,
    /// Required distance from obstacles and bounds, m.
    clearance_m: f64,
    /// Since when the cost map has had no path to the goal, s.
    without_path_since_s: Option<f64>,
}

impl<R: Rng + Send> InLoopPlanner for HorizonPlanner<R> {
    fn replan(&mut self, observation: &Observation<'_>) -> ReplanResult {
        let begins_leg = self.begin_next_leg(observation);
        let is_map_updated = self.update_space(observation) || begins_leg;
        let here = PointMassState::at_rest(observation.position_m.into());
        let in_force = motion_from_nodes(observation.in_force, observation.takes_effect_s)
            .unwrap_or_else(|| PointMassMotion::from(here));
        let start = self.predict_start(observation, &in_force);
        let applied_acceleration = in_force.mean_accelerations(-APPLIED_WINDOW_S, APPLIED_WINDOW_S, 1)[0];
        let replan = self.controller.replan(start, &in_force.tail_from(0.0), applied_acceleration, &self.space);
        self.without_path_since_s = (!replan.has_path).then(|| self.without_path_since_s.unwrap_or(observation.t_s));
        let graph = is_map_updated.then(|| self.controller.map().roadmap().edges().map(|ends| ends.map(Into::into)));
        let graph = graph.map(Iterator::collect);
        self.result(replan, observation.takes_effect_s, graph)
    }

    fn finish(&mut self) -> PlannerRemarks {
        let note = self.without_path_since_s.map(|since_s| {
            format!(
                "from {since_s:.1} s on, {} knew of no path to its goal that keeps {:.2} m from everything known to it",
                self.name, self.clearance_m
            )
        });
        PlannerRemarks { notes: note.into_iter().collect(), failure: None }
    }
}

/// A via-point counts as passed within this fraction of its radius: positions are measured with noise.
const PASSED_FRACTION: f64 = 0.8;

/// Time before the horizon over which the applied acceleration is averaged, s.
const APPLIED_WINDOW_S: f64 = 0.05;

impl<R: Rng> HorizonPlanner<R> {
    /// Goes on to the next leg where a via-point is passed. True if it does.
    fn begin_next_leg(&mut self, observation: &Observation<'_>) -> bool {
        let is_passed = |via: ViaPoint| {
            let offset = Point::from(observation.position_m) - Point::from(via.position_m());
            let has_opened = via.window_s.is_none_or(|window| observation.t_s > window.min);
            has_opened && offset.norm() <= PASSED_FRACTION * via.radius_m
        };
        if !self.via.is_some_and(is_passed) {
            return false;
        }
        let Some((controller, via)) = self.legs.pop_front() else { return false };
        (self.controller, self.via) = (controller, via);
        true
    }

    /// Adds newly known static obstacles and replaces the moving ones. True if there are new static obstacles.
    fn update_space(&mut self, observation: &Observation<'_>) -> bool {
        let before = self.space.static_obstacles.len();
        for (name, obstacle) in world::static_obstacles(observation.known) {
            if self.known_names.insert(name) {
                self.space.static_obstacles.push(obstacle);
            }
        }
        self.space.moving_obstacles = predict(observation, self.min_neighbour_radius_m);
        before != self.space.static_obstacles.len()
    }

    /// The predicted state when the answer takes effect: that of the reference, corrected by the present tracking error if
    /// it exceeds the tolerance.
    fn predict_start(&self, observation: &Observation<'_>, in_force: &PointMassMotion) -> PointMassState {
        let now = in_force.state_at(observation.t_s - observation.takes_effect_s);
        let then = in_force.state_at(0.0);
        let position_error = Point::from(observation.position_m) - now.position;
        let velocity_error = Point::from(observation.velocity_mps) - now.velocity;
        if position_error.norm() <= self.tracking_tolerance_m {
            return then;
        }
        let mut start =
            PointMassState { position: then.position + position_error, velocity: then.velocity + velocity_error };
        if self.is_planar {
            // an altitude error would persist, since altitude is not planned
            (start.position.z, start.velocity.z) = (then.position.z, 0.0);
        }
        start
    }

    fn result(&self, replan: Replan, takes_effect_s: f64, graph: Option<Vec<[[f64; 3]; 2]>>) -> ReplanResult {
        let Replan { decision, solution, follows_roadmap, has_path } = replan;
        let route = match &decision {
            Decision::Fly(motion) => self.controller.map().path_from(motion.last().1.position, &self.space),
            Decision::Keep => Vec::new(),
        };
        let to_arrays = |points: Vec<Point>| points.into_iter().map(Into::into).collect::<Vec<[f64; 3]>>();
        let note = match (has_path, follows_roadmap) {
            (false, _) => Some("no path to the goal is known"),
            (true, true) => Some("it gets no nearer to the goal, and follows the roadmap"),
            (true, false) => None,
        };
        let diagnostics = ReplanDiagnostics {
            iterations: solution.iterations,
            first_feasible: solution.first_feasible,
            feasible_fraction: Some(solution.feasible_fraction),
            cost: solution.fitness.is_feasible().then_some(solution.fitness.cost),
            convergence: solution.convergence,
            candidates: solution.paths.into_iter().map(to_arrays).collect(),
            route: to_arrays(route),
            graph,
            note: note.map(str::to_owned),
        };
        let decision = match decision {
            Decision::Fly(motion) => in_loop::Decision::Fly(nodes_from_motion(&motion, takes_effect_s)),
            Decision::Keep => in_loop::Decision::Keep {
                reason: if follows_roadmap {
                    "the motion in force follows the roadmap out of a deadlock".into()
                } else {
                    "nothing feasible was found, and the motion in force is clear".into()
                },
            },
        };
        ReplanResult { decision, diagnostics }
    }
}
