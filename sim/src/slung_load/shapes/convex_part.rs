//! Convex parts of a vehicle, and their support points.

use nalgebra::Vector3;

/// A direction with a smaller fraction than this across the axis is parallel to it.
const PARALLEL: f64 = 1e-12;

/// A flat disc or a line segment.
#[derive(Clone, Copy, Debug)]
pub(super) enum ConvexPart {
    Disc { center_m: Vector3<f64>, axis: Vector3<f64>, radius_m: f64 },
    Line { ends_m: [Vector3<f64>; 2] },
}

impl ConvexPart {
    /// Centre and radius of the ball around it, m.
    pub fn ball(&self) -> (Vector3<f64>, f64) {
        match self {
            Self::Disc { center_m, radius_m, .. } => (*center_m, *radius_m),
            Self::Line { ends_m: [a, b] } => ((a + b) / 2.0, (b - a).norm() / 2.0),
        }
    }

    /// Support point: the point farthest in a direction.
    pub fn support_m(&self, direction: &Vector3<f64>) -> Vector3<f64> {
        match self {
            Self::Disc { center_m, axis, radius_m } => {
                let in_plane = |vector: &Vector3<f64>| vector - axis * axis.dot(vector);
                // For a direction almost parallel to the axis the projection is mostly rounding, so that it is
                // repeated.
                let across = in_plane(direction).try_normalize(PARALLEL * direction.norm());
                center_m + across.map_or_else(Vector3::zeros, |across| in_plane(&across).normalize() * *radius_m)
            }
            Self::Line { ends_m: [a, b] } => {
                if direction.dot(a) >= direction.dot(b) {
                    *a
                } else {
                    *b
                }
            }
        }
    }
}
