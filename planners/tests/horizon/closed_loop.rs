use planners::horizon::cost_map::Ways;
use planners::horizon::pilot::{Charge, Decision};
use planners::horizon::question::Repulsion;

use crate::arena::{Flight, LIMITS, fly, ours, paper, random, swarm, trap};

const CLEARANCE_M: f64 = 0.4;

#[test]
fn our_rules_lead_through_the_trap() {
    for ways in [Ways::Visibility, Ways::Voronoi] {
        let flight = fly(&trap(), &ours(swarm(true), ways, 2), 1, f64::INFINITY, 40.0);
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
            assert!(planners::free_space::vector::distance(from, to) <= reach_m + 1e-9);
            let fastest = motion.knots().iter().map(|(_, state)| planners::free_space::vector::norm(state.velocity));
            assert!(fastest.fold(0.0, f64::max) <= LIMITS.speed_mps + 1e-9);
        }
    }
}

#[test]
fn the_same_seed_is_the_same_flight() {
    let options = ours(swarm(true), Ways::Visibility, 2);
    let [first, again, other] = [1, 1, 2].map(|seed| fly(&trap(), &options, seed, f64::INFINITY, 5.0));
    assert!(first.replans == again.replans);
    assert!(first.replans != other.replans);
}
