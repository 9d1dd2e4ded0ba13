use planners::free_space::{FreeSpace, MovingObstacle, Obstacle, Point};
use planners::horizon::controller::{ControllerSettings, CostModel, Decision, RecedingHorizonController};
use planners::horizon::problem::Repulsion;
use planners::multirotor::{PointMassMotion, PointMassState};
use planners::roadmap::{CostMap, RoadmapKind};

use crate::arena::{Arena, Flight, LIMITS, default_settings, fly, paper_settings, random, swarm, trap};

const CLEARANCE_M: f64 = 0.4;

#[test]
fn rhc_arrives_through_the_trap() {
    for roadmap in [RoadmapKind::Visibility, RoadmapKind::Voronoi] {
        let arena = trap();
        let flight = fly(&arena, &default_settings(swarm(true), roadmap, 2), 1, f64::INFINITY, 40.0);
        // the path along the corners is the shortest, up to their rounding
        let mut map = CostMap::new(RoadmapKind::Visibility, arena.goal, CLEARANCE_M, arena.node_altitudes_m.clone());
        map.update(&arena.space);
        let shortest_m = map.cost_to_go(arena.start, &arena.space).unwrap().length_m;
        assert!(flight.length_m < 1.05 * shortest_m, "{} {shortest_m}", flight.length_m);
        assert!(flight.arrived_s.is_some_and(|time_s| time_s < 22.0), "{:?}", flight.arrived_s);
        assert!(flight.clearance_m >= CLEARANCE_M - 1e-9, "{}", flight.clearance_m);
    }
}

#[test]
fn paper_planners_arrive_through_the_trap() {
    let field = Repulsion { gain: 0.05, reach_m: 1.0, is_squared: true, is_by_all: false };
    let visibility = CostModel::CostMap { roadmap: RoadmapKind::Visibility, repulsion: None };
    let voronoi = CostModel::CostMap { roadmap: RoadmapKind::Voronoi, repulsion: Some(field) };
    for cost_model in [visibility, voronoi] {
        for by_violation in [false, true] {
            let flight = fly(&trap(), &paper_settings(by_violation, cost_model), 1, f64::INFINITY, 60.0);
            assert!(flight.arrived_s.is_some(), "{cost_model:?}");
        }
    }
}

/// The flight stays clear of all obstacles that appear within sensor range, and every motion ends at rest.
#[test]
fn rhc_never_leaves_known_free_space() {
    let mut settings = default_settings(swarm(true), RoadmapKind::Visibility, 2);
    settings.budget.particles = 20;
    settings.budget.max_iterations = 15;
    settings.known_radius_m = 4.0;
    let arrived = (0..200).filter(|&seed| is_safe_and_arrives(seed, false, &settings)).count();
    assert!(arrived >= 190, "{arrived}");
}

#[test]
fn rhc_never_leaves_known_free_space_with_altitude() {
    let mut settings = default_settings(swarm(true), RoadmapKind::Visibility, 3);
    settings.budget.particles = 20;
    settings.budget.max_iterations = 15;
    settings.known_radius_m = 4.0;
    let arrived = (0..40).filter(|&seed| is_safe_and_arrives(seed, true, &settings)).count();
    assert!(arrived >= 36, "{arrived}");
}

fn is_safe_and_arrives(seed: u64, in_space: bool, settings: &ControllerSettings) -> bool {
    let arena = random(seed, in_space);
    let flight = fly(&arena, settings, seed, settings.known_radius_m, 60.0);
    assert!(flight.clearance_m >= CLEARANCE_M - 1e-9, "seed {seed}: {}", flight.clearance_m);
    ends_at_rest(&flight);
    flight.arrived_s.is_some()
}

fn ends_at_rest(flight: &Flight) {
    for replan in &flight.replans {
        if let Decision::Fly(motion) = &replan.decision {
            assert_eq!(motion.last().1.velocity, Point::zeros());
            let reach_m = 4.0 - CLEARANCE_M;
            let [from, to] = [motion.knots()[0].1.position, motion.last().1.position];
            assert!((from - to).norm() <= reach_m + 1e-9);
            let speeds_mps = motion.knots().iter().map(|(_, state)| state.velocity.norm());
            assert!(speeds_mps.fold(0.0, f64::max) <= LIMITS.speed_mps + 1e-9);
        }
    }
}

/// Two obstacles cross the path; their position and velocity are known at each replan.
#[test]
fn moving_obstacles_are_avoided() {
    const UNBOUNDED: [f64; 2] = [f64::NEG_INFINITY, f64::INFINITY];
    let position =
        |lane: usize, time_s: f64| [4.0 - 8.0 * lane as f64, [-6.0 + 1.2 * time_s, 7.0 - 0.8 * time_s][lane]];
    let velocity = |lane: usize| Point::new(0.0, [1.2, -0.8][lane], 0.0);
    let cylinder = |lane: usize, time_s: f64| Obstacle::cylinder(position(lane, time_s), 1.0, UNBOUNDED);
    let settings = default_settings(swarm(true), RoadmapKind::Visibility, 2);
    let (start, goal) = (Point::new(10.0, 0.0, 1.0), Point::new(-12.0, 0.0, 1.0));
    let mut controller = RecedingHorizonController::new(settings, goal, vec![1.0], scenarios::stream(1, "horizon"));
    let mut motion = PointMassMotion::from(PointMassState::at_rest(start));
    for replan in 0..80 {
        let time_s = 0.25 * f64::from(replan);
        let mut space = FreeSpace::empty([[-15.0, 15.0], [-8.0, 8.0], UNBOUNDED]);
        let obstacle = |lane| MovingObstacle::at_constant_velocity(cylinder(lane, time_s), velocity(lane));
        space.moving_obstacles = [0, 1].map(obstacle).to_vec();
        let applied = motion.mean_accelerations(-0.25, 0.25, 1)[0];
        if let Decision::Fly(new) = controller.replan(motion.state_at(0.0), &motion, applied, &space).decision {
            motion = new;
        }
        for tick in 0..25 {
            let since_s = 0.01 * f64::from(tick);
            let here = motion.state_at(since_s).position;
            let nearest_m = [0, 1].map(|lane| cylinder(lane, time_s + since_s).distance_m(here));
            assert!(nearest_m.iter().all(|distance_m| *distance_m >= CLEARANCE_M - 1e-9), "{nearest_m:?}");
        }
        motion = motion.tail_from(0.25);
    }
    assert!((motion.state_at(0.0).position - goal).norm() < 0.3, "{:?}", motion.state_at(0.0));
}

#[test]
fn the_same_seed_gives_the_same_flight() {
    let settings = default_settings(swarm(true), RoadmapKind::Visibility, 2);
    let [first, again, other] = [1, 1, 2].map(|seed| fly(&trap(), &settings, seed, f64::INFINITY, 5.0));
    assert!(first.replans == again.replans);
    assert!(first.replans != other.replans);
}

/// A wall with one gap, wider than twice the clearance by 4 cm: less than the sampler keeps of its steps' chords.
fn narrow_gap() -> Arena {
    const UNBOUNDED: [f64; 2] = [f64::NEG_INFINITY, f64::INFINITY];
    let wall = |[south, north]: [f64; 2]| {
        Obstacle::prism(&[[-0.5, south], [0.5, south], [0.5, north], [-0.5, north]], UNBOUNDED)
    };
    let mut space = FreeSpace::empty([[-10.0, 10.0], [-6.0, 6.0], UNBOUNDED]);
    space.static_obstacles = vec![wall([-6.0, -0.42]), wall([0.42, 6.0])];
    Arena { space, start: Point::new(8.0, 3.0, 1.0), goal: Point::new(-8.0, -2.0, 1.0), node_altitudes_m: vec![1.0] }
}

#[test]
fn a_passage_that_the_sampler_does_not_find_is_passed_along_the_roadmap() {
    let settings = default_settings(swarm(true), RoadmapKind::Visibility, 2);
    for seed in 0..5 {
        let flight = fly(&narrow_gap(), &settings, seed, f64::INFINITY, 40.0);
        assert!(flight.arrived_s.is_some_and(|time_s| time_s < 25.0), "{:?}", flight.arrived_s);
        assert!(flight.clearance_m >= CLEARANCE_M - 1e-6, "{}", flight.clearance_m);
        assert!(flight.replans.iter().any(|replan| replan.follows_roadmap));
    }
}

#[test]
fn a_vehicle_without_deadlocks_never_follows_the_roadmap() {
    let flight = fly(&trap(), &default_settings(swarm(true), RoadmapKind::Visibility, 2), 1, f64::INFINITY, 40.0);
    assert!(flight.arrived_s.is_some() && flight.replans.iter().all(|replan| !replan.follows_roadmap));
}

/// Another vehicle has come to rest in one of two passages, on the shorter path.
#[test]
fn a_vehicle_at_rest_in_a_passage_is_bypassed() {
    const UNBOUNDED: [f64; 2] = [f64::NEG_INFINITY, f64::INFINITY];
    let wall = |[south, north]: [f64; 2]| {
        Obstacle::prism(&[[-0.5, south], [0.5, south], [0.5, north], [-0.5, north]], UNBOUNDED)
    };
    let mut space = FreeSpace::empty([[-10.0, 10.0], [-8.0, 8.0], UNBOUNDED]);
    space.static_obstacles = vec![wall([-8.0, -6.0]), wall([-4.5, -0.75]), wall([0.75, 8.0])];
    let shape = Obstacle::cylinder([0.0, 0.0], 0.35, UNBOUNDED);
    space.moving_obstacles = vec![MovingObstacle::at_constant_velocity(shape, Point::zeros())];
    let arena = Arena {
        space,
        start: Point::new(7.0, 1.0, 1.0),
        goal: Point::new(-7.0, 1.0, 1.0),
        node_altitudes_m: vec![1.0],
    };
    let settings = default_settings(swarm(true), RoadmapKind::Visibility, 2);
    let flight = fly(&arena, &settings, 1, f64::INFINITY, 60.0);
    assert!(flight.arrived_s.is_some(), "{:?}", flight.length_m);
    assert!(flight.clearance_m >= CLEARANCE_M - 1e-6, "{}", flight.clearance_m);
}

#[test]
fn a_goal_behind_a_wall_without_a_gap_is_known_to_be_out_of_reach_at_once() {
    let mut arena = narrow_gap();
    let corners = [[-0.2, -1.0], [0.2, -1.0], [0.2, 1.0], [-0.2, 1.0]];
    arena.space.static_obstacles.push(Obstacle::prism(&corners, [f64::NEG_INFINITY, f64::INFINITY]));
    let settings = default_settings(swarm(true), RoadmapKind::Visibility, 2);
    let flight = fly(&arena, &settings, 1, f64::INFINITY, 3.0);
    assert!(flight.arrived_s.is_none());
    assert!(flight.replans.iter().all(|replan| !replan.has_path && !replan.follows_roadmap));
    let open = fly(&narrow_gap(), &settings, 1, f64::INFINITY, 3.0);
    assert!(open.replans.iter().all(|replan| replan.has_path));
}
