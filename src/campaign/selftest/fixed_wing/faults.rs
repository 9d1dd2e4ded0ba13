//! Faults of plans and flights of fixed wings.

use scenarios::Cylinder;

use super::load_factors;
use crate::campaign::selftest::faults::log::{delay, swap};
use crate::campaign::selftest::{Fault, ReferenceCase};

/// The faults of this family.
pub fn all() -> Vec<Fault> {
    let mut all = plans();
    all.extend(flights());
    all.extend(obstacles());
    all
}

fn plans() -> Vec<Fault> {
    vec![
        Fault::new("plan.complete", "planned headings in degrees", |it| {
            it.scenario.vehicles[0].start.heading_deg = 0.5;
            it.fixed_wing(0).states.iter_mut().for_each(|state| state.heading_rad = state.heading_rad.to_degrees());
        }),
        Fault::new("plan.complete", "planned altitudes in feet", |it| {
            it.fixed_wing(0).states.iter_mut().for_each(|state| state.z_m /= 0.3048);
        }),
        Fault::new("plan.dynamics", "planned speeds 1 % too fast from the second node on", |it| {
            it.fixed_wing(0).states.iter_mut().skip(1).for_each(|state| state.speed_mps *= 1.01);
        }),
        Fault::new("plan.control_limits", "a control jumps at one node", |it| it.fixed_wing(0).controls[10].n_z = 2.0),
        Fault::new("nodes.control_limits", "a control at one node is beyond what planning allows", |it| {
            let max = it.fixed_wing_model().planning_limits.n_y.max;
            it.fixed_wing(0).controls[10].n_y = max + 1e-3;
        }),
        Fault::new("nodes.state_limits", "a node is faster than planning allows", |it| {
            let fastest_mps = it.fixed_wing_model().planning_limits.speed_mps.max;
            it.fixed_wing(0).states[10].speed_mps = fastest_mps + 0.01;
        }),
        Fault::new("plan.rollout", "the planned controls pull slightly to one side", |it| {
            it.fixed_wing(0).controls.iter_mut().for_each(|control| control.n_y += 2e-4);
        }),
        Fault::new("plan.dynamics", "a planned control has the opposite sign", |it| {
            it.fixed_wing(0).controls.iter_mut().for_each(|control| control.n_y = -control.n_y);
        }),
        Fault::new("plan.separation", "the second plan is a copy of the first", |it| {
            let copy = it.fixed_wing(0).clone();
            let name = it.fixed_wing(1).vehicle.clone();
            let start = it.scenario.vehicles[0].start;
            it.scenario.vehicles[1].start = start;
            *it.fixed_wing(1) = scenarios::fixed_wing::Trajectory { vehicle: name, ..copy };
        }),
        Fault::new("plan.complete", "the plans of two vehicles are swapped", |it| it.plan.trajectories.swap(0, 1)),
        Fault::new("plan.arrival", "one vehicle is planned to arrive late", |it| {
            let spread_s = it.scenario.limits().arrival_spread_s;
            *it.times_s(0).last_mut().expect("a plan has nodes") += 1.1 * spread_s;
        }),
    ]
}

fn flights() -> Vec<Fault> {
    vec![
        Fault::new("flight.complete", "the logs of two vehicles are swapped", |it| it.flight().vehicles.swap(0, 1)),
        Fault::new("flight.complete", "the contents of two logs are swapped", |it| swap(it, 0)),
        Fault::new("flight.dynamics", "two vehicles change places in the middle of the flight", |it| {
            let middle = it.steps() / 2;
            swap(it, middle);
        }),
        Fault::new("flight.arrival", "one vehicle is delayed", |it| {
            let late_s = 1.1 * it.scenario.limits().arrival_spread_s;
            delay(it, late_s);
        }),
        Fault::new("flight.separation", "one vehicle flies beside another", |it| {
            let beside = it.samples(0).clone();
            for (sample, beside) in it.samples(1).iter_mut().zip(beside) {
                sample.position_m = [beside.position_m[0], beside.position_m[1] + 20.0, beside.position_m[2]];
                sample.velocity_mps = beside.velocity_mps;
            }
        }),
        Fault::new("flight.tracking_max", "a vehicle is blown aside for some seconds", |it| {
            let (middle, max_m) = (it.steps() / 2, it.scenario.limits().tracking_max_m);
            it.shift(0, middle..middle + 300, [0.0, 1.2 * max_m, 0.0]);
        }),
        Fault::new("flight.tracking_rms", "a vehicle flies beside its plan", |it| {
            let (steps, max_m) = (it.steps(), it.scenario.limits().tracking_rms_m);
            it.shift(0, 0..steps, [0.0, 0.0, 1.1 * max_m]);
        }),
        Fault::new("flight.state_limits", "a flight is slower than the smallest airspeed", |it| {
            let slowest_mps = it.fixed_wing_model().limits.speed_mps.min;
            let middle = it.steps() / 2;
            let sample = &mut it.samples(0)[middle];
            let now_mps = sample.velocity_mps.iter().map(|v| v * v).sum::<f64>().sqrt();
            (0..3).for_each(|axis| sample.velocity_mps[axis] *= 0.99 * slowest_mps / now_mps);
        }),
        Fault::new("flight.state_limits", "flown altitudes in feet", |it| {
            it.samples(0).iter_mut().for_each(|sample| sample.position_m[2] /= 0.3048);
        }),
        Fault::new("flight.control_limits", "a control jumps for one sample", |it| {
            let middle = it.steps() / 2;
            load_factors(&mut it.samples(0)[middle]).control.n_z = 3.0;
        }),
        Fault::new("flight.dynamics", "the controls in the log are not those that acted", |it| {
            let middle = it.steps() / 2;
            it.samples(0)[middle..middle + 50].iter_mut().for_each(|it| load_factors(it).control.n_y += 0.02);
        }),
        Fault::new("flight.saturation", "commands are cut off for a tenth of the time", |it| {
            let tenth = it.planned_steps() / 10;
            it.samples(0)[..tenth].iter_mut().for_each(|sample| load_factors(sample).command.n_x = 1.0);
        }),
        Fault::new("flight.duration", "a vehicle exceeds the longest duration", |it| {
            let planned_s = it.plan.flight_time_s().unwrap_or(0.0);
            it.scenario.simulation.max_duration_s = planned_s + 0.1;
            delay(it, 0.2);
        }),
    ]
}

fn obstacles() -> Vec<Fault> {
    vec![
        Fault::new("plan.clearance", "an obstacle stands in the path", |it| {
            let middle = it.steps() / 2;
            place(it, middle, 0.5, 0.0, 50.0);
        }),
        Fault::new("flight.clearance", "a pole of 2 cm stands between two samples", |it| {
            let middle = it.steps() / 2;
            place(it, middle, 0.5, 0.0, 0.01);
        }),
        Fault::new("plan.clearance", "a pole of 10 cm stands between two nodes", |it| {
            let trajectory = it.fixed_wing(0);
            let (node, half) = (trajectory.times_s.len() / 2, 0.5);
            let (from, to) = (trajectory.times_s[node], trajectory.times_s[node + 1]);
            let at_s = from + half * (to - from);
            let reference = sim::fixed_wing::Reference::new(trajectory).at(at_s);
            add(it, [reference.position_m.x, reference.position_m.y], 0.05);
        }),
        Fault::new("nodes.clearance", "an obstacle stands on a node", |it| {
            let state = it.fixed_wing(0).states[10];
            add(it, [state.x_m, state.y_m], 1.0);
        }),
        Fault::new("flight.crash", "a wing touches a pole, and the log tells of no crash", |it| {
            let (middle, wing_m) = (it.steps() / 2, it.fixed_wing_model().body_radius_m);
            place(it, middle, 0.5, 0.01 + 0.9 * wing_m, 0.01);
        }),
    ]
}

/// Adds a pole near the path of the first vehicle: at the fraction `between` of a step, its axis `left_m` to the left.
fn place(it: &mut ReferenceCase, step: usize, between: f64, left_m: f64, radius_m: f64) {
    let [from, to] = [it.samples(0)[step], it.samples(0)[step + 1]];
    let at = |axis: usize| from.position_m[axis] + between * (to.position_m[axis] - from.position_m[axis]);
    let [vx, vy, _] = from.velocity_mps;
    let speed_mps = vx.hypot(vy);
    add(it, [at(0) - left_m * vy / speed_mps, at(1) + left_m * vx / speed_mps], radius_m);
}

fn add(it: &mut ReferenceCase, center_m: [f64; 2], radius_m: f64) {
    it.scenario.world.cylinders.push(Cylinder { name: "planted".to_owned(), center_m, radius_m });
}
