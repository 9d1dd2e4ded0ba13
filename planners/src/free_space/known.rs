//! What a scenario's world is to a point that has to keep away from it.

use scenarios::{Prism, Range, World};

use super::{FreeSpace, Obstacle};

impl FreeSpace {
    /// Frame and obstacles of a world; in the plane altitude has no limits.
    pub fn of(world: &World, is_planar: bool) -> Self {
        let frame_m = frame_m(world, is_planar);
        Self { standing: obstacles(world).map(|(_, obstacle)| obstacle).collect(), ..Self::empty(frame_m) }
    }
}

/// Limits of each coordinate, m; in the plane altitude has none.
pub fn frame_m(world: &World, is_planar: bool) -> [[f64; 2]; 3] {
    let [x, y, z] = world.map.axes().map(|range| [range.min, range.max]);
    [x, y, if is_planar { [f64::NEG_INFINITY, f64::INFINITY] } else { z }]
}

/// Every obstacle that does not move, with its name.
pub fn obstacles(world: &World) -> impl Iterator<Item = (String, Obstacle)> {
    let cylinders = world.cylinders.iter().map(|cylinder| {
        (cylinder.name.clone(), Obstacle::cylinder(cylinder.center_m, cylinder.radius_m, altitude_m(None)))
    });
    let prism = |prism: Prism| {
        let obstacle = Obstacle::prism(&prism.corners_m, altitude_m(prism.z_m));
        (prism.name, obstacle)
    };
    cylinders.chain(world.flat_obstacles().into_iter().map(prism))
}

/// Lowest and highest altitude, m.
pub fn altitude_m(z_m: Option<Range>) -> [f64; 2] {
    z_m.map_or([f64::NEG_INFINITY, f64::INFINITY], |range| [range.min, range.max])
}
