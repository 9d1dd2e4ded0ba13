//! Free space of a scenario's world.

use scenarios::{GeofenceKind, Prism, Range, World};

use super::{FreeSpace, Obstacle, no_fly};

impl FreeSpace {
    /// Bounds and static obstacles of a world; in the plane altitude is unbounded.
    pub fn from_world(world: &World, is_planar: bool) -> Self {
        let static_obstacles = static_obstacles(world).map(|(_, obstacle)| obstacle).collect();
        Self { static_obstacles, ..Self::empty(bounds_m(world, is_planar)) }
    }
}

/// Lower and upper bound of each coordinate, m, of map and stay-in volumes; in the plane altitude is unbounded.
pub fn bounds_m(world: &World, is_planar: bool) -> [[f64; 2]; 3] {
    let [x, y, z] = world.map.axes().map(|range| [range.min, range.max]);
    let stay_in = world.geofences.iter().filter(|fence| fence.kind == GeofenceKind::StayIn);
    let allowed = stay_in.filter_map(|fence| fence.z_m).fold(z, |[min, max], it| [it.min.max(min), it.max.min(max)]);
    [x, y, if is_planar { altitude_range_m(None) } else { allowed }]
}

/// Every static obstacle, with its name. Those of other shapes are replaced by prisms that contain them,
/// geofences by prisms over what they forbid.
pub fn static_obstacles(world: &World) -> impl Iterator<Item = (String, Obstacle)> {
    let cylinders = world.cylinders.iter().map(|cylinder| {
        (cylinder.name.clone(), Obstacle::cylinder(cylinder.center_m, cylinder.radius_m, altitude_range_m(None)))
    });
    let prism = |prism: Prism| {
        let obstacle = Obstacle::prism(&prism.corners_m, altitude_range_m(prism.z_m));
        (prism.name, obstacle)
    };
    let enclosing = world.solids().into_iter().flat_map(|solid| solid.enclosing_prisms());
    let no_fly = world.geofences.iter().flat_map(|fence| no_fly::obstacles(fence, &world.map));
    cylinders.chain(world.prism_obstacles().into_iter().chain(enclosing).map(prism)).chain(no_fly)
}

/// Lowest and highest altitude, m; infinite where absent.
pub fn altitude_range_m(z_m: Option<Range>) -> [f64; 2] {
    z_m.map_or([f64::NEG_INFINITY, f64::INFINITY], |range| [range.min, range.max])
}
