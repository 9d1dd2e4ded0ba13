//! How good a solution is between its nodes, and a mesh on which it would be better.
//!
//! The error of a segment is that of Patterson, Hager, Rao 2015: the solution's controls drive the equations along the
//! solution's own states, integrated by a rule of higher order, and the result is compared with these states. Where the
//! error is too large the order rises, as one more point divides the error of a smooth solution by about N; where it would
//! have to rise too far, or where a row or a bound is violated between the nodes, the segment is split. A mesh that is a
//! little too fine costs less than one more mesh: twice as much is aimed at as is asked for.

use super::mesh::{Mesh, Segment};
use super::polynomial::Place;
use super::radau::Radau;
use super::transcription::Transcription;

/// Points between the nodes of a segment at which rows and bounds are checked, for every collocation point.
const SAMPLES: usize = 4;

/// Most parts of a segment that is split for a violated row, and for an error.
const MOST_PARTS: f64 = 8.0;
const MOST_PARTS_OF_ERROR: f64 = 4.0;

/// Least order of the parts of a segment that is split for its error.
const LEAST_ORDER: usize = 3;

/// So many times better than it must be is what a finer mesh aims at.
const AIM: f64 = 2.0;

/// What a mesh has to reach.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Tolerances {
    /// Error of the states, relative to 1 + their size on the segment.
    pub error: f64,
    /// Violation of a path row between the nodes, in the row's unit.
    pub violation: f64,
    /// Violation of a bound of a control between the nodes, in the control's unit.
    pub overshoot: f64,
    /// Highest order of a segment.
    pub highest_order: usize,
}

/// What the worst point of a segment shows.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct Quality {
    /// Error of the states.
    pub error: f64,
    /// Largest violation of a path row.
    pub violation: f64,
    /// Largest violation of a control's bound.
    pub overshoot: f64,
}

impl Quality {
    /// Whether this is good enough. False for NaN.
    pub fn meets(&self, tolerances: &Tolerances) -> bool {
        self.error <= tolerances.error
            && self.violation <= tolerances.violation
            && self.overshoot <= tolerances.overshoot
    }

    /// The worse of two in every respect; NaN wins.
    pub fn worse(self, other: Self) -> Self {
        let worse = |a: f64, b: f64| if a >= b || a.is_nan() { a } else { b };
        Self {
            error: worse(self.error, other.error),
            violation: worse(self.violation, other.violation),
            overshoot: worse(self.overshoot, other.overshoot),
        }
    }
}

/// Quality of every segment of the solution `x`, by phase.
pub fn qualities(problem: &Transcription, x: &[f64]) -> Vec<Vec<Quality>> {
    let phase = |(phase, segments): (usize, &Vec<Segment>)| {
        (0..segments.len()).map(|segment| quality(problem, x, phase, segment)).collect()
    };
    problem.mesh.phases.iter().enumerate().map(phase).collect()
}

/// The next mesh, or nothing if every segment is good enough.
pub fn refine(problem: &Transcription, x: &[f64], tolerances: &Tolerances) -> Option<Mesh> {
    let qualities = qualities(problem, x);
    if qualities.iter().flatten().all(|quality| quality.meets(tolerances)) {
        return None;
    }
    let aim = Tolerances { error: tolerances.error / AIM, ..*tolerances };
    let better = |(segments, qualities): (&Vec<Segment>, &Vec<Quality>)| {
        segments.iter().zip(qualities).flat_map(|(segment, quality)| refined(segment, quality, &aim)).collect()
    };
    Some(Mesh { phases: problem.mesh.phases.iter().zip(&qualities).map(better).collect() })
}

fn refined(segment: &Segment, quality: &Quality, tolerances: &Tolerances) -> Vec<Segment> {
    if quality.meets(tolerances) {
        return vec![*segment];
    }
    let is_bounded = quality.violation <= tolerances.violation && quality.overshoot <= tolerances.overshoot;
    let (order, excess) = (segment.order, quality.error / tolerances.error);
    let missing = (excess.ln() / (order.max(2) as f64).ln()).ceil().max(1.0) as usize;
    if is_bounded && order + missing <= tolerances.highest_order {
        return vec![Segment { order: order + missing, ..*segment }];
    }
    let (parts, order) = if is_bounded {
        // what no polynomial follows is best met by short segments of low order
        (excess.sqrt().ceil().clamp(2.0, MOST_PARTS_OF_ERROR), order.min(LEAST_ORDER.max(order - 1)))
    } else {
        // between its nodes a smooth row is off by the square of their distance
        ((AIM * quality.violation / tolerances.violation).sqrt().ceil().clamp(2.0, MOST_PARTS), order)
    };
    vec![Segment { share: segment.share / parts, order }; parts as usize]
}

fn quality(problem: &Transcription, x: &[f64], phase: usize, segment: usize) -> Quality {
    let (error, order) = (error(problem, x, phase, segment), problem.layout.phases[phase].segments[segment].order);
    let (states, width) = (problem.layout.states(), problem.layout.width());
    let (lower, upper) = problem.motion.bounds(phase);
    let count = problem.motion.rows(phase);
    let mut node = vec![0.0; width];
    let (mut acceleration, mut rows) = (vec![0.0; problem.layout.coordinates], vec![0.0; count]);
    let mut quality = Quality { error, ..Quality::default() };
    let samples = SAMPLES * order;
    for k in 0..=samples {
        let place = Place { phase, segment, τ: -1.0 + 2.0 * k as f64 / samples as f64 };
        problem.node(x, place, &mut node);
        problem.motion.values(phase, &node, &mut acceleration, &mut rows);
        let overshoot = (states..width).map(|r| (lower[r] - node[r]).max(node[r] - upper[r])).fold(0.0, f64::max);
        let violation = rows.iter().map(|row| -row).fold(0.0, f64::max);
        quality = quality.worse(Quality { error, violation, overshoot });
    }
    quality
}

/// `max |X̂ - X| / (1 + max |X|)` over the states.
fn error(problem: &Transcription, x: &[f64], phase: usize, segment: usize) -> f64 {
    let layout = &problem.layout.phases[phase].segments[segment];
    let (nq, n, width) = (problem.layout.coordinates, problem.layout.states(), problem.layout.width());
    let fine = Radau::new(layout.order + 2);
    let η = 0.5 * layout.share * problem.duration_s(phase, x);
    let m = fine.order();
    let mut nodes = vec![0.0; (m + 1) * width];
    let mut slopes = vec![0.0; m * n];
    let mut rows = vec![0.0; problem.motion.rows(phase)];
    for (k, node) in nodes.chunks_exact_mut(width).enumerate() {
        problem.node(x, Place { phase, segment, τ: fine.points[k] }, node);
        if k < m {
            let slope = &mut slopes[k * n..(k + 1) * n];
            slope[..nq].copy_from_slice(&node[nq..n]);
            problem.motion.values(phase, node, &mut slope[nq..], &mut rows);
        }
    }
    let mut worst = 0.0_f64;
    for r in 0..n {
        let size = nodes.chunks_exact(width).map(|node| node[r].abs()).fold(0.0, f64::max);
        for i in 0..m {
            let integral: f64 = (0..m).map(|j| fine.integration[(i, j)] * slopes[j * n + r]).sum();
            let difference = (nodes[r] + η * integral - nodes[(i + 1) * width + r]).abs() / (1.0 + size);
            if difference.is_nan() || difference > worst {
                worst = difference;
            }
        }
    }
    worst
}
