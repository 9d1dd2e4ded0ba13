//! Rigid bodies that move: vehicles, loads, obstacles.

use serde::Serialize;
use sim::Sample;

use super::{ItemPath, Shape, is_finite};

/// A rigid body that moves.
pub struct Body<'a> {
    /// Name of its frame, unique: that of the vehicle, `NAME/load`, or that of the obstacle.
    pub frame: String,
    /// As in [`Item`](super::Item).
    pub path: ItemPath,
    /// What it is.
    pub kind: BodyKind,
    /// Its parts.
    pub parts: Vec<Part>,
    /// Time between two poses with which the motion looks smooth, s.
    pub interval_s: f64,
    /// Its poses, at least the given time apart, s.
    pub poses: Box<dyn Fn(f64) -> Vec<Pose> + 'a>,
}

/// Kinds of bodies.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Serialize)]
#[serde(rename_all = "kebab-case")]
pub enum BodyKind {
    /// A vehicle, or the load that it carries.
    Vehicle,
    /// A moving obstacle.
    Obstacle,
    /// A vehicle of an earlier run.
    Ghost,
}

/// A shape that moves with a body.
#[derive(Clone, Debug, PartialEq, Serialize)]
pub struct Part {
    /// Its path below that of the body; empty for the only part of a body.
    pub name: &'static str,
    /// In the frame of the body.
    pub shape: Shape,
    /// Does it rotate with the body? If not, it only moves with it and stays upright.
    pub rotates: bool,
}

/// Where a body is at one time.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Pose {
    /// Time, s.
    pub t_s: f64,
    /// Position, m.
    pub position_m: [f64; 3],
    /// Attitude as a unit quaternion (x, y, z, w); the identity for a body that does not rotate.
    pub world_from_body: [f64; 4],
}

impl Part {
    /// A part that rotates with the body.
    pub fn fixed(name: &'static str, shape: impl Into<Shape>) -> Self {
        Self { name, shape: shape.into(), rotates: true }
    }

    /// A part that stays upright.
    pub fn upright(name: &'static str, shape: impl Into<Shape>) -> Self {
        Self { name, shape: shape.into(), rotates: false }
    }
}

impl Pose {
    /// The attitude of a body that does not rotate.
    pub const UPRIGHT: [f64; 4] = [0.0, 0.0, 0.0, 1.0];

    pub(super) fn of(sample: &Sample) -> Self {
        Self { t_s: sample.t_s, position_m: sample.position_m, world_from_body: sample.world_from_body }
    }
}

/// Can this sample be drawn?
pub(super) fn is_drawable(sample: &Sample) -> bool {
    let attitude_norm: f64 = sample.world_from_body.iter().map(|q| q * q).sum();
    sample.t_s.is_finite() && is_finite(&sample.position_m) && (0.5..2.0).contains(&attitude_norm)
}

/// Drawable samples at least `interval_s` apart, the first and the last among them.
pub(super) fn spaced(samples: &[Sample], interval_s: f64) -> Vec<Sample> {
    let mut kept: Vec<Sample> = Vec::new();
    for sample in samples.iter().filter(|sample| is_drawable(sample)) {
        if kept.last().is_none_or(|last| is_due(last.t_s, sample.t_s, interval_s)) {
            kept.push(*sample);
        }
    }
    let last = samples.iter().rfind(|sample| is_drawable(sample));
    if let Some(last) = last.filter(|last| kept.last() != Some(last)) {
        kept.push(*last);
    }
    kept
}

/// Are two times `interval_s` apart? A hundredth less will do: rounding must not skip a sample.
pub(super) fn is_due(last_s: f64, t_s: f64, interval_s: f64) -> bool {
    t_s - last_s >= 0.99 * interval_s
}
