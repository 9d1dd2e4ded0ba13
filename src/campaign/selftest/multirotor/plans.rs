//! Faults of plans that were made before the flight.

use scenarios::{BoxObstacle, Range};

use crate::campaign::selftest::{Fault, ReferenceCase};

/// The faults.
pub fn faults() -> Vec<Fault> {
    [states(), ends(), obstacles()].into_iter().flatten().collect()
}

fn states() -> Vec<Fault> {
    vec![
        Fault::new("plan.complete", "planned altitudes in feet", |it| {
            it.multirotor(0).states.iter_mut().for_each(|state| state.position_m[2] /= 0.3048);
        }),
        Fault::new("plan.complete", "the plans of two vehicles are swapped", |it| it.plan.trajectories.swap(0, 1)),
        Fault::new("plan.complete", "a trajectory has fewer states than times", |it| {
            it.multirotor(0).states.pop();
        }),
        Fault::new("plan.state_limits", "planned speeds in km/h", |it| {
            it.multirotor(0)
                .states
                .iter_mut()
                .for_each(|state| state.velocity_mps = state.velocity_mps.map(|v| 3.6 * v));
        }),
        Fault::new("nodes.state_limits", "a node is faster than planning allows", |it| {
            let fastest_mps = it.multirotor_model().planning_limits.speed_mps;
            it.multirotor(0).states[1].velocity_mps[0] = fastest_mps * (1.0 + 1e-3);
        }),
        Fault::new("plan.state_limits", "between two nodes a plan is faster than the vehicle", |it| {
            let fastest_mps = it.multirotor_model().limits.speed_mps;
            let middle = it.multirotor(0).states.len() / 2;
            let times_s = it.times_s(0);
            // Twice the distance in the same time: the cubic is fastest in its middle.
            let distance_m = fastest_mps * (times_s[middle] - times_s[middle - 1]);
            let from_m = it.multirotor(0).states[middle - 1].position_m[0];
            it.multirotor(0).states[middle].position_m[0] = from_m + distance_m;
        }),
        Fault::new("nodes.control_limits", "a node comes a tenth too early", |it| {
            let times_s = it.times_s(0);
            let early_s = 0.1 * (times_s[1] - times_s[0]);
            times_s.iter_mut().skip(1).for_each(|t_s| *t_s -= early_s);
        }),
        Fault::new("plan.control_limits", "the velocity at one node has the opposite sign", |it| {
            let velocity_mps = &mut it.multirotor(0).states[1].velocity_mps;
            *velocity_mps = velocity_mps.map(|component| -component);
        }),
    ]
}

fn ends() -> Vec<Fault> {
    vec![
        Fault::new("plan.rest", "the plan ends in motion", |it| {
            let max_mps = it.scenario.limits().rest_mps;
            let last = it.multirotor(0).states.last_mut().expect("a plan has nodes");
            last.velocity_mps[1] = 1.01 * max_mps;
        }),
        Fault::new("plan.goal", "the plan ends beside its goal", |it| {
            let max_m = it.scenario.limits().goal_m;
            let last = it.multirotor(0).states.last_mut().expect("a plan has nodes");
            last.position_m[2] += 1.01 * max_m;
        }),
        Fault::new("nodes.separation", "two plans share a node", |it| {
            let (state, t_s) = (it.multirotor(0).states[1], it.times_s(0)[1]);
            it.multirotor(1).states[1] = state;
            it.times_s(1)[1] = t_s;
        }),
        Fault::new("plan.separation", "two plans meet between their nodes", |it| {
            let middle = 0.5 * it.plan.flight_time_s().unwrap_or(0.0);
            let met = sim::multirotor::Reference::new(it.multirotor(0).nodes()).at(middle).position_m;
            let own = sim::multirotor::Reference::new(it.multirotor(1).nodes()).at(middle).position_m;
            let aside_m = met - own;
            it.multirotor(1).states.iter_mut().for_each(|state| state.position_m[1] += aside_m.y);
            let start_m = it.multirotor(1).states[0].position_m;
            it.scenario.vehicles[1].start.y_m = start_m[1];
        }),
        Fault::new("plan.arrival", "one vehicle is planned to arrive late", |it| {
            let spread_s = it.scenario.limits().arrival_spread_s;
            *it.times_s(0).last_mut().expect("a plan has nodes") += 1.1 * spread_s;
        }),
        Fault::new("flight.arrival", "one vehicle is planned to arrive late, and does", |it| {
            let spread_s = it.scenario.limits().arrival_spread_s;
            *it.times_s(0).last_mut().expect("a plan has nodes") += 1.1 * spread_s;
            let scenario = it.scenario.clone();
            it.fly_in(&scenario);
        }),
    ]
}

fn obstacles() -> Vec<Fault> {
    vec![
        Fault::new("nodes.clearance", "an obstacle stands on a node", |it| {
            let [x_m, y_m, _] = it.multirotor(0).states[1].position_m;
            add(it, [x_m, y_m], [0.02, 0.02], None);
        }),
        Fault::new("plan.clearance", "an obstacle stands in the path", |it| {
            let [x_m, y_m] = half_way(it);
            add(it, [x_m, y_m], [0.5, 0.5], None);
        }),
        Fault::new("plan.clearance", "a wall of 1 mm crosses the path between two nodes", |it| {
            let [x_m, y_m] = half_way(it);
            add(it, [x_m, y_m], [1e-3, 0.4], None);
        }),
        Fault::new("plan.clearance", "a pole is a millimetre inside the rotors' reach", |it| {
            let ([x_m, y_m], reach_m) = (half_way(it), it.multirotor_model().body_radius_m);
            add(it, [x_m, y_m - reach_m - 9e-3], [0.02, 0.02], None);
        }),
        Fault::new("plan.clearance", "an obstacle below the path is too high", |it| {
            let ([x_m, y_m], reach_m) = (half_way(it), it.multirotor_model().body_radius_m);
            let z_m = it.multirotor(0).states[0].position_m[2];
            add(it, [x_m, y_m], [0.5, 0.5], Some(Range::new(0.0, z_m - reach_m + 1e-3)));
        }),
        Fault::new("plan.state_limits", "the map ends before the goal", |it| {
            let end_m = it.scenario.vehicles[0].goal.x_m;
            it.scenario.world.map.x_m.max = end_m - 0.1;
        }),
    ]
}

/// Position of the first vehicle half way through its plan, (x, y) in m.
pub fn half_way(it: &mut ReferenceCase) -> [f64; 2] {
    let middle_s = 0.5 * it.plan.flight_time_s().unwrap_or(0.0);
    let position_m = sim::multirotor::Reference::new(it.multirotor(0).nodes()).at(middle_s).position_m;
    [position_m.x, position_m.y]
}

/// Adds a box with its sides along the axes.
pub fn add(it: &mut ReferenceCase, center_m: [f64; 2], size_m: [f64; 2], z_m: Option<Range>) {
    let heading_deg = 0.0;
    it.scenario.world.boxes.push(BoxObstacle { name: "planted".to_owned(), center_m, size_m, heading_deg, z_m });
}
