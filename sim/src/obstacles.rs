use nalgebra::Vector3;
use scenarios::geometry::Solid;
use scenarios::{Cylinder, MovingCylinder, Prism, World};

/// Distances up to this are contact, m.
const CONTACT_M: f64 = 1e-9;

/// All obstacles of a world, known to the vehicles or not.
#[derive(Clone, Debug)]
pub struct Obstacles {
    cylinders: Vec<Cylinder>,
    prisms: Vec<Prism>,
    moving: Vec<MovingCylinder>,
    solids: Vec<Solid>,
}

impl Obstacles {
    /// The obstacles of a world.
    pub fn new(world: &World) -> Self {
        Self { cylinders: world.cylinders.clone(), moving: world.moving.clone(), ..Self::beyond_cylinders(world) }
    }

    /// The obstacles of a world that are neither cylinders nor moving.
    pub fn beyond_cylinders(world: &World) -> Self {
        Self { cylinders: Vec::new(), prisms: world.prism_obstacles(), moving: Vec::new(), solids: world.solids() }
    }

    /// Number of obstacles. They are numbered from 0 in the order cylinders, boxes, prisms, moving cylinders,
    /// solids.
    pub fn count(&self) -> usize {
        self.cylinders.len() + self.prisms.len() + self.moving.len() + self.solids.len()
    }

    /// Name of an obstacle.
    pub fn name(&self, obstacle: usize) -> &str {
        match self.kind(obstacle) {
            Kind::Cylinder(it) => &it.name,
            Kind::Prism(it) => &it.name,
            Kind::Moving(it) => &it.name,
            Kind::Solid(it) => it.name(),
        }
    }

    /// Maximum speed of an obstacle, m/s; 0 for a static one.
    pub fn speed_mps(&self, obstacle: usize) -> f64 {
        match self.kind(obstacle) {
            Kind::Cylinder(_) | Kind::Prism(_) | Kind::Solid(_) => 0.0,
            Kind::Moving(it) => it.speed_mps,
        }
    }

    /// Whether an obstacle is known to be static and convex, so that the signed distance to it is a convex function of the position.
    pub fn is_convex(&self, obstacle: usize) -> bool {
        match self.kind(obstacle) {
            Kind::Cylinder(_) | Kind::Prism(_) => true,
            Kind::Moving(_) | Kind::Solid(_) => false,
        }
    }

    /// Signed distance from a point to the surface of an obstacle at an instant, m: negative inside.
    pub fn distance_m(&self, obstacle: usize, t_s: f64, position_m: [f64; 3]) -> f64 {
        match self.kind(obstacle) {
            Kind::Cylinder(it) => it.signed_distance_m(position_m[0], position_m[1]),
            Kind::Prism(it) => it.signed_distance_in_space_m(position_m),
            Kind::Moving(it) => it.signed_distance_m(t_s, position_m),
            Kind::Solid(it) => it.signed_distance_m(position_m),
        }
    }

    /// Whether a point is inside an obstacle of any shape, even if its surface intersects itself or has small holes, so that no
    /// sign of a distance says so.
    pub fn encloses(&self, obstacle: usize, position_m: [f64; 3]) -> bool {
        matches!(self.kind(obstacle), Kind::Solid(it) if it.encloses(position_m))
    }

    /// First contact of a ball that moves along a straight line at constant velocity with an obstacle. Returns the
    /// fraction of its path, and the obstacle.
    ///
    /// - `times_s`, `ends_m`: times and positions at the beginning and the end of the path
    ///
    /// Conservative advancement: the distance cannot decrease faster than the sum of the speeds, so that the ball is
    /// advanced by the time that the current distance allows, until there is contact or the path ends.
    pub fn time_of_impact(&self, times_s: [f64; 2], ends_m: [Vector3<f64>; 2], radius_m: f64) -> Option<(f64, usize)> {
        let duration_s = times_s[1] - times_s[0];
        let path_m = (ends_m[1] - ends_m[0]).norm();
        let contacts = (0..self.count()).filter_map(|obstacle| {
            let closing_m = path_m + self.speed_mps(obstacle) * duration_s;
            let mut fraction = 0.0;
            loop {
                let position_m = ends_m[0] + (ends_m[1] - ends_m[0]) * fraction;
                let t_s = times_s[0] + duration_s * fraction;
                let free_m = self.distance_m(obstacle, t_s, position_m.into()) - radius_m;
                // NaN counts as contact.
                if !matches!(free_m.partial_cmp(&CONTACT_M), Some(std::cmp::Ordering::Greater)) {
                    return Some((fraction, obstacle));
                }
                fraction += free_m / closing_m;
                if fraction > 1.0 || closing_m <= 0.0 {
                    return None;
                }
            }
        });
        contacts.min_by(|a, b| a.0.total_cmp(&b.0))
    }

    fn kind(&self, obstacle: usize) -> Kind<'_> {
        let (cylinders, prisms, moving) = (self.cylinders.len(), self.prisms.len(), self.moving.len());
        if obstacle < cylinders {
            Kind::Cylinder(&self.cylinders[obstacle])
        } else if obstacle < cylinders + prisms {
            Kind::Prism(&self.prisms[obstacle - cylinders])
        } else if obstacle < cylinders + prisms + moving {
            Kind::Moving(&self.moving[obstacle - cylinders - prisms])
        } else {
            Kind::Solid(&self.solids[obstacle - cylinders - prisms - moving])
        }
    }
}

enum Kind<'a> {
    Cylinder(&'a Cylinder),
    Prism(&'a Prism),
    Moving(&'a MovingCylinder),
    Solid(&'a Solid),
}

#[cfg(test)]
mod tests {
    use super::*;
    use scenarios::{BoxObstacle, Map, Range};

    fn obstacles() -> Obstacles {
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

    fn contact(from_m: [f64; 3], to_m: [f64; 3]) -> Option<(f64, usize)> {
        obstacles().time_of_impact([0.0, 2.0], [from_m.into(), to_m.into()], 0.5)
    }

    #[test]
    fn a_thin_wall_is_not_passed_through() {
        let (fraction, obstacle) = contact([0.0, 0.0, 1.0], [10.0, 0.0, 1.0]).expect("a contact");
        assert_eq!(obstacle, 0);
        assert!((fraction - 0.44995).abs() < 1e-6, "{fraction}");
        // The ball passes just above the top edge, and collides a little lower.
        assert_eq!(contact([0.0, 0.0, 2.5001], [10.0, 0.0, 2.5001]), None);
        assert!(contact([0.0, 0.0, 2.4999], [10.0, 0.0, 2.4999]).is_some());
    }

    #[test]
    fn a_moving_obstacle_is_met_at_its_position_at_that_time() {
        // The cart comes down from y = 50 m at 10 m/s; it reaches the ball at rest at y = 40 m after 0.85 s.
        let (fraction, obstacle) = contact([0.0, 40.0, 0.0], [0.0, 40.0, 0.0]).expect("a contact");
        assert_eq!(obstacle, 1);
        assert!((fraction - 0.425).abs() < 1e-6, "{fraction}");
        assert_eq!(contact([0.0, 10.0, 0.0], [0.0, 10.0, 0.0]), None);
        assert!(contact([f64::NAN, 0.0, 0.0], [0.0, 0.0, 0.0]).is_some());
    }
}
