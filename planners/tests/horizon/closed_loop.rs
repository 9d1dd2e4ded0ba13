use planners::horizon::cost_map::Ways;

use crate::arena::{fly, ours, random, swarm, trap};

#[test]
fn our_rules_lead_through_the_trap() {
    let arena = trap();
    let flight = fly(&arena, &ours(swarm(true), Ways::Visibility, 2), 1, f64::INFINITY, 60.0);
    println!(
        "{:?} {} {} {}",
        flight.arrived_s,
        flight.length_m,
        flight.clearance_m,
        flight.wall_s / flight.replans.len() as f64
    );
    assert!(flight.arrived_s.is_some_and(|time_s| time_s < 25.0), "{:?}", flight.arrived_s);
    assert!(flight.clearance_m >= 0.4 - 1e-9, "{}", flight.clearance_m);
}
