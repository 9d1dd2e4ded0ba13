use super::model::Model;
use super::problem::{Gate, Mode, Problem, Rest, Stage};
use crate::pseudospectral::{Duration, EndDerivatives, EndValues, EndWeights, Motion, NodeDerivatives, NodeWeights};

pub fn problems() -> Vec<Problem> {
    let paper = Problem {
        limits: super::Limits { floor_m: Some(0.0), tension_n: 9.0, ..Problem::paper().limits },
        ..Problem::paper()
    };
    let stage = |mode| Stage { mode, duration: Duration::Fixed(1.0), impulse_ns: Some(0.1), gate: None };
    let open = [f64::NEG_INFINITY, f64::INFINITY];
    let gate =
        Gate { quadrotor_m: [[-1.0, 1.0], open, [0.5, 1.5]], load_m: [[-0.5, 2.0], [-1.0, f64::INFINITY], [1.0, 2.0]] };
    let gated = |mode| Stage { gate: Some(gate), ..stage(mode) };
    let phased = Problem {
        start: Rest { position_m: [-2.0, 0.0, 0.35], cable: [0.0, 0.0, 0.35] },
        stages: [Mode::Parked, Mode::Taut, Mode::Slack, Mode::Taut].map(stage).to_vec(),
        ..paper.clone()
    };
    let either = Problem { stages: vec![stage(Mode::Either { epsilon: 1e-3 })], ..paper.clone() };
    let stages = vec![gated(Mode::Taut), stage(Mode::Taut), gated(Mode::Slack), stage(Mode::Slack), stage(Mode::Taut)];
    let through_gates = Problem { stages, ..paper.clone() };
    vec![paper, phased, either, through_gates]
}

pub fn noise(seed: usize, i: usize) -> f64 {
    ((seed * 37 + i * 101 + 13) as f64).sin()
}

fn node(model: &Model, seed: usize) -> Vec<f64> {
    let n = model.coordinates();
    let mut node: Vec<f64> = (0..model.width()).map(|i| 0.5 * noise(seed, i)).collect();
    node[0] -= 1.9;
    node[1] -= 1.3;
    for thrust in &mut node[2 * n..] {
        *thrust += 3.0;
    }
    if n > 8 {
        node[8] = 0.5 + 0.1 * noise(seed, 99);
    }
    node
}

/// Accelerations, rows and cost, weighted: what the Hessian belongs to, and the first derivatives.
#[test]
fn derivatives_of_every_phase_agree_with_differences() {
    let h = 1e-5;
    for problem in problems() {
        let model = Model::new(&problem);
        let (nq, width) = (model.coordinates(), model.width());
        for (phase, seed) in (0..problem.stages.len()).flat_map(|phase| (0..5).map(move |seed| (phase, seed))) {
            let at = node(&model, seed);
            let rows = model.rows(phase);
            let y: Vec<f64> = (0..nq).map(|i| noise(seed + 7, i)).collect();
            let z: Vec<f64> = (0..rows).map(|i| noise(seed + 8, i)).collect();
            let derivatives = |at: &[f64]| {
                let (mut a, mut cost) = (vec![0.0; nq * width], vec![0.0; width]);
                let (mut r, mut hessian) = (vec![0.0; rows * width], vec![0.0; width * width]);
                let into =
                    NodeDerivatives { acceleration: &mut a, cost: &mut cost, rows: &mut r, hessian: &mut hessian };
                model.differentiate(phase, at, NodeWeights { cost: 0.7, acceleration: &y, rows: &z }, into);
                (a, cost, r, hessian)
            };
            let values = |at: &[f64]| {
                let (mut a, mut r) = (vec![0.0; nq], vec![0.0; rows]);
                let cost = model.values(phase, at, &mut a, &mut r);
                (a, r, cost)
            };
            let lagrangian = |at: &[f64]| {
                let (a, cost, r, _) = derivatives(at);
                (0..width)
                    .map(|j| {
                        let a: f64 = (0..nq).map(|i| y[i] * a[i * width + j]).sum();
                        a + 0.7 * cost[j] + (0..rows).map(|i| z[i] * r[i * width + j]).sum::<f64>()
                    })
                    .collect::<Vec<f64>>()
            };
            let (a, cost, r, hessian) = derivatives(&at);
            for j in 0..width {
                let moved = |sign: f64| {
                    let mut moved = at.clone();
                    moved[j] += sign * h;
                    moved
                };
                let (ahead, behind) = (values(&moved(1.0)), values(&moved(-1.0)));
                for i in 0..nq {
                    let difference = (ahead.0[i] - behind.0[i]) / (2.0 * h);
                    assert!((a[i * width + j] - difference).abs() < 1e-6, "phase {phase}: a_{i} by {j}");
                }
                for i in 0..rows {
                    let difference = (ahead.1[i] - behind.1[i]) / (2.0 * h);
                    assert!((r[i * width + j] - difference).abs() < 1e-6, "phase {phase}: row {i} by {j}");
                }
                assert!((cost[j] - (ahead.2 - behind.2) / (2.0 * h)).abs() < 1e-6);
                let (ahead, behind) = (lagrangian(&moved(1.0)), lagrangian(&moved(-1.0)));
                for i in 0..width {
                    let difference = (ahead[i] - behind[i]) / (2.0 * h);
                    let exact = hessian[i * width + j];
                    assert!((exact - difference).abs() < 1e-5, "phase {phase}: ({i}, {j}) {exact} for {difference}");
                }
            }
        }
    }
}

#[test]
fn derivatives_of_the_ends_agree_with_differences() {
    let h = 1e-5;
    for problem in problems() {
        let model = Model::new(&problem);
        let n = 2 * model.coordinates();
        for phase in 0..problem.stages.len() {
            let is_last = phase + 1 == problem.stages.len();
            let (events, rows) = model.end_rows(phase);
            let links = if is_last { 0 } else { n };
            let at = node(&model, 3)[..n].to_vec();
            let [e, r, l] = [events, rows, links].map(|count| (0..count).map(|i| noise(i, 5)).collect::<Vec<f64>>());
            let values = |at: &[f64]| {
                let mut values = EndValues { events: vec![0.0; events], rows: vec![0.0; rows], next: vec![0.0; links] };
                model.end_values(phase, at, &mut values);
                [values.events, values.rows, values.next].concat()
            };
            let derivatives = |at: &[f64]| {
                let [mut a, mut b, mut c] = [events, rows, links].map(|count| vec![0.0; count * n]);
                let mut hessian = vec![0.0; n * n];
                let into = EndDerivatives { events: &mut a, rows: &mut b, next: &mut c, hessian: &mut hessian };
                model.end_differentiate(phase, at, EndWeights { events: &e, rows: &r, next: &l }, into);
                ([a, b, c].concat(), hessian)
            };
            let weights = [e.clone(), r.clone(), l.clone()].concat();
            let (jacobian, hessian) = derivatives(&at);
            for j in 0..n {
                let moved = |sign: f64| {
                    let mut moved = at.clone();
                    moved[j] += sign * h;
                    moved
                };
                let (ahead, behind) = (values(&moved(1.0)), values(&moved(-1.0)));
                for i in 0..ahead.len() {
                    assert!((jacobian[i * n + j] - (ahead[i] - behind[i]) / (2.0 * h)).abs() < 1e-6);
                }
                let (ahead, behind) = (derivatives(&moved(1.0)).0, derivatives(&moved(-1.0)).0);
                for i in 0..n {
                    let difference: f64 = weights
                        .iter()
                        .enumerate()
                        .map(|(k, w)| w * (ahead[k * n + i] - behind[k * n + i]) / (2.0 * h))
                        .sum();
                    assert!((hessian[i * n + j] - difference).abs() < 1e-5);
                }
            }
        }
    }
}
