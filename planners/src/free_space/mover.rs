use super::Obstacle;
use super::vector::{Point, interpolate, scaled};

/// An obstacle that moves.
#[derive(Clone, Debug, PartialEq)]
pub struct Mover {
    /// What it is like at time 0.
    pub shape: Obstacle,
    /// How it moves.
    pub track: Track,
}

/// Displacement since time 0.
#[derive(Clone, Debug, PartialEq)]
pub enum Track {
    /// At constant velocity, m/s.
    Straight(Point),
    /// From point to point (time s, displacement m) at constant velocity each, times increasing, at least one; it stands
    /// still before the first and after the last.
    Known(Vec<(f64, Point)>),
}

impl Mover {
    /// At constant velocity, m/s.
    pub fn straight(shape: Obstacle, velocity: Point) -> Self {
        Self { shape, track: Track::Straight(velocity) }
    }

    /// Where it is at a time, as displacement since time 0, m.
    pub fn offset_m(&self, time_s: f64) -> Point {
        let points = match &self.track {
            Track::Straight(velocity) => return scaled(*velocity, time_s),
            Track::Known(points) => points,
        };
        let next = points.partition_point(|&(at_s, _)| at_s <= time_s);
        if next == 0 || next == points.len() {
            return points[next.min(points.len() - 1)].1;
        }
        let [(from_s, from), (to_s, to)] = [points[next - 1], points[next]];
        interpolate(from, to, (time_s - from_s) / (to_s - from_s))
    }
}
