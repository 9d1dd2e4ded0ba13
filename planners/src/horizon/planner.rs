//! The planners of the registry, and what they make of an observation.

use std::collections::HashSet;

use rand::Rng;
use scenarios::in_loop::{Decision as Flown, InLoopPlanner, Observation, ReplanDiagnostics, ReplanResult};
use scenarios::{Scenario, stream};

use super::brief::{self, Variant};
use super::motion::{Motion, State};
use super::others;
use super::pilot::{Decision, Pilot, Replan};
use super::reference::{motion, nodes};
use crate::free_space::vector::{Point, minus, norm, plus};
use crate::free_space::{FreeSpace, known};
use crate::planner::{Answers, Planner};

const HANDLES: &str = "multirotors among obstacles known, sensed or moving";

/// Receding horizon, our own rules.
pub const RHC: Planner = Planner {
    name: "rhc",
    summary: "receding horizon that always ends in a stop in free space: warm start, projection, swarm or other samplers",
    handles: HANDLES,
    refuses: brief::refuses,
    answers: Answers::InLoop(|scenario, vehicle, seed| make(scenario, vehicle, seed, Variant::Ours)),
};

/// RHC-PSO.
pub const RHC_PSO: Planner = Planner {
    name: "rhc-pso",
    summary: "receding horizon by particle swarm with cost map, as in the paper",
    handles: HANDLES,
    refuses: brief::refuses,
    answers: Answers::InLoop(|scenario, vehicle, seed| make(scenario, vehicle, seed, Variant::Pso)),
};

/// RHC-FPSO.
pub const RHC_FPSO: Planner = Planner {
    name: "rhc-fpso",
    summary: "the same with the feasibility-driven swarm of the paper (eq. 15)",
    handles: HANDLES,
    refuses: brief::refuses,
    answers: Answers::InLoop(|scenario, vehicle, seed| make(scenario, vehicle, seed, Variant::Fpso)),
};

/// RHC-APF.
pub const RHC_APF: Planner = Planner {
    name: "rhc-apf",
    summary: "the same with an artificial potential field beside the cost map (eq. 16) or instead of it (eq. 17)",
    handles: HANDLES,
    refuses: brief::refuses,
    answers: Answers::InLoop(|scenario, vehicle, seed| make(scenario, vehicle, seed, Variant::Apf)),
};

fn make(scenario: &Scenario, vehicle: usize, seed: u64, variant: Variant) -> Box<dyn InLoopPlanner> {
    let own = &scenario.vehicles[vehicle];
    let goal = own.goal.position_m();
    let random = stream(seed, &format!("horizon/{}", own.name));
    let options = brief::options(scenario, vehicle, variant);
    let clearance_m = options.clearance_m;
    let room_m = scenario.fleet.separation_m.map_or(0.0, |separation_m| {
        let model = scenario.multirotor_model(own);
        separation_m - model.body_radius_m
    });
    Box::new(InLoop {
        pilot: Pilot::new(options, goal, brief::levels_m(scenario, vehicle), random),
        space: FreeSpace::empty(known::frame_m(&scenario.world, scenario.is_planar())),
        names: HashSet::new(),
        neighbour_radius_m: room_m,
        is_planar: scenario.is_planar(),
        // our own rules trust the reference as long as the vehicle is within the room kept for the tracker
        trusted_m: if variant == Variant::Ours { clearance_m - own_radius_m(scenario, vehicle) } else { 0.0 },
    })
}

fn own_radius_m(scenario: &Scenario, vehicle: usize) -> f64 {
    scenario.multirotor_model(&scenario.vehicles[vehicle]).body_radius_m
}

/// A pilot, and what its vehicle has seen so far.
struct InLoop<R> {
    pilot: Pilot<R>,
    space: FreeSpace,
    /// Obstacles in `space`.
    names: HashSet<String>,
    /// Radius about other vehicles at least, m.
    neighbour_radius_m: f64,
    /// Distance from the reference up to which a measured position is taken for noise, m.
    trusted_m: f64,
    /// Is altitude kept as it is?
    is_planar: bool,
}

impl<R: Rng + Send> InLoopPlanner for InLoop<R> {
    fn replan(&mut self, observation: &Observation<'_>) -> ReplanResult {
        let is_new_map = self.learn(observation);
        let here = State::at_rest(observation.position_m);
        let flown = motion(observation.in_force, observation.takes_effect_s).unwrap_or_else(|| Motion::from(here));
        let start = self.start(observation, &flown);
        let applied = flown.mean_accelerations(-APPLIED_S, APPLIED_S, 1)[0];
        let replan = self.pilot.replan(start, &flown.rest_from(0.0), applied, &self.space);
        let graph = is_new_map.then(|| self.pilot.map().roadmap().edges().collect());
        answer(&self.pilot, &self.space, replan, observation.takes_effect_s, graph)
    }
}

/// Time over which the acceleration that is applied before the horizon is taken, s.
const APPLIED_S: f64 = 0.05;

impl<R: Rng> InLoop<R> {
    /// Takes in what is known; true if it is more than before.
    fn learn(&mut self, observation: &Observation<'_>) -> bool {
        let before = self.space.standing.len();
        for (name, obstacle) in known::obstacles(observation.known) {
            if self.names.insert(name) {
                self.space.standing.push(obstacle);
            }
        }
        self.space.moving = others::movers(observation, self.neighbour_radius_m);
        before != self.space.standing.len()
    }

    /// Where the vehicle will be when the answer takes effect: on its reference, moved by what it is off it now, unless
    /// that is noise.
    fn start(&self, observation: &Observation<'_>, flown: &Motion) -> State {
        let now = flown.state_at(observation.t_s - observation.takes_effect_s);
        let then = flown.state_at(0.0);
        let [off_m, off_mps] =
            [minus(observation.position_m, now.position), minus(observation.velocity_mps, now.velocity)];
        if norm(off_m) <= self.trusted_m {
            return then;
        }
        let mut start = State { position: plus(then.position, off_m), velocity: plus(then.velocity, off_mps) };
        if self.is_planar {
            // nothing is planned in altitude, so nothing would bring it back
            (start.position[2], start.velocity[2]) = (then.position[2], 0.0);
        }
        start
    }
}

fn answer<R: Rng>(
    pilot: &Pilot<R>,
    space: &FreeSpace,
    replan: Replan,
    takes_effect_s: f64,
    graph: Option<Vec<[Point; 2]>>,
) -> ReplanResult {
    let Replan { decision, found } = replan;
    let route = match &decision {
        Decision::Fly(motion) => pilot.map().route(motion.last().1.position, space),
        Decision::Keep => Vec::new(),
    };
    let diagnostics = ReplanDiagnostics {
        iterations: found.iterations,
        first_feasible: found.first_feasible,
        feasible_fraction: Some(found.feasible_share),
        cost: found.fitness.is_feasible().then_some(found.fitness.cost),
        candidates: found.paths,
        route,
        graph,
        note: None,
    };
    let decision = match decision {
        Decision::Fly(motion) => Flown::Fly(nodes(&motion, takes_effect_s)),
        Decision::Keep => Flown::Keep { reason: "nothing feasible was found, and the motion in force is clear".into() },
    };
    ReplanResult { decision, diagnostics }
}
