//! Quality of a solution between its nodes, and hp-adaptive mesh refinement.
//!
//! The error of a segment is that of Patterson, Hager, Rao 2015: the dynamics, evaluated along the interpolated states
//! and controls, are integrated by a rule of higher order, and the result is compared with the interpolated states.
//! Where the error is too large the order is raised, as one more point divides the error of a smooth solution by about
//! N. A segment is split where the order would have to exceed its maximum, or where a path constraint or a bound is
//! violated between the nodes. A slightly finer mesh costs less than another mesh, so the aim is half the tolerance.

use super::interpolation::MeshPoint;
use super::mesh::{Mesh, Segment};
use super::radau::Radau;
use super::transcription::Transcription;

/// Samples per collocation point at which path constraints and bounds are checked.
const SAMPLES_PER_POINT: usize = 4;

/// Maximum number of parts of a segment that is split for a violated constraint, and for its error.
const MAX_PARTS_FOR_VIOLATION: f64 = 8.0;
const MAX_PARTS_FOR_ERROR: f64 = 4.0;

/// Minimum order of the parts of a segment that is split for its error.
const MIN_SPLIT_ORDER: usize = 3;

/// Ratio of the tolerance to the error that a refined mesh aims at.
const SAFETY_FACTOR: f64 = 2.0;

/// Tolerances of mesh refinement.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Tolerances {
    /// Error of the states, relative to 1 + their size on the segment.
    pub error: f64,
    /// Violation of a path constraint between the nodes, in the constraint's unit.
    pub violation: f64,
    /// Violation of a bound of a control between the nodes, in the control's unit.
    pub overshoot: f64,
    /// Maximum order of a segment.
    pub max_order: usize,
}

/// Largest errors on a segment, or on a mesh.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct Quality {
    /// Error of the states, relative to 1 + their size on the segment.
    pub error: f64,
    /// Largest violation of a path constraint, in its unit.
    pub violation: f64,
    /// Largest violation of a control's bound, in its unit.
    pub overshoot: f64,
}

impl Quality {
    /// Whether all errors are within tolerance. False for NaN.
    pub fn meets(&self, tolerances: &Tolerances) -> bool {
        self.error <= tolerances.error
            && self.violation <= tolerances.violation
            && self.overshoot <= tolerances.overshoot
    }

    /// The larger of the two errors in every field; NaN if either is NaN.
    pub fn worst(self, other: Self) -> Self {
        let worst = |a: f64, b: f64| if a >= b || a.is_nan() { a } else { b };
        Self {
            error: worst(self.error, other.error),
            violation: worst(self.violation, other.violation),
            overshoot: worst(self.overshoot, other.overshoot),
        }
    }
}

/// Quality of every segment of the solution `x`, by phase.
pub fn segment_qualities(program: &Transcription, x: &[f64]) -> Vec<Vec<Quality>> {
    let phase = |(phase, segments): (usize, &Vec<Segment>)| {
        (0..segments.len()).map(|segment| quality(program, x, phase, segment)).collect()
    };
    program.mesh.phases.iter().enumerate().map(phase).collect()
}

/// The refined mesh, or none if every segment of the solution `x` is within tolerance.
pub fn refine(program: &Transcription, x: &[f64], tolerances: &Tolerances) -> Option<Mesh> {
    let qualities = segment_qualities(program, x);
    if qualities.iter().flatten().all(|quality| quality.meets(tolerances)) {
        return None;
    }
    let aim = Tolerances { error: tolerances.error / SAFETY_FACTOR, ..*tolerances };
    let phase = |(segments, qualities): (&Vec<Segment>, &Vec<Quality>)| {
        segments.iter().zip(qualities).flat_map(|(segment, quality)| refined(segment, quality, &aim)).collect()
    };
    Some(Mesh { phases: program.mesh.phases.iter().zip(&qualities).map(phase).collect() })
}

fn refined(segment: &Segment, quality: &Quality, tolerances: &Tolerances) -> Vec<Segment> {
    if quality.meets(tolerances) {
        return vec![*segment];
    }
    let is_feasible = quality.violation <= tolerances.violation && quality.overshoot <= tolerances.overshoot;
    let (order, excess) = (segment.order, quality.error / tolerances.error);
    let missing = (excess.ln() / (order.max(2) as f64).ln()).ceil().max(1.0) as usize;
    if is_feasible && order + missing <= tolerances.max_order {
        return vec![Segment { order: order + missing, ..*segment }];
    }
    let (parts, order) = if is_feasible {
        // the solution is not smooth here: short segments of low order
        (excess.sqrt().ceil().clamp(2.0, MAX_PARTS_FOR_ERROR), order.min(MIN_SPLIT_ORDER.max(order - 1)))
    } else {
        // between its nodes a smooth constraint is violated by the square of their distance
        let ratio = SAFETY_FACTOR * quality.violation / tolerances.violation;
        (ratio.sqrt().ceil().clamp(2.0, MAX_PARTS_FOR_VIOLATION), order)
    };
    vec![Segment { fraction: segment.fraction / parts, order }; parts as usize]
}

fn quality(program: &Transcription, x: &[f64], phase: usize, segment: usize) -> Quality {
    let (error, order) = (error(program, x, phase, segment), program.layout.phases[phase].segments[segment].order);
    let (states, width) = (program.layout.states(), program.layout.width());
    let (lower, upper) = program.system.bounds(phase);
    let mut node = vec![0.0; width];
    let mut acceleration = vec![0.0; program.layout.coordinates];
    let mut path_constraints = vec![0.0; program.system.path_constraint_count(phase)];
    let mut quality = Quality { error, ..Quality::default() };
    let mut before = [path_constraints.clone(), path_constraints.clone()];
    let samples = SAMPLES_PER_POINT * order;
    for k in 0..=samples {
        let point = MeshPoint { phase, segment, τ: -1.0 + 2.0 * k as f64 / samples as f64 };
        program.node(x, point, &mut node);
        program.system.evaluate(phase, &node, &mut acceleration, &mut path_constraints);
        let overshoot = (states..width).map(|r| (lower[r] - node[r]).max(node[r] - upper[r])).fold(0.0, f64::max);
        let violation = path_constraints.iter().map(|d| -d).fold(0.0, f64::max);
        quality = quality.worst(Quality { error, violation, overshoot });
        if k >= 2 {
            let [first, second] = &before;
            let three = first.iter().zip(second).zip(&path_constraints);
            let violation = three.map(|((a, b), c)| peak([-a, -b, -c])).fold(0.0, f64::max);
            quality = quality.worst(Quality { error, violation, overshoot });
        }
        before.rotate_left(1);
        before[1].copy_from_slice(&path_constraints);
    }
    quality
}

/// The peak of the parabola through three equidistant values; the largest of them if it is not the second one.
fn peak([a, b, c]: [f64; 3]) -> f64 {
    if b < a.max(c) {
        return a.max(c);
    }
    let curvature = 2.0 * b - a - c;
    if curvature > 0.0 { b + (c - a).powi(2) / (8.0 * curvature) } else { b }
}

/// Relative error of the states on a segment, with X̂ the integral of the dynamics along the interpolated solution X:
///
/// ```text
/// max |X̂ - X| / (1 + max |X|)                                                        [Patterson, Hager, Rao 2015]
/// ```
fn error(program: &Transcription, x: &[f64], phase: usize, segment: usize) -> f64 {
    let layout = &program.layout.phases[phase].segments[segment];
    let (nq, n, width) = (program.layout.coordinates, program.layout.states(), program.layout.width());
    let fine = Radau::new(layout.order + 2);
    let η = 0.5 * layout.fraction * program.duration_s(phase, x);
    let m = fine.order();
    let mut nodes = vec![0.0; (m + 1) * width];
    let mut slopes = vec![0.0; m * n];
    let mut path_constraints = vec![0.0; program.system.path_constraint_count(phase)];
    for (k, node) in nodes.chunks_exact_mut(width).enumerate() {
        program.node(x, MeshPoint { phase, segment, τ: fine.points[k] }, node);
        if k < m {
            let slope = &mut slopes[k * n..(k + 1) * n];
            slope[..nq].copy_from_slice(&node[nq..n]);
            program.system.evaluate(phase, node, &mut slope[nq..], &mut path_constraints);
        }
    }
    let mut max = 0.0_f64;
    for r in 0..n {
        let size = nodes.chunks_exact(width).map(|node| node[r].abs()).fold(0.0, f64::max);
        for i in 0..m {
            let integral: f64 = (0..m).map(|j| fine.integration[(i, j)] * slopes[j * n + r]).sum();
            let difference = (nodes[r] + η * integral - nodes[(i + 1) * width + r]).abs() / (1.0 + size);
            if difference.is_nan() || difference > max {
                max = difference;
            }
        }
    }
    max
}

#[cfg(test)]
mod tests {
    use super::peak;

    #[test]
    fn the_peak_is_that_of_the_parabola_or_an_end() {
        // 3 - (t - 0.25)² at t = -1, 0, 1
        assert!((peak([3.0 - 1.5625, 3.0 - 0.0625, 3.0 - 0.5625]) - 3.0).abs() < 1e-15);
        assert_eq!(peak([1.0, 2.0, 4.0]), 4.0);
        assert_eq!(peak([4.0, 2.0, 1.0]), 4.0);
        assert_eq!(peak([1.0, 1.0, 1.0]), 1.0);
        assert!(peak([1.0, f64::NAN, 1.0]).is_nan());
    }
}
