use super::{Obstacle, Point, interpolate};

/// An obstacle that translates.
#[derive(Clone, Debug, PartialEq)]
pub struct MovingObstacle {
    /// Shape and place at time 0.
    pub shape: Obstacle,
    /// Translation since time 0.
    pub displacement: Displacement,
}

/// Translation since time 0, as a function of time.
#[derive(Clone, Debug, PartialEq)]
pub enum Displacement {
    /// Constant velocity, m/s.
    ConstantVelocity(Point),
    /// Linear interpolation between knots (time s, displacement m): at least one, times increasing. Constant before the
    /// first knot and after the last.
    PiecewiseLinear(Vec<(f64, Point)>),
}

impl MovingObstacle {
    /// At constant velocity, m/s.
    pub fn at_constant_velocity(shape: Obstacle, velocity: Point) -> Self {
        Self { shape, displacement: Displacement::ConstantVelocity(velocity) }
    }

    /// Does it stay within `distance_m` of its place until `time_s`?
    pub fn stays(&self, distance_m: f64, time_s: f64) -> bool {
        match &self.displacement {
            Displacement::ConstantVelocity(velocity) => velocity.norm() * time_s <= distance_m,
            Displacement::PiecewiseLinear(knots) => knots.iter().all(|(_, moved)| moved.norm() <= distance_m),
        }
    }

    /// Displacement from time 0 to `time_s`, m.
    ///
    /// # Panics
    ///
    /// If there are no knots.
    pub fn displacement_m(&self, time_s: f64) -> Point {
        let knots = match &self.displacement {
            Displacement::ConstantVelocity(velocity) => return velocity * time_s,
            Displacement::PiecewiseLinear(knots) => knots,
        };
        let next = knots.partition_point(|&(at_s, _)| at_s <= time_s);
        if next == 0 || next == knots.len() {
            return knots[next.min(knots.len() - 1)].1;
        }
        let [(from_s, from), (to_s, to)] = [knots[next - 1], knots[next]];
        interpolate(from, to, (time_s - from_s) / (to_s - from_s))
    }
}
