//! From a solution to a plan: the polynomials, sampled densely enough that the thrusts are linear between samples.

use scenarios::slung_load::{Cable, Control, State, Trajectory};
use scenarios::{GRAVITY_MPS2, Interpolation, PlannedEvent};

use super::attitude::body_rate;
use super::cable::CableGeometry;
use super::jet::Jet;
use super::optimise::Candidate;
use super::problem::{CableMode, Problem};
use super::system::{ALPHA, BETA, EULER, LENGTH, SlungLoadSystem};
use crate::pseudospectral::{MeshPoint, Transcription};

/// Maximum time between two samples, s.
const MAX_SAMPLE_S: f64 = 0.005;

/// The trajectory of a candidate.
pub fn trajectory(problem: &Problem, candidate: &Candidate, vehicle: &str) -> Trajectory {
    let system = SlungLoadSystem::new(problem);
    let program = Transcription::new(&system, candidate.mesh.clone());
    let mut trajectory = Trajectory {
        vehicle: vehicle.to_owned(),
        interpolation: Interpolation::FirstOrderHold,
        times_s: Vec::new(),
        states: Vec::new(),
        controls: Vec::new(),
        cable: Vec::new(),
        planner_nodes: Vec::new(),
    };
    let mut node = vec![0.0; system.width()];
    let mut sample = |time_s: f64, point: MeshPoint, is_node: bool| {
        program.node(&candidate.x, point, &mut node);
        if is_node {
            trajectory.planner_nodes.push(trajectory.times_s.len());
        }
        trajectory.times_s.push(time_s);
        trajectory.states.push(state(problem, point.phase, system.coordinates, &node));
        let [min_n, max_n] = problem.limits.thrust_n;
        // there is no control at the end of a phase: the polynomial is extrapolated, and may leave its bounds
        let is_end = point.τ == 1.0 && is_node;
        let thrust_n = |rotor: usize| {
            let thrust_n = node[2 * system.coordinates + rotor];
            if is_end { thrust_n.clamp(min_n, max_n) } else { thrust_n }
        };
        trajectory.controls.push(Control { thrust_n: std::array::from_fn(thrust_n) });
        trajectory.cable.push(match problem.phases[point.phase].mode {
            CableMode::Taut => Cable::Taut,
            CableMode::Slack | CableMode::OnGround => Cable::Slack,
            CableMode::Complementarity { .. } => complementary_state(problem, &system, &node),
        });
    };
    let nodes = program.node_times_s(&candidate.x);
    for (k, &(time_s, point)) in nodes.iter().enumerate() {
        sample(time_s, point, true);
        let Some(&(next_s, next)) = nodes.get(k + 1).filter(|(_, next)| next.phase == point.phase) else { continue };
        let count = ((next_s - time_s) / MAX_SAMPLE_S).ceil().max(1.0) as usize;
        let τ_next = if next.segment == point.segment { next.τ } else { 1.0 };
        for step in 1..count {
            let fraction = step as f64 / count as f64;
            let between = MeshPoint { τ: point.τ + fraction * (τ_next - point.τ), ..point };
            sample(time_s + fraction * (next_s - time_s), between, false);
        }
    }
    trajectory
}

/// Switches of the cable, with the impulses of impacts, and the passing of gates.
pub fn events(problem: &Problem, candidate: &Candidate) -> Vec<PlannedEvent> {
    let system = SlungLoadSystem::new(problem);
    let program = Transcription::new(&system, candidate.mesh.clone());
    let mut node = vec![0.0; system.width()];
    let mut at_s = 0.0;
    let mut events = Vec::new();
    for (phase, pair) in problem.phases.windows(2).enumerate() {
        at_s += program.duration_s(phase, &candidate.x);
        if pair[0].gate.is_some() {
            events.push(PlannedEvent { at_s, what: "quadrotor and load are in a gate's windows".to_owned() });
        } else if pair[1].mode == CableMode::Taut {
            program.node(&candidate.x, program.mesh_point(phase, 1.0), &mut node);
            let impulse_ns = system.reduced_kg() * node[system.coordinates + LENGTH];
            events.push(PlannedEvent { at_s, what: format!("the cable becomes taut with {impulse_ns:.3} N s") });
        } else {
            events.push(PlannedEvent { at_s, what: "the cable becomes slack".to_owned() });
        }
    }
    events
}

/// The quadrotor's path at the nodes, m.
pub fn path_m(problem: &Problem, candidate: &Candidate) -> Vec<[f64; 3]> {
    let system = SlungLoadSystem::new(problem);
    let program = Transcription::new(&system, candidate.mesh.clone());
    let mut node = vec![0.0; system.width()];
    let mut position = |(_, point): (f64, MeshPoint)| {
        program.node(&candidate.x, point, &mut node);
        [node[0], node[1], node[2]]
    };
    program.node_times_s(&candidate.x).into_iter().map(&mut position).collect()
}

/// State of the cable under complementarity, where neither tension nor slack is exactly zero: the smaller one of λ/(m_L
/// g) and (l_0 - ρ)/l_0 counts as zero.
fn complementary_state(problem: &Problem, system: &SlungLoadSystem, node: &[f64]) -> Cable {
    let vehicle = &problem.vehicle;
    let tension = node[system.tension()] / (vehicle.load_kg * GRAVITY_MPS2);
    let slack = (vehicle.cable_m - node[LENGTH]) / vehicle.cable_m;
    if tension > slack { Cable::Taut } else { Cable::Slack }
}

/// A node in world coordinates.
fn state(problem: &Problem, phase: usize, coordinates: usize, node: &[f64]) -> State {
    let (q, v) = (&node[..coordinates], &node[coordinates..2 * coordinates]);
    let [yaw, pitch, roll] = std::array::from_fn(|k| q[EULER + k]);
    let is_fixed = coordinates == LENGTH || problem.phases[phase].mode == CableMode::Taut;
    let (length_m, length_rate) = if is_fixed { (problem.vehicle.cable_m, 0.0) } else { (q[LENGTH], v[LENGTH]) };
    let [alpha, beta] = Jet::<2>::variables([q[ALPHA], q[BETA]]);
    let direction = CableGeometry::at([alpha, beta, Jet::constant(length_m)]).direction;
    let direction_rate = |k: usize| direction[k].gradient[0] * v[ALPHA] + direction[k].gradient[1] * v[BETA];
    let is_on_ground = problem.phases[phase].mode == CableMode::OnGround;
    State {
        position_m: [q[0], q[1], q[2]],
        velocity_mps: [v[0], v[1], v[2]],
        roll_pitch_yaw_rad: [roll, pitch, yaw],
        body_rate_radps: body_rate([yaw, pitch, roll], std::array::from_fn(|k| v[EULER + k])),
        load_position_m: if is_on_ground {
            load_on_ground_m(problem)
        } else {
            std::array::from_fn(|k| q[k] + length_m * direction[k].value)
        },
        load_velocity_mps: if is_on_ground {
            [0.0; 3]
        } else {
            std::array::from_fn(|k| v[k] + length_rate * direction[k].value + length_m * direction_rate(k))
        },
    }
}

/// Position of a load at rest on the ground, m: its initial one, which the planner's coordinates keep to within the
/// collocation error only.
fn load_on_ground_m(problem: &Problem) -> [f64; 3] {
    let [_, _, length_m] = problem.start.cable;
    let direction = CableGeometry::at(problem.start.cable.map(Jet::<0>::constant)).direction;
    std::array::from_fn(|k| problem.start.position_m[k] + length_m * direction[k].value)
}
