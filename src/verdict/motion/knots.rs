use std::fmt;

use crate::verdict::missing_evidence::MissingEvidence;

/// Largest magnitude of a coordinate that is judged, m and m/s: up to here squares and products are accurate.
const MAX_MAGNITUDE: f64 = 1e9;

/// Position and velocity at one instant, world frame.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Knot {
    /// Time, s.
    pub t_s: f64,
    /// Position, m.
    pub position_m: [f64; 3],
    /// Velocity, m/s.
    pub velocity_mps: [f64; 3],
}

/// Why knots are no motion that can be judged.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum KnotDefect {
    /// Fewer than two; how many.
    TooFew(usize),
    /// A number is not finite or larger than 1e9, at this time, s.
    OutOfRange(f64),
    /// Time decreases after this time, s.
    DecreasingTime(f64),
}

impl fmt::Display for KnotDefect {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        self.of("the candidate").fmt(f)
    }
}

impl KnotDefect {
    pub(super) fn find(knots: &[Knot]) -> Option<Self> {
        if knots.len() < 2 {
            return Some(Self::TooFew(knots.len()));
        }
        if let Some(knot) = knots.iter().find(|knot| !is_judgeable(knot)) {
            return Some(Self::OutOfRange(knot.t_s));
        }
        let backwards = knots.windows(2).find(|pair| pair[1].t_s < pair[0].t_s);
        backwards.map(|pair| Self::DecreasingTime(pair[0].t_s))
    }

    /// The same, with the name of the vehicle.
    pub(super) fn of(self, vehicle: &str) -> MissingEvidence {
        let body = vehicle.to_owned();
        match self {
            Self::TooFew(knots) => MissingEvidence::TooFewKnots { body, knots },
            Self::OutOfRange(t_s) => MissingEvidence::OutOfRange { body, t_s },
            Self::DecreasingTime(t_s) => MissingEvidence::DecreasingTime { body, t_s },
        }
    }
}

fn is_judgeable(knot: &Knot) -> bool {
    knot.t_s.is_finite() && knot.position_m.iter().chain(&knot.velocity_mps).all(|value| value.abs() <= MAX_MAGNITUDE)
}
