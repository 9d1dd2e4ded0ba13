//! From a solution to a plan: the polynomials, sampled densely enough that thrusts may be taken as linear in between.

use scenarios::slung_load::{Cable, Control, State, Trajectory};
use scenarios::{Interpolation, PlannedEvent};

use super::attitude::body_rate;
use super::cable::Cable as Direction;
use super::jet::Jet;
use super::model::{LENGTH, Model};
use super::optimise::Candidate;
use super::problem::{GRAVITY, Mode, Problem};
use crate::pseudospectral::{Motion, Place, Transcription};

/// Longest time between two samples, s.
const SAMPLE_S: f64 = 0.005;

/// The trajectory of a candidate.
pub fn trajectory(problem: &Problem, candidate: &Candidate, vehicle: &str) -> Trajectory {
    let model = Model::new(problem);
    let programme = Transcription::new(&model, candidate.mesh.clone());
    let mut trajectory = Trajectory {
        vehicle: vehicle.to_owned(),
        interpolation: Interpolation::FirstOrderHold,
        times_s: Vec::new(),
        states: Vec::new(),
        controls: Vec::new(),
        cable: Vec::new(),
        planner_nodes: Vec::new(),
    };
    let mut node = vec![0.0; model.width()];
    let mut sample = |time_s: f64, place: Place, is_node: bool| {
        programme.node(&candidate.x, place, &mut node);
        if is_node {
            trajectory.planner_nodes.push(trajectory.times_s.len());
        }
        trajectory.times_s.push(time_s);
        trajectory.states.push(state(problem, place.phase, model.coordinates(), &node));
        let [least_n, most_n] = problem.limits.thrust_n;
        // no control stands at the end of a phase: the polynomial goes on to there, and may leave its bounds
        let is_end = place.τ == 1.0 && is_node;
        let thrust_n = |rotor: usize| {
            let thrust_n = node[2 * model.coordinates() + rotor];
            if is_end { thrust_n.clamp(least_n, most_n) } else { thrust_n }
        };
        trajectory.controls.push(Control { thrust_n: std::array::from_fn(thrust_n) });
        trajectory.cable.push(match problem.stages[place.phase].mode {
            Mode::Taut => Cable::Taut,
            Mode::Slack | Mode::Parked => Cable::Slack,
            Mode::Either { .. } => nearest(problem, &model, &node),
        });
    };
    let nodes = programme.times_s(&candidate.x);
    for (k, &(time_s, place)) in nodes.iter().enumerate() {
        sample(time_s, place, true);
        let Some(&(next_s, next)) = nodes.get(k + 1).filter(|(_, next)| next.phase == place.phase) else { continue };
        let count = ((next_s - time_s) / SAMPLE_S).ceil().max(1.0) as usize;
        let τ_next = if next.segment == place.segment { next.τ } else { 1.0 };
        for step in 1..count {
            let share = step as f64 / count as f64;
            let between = Place { τ: place.τ + share * (τ_next - place.τ), ..place };
            sample(time_s + share * (next_s - time_s), between, false);
        }
    }
    trajectory
}

/// Where the cable switches, the impulses of its impacts, and where gates are passed.
pub fn switches(problem: &Problem, candidate: &Candidate) -> Vec<PlannedEvent> {
    let model = Model::new(problem);
    let programme = Transcription::new(&model, candidate.mesh.clone());
    let mut node = vec![0.0; model.width()];
    let mut at_s = 0.0;
    let mut events = Vec::new();
    for (phase, pair) in problem.stages.windows(2).enumerate() {
        at_s += programme.duration_s(phase, &candidate.x);
        if pair[0].gate.is_some() {
            events.push(PlannedEvent { at_s, what: "quadrotor and load are in a gate's windows".to_owned() });
        } else if pair[1].mode == Mode::Taut {
            programme.node(&candidate.x, programme.place(phase, 1.0), &mut node);
            let impulse_ns = model.reduced_kg() * node[model.coordinates() + 8];
            events.push(PlannedEvent { at_s, what: format!("the cable becomes taut with {impulse_ns:.3} N s") });
        } else {
            events.push(PlannedEvent { at_s, what: "the cable becomes slack".to_owned() });
        }
    }
    events
}

/// The quadrotor's path at the nodes, m.
pub fn path_m(problem: &Problem, candidate: &Candidate) -> Vec<[f64; 3]> {
    let model = Model::new(problem);
    let programme = Transcription::new(&model, candidate.mesh.clone());
    let mut node = vec![0.0; model.width()];
    let mut position = |(_, place): (f64, Place)| {
        programme.node(&candidate.x, place, &mut node);
        [node[0], node[1], node[2]]
    };
    programme.times_s(&candidate.x).into_iter().map(&mut position).collect()
}

/// What the cable does under complementarity, where neither tension nor slack length is quite zero: whichever is smaller,
/// the one in weights of the load, the other in lengths of the cable, counts as zero.
fn nearest(problem: &Problem, model: &Model, node: &[f64]) -> Cable {
    let body = &problem.body;
    let tension = node[model.tension()] / (body.load_kg * GRAVITY);
    let slack = (body.cable_m - node[LENGTH]) / body.cable_m;
    if tension > slack { Cable::Taut } else { Cable::Slack }
}

/// A state in world coordinates.
fn state(problem: &Problem, phase: usize, coordinates: usize, node: &[f64]) -> State {
    let (q, v) = (&node[..coordinates], &node[coordinates..2 * coordinates]);
    let is_fixed = coordinates == 8 || problem.stages[phase].mode == Mode::Taut;
    let (length_m, length_rate) = if is_fixed { (problem.body.cable_m, 0.0) } else { (q[8], v[8]) };
    let [alpha, beta] = Jet::<2>::variables([q[6], q[7]]);
    let direction = Direction::at([alpha, beta, Jet::constant(length_m)]).direction;
    let turning = |k: usize| direction[k].gradient[0] * v[6] + direction[k].gradient[1] * v[7];
    let is_parked = problem.stages[phase].mode == Mode::Parked;
    State {
        position_m: [q[0], q[1], q[2]],
        velocity_mps: [v[0], v[1], v[2]],
        roll_pitch_yaw_rad: [q[5], q[4], q[3]],
        body_rate_radps: body_rate([q[3], q[4], q[5]], [v[3], v[4], v[5]]),
        load_position_m: if is_parked {
            parked_m(problem)
        } else {
            std::array::from_fn(|k| q[k] + length_m * direction[k].value)
        },
        load_velocity_mps: if is_parked {
            [0.0; 3]
        } else {
            std::array::from_fn(|k| v[k] + length_rate * direction[k].value + length_m * turning(k))
        },
    }
}

/// Where a load stands that the ground carries, m: in the planner's coordinates it does so to within the collocation's
/// error.
fn parked_m(problem: &Problem) -> [f64; 3] {
    let [_, _, length_m] = problem.start.cable;
    let direction = Direction::at(problem.start.cable.map(Jet::<0>::constant)).direction;
    std::array::from_fn(|k| problem.start.position_m[k] + length_m * direction[k].value)
}
