//! Test maps, and closed loops on them with an ideal vehicle: a double integrator without tracking error.

use planners::free_space::{FreeSpace, Obstacle, Point};
use planners::horizon::controller::{ControllerSettings, CostModel, Decision, RecedingHorizonController, Replan};
use planners::horizon::optimiser::Budget;
use planners::horizon::problem::{ControlGrid, VIOLATION_WEIGHTS};
use planners::horizon::sampler::{SamplerKind, SwarmSettings};
use planners::multirotor::{PlanningLimits, PointMassMotion, PointMassState};
use planners::roadmap::RoadmapKind;
use rand::RngExt;

/// A map with a path from start to goal.
pub struct Arena {
    pub space: FreeSpace,
    pub start: Point,
    pub goal: Point,
    /// Altitudes of the cost map's nodes, m.
    pub node_altitudes_m: Vec<f64>,
}

const UNBOUNDED: [f64; 2] = [f64::NEG_INFINITY, f64::INFINITY];

fn block([x, y]: [f64; 2], [width, height]: [f64; 2], altitude_m: [f64; 2]) -> Obstacle {
    let corners = [[x, y], [x + width, y], [x + width, y + height], [x, y + height]];
    Obstacle::prism(&corners, altitude_m)
}

/// Ten boxes and a trap that opens towards the start, in a frame of 54 m by 27 m.
pub fn trap() -> Arena {
    let mut space = FreeSpace::empty([[-27.0, 27.0], [-15.0, 12.0], UNBOUNDED]);
    let corners = [
        [16.0, 4.0],
        [15.0, -9.0],
        [8.0, 7.0],
        [9.0, -13.0],
        [1.0, -11.0],
        [-1.0, 8.0],
        [-8.0, -12.0],
        [-9.0, 5.0],
        [-17.0, -9.0],
        [-18.0, 3.0],
    ];
    space.static_obstacles.extend(corners.map(|corner| block(corner, [3.0, 3.0], UNBOUNDED)));
    for (corner, size) in [([-3.0, -5.0], [1.0, 9.0]), ([-2.0, -5.0], [8.0, 1.0]), ([-2.0, 3.0], [8.0, 1.0])] {
        space.static_obstacles.push(block(corner, size, UNBOUNDED));
    }
    let (start, goal) = (Point::new(25.0, 0.0, 1.0), Point::new(-25.0, -3.0, 1.0));
    Arena { space, start, goal, node_altitudes_m: vec![1.0] }
}

/// Random boxes and cylinders, unbounded in altitude in the plane, bounded in space.
pub fn random(seed: u64, in_space: bool) -> Arena {
    let mut stream = scenarios::stream(seed, "arena");
    let altitudes = if in_space { [0.0, 10.0] } else { UNBOUNDED };
    let mut space = FreeSpace::empty([[-20.0, 20.0], [-12.0, 12.0], altitudes]);
    let start = Point::new(17.0, 0.0, 2.0);
    let goal = Point::new(-17.0, -3.0, if in_space { 3.0 } else { start.z });
    while space.static_obstacles.len() < 14 {
        let mut draw = |from: f64, to: f64| stream.random_range(from..to);
        let at = [draw(-14.0, 13.0), draw(-12.0, 11.0)];
        let size = [draw(0.5, 4.0), draw(0.5, 4.0)];
        let altitude_m = if in_space { [draw(-4.0, 2.0), draw(3.0, 12.0)] } else { UNBOUNDED };
        let obstacle = if draw(0.0, 1.0) < 0.7 {
            block(at, size, altitude_m)
        } else {
            Obstacle::cylinder(at, 0.5 * size[0], altitude_m)
        };
        if obstacle.distance_m(start).min(obstacle.distance_m(goal)) > 2.0 {
            space.static_obstacles.push(obstacle);
        }
    }
    Arena { space, start, goal, node_altitudes_m: if in_space { vec![2.0, 3.0, 5.0, 8.0] } else { vec![2.0] } }
}

pub const LIMITS: PlanningLimits = PlanningLimits { speed_mps: 3.0, acceleration_mps2: 3.0 };

/// The swarm of eq. 13 and 14, optionally with eq. 15.
pub fn swarm(by_violation: bool) -> SamplerKind {
    SamplerKind::ParticleSwarm(if by_violation { SwarmSettings::FEASIBILITY_DRIVEN } else { SwarmSettings::STANDARD })
}

/// Settings of the planner `rhc`.
pub fn default_settings(sampler: SamplerKind, roadmap: RoadmapKind, axes: usize) -> ControllerSettings {
    ControllerSettings {
        sampler,
        budget: Budget { particles: 40, max_iterations: 60, stall_iterations: None },
        cost_model: CostModel::CostMap { roadmap, repulsion: None },
        grid: ControlGrid { steps: 12, axes },
        step_s: 0.25,
        limits: LIMITS,
        clearance_m: 0.4,
        smoothness_weight: 1e-2,
        violation_weights: VIOLATION_WEIGHTS,
        stage_weight: 1.0,
        brakes_at_goal: true,
        starts_warm: true,
        projects_controls: true,
        requires_stop: true,
        costs_infeasible: false,
        known_radius_m: f64::INFINITY,
    }
}

/// Settings of the paper's planners.
pub fn paper_settings(by_violation: bool, cost_model: CostModel) -> ControllerSettings {
    ControllerSettings {
        cost_model,
        starts_warm: false,
        projects_controls: false,
        requires_stop: false,
        smoothness_weight: 0.0,
        ..default_settings(swarm(by_violation), RoadmapKind::Visibility, 2)
    }
}

/// Record of a flight.
#[derive(Debug)]
pub struct Flight {
    pub arrived_s: Option<f64>,
    pub length_m: f64,
    pub replans: Vec<Replan>,
    /// Smallest distance to obstacles and bounds, m.
    pub clearance_m: f64,
    pub wall_s: f64,
}

/// Flies from rest. Obstacles become known within `range_m` of the vehicle.
pub fn fly(arena: &Arena, settings: &ControllerSettings, seed: u64, range_m: f64, limit_s: f64) -> Flight {
    let stream = scenarios::stream(seed, "horizon");
    let altitudes_m = arena.node_altitudes_m.clone();
    let mut controller = RecedingHorizonController::new(settings.clone(), arena.goal, altitudes_m, stream);
    let mut known = FreeSpace { static_obstacles: Vec::new(), ..arena.space.clone() };
    let mut unknown = arena.space.static_obstacles.clone();
    let mut motion = PointMassMotion::from(PointMassState::at_rest(arena.start));
    let mut flight =
        Flight { arrived_s: None, length_m: 0.0, replans: Vec::new(), clearance_m: f64::INFINITY, wall_s: 0.0 };
    let mut applied = Point::zeros();
    while flight.replans.len() as f64 * settings.step_s < limit_s {
        let state = motion.state_at(0.0);
        let (sensed, rest) = unknown.into_iter().partition(|obstacle| obstacle.distance_m(state.position) <= range_m);
        unknown = rest;
        known.static_obstacles.extend::<Vec<_>>(sensed);
        let begin = std::time::Instant::now();
        let replan = controller.replan(state, &motion, applied, &known);
        flight.wall_s += begin.elapsed().as_secs_f64();
        if let Decision::Fly(new) = &replan.decision {
            motion = new.clone();
        }
        flight.replans.push(replan);
        for tick in 0..20 {
            let [here, next] =
                [tick, tick + 1].map(|tick| motion.state_at(settings.step_s * f64::from(tick) / 20.0).position);
            flight.length_m += (here - next).norm();
            flight.clearance_m = flight.clearance_m.min(arena.space.distance_m(here));
        }
        applied = motion.mean_accelerations(0.0, settings.step_s, 1)[0];
        motion = motion.tail_from(settings.step_s);
        let now = motion.state_at(0.0);
        if (now.position - arena.goal).norm() < 0.3 && now.velocity.norm() < 0.3 {
            flight.arrived_s = Some(flight.replans.len() as f64 * settings.step_s);
            break;
        }
    }
    flight
}
