//! Where the load factors of a plan lead without its states: what remains of an optimum whose controls jump.

use super::node_vector::{COORDINATES, STATES, VELOCITY, WIDTH};
use super::problem::Problem;
use super::rows;
use super::solve::Sample;
use super::system::AircraftSystem;
use crate::pseudospectral::MultiphaseSystem;

/// Largest distance of the samples from the motion to which their load factors, linear in between, lead from the first sample
/// on: units of the program. One Runge-Kutta step of order 4 from sample to sample.
pub fn error(problem: &Problem, samples: &[Sample]) -> f64 {
    let system = AircraftSystem::new(problem);
    let mut path_constraints = vec![0.0; rows::count(problem)];
    let mut slope = |node: &[f64; WIDTH]| {
        let mut slope = [0.0; STATES];
        slope[..COORDINATES].copy_from_slice(&node[VELOCITY..STATES]);
        system.evaluate(0, node, &mut slope[COORDINATES..], &mut path_constraints);
        slope
    };
    let (mut node, mut largest) = (samples[0].1, 0.0_f64);
    for pair in samples.windows(2) {
        let ([(from, first), (to, last)], begin) = ([pair[0], pair[1]], node);
        let step = to - from;
        let mut at = |fraction: f64, slopes: &[f64; STATES]| {
            let state = |i: usize| begin[i] + fraction * step * slopes[i];
            let control = |i: usize| first[i] + fraction * (last[i] - first[i]);
            slope(&std::array::from_fn(|i| if i < STATES { state(i) } else { control(i) }))
        };
        let k1 = at(0.0, &[0.0; STATES]);
        let k2 = at(0.5, &k1);
        let k3 = at(0.5, &k2);
        let k4 = at(1.0, &k3);
        for i in 0..STATES {
            node[i] += step / 6.0 * (k1[i] + 2.0 * (k2[i] + k3[i]) + k4[i]);
        }
        largest = largest.max((0..3).map(|axis| (node[axis] - last[axis]).powi(2)).sum::<f64>().sqrt());
    }
    largest
}
