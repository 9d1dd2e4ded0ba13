//! How far the cubics that are judged may be from the polynomial pieces of a plan.

use scenarios::curve::CubicsError;
use schemars::JsonSchema;
use serde::{Deserialize, Serialize};

use crate::number_format::quantity;

/// Polynomial pieces that are judged as cubics between nodes, and bounds of the differences, which no margin may be smaller
/// than.
#[derive(Clone, Copy, Debug, PartialEq, Serialize, Deserialize, JsonSchema)]
pub struct CurveAsCubics {
    /// Number of pieces.
    pub pieces: usize,
    /// Their highest degree.
    pub degree: usize,
    /// Number of cubics.
    pub cubics: usize,
    /// Largest distance from the pieces, what rounding of their numbers leaves open included, m.
    pub position_m: f64,
    /// Largest difference of the velocities, likewise, m/s.
    pub velocity_mps: f64,
    /// Largest difference of the accelerations, m/s².
    pub acceleration_mps2: f64,
}

impl CurveAsCubics {
    /// Both together.
    pub(super) fn sum(a: Option<Self>, b: Option<Self>) -> Option<Self> {
        match (a, b) {
            (Some(a), Some(b)) => Some(Self {
                pieces: a.pieces + b.pieces,
                degree: a.degree.max(b.degree),
                cubics: a.cubics + b.cubics,
                position_m: a.position_m.max(b.position_m),
                velocity_mps: a.velocity_mps.max(b.velocity_mps),
                acceleration_mps2: a.acceleration_mps2.max(b.acceleration_mps2),
            }),
            (a, b) => a.or(b),
        }
    }

    /// The differences.
    pub(super) fn error(&self) -> CubicsError {
        CubicsError {
            position_m: self.position_m,
            velocity_mps: self.velocity_mps,
            acceleration_mps2: self.acceleration_mps2,
        }
    }

    /// In words, for people.
    pub fn describe(&self) -> String {
        format!(
            "{} polynomial pieces of degree {} as {} cubics: within {} and {} of them",
            self.pieces,
            self.degree,
            self.cubics,
            quantity(self.position_m, "m"),
            quantity(self.acceleration_mps2, "m/s²"),
        )
    }
}

#[cfg(test)]
mod tests {
    use super::CurveAsCubics;

    #[test]
    fn of_two_vehicles_the_counts_are_added_and_the_largest_differences_kept() {
        let one = CurveAsCubics {
            pieces: 2,
            degree: 7,
            cubics: 40,
            position_m: 0.1,
            velocity_mps: 0.5,
            acceleration_mps2: 0.2,
        };
        let other = CurveAsCubics {
            pieces: 3,
            degree: 5,
            cubics: 30,
            position_m: 0.3,
            velocity_mps: 0.4,
            acceleration_mps2: 0.9,
        };
        let both = CurveAsCubics {
            pieces: 5,
            degree: 7,
            cubics: 70,
            position_m: 0.3,
            velocity_mps: 0.5,
            acceleration_mps2: 0.9,
        };
        assert_eq!(CurveAsCubics::sum(Some(one), Some(other)), Some(both));
        assert_eq!(CurveAsCubics::sum(None, Some(other)), Some(other));
        assert_eq!(CurveAsCubics::sum(None, None), None);
    }
}
