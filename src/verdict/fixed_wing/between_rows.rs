//! What may lie between the rows of a plan of a fixed wing that gives no controls: the [law](crate::verdict::reconstruction)
//! with the largest acceleration that the limits allow. It follows from the load factors and the flight-path angle γ,
//!
//! ```text
//! |p''|² = g² ((n_x - sin γ)² + n_y² + (n_z - cos γ)²) ≤ a²
//! ```

use scenarios::Range;
use scenarios::fixed_wing::{GRAVITY_MPS2, Limits, Trajectory};

use crate::verdict::compare::{exceeds, larger};
use crate::verdict::fixed_wing::planned::{NodeError, WINDOW_S};
use crate::verdict::motion::{Knot, Motion, Segment};
use crate::verdict::provenance::{EndVelocity, GivenRows};
use crate::verdict::reconstruction::{max_position_factor, max_velocity_factor, max_velocity_from_chord_mps};
use crate::verdict::tube::{EndError, Stretch, Tube};

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

/// How well a reconstructed motion is known.
#[derive(Clone, Debug, Default)]
pub struct RowTube {
    /// Around the motion.
    pub tube: Tube,
    /// At arrival; `None` if all was given.
    end: Option<KnownEnd>,
}

/// What the rows tell of the arrival.
#[derive(Clone, Debug)]
struct KnownEnd {
    position_m: [f64; 3],
    velocity_mps: [f64; 3],
    /// How far the true end may be from it.
    error: EndError,
}

impl RowTube {
    /// The tube around the reconstructed `motion` of a trajectory, which has no width if all was given.
    ///
    /// - `end_velocity`: at the last one of rows without velocities
    /// - `arrival`: the row at which the vehicle arrives
    /// - `limits`: what the vehicle can do
    pub fn around(
        motion: &Motion,
        trajectory: &Trajectory,
        given: &GivenRows,
        end_velocity: Option<EndVelocity>,
        arrival: usize,
        limits: &Limits,
    ) -> Self {
        let end_velocity = end_velocity.filter(|_| arrival + 1 == trajectory.states.len());
        let Some(end) = KnownEnd::new(trajectory, given, end_velocity, arrival) else { return Self::default() };
        let acceleration_mps2 = max_acceleration_mps2(limits);
        let rows = (1..trajectory.times_s.len()).map(|end| RowPair::new(trajectory, end, given));
        let mut segments = motion.segments().filter(Segment::lasts).peekable();
        let mut stretches = Vec::new();
        for pair in rows {
            while let Some(segment) = segments.next_if(|segment| segment.t_s[1] <= pair.curve.t_s[1]) {
                stretches.push(pair.stretch(&segment, acceleration_mps2));
            }
        }
        Self { tube: Tube::new(stretches), end: Some(end) }
    }

    /// The same around rows that are known up to a distance, m.
    pub fn widened(self, distance_m: f64) -> Self {
        let widened = |end: KnownEnd| {
            let error = EndError { position_m: end.error.position_m + distance_m, ..end.error };
            KnownEnd { error, ..end }
        };
        Self { tube: self.tube.widened(distance_m), end: self.end.map(widened) }
    }

    /// How far the true arrival may be from this one.
    pub fn end_error(&self, end: &Knot) -> EndError {
        let Some(known) = &self.end else { return EndError::default() };
        EndError {
            position_m: known.error.position_m + distance(end.position_m, known.position_m),
            velocity_mps: known.error.velocity_mps + distance(end.velocity_mps, known.velocity_mps),
        }
    }
}

impl KnownEnd {
    /// `None` without rows, or if all was given.
    fn new(
        trajectory: &Trajectory,
        given: &GivenRows,
        end_velocity: Option<EndVelocity>,
        arrival: usize,
    ) -> Option<Self> {
        if *given == GivenRows::Everything {
            return None;
        }
        let state = trajectory.states.get(arrival)?;
        let EndVelocity { velocity_mps, error_mps } = match (given, end_velocity) {
            (GivenRows::States(velocities_mps), _) => {
                EndVelocity { velocity_mps: velocities_mps[arrival], error_mps: 0.0 }
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

fn distance(a: [f64; 3], b: [f64; 3]) -> f64 {
    (0..3).map(|axis| (a[axis] - b[axis]).powi(2)).sum::<f64>().sqrt()
}

#[cfg(test)]
mod tests;
