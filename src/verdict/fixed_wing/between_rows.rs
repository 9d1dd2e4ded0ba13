//! What may lie between the rows of a plan that gives no controls.
//!
//! Between two rows the vehicle may do anything that its limits allow. Its acceleration follows from the load factors and
//! the flight-path angle γ,
//!
//! ```text
//! |p''|² = g² ((n_x - sin γ)² + n_y² + (n_z - cos γ)²) ≤ a²,
//! ```
//!
//! with the largest value that the limits admit. On an interval of length T let u = t/T ∈ [0, 1].
//!
//! **Positions are given.** Let c be the chord between two rows. p - c vanishes at both, so that
//! p(t) - c(t) = -∫ G(t, s) p''(s) ds with Green's function G ≥ 0 of the second derivative, ∫ G ds = t (T - t)/2, and
//!
//! ```text
//! |p - c| ≤ a T² u (1 - u)/2 ≤ a T²/8        |p' - c'| ≤ a T (u² + (1 - u)²)/2 ≤ a T/2
//! ```
//!
//! **Velocities are given too.** Let h be the cubic Hermite through both rows. Interpolation reproduces cubics, so by Peano's
//! theorem p(t) - h(t) = ∫ K(t, s) p''(s) ds, where for s > t, with w = 1 - s/T,
//! K = T (u² (1 - u) - u² (3 - 2u) w), and likewise for s < t with u and w replaced by 1 - u and 1 - w. Integrating the
//! absolute values of these linear functions gives
//!
//! ```text
//! |p - h| ≤ a T² κ(u),   κ(u) = u² (1 - u)²/2 ((1 + 4 (1 - u)²)/(3 - 2u) + (1 + 4u²)/(1 + 2u)) ≤ κ(1/2) = 1/16
//! |p' - h'| ≤ a T ρ(u) ≤ 0.252 a T
//! ```
//!
//! where ρ is the same integral over |∂K/∂t|. Both bounds are sharp: accelerations of magnitude a that change sign with the
//! kernel attain them. The reconstructed motion q is known, so that |p - q| ≤ |p - c| + |c - q|, and with h for c.

use scenarios::Range;
use scenarios::fixed_wing::{GRAVITY_MPS2, Limits, Trajectory};

use crate::verdict::compare::{exceeds, is_larger};
use crate::verdict::fixed_wing::planned::{NodeError, WINDOW_S};
use crate::verdict::goal::EndError;
use crate::verdict::motion::{Knot, Motion, Segment};
use crate::verdict::provenance::{EndVelocity, GivenRows};

/// Largest ρ, rounded up.
const MAX_VELOCITY_FACTOR: f64 = 0.252;

/// Largest acceleration within the limits, m/s².
pub fn max_acceleration_mps2(limits: &Limits) -> f64 {
    let Range { min, max } = limits.flight_path_deg;
    let sines = [min, max].map(|angle_deg| angle_deg.to_radians().sin());
    let cosines = [min, max].map(|angle_deg| angle_deg.to_radians().cos());
    let steepest = cosines[0].min(cosines[1]);
    let along = (limits.n_x.max - sines[0]).max(sines[1] - limits.n_x.min);
    let across = limits.n_y.max.max(-limits.n_y.min);
    let upwards = (limits.n_z.max - steepest).max(1.0 - limits.n_z.min);
    GRAVITY_MPS2 * (along * along + across * across + upwards * upwards).sqrt()
}

/// Largest distance of the vehicle's motion from the curve through two rows, m.
///
/// - `interval_s`: between the rows
pub fn max_distance_m(given: &GivenRows, acceleration_mps2: f64, interval_s: f64) -> f64 {
    acceleration_mps2 * interval_s * interval_s * max_position_factor(given, [0.0, 1.0])
}

/// Largest distance of the vehicle's motion from the chord between two positions, a T² u (1 - u)/2, m.
///
/// - `u`: the instant, as a fraction of the interval
pub fn max_distance_from_chord_m(acceleration_mps2: f64, interval_s: f64, u: f64) -> f64 {
    acceleration_mps2 * interval_s * interval_s * max_position_factor(&GivenRows::Positions, [u, u])
}

/// Largest difference of the vehicle's velocity from that of the chord, a T (u² + (1 - u)²)/2, m/s.
pub fn max_velocity_from_chord_mps(acceleration_mps2: f64, interval_s: f64, u: f64) -> f64 {
    acceleration_mps2 * interval_s * max_velocity_factor(&GivenRows::Positions, [u, u])
}

/// Largest angle by which a velocity turns if up to `error_mps` is added: asin(|error|/|velocity|), deg.
pub fn max_turn_deg(error_mps: f64, speed_mps: f64) -> f64 {
    match error_mps {
        0.0 => 0.0,
        _ if error_mps < speed_mps => (error_mps / speed_mps).asin().to_degrees(),
        _ => 180.0,
    }
}

/// The largest contradiction between given positions and given velocities: the part of the difference of a velocity from
/// that of the chord that no motion within the limits has, times the duration of the interval, at least 1 s.
///
/// Returns `None` if there is none.
pub fn contradiction(trajectory: &Trajectory, velocities_mps: &[[f64; 3]], limits: &Limits) -> Option<NodeError> {
    let acceleration_mps2 = max_acceleration_mps2(limits);
    let at_ends = (1..trajectory.times_s.len()).flat_map(|end| {
        let interval_s = trajectory.times_s[end] - trajectory.times_s[end - 1];
        let possible_mps = max_velocity_from_chord_mps(acceleration_mps2, interval_s, 1.0);
        let chord_mps = chord_mps(trajectory, end);
        [end - 1, end].map(|row| NodeError {
            error_m: (distance(velocities_mps[row], chord_mps) - possible_mps) * interval_s.max(WINDOW_S),
            t_s: trajectory.times_s[row],
        })
    });
    at_ends.reduce(NodeError::larger).filter(|largest| exceeds(largest.error_m, 0.0))
}

/// How far the true motion may be from a reconstructed one.
#[derive(Clone, Debug)]
pub struct Tube {
    stretches: Vec<Stretch>,
    end: KnownEnd,
}

/// What the rows tell of the end of the motion.
#[derive(Clone, Debug)]
struct KnownEnd {
    position_m: [f64; 3],
    velocity_mps: [f64; 3],
    /// How far the true end may be from it.
    error: EndError,
}

/// A stretch of time and the deviations during it.
#[derive(Clone, Copy, Debug)]
struct Stretch {
    end_s: f64,
    position_m: f64,
    velocity_mps: f64,
}

impl Tube {
    /// The tube around the reconstructed `motion` of a trajectory; `None` if all was given.
    ///
    /// - `end_velocity`: of rows without velocities
    /// - `limits`: what the vehicle can do
    pub fn around(
        motion: &Motion,
        trajectory: &Trajectory,
        given: &GivenRows,
        end_velocity: Option<EndVelocity>,
        limits: &Limits,
    ) -> Option<Self> {
        if *given == GivenRows::Everything {
            return None;
        }
        let acceleration_mps2 = max_acceleration_mps2(limits);
        let rows = (1..trajectory.times_s.len()).map(|end| RowPair::new(trajectory, end, given));
        let mut segments = motion.segments().filter(Segment::lasts).peekable();
        let mut stretches = Vec::new();
        let end = KnownEnd::new(trajectory, given, end_velocity)?;
        for pair in rows {
            while let Some(segment) = segments.next_if(|segment| segment.t_s[1] <= pair.curve.t_s[1]) {
                stretches.push(pair.stretch(&segment, acceleration_mps2));
            }
        }
        Some(Self { stretches, end })
    }

    /// The tube around rows that are known up to a distance, m.
    pub fn widened(mut self, distance_m: f64) -> Self {
        self.stretches.iter_mut().for_each(|stretch| stretch.position_m += distance_m);
        self.end.error.position_m += distance_m;
        self
    }

    /// The motion in its tube.
    pub fn surround(&self, motion: Motion) -> Motion {
        motion.within(|segment| self.distance_m(segment.t_s))
    }

    /// Largest distance from the reconstructed motion during an interval of time, m.
    pub fn distance_m(&self, t_s: [f64; 2]) -> f64 {
        self.during(t_s).map(|stretch| stretch.position_m).fold(0.0, larger)
    }

    /// Largest difference of the velocities at a time, m/s.
    pub fn velocity_mps(&self, t_s: f64) -> f64 {
        self.during([t_s, t_s]).map(|stretch| stretch.velocity_mps).fold(0.0, larger)
    }

    /// How far the true end may be from this one.
    pub fn end_error(&self, end: &Knot) -> EndError {
        EndError {
            position_m: self.end.error.position_m + distance(end.position_m, self.end.position_m),
            velocity_mps: self.end.error.velocity_mps + distance(end.velocity_mps, self.end.velocity_mps),
        }
    }

    /// The stretches that touch an interval of time; beyond the end the last one.
    fn during(&self, [from_s, to_s]: [f64; 2]) -> impl Iterator<Item = &Stretch> {
        let last = self.stretches.len().saturating_sub(1);
        let first = self.stretches.partition_point(|stretch| stretch.end_s < from_s).min(last);
        let end = self.stretches.partition_point(|stretch| stretch.end_s < to_s).min(last);
        self.stretches.iter().skip(first).take(end + 1 - first)
    }
}

impl KnownEnd {
    /// `None` without rows.
    fn new(trajectory: &Trajectory, given: &GivenRows, end_velocity: Option<EndVelocity>) -> Option<Self> {
        let last = trajectory.states.len().checked_sub(1)?;
        let state = &trajectory.states[last];
        let EndVelocity { velocity_mps, error_mps } = match (given, end_velocity) {
            (GivenRows::States(velocities_mps), _) => {
                EndVelocity { velocity_mps: velocities_mps[last], error_mps: 0.0 }
            }
            (_, Some(end_velocity)) => end_velocity,
            (_, None) => EndVelocity { velocity_mps: state.velocity_mps(), error_mps: f64::INFINITY },
        };
        let error = EndError { position_m: 0.0, velocity_mps: error_mps };
        Some(Self { position_m: state.position_m(), velocity_mps, error })
    }
}

/// Two successive rows.
struct RowPair<'a> {
    given: &'a GivenRows,
    /// The curve from which the law counts: chord or cubic.
    curve: Segment,
}

impl<'a> RowPair<'a> {
    fn new(trajectory: &Trajectory, end: usize, given: &'a GivenRows) -> Self {
        let knot = |row: usize, velocity_mps| Knot {
            t_s: trajectory.times_s[row],
            position_m: trajectory.states[row].position_m(),
            velocity_mps,
        };
        let velocities_mps = match given {
            GivenRows::States(velocities_mps) => [velocities_mps[end - 1], velocities_mps[end]],
            GivenRows::Positions | GivenRows::Everything => [chord_mps(trajectory, end); 2],
        };
        let curve = Segment::between(&knot(end - 1, velocities_mps[0]), &knot(end, velocities_mps[1]));
        Self { given, curve }
    }

    /// The law over one segment of the reconstructed motion, plus the distance of that segment from the curve.
    fn stretch(&self, segment: &Segment, acceleration_mps2: f64) -> Stretch {
        let [begin_s, end_s] = self.curve.t_s;
        let interval_s = end_s - begin_s;
        let u = segment.t_s.map(|t_s| (t_s - begin_s) / interval_s);
        let curve = self.curve.during(segment.t_s[0], segment.t_s[1]);
        let apart_m: [[f64; 3]; 4] = std::array::from_fn(|point| {
            std::array::from_fn(|axis| segment.points_m[point][axis] - curve.points_m[point][axis])
        });
        let duration_s = segment.t_s[1] - segment.t_s[0];
        let apart_mps = (0..3).map(|leg| distance(apart_m[leg], apart_m[leg + 1]) * 3.0 / duration_s).fold(0.0, larger);
        Stretch {
            end_s: segment.t_s[1],
            position_m: acceleration_mps2 * interval_s * interval_s * max_position_factor(self.given, u)
                + apart_m.map(|apart_m| distance(apart_m, [0.0; 3])).into_iter().fold(0.0, larger),
            velocity_mps: acceleration_mps2 * interval_s * max_velocity_factor(self.given, u) + apart_mps,
        }
    }
}

/// Mean velocity from the row before `end` to the row `end`, m/s.
fn chord_mps(trajectory: &Trajectory, end: usize) -> [f64; 3] {
    let [a, b] = [end - 1, end].map(|row| trajectory.states[row].position_m());
    let duration_s = trajectory.times_s[end] - trajectory.times_s[end - 1];
    std::array::from_fn(|axis| (b[axis] - a[axis]) / duration_s)
}

/// Largest |p - c|/(a T²), or |p - h|/(a T²), over a part of the interval.
fn max_position_factor(given: &GivenRows, [from, to]: [f64; 2]) -> f64 {
    let at = |u: f64| match given {
        GivenRows::Positions => u * (1.0 - u) / 2.0,
        GivenRows::States(_) => {
            let ends = (u * (1.0 - u)).powi(2) / 2.0;
            let later = (1.0 + 4.0 * (1.0 - u).powi(2)) / (3.0 - 2.0 * u);
            ends * (later + (1.0 + 4.0 * u * u) / (1.0 + 2.0 * u))
        }
        GivenRows::Everything => 0.0,
    };
    // Both rise until the middle and fall after it.
    at(0.5_f64.clamp(from, to))
}

/// Largest |p' - c'|/(a T), or |p' - h'|/(a T), over a part of the interval.
fn max_velocity_factor(given: &GivenRows, [from, to]: [f64; 2]) -> f64 {
    match given {
        GivenRows::Positions => [from, to].map(|u| (u * u + (1.0 - u).powi(2)) / 2.0).into_iter().fold(0.0, larger),
        GivenRows::States(_) => MAX_VELOCITY_FACTOR,
        GivenRows::Everything => 0.0,
    }
}

fn distance(a: [f64; 3], b: [f64; 3]) -> f64 {
    (0..3).map(|axis| (a[axis] - b[axis]).powi(2)).sum::<f64>().sqrt()
}

/// The larger of two numbers. NaN counts as larger than any.
fn larger(a: f64, b: f64) -> f64 {
    if is_larger(b, a) { b } else { a }
}

#[cfg(test)]
mod tests;
