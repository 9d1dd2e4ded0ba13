//! The envelope's circle along a whole plan: how close it comes to the obstacles between the nodes as well, and when it
//! switches between the body and the load's reach.

use super::cable::Cable;
use super::jet::Jet;
use super::model::{ALPHA, BETA, Model};
use super::optimise::Candidate;
use super::problem::Problem;
use crate::pseudospectral::{Place, Transcription};

/// Samples between two nodes.
const SAMPLES: usize = 16;

/// Bisections of an instant.
const BISECTIONS: usize = 40;

/// What the circle does along a plan.
#[derive(Clone, Debug, PartialEq)]
pub struct Envelope {
    /// Smallest distance of the circle (eq. 14) from an obstacle, m; infinite where there is none.
    pub clearance_m: f64,
    /// When its radius switches, s, and whether to the load's reach.
    pub switches: Vec<(f64, bool)>,
}

/// The circle along a candidate.
pub fn envelope(problem: &Problem, candidate: &Candidate) -> Envelope {
    let model = Model::new(problem);
    let programme = Transcription::new(&model, candidate.mesh.clone());
    let mut node = vec![0.0; model.width()];
    let mut circle = |place: Place| {
        programme.node(&candidate.x, place, &mut node);
        let length_m = model.length_m(model.mode(place.phase), &node);
        Circle::at(problem, &node, length_m)
    };
    let times = programme.times_s(&candidate.x);
    let mut envelope = Envelope { clearance_m: f64::INFINITY, switches: Vec::new() };
    let mut was_load = circle(times[0].1).is_load();
    for pair in times.windows(2) {
        let ((from_s, from), (to_s, to)) = (pair[0], pair[1]);
        if to.phase != from.phase {
            continue;
        }
        let τ_end = if to.segment == from.segment { to.τ } else { 1.0 };
        let at = |share: f64| Place { τ: from.τ + share * (τ_end - from.τ), ..from };
        for k in 1..=SAMPLES {
            let share = |k: f64| k / SAMPLES as f64;
            let now = circle(at(share(k as f64)));
            envelope.clearance_m = envelope.clearance_m.min(now.clearance_m);
            if now.is_load() != was_load {
                let (mut before, mut after) = (share(k as f64 - 1.0), share(k as f64));
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

/// The circle at an instant.
struct Circle {
    /// The load's reach by the R-function (eq. 19) less the body's radius, m: the sign says which of them is the radius.
    excess_m: f64,
    clearance_m: f64,
}

impl Circle {
    fn at(problem: &Problem, node: &[f64], length_m: f64) -> Self {
        let cable = Cable::at([node[ALPHA], node[BETA], length_m].map(Jet::<0>::constant));
        let [x, y] = [cable.direction[0], cable.direction[1]].map(|d| length_m * d.value);
        let radius_m = problem.body.radius_m.max(x.hypot(y));
        let distances = problem.obstacles.iter().map(|obstacle| obstacle.distance([node[0], node[1]]).value);
        Self {
            excess_m: std::f64::consts::SQRT_2 * x.abs().max(y.abs()) - problem.body.radius_m,
            clearance_m: distances.fold(f64::INFINITY, f64::min) - radius_m,
        }
    }

    fn is_load(&self) -> bool {
        self.excess_m > 0.0
    }
}
