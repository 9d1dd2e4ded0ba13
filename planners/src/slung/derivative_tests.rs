//! Derivatives of the slung-load system against central differences.

use super::problem::{Avoidance, CableMode, Gate, InitialCondition, Limits, Phase, Problem, TorqueModel};
use super::system::{LENGTH, SlungLoadSystem};
use crate::pseudospectral::{
    Duration, MultiphaseSystem, NodeDerivatives, NodeWeights, TerminalDerivatives, TerminalValues, TerminalWeights,
};

/// Step of the differences.
const H: f64 = 1e-5;

/// Problems that cover every mode, every switch and every kind of constraint.
pub fn problems() -> Vec<Problem> {
    let paper = Problem {
        limits: Limits { floor_m: Some(0.0), tension_n: 9.0, ..Problem::paper().limits },
        ..Problem::paper()
    };
    let phase = |mode| Phase { mode, duration: Duration::Fixed(1.0), max_impulse_ns: Some(0.1), gate: None };
    let open = [f64::NEG_INFINITY, f64::INFINITY];
    let gate =
        Gate { quadrotor_m: [[-1.0, 1.0], open, [0.5, 1.5]], load_m: [[-0.5, 2.0], [-1.0, f64::INFINITY], [1.0, 2.0]] };
    let gated = |mode| Phase { gate: Some(gate), ..phase(mode) };
    let switching = Problem {
        start: InitialCondition { position_m: [-2.0, 0.0, 0.35], cable: [0.0, 0.0, 0.35] },
        phases: [CableMode::OnGround, CableMode::Taut, CableMode::Slack, CableMode::Taut].map(phase).to_vec(),
        ..paper.clone()
    };
    let complementarity = CableMode::Complementarity { epsilon: 1e-3 };
    let complementary = Problem { phases: vec![phase(complementarity)], ..paper.clone() };
    let phases = vec![
        gated(CableMode::Taut),
        phase(CableMode::Taut),
        gated(CableMode::Slack),
        phase(CableMode::Slack),
        phase(CableMode::Taut),
    ];
    let through_gates = Problem { phases, ..paper.clone() };
    let by_r_function = Problem { avoidance: Avoidance::RFunction, ..complementary.clone() };
    let parts = Problem {
        avoidance: Avoidance::Parts,
        obstacle_altitudes_m: vec![[-0.5, 0.3]],
        torques: TorqueModel::Generalised,
        ..complementary.clone()
    };
    vec![paper, switching, complementary, through_gates, by_r_function, parts]
}

pub fn noise(seed: usize, i: usize) -> f64 {
    ((seed * 37 + i * 101 + 13) as f64).sin()
}

fn node(system: &SlungLoadSystem, seed: usize) -> Vec<f64> {
    let nq = system.coordinates;
    let mut node: Vec<f64> = (0..system.width()).map(|i| 0.5 * noise(seed, i)).collect();
    node[0] -= 1.9;
    node[1] -= 1.3;
    for thrust in &mut node[2 * nq..] {
        *thrust += 3.0;
    }
    if nq > LENGTH {
        node[LENGTH] = 0.5 + 0.1 * noise(seed, 99);
    }
    node
}

/// A Jacobian (values x arguments), and the Hessian of the weighted sum of the values.
type Derivatives = (Vec<f64>, Vec<f64>);

/// Functions with their derivatives, and the weights of the Hessian.
struct Functions<'a> {
    values: &'a dyn Fn(&[f64]) -> Vec<f64>,
    derivatives: &'a dyn Fn(&[f64]) -> Derivatives,
    weights: Vec<f64>,
}

impl Functions<'_> {
    fn assert_derivatives_agree(&self, at: &[f64], label: &str) {
        let width = at.len();
        let (jacobian, hessian) = (self.derivatives)(at);
        for j in 0..width {
            let moved = |sign: f64| {
                let mut moved = at.to_vec();
                moved[j] += sign * H;
                moved
            };
            let (ahead, behind) = ((self.values)(&moved(1.0)), (self.values)(&moved(-1.0)));
            for i in 0..ahead.len() {
                let difference = (ahead[i] - behind[i]) / (2.0 * H);
                assert!((jacobian[i * width + j] - difference).abs() < 1e-6, "{label}: value {i} by {j}");
            }
            let (ahead, behind) = (self.weighted_gradient(&moved(1.0)), self.weighted_gradient(&moved(-1.0)));
            for i in 0..width {
                let difference = (ahead[i] - behind[i]) / (2.0 * H);
                let exact = hessian[i * width + j];
                assert!((exact - difference).abs() < 1e-5, "{label}: ({i}, {j}) {exact} for {difference}");
            }
        }
    }

    fn weighted_gradient(&self, at: &[f64]) -> Vec<f64> {
        let (jacobian, _) = (self.derivatives)(at);
        let mut gradient = vec![0.0; at.len()];
        for (row, weight) in jacobian.chunks_exact(at.len()).zip(&self.weights) {
            gradient.iter_mut().zip(row).for_each(|(gradient, slope)| *gradient += weight * slope);
        }
        gradient
    }
}

/// Accelerations, path constraints and running cost.
#[test]
fn node_derivatives_agree_with_differences() {
    for problem in problems() {
        let system = SlungLoadSystem::new(&problem);
        let (nq, width) = (system.coordinates, system.width());
        for (phase, seed) in (0..problem.phases.len()).flat_map(|phase| (0..5).map(move |seed| (phase, seed))) {
            let constraints = system.path_constraint_count(phase);
            let y: Vec<f64> = (0..nq).map(|i| noise(seed + 7, i)).collect();
            let z: Vec<f64> = (0..constraints).map(|i| noise(seed + 8, i)).collect();
            let values = |at: &[f64]| {
                let (mut a, mut d) = (vec![0.0; nq], vec![0.0; constraints]);
                let cost = system.evaluate(phase, at, &mut a, &mut d);
                [a, d, vec![cost]].concat()
            };
            let derivatives = |at: &[f64]| {
                let (mut a, mut cost) = (vec![0.0; nq * width], vec![0.0; width]);
                let (mut d, mut hessian) = (vec![0.0; constraints * width], vec![0.0; width * width]);
                let into = NodeDerivatives {
                    acceleration: &mut a,
                    cost: &mut cost,
                    path_constraints: &mut d,
                    hessian: &mut hessian,
                };
                let weights = NodeWeights { cost: 0.7, acceleration: &y, path_constraints: &z };
                system.differentiate(phase, at, weights, into);
                ([a, d, cost].concat(), hessian)
            };
            let weights = [y.clone(), z.clone(), vec![0.7]].concat();
            let functions = Functions { values: &values, derivatives: &derivatives, weights };
            functions.assert_derivatives_agree(&node(&system, seed), &format!("phase {phase}"));
        }
    }
}

/// Terminal constraints and linkages.
#[test]
fn terminal_derivatives_agree_with_differences() {
    for problem in problems() {
        let system = SlungLoadSystem::new(&problem);
        let n = 2 * system.coordinates;
        for phase in 0..problem.phases.len() {
            let (equalities, inequalities) = system.terminal_constraint_counts(phase);
            let linkages = if phase + 1 == problem.phases.len() { 0 } else { n };
            let counts = [equalities, inequalities, linkages];
            let weights = counts.map(|count| (0..count).map(|i| noise(i, 5)).collect::<Vec<f64>>());
            let values = |at: &[f64]| {
                let [equalities, inequalities, next_state] = counts.map(|count| vec![0.0; count]);
                let mut values = TerminalValues { equalities, inequalities, next_state };
                system.evaluate_terminal(phase, at, &mut values);
                [values.equalities, values.inequalities, values.next_state].concat()
            };
            let derivatives = |at: &[f64]| {
                let [mut a, mut b, mut c] = counts.map(|count| vec![0.0; count * n]);
                let mut hessian = vec![0.0; n * n];
                let into = TerminalDerivatives {
                    equalities: &mut a,
                    inequalities: &mut b,
                    next_state: &mut c,
                    hessian: &mut hessian,
                };
                let [equalities, inequalities, next_state] = weights.each_ref().map(Vec::as_slice);
                let weights = TerminalWeights { equalities, inequalities, next_state };
                system.differentiate_terminal(phase, at, weights, into);
                ([a, b, c].concat(), hessian)
            };
            let functions = Functions { values: &values, derivatives: &derivatives, weights: weights.concat() };
            functions.assert_derivatives_agree(&node(&system, 3)[..n], &format!("end of phase {phase}"));
        }
    }
}
