use planners::free_space::vector::{distance, norm};
use planners::free_space::{FreeSpace, Mover, Obstacle};
use planners::horizon::cost_map::{CostMap, Ways};
use planners::horizon::motion::{Motion, State};
use planners::horizon::pilot::{Charge, Decision, Pilot};
use planners::horizon::question::Repulsion;

use crate::arena::{Flight, LIMITS, fly, ours, paper, random, swarm, trap};

const CLEARANCE_M: f64 = 0.4;

#[test]
fn our_rules_lead_through_the_trap() {
    for ways in [Ways::Visibility, Ways::Voronoi] {
        let arena = trap();
        let flight = fly(&arena, &ours(swarm(true), ways, 2), 1, f64::INFINITY, 40.0);
        // no way can be shorter than the one along the corners, but for their rounding
        let mut map = CostMap::new(Ways::Visibility, arena.goal, CLEARANCE_M, arena.levels_m.clone());
        map.update(&arena.space);
        let shortest_m = map.cost_to_go(arena.start, &arena.space).unwrap().length_m;
        assert!(flight.length_m < 1.05 * shortest_m, "{} {shortest_m}", flight.length_m);
        assert!(flight.arrived_s.is_some_and(|time_s| time_s < 22.0), "{:?}", flight.arrived_s);
        assert!(flight.clearance_m >= CLEARANCE_M - 1e-9, "{}", flight.clearance_m);
    }
}

#[test]
fn the_papers_rules_lead_through_the_trap() {
    let field = Repulsion { gain: 0.05, reach_m: 1.0, is_squared: true };
    for charge in [Charge::Map(Ways::Visibility, None), Charge::Map(Ways::Voronoi, Some(field))] {
        for by_violation in [false, true] {
            let flight = fly(&trap(), &paper(by_violation, charge), 1, f64::INFINITY, 60.0);
            assert!(flight.arrived_s.is_some(), "{charge:?}");
        }
    }
}

/// Whatever appears within sensor range, what is flown keeps clear of it and ends at rest.
#[test]
fn our_rules_never_leave_known_free_space() {
    let mut options = ours(swarm(true), Ways::Visibility, 2);
    options.budget.particles = 20;
    options.budget.iterations = 15;
    options.known_within_m = 4.0;
    let arrived = (0..200).filter(|&seed| is_safe_and_arrives(seed, false, &options)).count();
    assert!(arrived >= 190, "{arrived}");
}

#[test]
fn our_rules_never_leave_known_free_space_with_altitude() {
    let mut options = ours(swarm(true), Ways::Visibility, 3);
    options.budget.particles = 20;
    options.budget.iterations = 15;
    options.known_within_m = 4.0;
    let arrived = (0..40).filter(|&seed| is_safe_and_arrives(seed, true, &options)).count();
    assert!(arrived >= 36, "{arrived}");
}

fn is_safe_and_arrives(seed: u64, in_space: bool, options: &planners::horizon::pilot::Options) -> bool {
    let arena = random(seed, in_space);
    let flight = fly(&arena, options, seed, options.known_within_m, 60.0);
    assert!(flight.clearance_m >= CLEARANCE_M - 1e-9, "seed {seed}: {}", flight.clearance_m);
    ends_at_rest(&flight);
    flight.arrived_s.is_some()
}

fn ends_at_rest(flight: &Flight) {
    for replan in &flight.replans {
        if let Decision::Fly(motion) = &replan.decision {
            assert_eq!(motion.last().1.velocity, [0.0; 3]);
            let reach_m = 4.0 - CLEARANCE_M;
            let [from, to] = [motion.knots()[0].1.position, motion.last().1.position];
            assert!(distance(from, to) <= reach_m + 1e-9);
            let fastest = motion.knots().iter().map(|(_, state)| norm(state.velocity));
            assert!(fastest.fold(0.0, f64::max) <= LIMITS.speed_mps + 1e-9);
        }
    }
}

/// Two obstacles that cross the way, known by their position and velocity at each replan.
#[test]
fn moving_obstacles_are_let_pass() {
    const UNBOUNDED: [f64; 2] = [f64::NEG_INFINITY, f64::INFINITY];
    let place = |lane: usize, time_s: f64| [4.0 - 8.0 * lane as f64, [-6.0 + 1.2 * time_s, 7.0 - 0.8 * time_s][lane]];
    let velocity = |lane: usize| [0.0, [1.2, -0.8][lane], 0.0];
    let cylinder = |lane: usize, time_s: f64| Obstacle::cylinder(place(lane, time_s), 1.0, UNBOUNDED);
    let options = ours(swarm(true), Ways::Visibility, 2);
    let (start, goal) = ([10.0, 0.0, 1.0], [-12.0, 0.0, 1.0]);
    let mut pilot = Pilot::new(options.clone(), goal, vec![1.0], scenarios::stream(1, "horizon"));
    let mut motion = Motion::from(State::at_rest(start));
    for replan in 0..80 {
        let time_s = 0.25 * f64::from(replan);
        let mut space = FreeSpace::empty([[-15.0, 15.0], [-8.0, 8.0], UNBOUNDED]);
        space.moving = [0, 1].map(|lane| Mover::straight(cylinder(lane, time_s), velocity(lane))).to_vec();
        let applied = motion.mean_accelerations(-0.25, 0.25, 1)[0];
        if let Decision::Fly(new) = pilot.replan(motion.state_at(0.0), &motion, applied, &space).decision {
            motion = new;
        }
        for tick in 0..25 {
            let since_s = 0.01 * f64::from(tick);
            let here = motion.state_at(since_s).position;
            let nearest_m = [0, 1].map(|lane| cylinder(lane, time_s + since_s).distance_m(here));
            assert!(nearest_m.iter().all(|distance_m| *distance_m >= CLEARANCE_M - 1e-9), "{nearest_m:?}");
        }
        motion = motion.rest_from(0.25);
    }
    assert!(distance(motion.state_at(0.0).position, goal) < 0.3, "{:?}", motion.state_at(0.0));
}

#[test]
fn the_same_seed_is_the_same_flight() {
    let options = ours(swarm(true), Ways::Visibility, 2);
    let [first, again, other] = [1, 1, 2].map(|seed| fly(&trap(), &options, seed, f64::INFINITY, 5.0));
    assert!(first.replans == again.replans);
    assert!(first.replans != other.replans);
}
