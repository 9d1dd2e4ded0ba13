//! Derivatives of the aircraft's system against central differences, and the equations against those of the paper.

use scenarios::GRAVITY_MPS2;

use super::neighbour::Neighbour;
use super::node_vector::{COORDINATES, STATES, VELOCITY, WIDTH};
use super::problem::Problem;
use super::system::AircraftSystem;
use super::units::{LENGTH_M, SPEED_MPS, TIME_S};
use crate::pseudospectral::{Duration, MultiphaseSystem, NodeDerivatives, NodeWeights};

const H: f64 = 1e-5;

fn problem() -> Problem {
    Problem {
        ends: [[0.0, 0.0, 0.4, 0.35, 0.0, 0.0], [6.0, 1.0, 0.5, 0.3, 0.1, 0.0]],
        position: [[-10.0, 10.0], [-10.0, 10.0], [0.2, 0.8]],
        speed: [0.25, 0.45],
        climb: [-0.3, 0.2],
        load_factors: [[-1.0, 1.0], [-1.5, 1.5], [-1.0, 2.0]],
        obstacles: vec![([3.0, 1.0], 0.4)],
        neighbours: vec![Neighbour {
            times: vec![0.0, 8.0, 20.0],
            positions: vec![[0.0, -1.0], [2.0, 0.5], [6.0, 0.7]],
            velocities: vec![[0.3, 0.1], [0.2, 0.3], [0.35, -0.1]],
        }],
        separation: 0.1,
        duration: Duration::Fixed(20.0),
    }
}

fn node(seed: usize) -> [f64; WIDTH] {
    let noise = |i: usize| ((seed * 37 + i * 101 + 13) as f64).sin();
    let mut node = std::array::from_fn(|i| 0.3 * noise(i));
    node[0] += 1.0;
    node[3] = 10.0 + 3.0 * noise(50);
    node[VELOCITY] += 0.5;
    node
}

/// Accelerations, path constraints and running cost at a node.
fn values(system: &AircraftSystem<'_>, at: &[f64]) -> Vec<f64> {
    let (mut acceleration, mut rows) = ([0.0; COORDINATES], vec![0.0; system.path_constraint_count(0)]);
    let cost = system.evaluate(0, at, &mut acceleration, &mut rows);
    [acceleration.to_vec(), rows, vec![cost]].concat()
}

/// Their Jacobian and weighted Hessian.
fn derivatives(system: &AircraftSystem<'_>, at: &[f64], weights: &[f64]) -> (Vec<f64>, Vec<f64>) {
    let count = system.path_constraint_count(0);
    let (mut acceleration, mut rows) = (vec![0.0; COORDINATES * WIDTH], vec![0.0; count * WIDTH]);
    let (mut cost, mut hessian) = (vec![0.0; WIDTH], vec![0.0; WIDTH * WIDTH]);
    let into = NodeDerivatives {
        acceleration: &mut acceleration,
        cost: &mut cost,
        path_constraints: &mut rows,
        hessian: &mut hessian,
    };
    let [accelerations, others] = [&weights[..COORDINATES], &weights[COORDINATES..]];
    let weights = NodeWeights { cost: others[count], acceleration: accelerations, path_constraints: &others[..count] };
    system.differentiate(0, at, weights, into);
    ([acceleration, rows, cost].concat(), hessian)
}

#[test]
fn derivatives_agree_with_differences() {
    let problem = problem();
    let system = AircraftSystem::new(&problem);
    for seed in 0..6 {
        let at = node(seed);
        let count = values(&system, &at).len();
        let weights: Vec<f64> = (0..count).map(|i| ((i * 7 + seed) as f64).cos()).collect();
        let (jacobian, hessian) = derivatives(&system, &at, &weights);
        for j in 0..WIDTH {
            let moved = |sign: f64| {
                let mut moved = at;
                moved[j] += sign * H;
                moved
            };
            let (ahead, behind) = (values(&system, &moved(1.0)), values(&system, &moved(-1.0)));
            for i in 0..count {
                let difference = (ahead[i] - behind[i]) / (2.0 * H);
                assert!((jacobian[i * WIDTH + j] - difference).abs() < 1e-6, "value {i} by {j}");
            }
            let gradient = |at: &[f64]| {
                let (jacobian, _) = derivatives(&system, at, &weights);
                let column = |k: usize| (0..count).map(|i| weights[i] * jacobian[i * WIDTH + k]).sum::<f64>();
                (0..WIDTH).map(column).collect::<Vec<f64>>()
            };
            let (ahead, behind) = (gradient(&moved(1.0)), gradient(&moved(-1.0)));
            for i in 0..WIDTH {
                let difference = (ahead[i] - behind[i]) / (2.0 * H);
                assert!((hessian[i * WIDTH + j] - difference).abs() < 1e-5, "({i}, {j})");
            }
        }
    }
}

/// V' = g (n_x - sin γ), χ' = g n_y/(V cos γ), γ' = g (n_z - cos γ)/V (Wang, Xu, Long 2020, eq. 2), from the Cartesian
/// acceleration.
#[test]
fn the_accelerations_are_those_of_the_paper() {
    let problem = problem();
    let system = AircraftSystem::new(&problem);
    for seed in 0..6 {
        let at = node(seed);
        let acceleration = values(&system, &at);
        let a: [f64; 3] = std::array::from_fn(|k| acceleration[k] * LENGTH_M / (TIME_S * TIME_S));
        let v: [f64; 3] = std::array::from_fn(|k| at[VELOCITY + k] * SPEED_MPS);
        let n = &at[STATES..];
        let (level, speed) = (v[0].hypot(v[1]), v[0].hypot(v[1]).hypot(v[2]));
        let (sin_γ, cos_γ) = (v[2] / speed, level / speed);
        let speed_rate = (0..3).map(|k| a[k] * v[k]).sum::<f64>() / speed;
        let heading_rate = (v[0] * a[1] - v[1] * a[0]) / (level * level);
        let climb_rate = (a[2] - speed_rate * sin_γ) / (speed * cos_γ);
        assert!((speed_rate - GRAVITY_MPS2 * (n[0] - sin_γ)).abs() < 1e-9);
        assert!((heading_rate - GRAVITY_MPS2 * n[1] / (speed * cos_γ)).abs() < 1e-9);
        assert!((climb_rate - GRAVITY_MPS2 * (n[2] - cos_γ) / speed).abs() < 1e-9);
    }
}
