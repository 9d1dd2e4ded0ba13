//! What a plan leaves open between its nodes.
//!
//! A plan of positions and velocities is the cubics through them. One of polynomial pieces is cubics up to their
//! [errors](CubicsError). One of positions alone leaves open whatever the acceleration a of the vehicle allows: between two
//! rows T apart it is within a T²/8 of the chord c, and its velocity within a T/2 of the chord's (the
//! [law](crate::verdict::reconstruction)). The reconstructed cubic q is known, so that |p - q| ≤ a T²/8 + |c - q|.
//!
//! The samples of a flight give positions and velocities, and leave open what the acceleration allows around the cubic through
//! them. Of two of them, T apart, with the mean velocity v̄, some instant needs at least the acceleration
//!
//! ```text
//! max |p''| ≥ max(|v₁ - v₀|/T, 2 |v̄ - v₀|/T, 2 |v̄ - v₁|/T)                      ∫ p'' dt, ∫ (T - t) p'' dt, ∫ t p'' dt
//! ```
//!
//! Of three positions p₀, p₁, p₂ the mean chord velocities v₀, v₁ determine the acceleration that some instant needs at least,
//!
//! ```text
//! max |p''| ≥ 2 |v₁ - v₀|/(T₀ + T₁)                                                     mean value of the second derivative
//! ```

use nalgebra::Vector3;
use scenarios::curve::CubicsError;
use scenarios::multirotor::Model;

use crate::verdict::compare::larger;
use crate::verdict::motion::{Motion, Segment};
use crate::verdict::reconstruction::{
    max_distance_from_chord_m, max_distance_m, max_velocity_factor, max_velocity_from_chord_mps,
};
use crate::verdict::{GivenRows, Provenance};

/// How well the motion of a vehicle is known between the nodes of its plan.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum BetweenNodes {
    /// Up to these errors.
    Within(CubicsError),
    /// By positions and velocities, of a vehicle that accelerates by no more than this, m/s².
    States(f64),
    /// By positions alone, of a vehicle that accelerates by no more than this, m/s².
    Positions(f64),
}

/// A value and its largest error.
pub type Bounded = (f64, f64);

impl BetweenNodes {
    /// Of a plan that is the cubics between its nodes.
    pub const EXACT: Self = Self::Within(CubicsError { position_m: 0.0, velocity_mps: 0.0, acceleration_mps2: 0.0 });

    /// Of the vehicle with this index.
    pub fn of(provenance: &Provenance, vehicle: usize, model: &Model) -> Self {
        match provenance.given(vehicle) {
            GivenRows::Positions => Self::Positions(model.limits.acceleration_mps2),
            GivenRows::States(_) => Self::States(model.limits.acceleration_mps2),
            GivenRows::Everything => Self::Within(provenance.curve_error(vehicle)),
        }
    }

    /// Whether the plan gives velocities.
    pub fn gives_velocities(&self) -> bool {
        !matches!(self, Self::Positions(_))
    }

    /// Largest distance of the planned motion from a cubic between two nodes, m.
    pub fn distance_m(&self, segment: &Segment) -> f64 {
        match self {
            Self::Within(error) => error.position_m,
            Self::States(acceleration_mps2) => {
                let duration_s = segment.t_s[1] - segment.t_s[0];
                max_distance_m(&GivenRows::States(Vec::new()), *acceleration_mps2, duration_s)
            }
            Self::Positions(acceleration_mps2) => {
                let duration_s = segment.t_s[1] - segment.t_s[0];
                max_distance_from_chord_m(*acceleration_mps2, duration_s, 0.5) + from_chord_m(segment)
            }
        }
    }

    /// Largest speed between two nodes, m/s.
    ///
    /// - `fastest_mps`: of the cubic
    pub fn speed_mps(&self, segment: &Segment, fastest_mps: f64) -> Bounded {
        match self {
            Self::Within(error) => (fastest_mps, error.velocity_mps),
            Self::States(acceleration_mps2) => {
                let duration_s = segment.t_s[1] - segment.t_s[0];
                let factor = max_velocity_factor(&GivenRows::States(Vec::new()), [0.0, 1.0]);
                (fastest_mps, acceleration_mps2 * duration_s * factor)
            }
            Self::Positions(acceleration_mps2) => {
                let duration_s = segment.t_s[1] - segment.t_s[0];
                let reserve_mps = max_velocity_from_chord_mps(*acceleration_mps2, duration_s, 1.0);
                // The mean speed along the chord is reached, and not exceeded by more than the reserve.
                (chord_mps(segment).norm() + reserve_mps / 2.0, reserve_mps / 2.0)
            }
        }
    }

    /// The magnitude of the acceleration at a knot, m/s².
    ///
    /// - `knot`: its index
    /// - `value_mps2`: of the cubic
    /// - `limit_mps2`: what it is compared with: a cubic within it shows that a motion within it exists
    pub fn acceleration_mps2(&self, motion: &Motion, knot: usize, value_mps2: f64, limit_mps2: f64) -> Bounded {
        match self {
            Self::Within(error) => (value_mps2, error.acceleration_mps2),
            Self::States(_) | Self::Positions(_) if value_mps2 <= limit_mps2 => (value_mps2, 0.0),
            Self::States(_) => shown(value_mps2, needed_of_states_mps2(motion, knot), limit_mps2),
            Self::Positions(_) => shown(value_mps2, needed_mps2(motion, knot), limit_mps2),
        }
    }
}

/// An acceleration of the cubic, beyond the limit, of which so much is needed: the true one is in between.
fn shown(value_mps2: f64, needed_mps2: f64, limit_mps2: f64) -> Bounded {
    if needed_mps2 > limit_mps2 { (needed_mps2, 0.0) } else { (value_mps2, value_mps2 - needed_mps2) }
}

/// The acceleration without which no motion has the positions and velocities at a knot and at those next to it, m/s².
fn needed_of_states_mps2(motion: &Motion, knot: usize) -> f64 {
    let adjacent = knot.saturating_sub(1)..(knot + 1).min(motion.segment_count());
    let segments = adjacent.map(|index| motion.segment(index)).filter(Segment::lasts);
    segments.map(|segment| needed_between_mps2(&segment)).fold(0.0, larger)
}

/// The same for the ends of one segment.
fn needed_between_mps2(segment: &Segment) -> f64 {
    let duration_s = segment.t_s[1] - segment.t_s[0];
    let [first, second, third, last] = segment.points_m.map(Vector3::from);
    let [begin_mps, end_mps] = [second - first, last - third].map(|leg_m| leg_m * (3.0 / duration_s));
    let mean_mps = (last - first) / duration_s;
    let from_mean_mps = (mean_mps - begin_mps).norm().max((mean_mps - end_mps).norm());
    (end_mps - begin_mps).norm().max(2.0 * from_mean_mps) / duration_s
}

/// The acceleration without which the positions before, at and after a knot cannot be passed, m/s²; 0 at the ends.
fn needed_mps2(motion: &Motion, knot: usize) -> f64 {
    if knot == 0 || knot >= motion.segment_count() {
        return 0.0;
    }
    let [before, after] = [motion.segment(knot - 1), motion.segment(knot)];
    2.0 * (chord_mps(&after) - chord_mps(&before)).norm() / (after.t_s[1] - before.t_s[0])
}

/// Mean velocity, m/s.
fn chord_mps(segment: &Segment) -> Vector3<f64> {
    let [first, .., last] = segment.points_m.map(Vector3::from);
    (last - first) / (segment.t_s[1] - segment.t_s[0])
}

/// Upper bound of the distance of a cubic from its chord, m: that of the control points, whose hull their difference lies in.
fn from_chord_m(segment: &Segment) -> f64 {
    let [first, second, third, last] = segment.points_m.map(Vector3::from);
    let leg_m = (last - first) / 3.0;
    (second - first - leg_m).norm().max((third - first - leg_m * 2.0).norm())
}

#[cfg(test)]
mod tests {
    use super::{BetweenNodes, needed_mps2};
    use crate::verdict::motion::{Knot, Motion};

    /// x = t² on [0, 2], then straight on: acceleration 2 m/s² and none.
    fn motion() -> Motion {
        let knot = |(t_s, x_m, v_mps): (f64, f64, f64)| Knot {
            t_s,
            position_m: [x_m, 0.0, 0.0],
            velocity_mps: [v_mps, 0.0, 0.0],
        };
        let knots = [(0.0, 0.0, 0.0), (1.0, 1.0, 2.0), (2.0, 4.0, 4.0), (3.0, 8.0, 4.0)].map(knot).to_vec();
        Motion::new("uav", knots).unwrap()
    }

    #[test]
    fn three_positions_need_their_mean_acceleration() {
        let motion = motion();
        assert_eq!([0, 1, 2, 3].map(|knot| needed_mps2(&motion, knot)), [0.0, 2.0, 1.0, 0.0]);
    }

    #[test]
    fn two_states_need_what_their_velocities_and_their_mean_velocity_ask_for() {
        let close = |a: f64, b: f64| assert!((a - b).abs() < 1e-12, "{a}, not {b}");
        // Accelerations of 2, 2 and 0 m/s² pass the states exactly.
        for (knot, needed_mps2) in [2.0, 2.0, 2.0, 0.0].into_iter().enumerate() {
            close(super::needed_of_states_mps2(&motion(), knot), needed_mps2);
        }
        // At rest at both ends and 1 m further after 2 s: half of the way with 1 m/s², half with -1 m/s².
        let knot = |t_s: f64, x_m: f64| Knot { t_s, position_m: [x_m, 0.0, 0.0], velocity_mps: [0.0; 3] };
        let moved = Motion::new("uav", vec![knot(0.0, 0.0), knot(2.0, 1.0)]).unwrap();
        close(super::needed_of_states_mps2(&moved, 0), 0.5);
        let between = BetweenNodes::States(2.0);
        close(between.distance_m(&moved.segment(0)), 0.5);
        close(between.acceleration_mps2(&moved, 0, 1.5, 1.0).1, 1.0);
        assert_eq!(between.acceleration_mps2(&moved, 0, 1.5, 0.4).1, 0.0);
        close(between.speed_mps(&moved.segment(0), 0.75).1, 1.008);
    }

    #[test]
    fn positions_alone_leave_open_what_the_acceleration_allows() {
        let (motion, between) = (motion(), BetweenNodes::Positions(2.0));
        // a T²/8, and the bulge of the parabola: its control points are 1/3 m off the chord.
        assert!((between.distance_m(&motion.segment(0)) - (0.25 + 1.0 / 3.0)).abs() < 1e-12);
        assert!((between.distance_m(&motion.segment(2)) - 0.25).abs() < 1e-12);
        assert_eq!(between.speed_mps(&motion.segment(2), 4.0), (4.5, 0.5));
        assert_eq!(between.acceleration_mps2(&motion, 1, 2.0, 2.0), (2.0, 0.0));
        assert_eq!(between.acceleration_mps2(&motion, 1, 3.0, 2.5), (3.0, 1.0));
        assert_eq!(between.acceleration_mps2(&motion, 1, 3.0, 1.5), (2.0, 0.0));
    }
}
