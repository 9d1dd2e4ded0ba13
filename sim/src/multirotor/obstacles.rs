use nalgebra::Vector3;
use scenarios::{Cylinder, MovingCylinder, Prism, World};

/// A distance that counts as touching, m.
const TOUCH_M: f64 = 1e-9;

/// All obstacles of a world, sensed or not, and how far they are.
#[derive(Clone, Debug)]
pub struct Obstacles {
    cylinders: Vec<Cylinder>,
    flat: Vec<Prism>,
    moving: Vec<MovingCylinder>,
}

impl Obstacles {
    /// Of a world.
    pub fn new(world: &World) -> Self {
        Self { cylinders: world.cylinders.clone(), flat: world.prism_obstacles(), moving: world.moving.clone() }
    }

    /// Number of obstacles; they count from 0 in the order cylinders, boxes, prisms, moving ones.
    pub fn count(&self) -> usize {
        self.cylinders.len() + self.flat.len() + self.moving.len()
    }

    /// Name of an obstacle.
    pub fn name(&self, obstacle: usize) -> &str {
        match self.kind(obstacle) {
            Kind::Cylinder(it) => &it.name,
            Kind::ConvexPart(it) => &it.name,
            Kind::Moving(it) => &it.name,
        }
    }

    /// Largest speed of an obstacle, m/s.
    pub fn speed_mps(&self, obstacle: usize) -> f64 {
        match self.kind(obstacle) {
            Kind::Cylinder(_) | Kind::ConvexPart(_) => 0.0,
            Kind::Moving(it) => it.speed_mps,
        }
    }

    /// Signed distance from a point to the surface of an obstacle at an instant, m: negative inside.
    pub fn distance_m(&self, obstacle: usize, t_s: f64, position_m: [f64; 3]) -> f64 {
        match self.kind(obstacle) {
            Kind::Cylinder(it) => it.signed_distance_m(position_m[0], position_m[1]),
            Kind::ConvexPart(it) => it.signed_distance_in_space_m(position_m),
            Kind::Moving(it) => it.signed_distance_m(t_s, position_m),
        }
    }

    /// The first obstacle that a ball touches which goes along a straight line, and when, as a share of its way.
    ///
    /// - `times_s`, `ends_m`: of the way's beginning and end
    ///
    /// No point can come nearer faster than both move: the ball goes on by what is free, until nothing is, or the way ends.
    pub fn time_of_impact(&self, times_s: [f64; 2], ends_m: [Vector3<f64>; 2], radius_m: f64) -> Option<(f64, usize)> {
        let duration_s = times_s[1] - times_s[0];
        let way_m = (ends_m[1] - ends_m[0]).norm();
        let touches = (0..self.count()).filter_map(|obstacle| {
            let closing_m = way_m + self.speed_mps(obstacle) * duration_s;
            let mut share = 0.0;
            loop {
                let position_m = ends_m[0] + (ends_m[1] - ends_m[0]) * share;
                let t_s = times_s[0] + duration_s * share;
                let free_m = self.distance_m(obstacle, t_s, position_m.into()) - radius_m;
                // What is not a number touches.
                if !matches!(free_m.partial_cmp(&TOUCH_M), Some(std::cmp::Ordering::Greater)) {
                    return Some((share, obstacle));
                }
                share += free_m / closing_m;
                if share > 1.0 || closing_m <= 0.0 {
                    return None;
                }
            }
        });
        touches.min_by(|a, b| a.0.total_cmp(&b.0))
    }

    fn kind(&self, obstacle: usize) -> Kind<'_> {
        let (cylinders, flat) = (self.cylinders.len(), self.flat.len());
        if obstacle < cylinders {
            Kind::Cylinder(&self.cylinders[obstacle])
        } else if obstacle < cylinders + flat {
            Kind::ConvexPart(&self.flat[obstacle - cylinders])
        } else {
            Kind::Moving(&self.moving[obstacle - cylinders - flat])
        }
    }
}

enum Kind<'a> {
    Cylinder(&'a Cylinder),
    ConvexPart(&'a Prism),
    Moving(&'a MovingCylinder),
}

#[cfg(test)]
mod tests {
    use super::*;
    use scenarios::{BoxObstacle, Map, Range};

    fn surroundings() -> Obstacles {
        let wide = Range::new(-100.0, 100.0);
        let mut world = World::empty(Map { x_m: wide, y_m: wide, z_m: wide });
        world.boxes.push(BoxObstacle {
            name: "wall".into(),
            center_m: [5.0, 0.0],
            size_m: [0.001, 10.0],
            heading_deg: 0.0,
            z_m: Some(Range::new(0.0, 2.0)),
        });
        world.moving.push(MovingCylinder {
            name: "cart".into(),
            radius_m: 1.0,
            z_m: None,
            path_m: vec![[0.0, 50.0], [0.0, 20.0]],
            speed_mps: 10.0,
            offset_m: 0.0,
        });
        Obstacles::new(&world)
    }

    fn touch(from_m: [f64; 3], to_m: [f64; 3]) -> Option<(f64, usize)> {
        surroundings().time_of_impact([0.0, 2.0], [from_m.into(), to_m.into()], 0.5)
    }

    #[test]
    fn a_thin_wall_is_not_passed_through() {
        let (share, obstacle) = touch([0.0, 0.0, 1.0], [10.0, 0.0, 1.0]).expect("a touch");
        assert_eq!(obstacle, 0);
        assert!((share - 0.44995).abs() < 1e-6, "{share}");
        // Above its top edge there is room for the ball, a little lower there is not.
        assert_eq!(touch([0.0, 0.0, 2.5001], [10.0, 0.0, 2.5001]), None);
        assert!(touch([0.0, 0.0, 2.4999], [10.0, 0.0, 2.4999]).is_some());
    }

    #[test]
    fn what_moves_is_met_where_it_is_then() {
        // The cart comes down from y = 50 m at 10 m/s; standing at y = 40 m, the ball is met after 0.85 s.
        let (share, obstacle) = touch([0.0, 40.0, 0.0], [0.0, 40.0, 0.0]).expect("a touch");
        assert_eq!(obstacle, 1);
        assert!((share - 0.425).abs() < 1e-6, "{share}");
        assert_eq!(touch([0.0, 10.0, 0.0], [0.0, 10.0, 0.0]), None);
        assert!(touch([f64::NAN, 0.0, 0.0], [0.0, 0.0, 0.0]).is_some());
    }
}
