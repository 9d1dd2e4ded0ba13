//! The envelope circle along a plan, between the nodes too: its clearance from the obstacles, and the instants at which
//! its radius switches between the body's and the load's reach (Kang, Huang, Wen 2020, eq. 14).

use super::cable::CableGeometry;
use super::jet::Jet;
use super::optimise::Candidate;
use super::problem::Problem;
use super::system::{ALPHA, BETA, SlungLoadSystem};
use crate::pseudospectral::{MeshPoint, Transcription};

/// Samples between two nodes.
const SAMPLES: usize = 16;

/// Bisections for the instant of a switch.
const BISECTIONS: usize = 40;

/// The envelope circle along a plan.
#[derive(Clone, Debug, PartialEq)]
pub struct Envelope {
    /// Minimum distance of the circle (eq. 14) from the obstacles, m; infinite if there are none.
    pub clearance_m: f64,
    /// Instants at which the radius switches, s, and whether to the load's reach.
    pub switches: Vec<(f64, bool)>,
}

/// The envelope circle along a candidate.
pub fn envelope(problem: &Problem, candidate: &Candidate) -> Envelope {
    let system = SlungLoadSystem::new(problem);
    let program = Transcription::new(&system, candidate.mesh.clone());
    let mut node = vec![0.0; system.width()];
    let mut circle = |point: MeshPoint| {
        program.node(&candidate.x, point, &mut node);
        let length_m = system.length_m(system.mode(point.phase), &node);
        Circle::at(problem, &node, length_m)
    };
    let times = program.node_times_s(&candidate.x);
    let mut envelope = Envelope { clearance_m: f64::INFINITY, switches: Vec::new() };
    let mut was_load = circle(times[0].1).is_load();
    for pair in times.windows(2) {
        let ((from_s, from), (to_s, to)) = (pair[0], pair[1]);
        if to.phase != from.phase {
            continue;
        }
        let τ_end = if to.segment == from.segment { to.τ } else { 1.0 };
        let at = |fraction: f64| MeshPoint { τ: from.τ + fraction * (τ_end - from.τ), ..from };
        for k in 1..=SAMPLES {
            let fraction = |k: f64| k / SAMPLES as f64;
            let now = circle(at(fraction(k as f64)));
            envelope.clearance_m = envelope.clearance_m.min(now.clearance_m);
            if now.is_load() != was_load {
                let (mut before, mut after) = (fraction(k as f64 - 1.0), fraction(k as f64));
                for _ in 0..BISECTIONS {
                    let middle = 0.5 * (before + after);
                    let is_load = circle(at(middle)).is_load();
                    *(if is_load == was_load { &mut before } else { &mut after }) = middle;
                }
                was_load = !was_load;
                envelope.switches.push((from_s + after * (to_s - from_s), was_load));
            }
        }
    }
    envelope
}

/// The envelope circle at an instant.
struct Circle {
    /// The load's reach by the R-function (eq. 19) less the body's radius, m: where positive, the reach is the radius.
    excess_m: f64,
    /// Distance of the circle from the nearest obstacle, m.
    clearance_m: f64,
}

impl Circle {
    fn at(problem: &Problem, node: &[f64], length_m: f64) -> Self {
        let cable = CableGeometry::at([node[ALPHA], node[BETA], length_m].map(Jet::<0>::constant));
        let [x, y] = [cable.direction[0], cable.direction[1]].map(|d| length_m * d.value);
        let radius_m = problem.vehicle.radius_m.max(x.hypot(y));
        let distances = problem.obstacles.iter().map(|obstacle| obstacle.distance([node[0], node[1]]).value);
        Self {
            excess_m: std::f64::consts::SQRT_2 * x.abs().max(y.abs()) - problem.vehicle.radius_m,
            clearance_m: distances.fold(f64::INFINITY, f64::min) - radius_m,
        }
    }

    fn is_load(&self) -> bool {
        self.excess_m > 0.0
    }
}
