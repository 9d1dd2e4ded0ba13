//! The envelope circle along a plan, between the nodes too: its clearance from the obstacles, and the instants at which
//! its radius switches between the body's and the load's reach. That is the switch of Kang, Huang, Wen 2020, eq. 14. The
//! planner's constraints bound the reach from above by R-functions (eq. 19), by up to √2, and switch earlier.

use super::cable::CableGeometry;
use super::jet::Jet;
use super::optimise::Candidate;
use super::problem::Problem;
use super::r_function::load_reach;
use super::system::{ALPHA, BETA, SlungLoadSystem};
use crate::pseudospectral::{MeshPoint, Transcription};

/// Samples between two nodes.
const SAMPLES: usize = 16;

/// Bisections for the instant of a switch.
const BISECTIONS: usize = 40;

/// Instants at which a radius switches, s, and whether to the load's reach.
pub type Switches = Vec<(f64, bool)>;

/// The envelope circle along a plan.
#[derive(Clone, Debug, PartialEq)]
pub struct Envelope {
    /// Minimum distance of the circle (eq. 14) from the obstacles, m; infinite if there are none.
    pub clearance_m: f64,
    /// Switches of the radius (eq. 14).
    pub switches: Switches,
    /// Switches of its bound by R-functions (eq. 19, 20).
    pub r_function_switches: Switches,
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
    let mut clearance_m = f64::INFINITY;
    let mut switches = [Switches::new(), Switches::new()];
    let mut was_load = circle(times[0].1).is_load();
    for pair in times.windows(2) {
        let ((from_s, from), (to_s, to)) = (pair[0], pair[1]);
        if to.phase != from.phase {
            continue;
        }
        let τ_end = if to.segment == from.segment { to.τ } else { 1.0 };
        let at = |fraction: f64| MeshPoint { τ: from.τ + fraction * (τ_end - from.τ), ..from };
        for k in 1..=SAMPLES {
            let fraction = |k: usize| k as f64 / SAMPLES as f64;
            let now = circle(at(fraction(k)));
            clearance_m = clearance_m.min(now.clearance_m);
            for (form, is_load) in now.is_load().into_iter().enumerate().filter(|(form, now)| *now != was_load[*form]) {
                let differs = |at_fraction: f64| circle(at(at_fraction)).is_load()[form] == is_load;
                let instant = first_true([fraction(k - 1), fraction(k)], differs);
                switches[form].push((from_s + instant * (to_s - from_s), is_load));
            }
            was_load = now.is_load();
        }
    }
    let [switches, r_function_switches] = switches;
    Envelope { clearance_m, switches, r_function_switches }
}

/// Where a condition becomes true that is false at the beginning of an interval and true at its end.
fn first_true([mut before, mut after]: [f64; 2], mut condition: impl FnMut(f64) -> bool) -> f64 {
    for _ in 0..BISECTIONS {
        let middle = 0.5 * (before + after);
        *(if condition(middle) { &mut after } else { &mut before }) = middle;
    }
    after
}

/// The envelope circle at an instant.
struct Circle {
    /// The load's horizontal distance (eq. 14), and its bound by R-functions (eq. 19), less the body's radius, m: where
    /// positive, they are the radius.
    excess_m: [f64; 2],
    /// Distance of the circle from the nearest obstacle, m.
    clearance_m: f64,
}

impl Circle {
    fn at(problem: &Problem, node: &[f64], length_m: f64) -> Self {
        let cable = CableGeometry::at([node[ALPHA], node[BETA], length_m].map(Jet::<0>::constant));
        let reach_m = length_m * cable.direction[0].value.hypot(cable.direction[1].value);
        let body_m = problem.vehicle.radius_m;
        let bound_m = load_reach(&cable, Jet::constant(length_m)).value;
        let distances = problem.obstacles.iter().map(|obstacle| obstacle.distance([node[0], node[1]]).value);
        Self {
            excess_m: [reach_m - body_m, bound_m - body_m],
            clearance_m: distances.fold(f64::INFINITY, f64::min) - body_m.max(reach_m),
        }
    }

    fn is_load(&self) -> [bool; 2] {
        self.excess_m.map(|excess_m| excess_m > 0.0)
    }
}
