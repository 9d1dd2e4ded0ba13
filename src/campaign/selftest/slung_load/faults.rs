//! Faults of plans and flights of quadrotors with a slung load.

use scenarios::slung_load::Cable;
use scenarios::{BoxObstacle, Gate, Range, Window};
use sim::{Event, EventKind};

use crate::campaign::selftest::reference_case::thrusts;
use crate::campaign::selftest::{Fault, ReferenceCase};

/// The faults of this family.
pub fn all() -> Vec<Fault> {
    let mut all = plans();
    all.extend(flights());
    all.extend(cables());
    all.extend(obstacles());
    all.extend(gates());
    all.extend(rotors());
    all
}

fn plans() -> Vec<Fault> {
    vec![
        Fault::new("plan.complete", "the planner's nodes are out of range", |it| {
            let beyond = it.slung_load().times_s.len();
            it.slung_load().planner_nodes = vec![0, beyond];
        }),
        Fault::new("nodes.control_limits", "a thrust at one node is beyond what planning allows", |it| {
            let max_n = it.slung_load_model().planning_limits.thrust_n.max;
            let node = it.slung_load().planner_nodes()[5];
            it.slung_load().controls[node].thrust_n[2] = max_n + 1e-3;
        }),
        Fault::new("plan.control_limits", "a thrust jumps at one node", |it| {
            let node = it.slung_load().times_s.len() / 2;
            it.slung_load().controls[node].thrust_n[0] = 30.0;
        }),
        Fault::new("nodes.state_limits", "planned attitudes in degrees", |it| {
            let node = it.slung_load().planner_nodes()[9];
            it.slung_load().states[node].roll_pitch_yaw_rad = [0.0, 5.0, 0.0];
        }),
        Fault::new("plan.dynamics", "the planned load is somewhere else at one node", |it| {
            let node = it.slung_load().times_s.len() / 2;
            it.slung_load().states[node].load_position_m[0] += 0.02;
        }),
        Fault::new("plan.dynamics", "the thrusts of two rotors are swapped", |it| {
            it.slung_load().controls.iter_mut().for_each(|control| control.thrust_n.swap(0, 2));
        }),
        Fault::new("plan.rest", "the plan ends in motion", |it| it.scenario.vehicles[0].goal.speed_mps = 0.2),
        Fault::new("plan.slack", "the planned cable is stretched at one node", |it| {
            let node = it.slung_load().times_s.len() / 2;
            it.slung_load().states[node].load_position_m[2] -= 0.02;
        }),
        Fault::new("plan.tension", "the planned cable is taut where it would have to push", |it| {
            it.slung_load().cable.fill(Cable::Taut);
            it.slung_load().controls.iter_mut().take(3).for_each(|control| control.thrust_n = [0.0; 4]);
            let model = it.slung_load_model();
            model.limits.tension_n = 1e-6;
        }),
        Fault::new("plan.state_limits", "the map ends before the goal", |it| {
            it.scenario.world.map.x_m = Range::new(-4.0, 1.9);
        }),
        Fault::new("plan.swing", "the cable swings beyond its limit", |it| {
            it.slung_load_model().limits.cable_deg = Range::new(-0.5, 0.5);
        }),
    ]
}

fn gates() -> Vec<Fault> {
    vec![
        Fault::new("nodes.gates", "a gate is beside the path", |it| add_gate(it, 0.5)),
        Fault::new("plan.gates", "a gate is missed by a millimetre", |it| add_gate(it, HALF_GATE_M + 1e-3)),
        Fault::new("flight.gates", "the load is blown past a gate", |it| {
            add_gate(it, 0.0);
            let steps = it.steps();
            it.shift(0, 0..steps, [0.0, 5.0 * HALF_GATE_M, 0.0]);
        }),
    ]
}

/// Half the width of the gates, m.
const HALF_GATE_M: f64 = 0.1;

/// Adds a gate around the load in the middle of the plan; with `aside_m` > 0, beside everything that the load passes.
fn add_gate(it: &mut ReferenceCase, aside_m: f64) {
    let middle = it.slung_load().times_s.len() / 2;
    let load_m = it.slung_load().states[middle].load_position_m;
    let [x_m, _, _] = load_m.map(|at_m| Some(Range::new(at_m - HALF_GATE_M, at_m + HALF_GATE_M)));
    let farthest_m = it.slung_load().states.iter().map(|state| state.load_position_m[1]).fold(f64::MIN, f64::max);
    let y_m = if aside_m > 0.0 { farthest_m + aside_m } else { load_m[1] };
    let load = Window { x_m, y_m: Some(Range::new(y_m - HALF_GATE_M, y_m + HALF_GATE_M)), z_m: None };
    let gate = Gate { name: "gate".to_owned(), quadrotor: Window::default(), load };
    it.scenario.world.gates.push(gate);
}

fn rotors() -> Vec<Fault> {
    vec![
        Fault::new("nodes.rotor_clearance", "the load is in the rotors at one node", |it| {
            let node = it.slung_load().planner_nodes()[9];
            let state = &mut it.slung_load().states[node];
            let [x_m, y_m, z_m] = state.position_m;
            state.load_position_m = [x_m + 0.1, y_m, z_m - 0.01];
        }),
        Fault::new("plan.rotor_clearance", "the load is larger than the cable is long", |it| {
            let model = it.slung_load_model();
            model.load_radius_m = 1.01 * model.cable_length_m;
        }),
        Fault::new("flight.rotor_clearance", "the load falls through the rotors between two samples", |it| {
            let middle = it.steps() / 2;
            for (step, above_m) in [(middle, 0.2), (middle + 1, -0.2)] {
                let [x_m, y_m, z_m] = it.samples(0)[step].position_m;
                it.loads()[step].position_m = [x_m, y_m, z_m + above_m];
            }
        }),
    ]
}

fn flights() -> Vec<Fault> {
    vec![
        Fault::new("flight.tracking_max", "the quadrotor is pushed aside for a moment", |it| {
            let (middle, max_m) = (it.steps() / 2, it.scenario.limits().tracking_max_m);
            it.shift(0, middle..middle + 20, [0.0, 1.2 * max_m, 0.0]);
        }),
        Fault::new("flight.tracking_rms", "the quadrotor flies above its plan", |it| {
            let (steps, max_m) = (it.steps(), it.scenario.limits().tracking_rms_m);
            it.shift(0, 0..steps, [0.0, 0.0, 1.1 * max_m]);
        }),
        Fault::new("flight.control_limits", "a thrust jumps for one sample", |it| {
            let middle = it.steps() / 2;
            thrusts(&mut it.samples(0)[middle]).control.thrust_n[1] = 30.0;
        }),
        Fault::new("flight.dynamics", "the thrusts in the log are not those that acted", |it| {
            let middle = it.steps() / 2;
            it.samples(0)[middle..middle + 20].iter_mut().for_each(|it| thrusts(it).control.thrust_n[0] += 1.0);
        }),
        Fault::new("flight.saturation", "commands are cut off for a tenth of the time", |it| {
            let tenth = it.planned_steps() / 10;
            it.samples(0)[..tenth].iter_mut().for_each(|sample| thrusts(sample).command.thrust_n[0] = 9.0);
        }),
        Fault::new("flight.state_limits", "the quadrotor turns over for one sample", |it| {
            let middle = it.steps() / 2;
            it.samples(0)[middle].world_from_body = [1.0, 0.0, 0.0, 0.0];
        }),
        Fault::new("flight.clearance", "one attitude is no rotation", |it| {
            let middle = it.steps() / 2;
            it.samples(0)[middle].world_from_body = [0.0, 0.0, 0.0, 2.0];
        }),
        Fault::new("flight.dynamics", "the attitude in the log stays level", |it| {
            it.samples(0).iter_mut().for_each(|sample| sample.world_from_body = [0.0, 0.0, 0.0, 1.0]);
        }),
        Fault::new("flight.rest", "the load still swings at the end", |it| {
            it.loads().iter_mut().for_each(|load| load.velocity_mps[1] += 0.2);
        }),
        Fault::new("flight.finite", "one position of the load is not a number", |it| {
            let middle = it.steps() / 2;
            it.loads()[middle].position_m[2] = f64::NAN;
        }),
        Fault::new("flight.clearance", "the log holds no load", |it| it.loads().clear()),
        Fault::new("flight.duration", "the flight exceeds the longest duration", |it| {
            it.scenario.simulation.max_duration_s = 0.9 * it.plan.flight_time_s().unwrap_or(0.0);
        }),
        Fault::new("flight.swing", "the load swings out at one sample", |it| {
            let middle = it.steps() / 2;
            let [x_m, y_m, z_m] = it.samples(0)[middle].position_m;
            it.loads()[middle].position_m = [x_m + 0.649, y_m, z_m - 0.03];
        }),
    ]
}

fn cables() -> Vec<Fault> {
    vec![
        Fault::new("flight.tension", "the tension has a spike", |it| {
            let (middle, max_n) = (it.steps() / 2, it.slung_load_model().limits.tension_n);
            let samples = (0.02 / it.scenario.simulation.step_s).ceil();
            it.loads()[middle].tension_n = 1.1 * max_n * samples;
        }),
        Fault::new("flight.tension", "the cable pushes", |it| {
            let middle = it.steps() / 2;
            it.loads()[middle].tension_n = -1.0;
        }),
        Fault::new("flight.dynamics", "the tension in the log is a tenth too low", |it| {
            it.loads().iter_mut().for_each(|load| load.tension_n *= 0.9);
        }),
        Fault::new("flight.dynamics", "the cable is 2 cm longer than it is, for a while", |it| {
            let middle = it.steps() / 2;
            it.loads()[middle..middle + 60].iter_mut().for_each(|load| load.position_m[2] -= 0.02);
        }),
        Fault::new("flight.slack", "the cable became taut without an event in the log", |it| {
            it.flight().events.retain(|event| !matches!(event.kind, EventKind::CableTaut { .. }));
        }),
        Fault::new("flight.slack", "the cable became taut too late", |it| {
            let late_s = 1.1 * it.scenario.limits().switch_s;
            let taut = |event: &&mut Event| matches!(event.kind, EventKind::CableTaut { .. });
            it.flight().events.iter_mut().filter(taut).for_each(|event| event.t_s += late_s);
        }),
        Fault::new("flight.slack", "the cable became slack once more than planned", |it| {
            it.flight().events.push(Event { t_s: 2.0, kind: EventKind::CableSlack, vehicles: vec![] });
        }),
        Fault::new("flight.slack", "the cable does not pull, and the log calls it taut", |it| {
            let middle = it.steps() / 2;
            it.loads()[middle..middle + 20].iter_mut().for_each(|load| load.tension_n = 0.0);
        }),
        Fault::new("flight.slack", "the cable pulls, and the log calls it slack", |it| {
            let middle = it.steps() / 2;
            it.loads()[middle..middle + 20].iter_mut().for_each(|load| load.cable = Cable::Slack);
        }),
    ]
}

fn obstacles() -> Vec<Fault> {
    vec![
        Fault::new("plan.clearance", "an obstacle stands in the path", |it| {
            let middle = it.steps() / 2;
            place(it, middle, [0.3, 0.3], None);
        }),
        Fault::new("flight.clearance", "a wall of 1 mm crosses the path between two samples", |it| {
            let middle = it.steps() / 2;
            place(it, middle, [0.001, 0.5], None);
        }),
        Fault::new("flight.clearance", "a bar crosses the cable, below the body and above the load", |it| {
            let middle = it.steps() / 2;
            let (body_m, load_m) = (it.samples(0)[middle].position_m, it.loads()[middle].position_m);
            let [x_m, y_m, z_m] = [0, 1, 2].map(|axis| f64::midpoint(body_m[axis], load_m[axis]));
            add(it, [x_m, y_m], [0.02, 0.02], Some(Range::new(z_m - 0.02, z_m + 0.02)));
        }),
        Fault::new("flight.envelope", "a pole stands under a rotor", |it| {
            let middle = it.steps() / 2;
            let z_m = it.samples(0)[middle].position_m[2];
            place(it, middle, [0.3, 0.3], Some(Range::new(-0.5, z_m - 0.9)));
        }),
        Fault::new("nodes.clearance", "an obstacle stands on a node of the planner", |it| {
            let node = it.slung_load().planner_nodes()[9];
            let [x_m, y_m, _] = it.slung_load().states[node].position_m;
            add(it, [x_m, y_m], [0.02, 0.02], None);
        }),
        Fault::new("nodes.envelope", "the envelope of a node of the planner cuts an obstacle", |it| {
            let node = it.slung_load().planner_nodes()[9];
            let [x_m, y_m, z_m] = it.slung_load().states[node].position_m;
            add(it, [x_m, y_m], [0.02, 0.02], Some(Range::new(-0.5, z_m - 1.0)));
        }),
        Fault::new("plan.envelope", "the envelope of the plan cuts an obstacle", |it| {
            let middle = it.steps() / 2;
            let z_m = it.samples(0)[middle].position_m[2];
            place(it, middle, [0.05, 0.05], Some(Range::new(-0.5, z_m - 0.9)));
        }),
        Fault::new("flight.clearance", "the ground is higher than the body flies", |it| {
            let highest_m = it.samples(0).iter().map(|sample| sample.position_m[2]).fold(f64::MIN, f64::max);
            it.scenario.world.ground_m = Some(highest_m);
        }),
    ]
}

/// Adds a box half way between two samples of the quadrotor, across the path.
fn place(it: &mut ReferenceCase, step: usize, size_m: [f64; 2], z_m: Option<Range>) {
    let [from, to] = [it.samples(0)[step], it.samples(0)[step + 1]];
    let middle = |axis: usize| f64::midpoint(from.position_m[axis], to.position_m[axis]);
    let heading_deg = from.velocity_mps[1].atan2(from.velocity_mps[0]).to_degrees();
    let center_m = [middle(0), middle(1)];
    it.scenario.world.boxes.push(BoxObstacle { name: "planted".to_owned(), center_m, size_m, heading_deg, z_m });
}

fn add(it: &mut ReferenceCase, center_m: [f64; 2], size_m: [f64; 2], z_m: Option<Range>) {
    let heading_deg = 0.0;
    it.scenario.world.boxes.push(BoxObstacle { name: "planted".to_owned(), center_m, size_m, heading_deg, z_m });
}
