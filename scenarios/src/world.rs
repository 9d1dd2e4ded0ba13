use schemars::JsonSchema;
use serde::{Deserialize, Serialize};

use crate::Range;
use crate::geometry::Solid;

mod gate;
mod geofence;
mod moving_cylinder;
mod origin;
mod prism;
mod solid;

pub use gate::{Gate, Window};
pub use geofence::{Geofence, GeofenceKind};
pub(crate) use geofence::{is_inside, is_simple};
pub use moving_cylinder::MovingCylinder;
pub use origin::Origin;
pub use prism::{BoxObstacle, Prism};
pub use solid::{Capsule, Cuboid, Mesh, Sphere, Terrain};

/// How many of [`World::obstacle_lists`] may be hidden, and how many are upright.
const LISTS_THAT_MAY_BE_HIDDEN: usize = 3;
pub(crate) const UPRIGHT_LISTS: usize = 4;
/// Wildcard in [`World::hidden`]: all static obstacles.
const EVERY_OBSTACLE: &str = "*";

/// The map and the obstacles on it.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields)]
pub struct World {
    /// The volume that no body may leave: neither that of a vehicle nor its load.
    pub map: Map,
    /// Where the world frame lies on the Earth. With it, positions may be given as latitude, longitude and altitude.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub origin: Option<Origin>,
    /// Vertical cylinders without top and bottom: keep-out zones in the plane, such as threats and pillars.
    #[serde(default, skip_serializing_if = "Vec::is_empty")]
    pub cylinders: Vec<Cylinder>,
    /// Boxes with vertical sides, at any heading.
    #[serde(default, skip_serializing_if = "Vec::is_empty")]
    pub boxes: Vec<BoxObstacle>,
    /// Vertical prisms over convex polygons.
    #[serde(default, skip_serializing_if = "Vec::is_empty")]
    pub prisms: Vec<Prism>,
    /// Balls.
    #[serde(default, skip_serializing_if = "Vec::is_empty")]
    pub spheres: Vec<Sphere>,
    /// Straight bars with round ends, at any attitude.
    #[serde(default, skip_serializing_if = "Vec::is_empty")]
    pub capsules: Vec<Capsule>,
    /// Boxes at any attitude.
    #[serde(default, skip_serializing_if = "Vec::is_empty")]
    pub cuboids: Vec<Cuboid>,
    /// Triangle meshes from files.
    #[serde(default, skip_serializing_if = "Vec::is_empty")]
    pub meshes: Vec<Mesh>,
    /// Ground of varying height from a file.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub terrain: Option<Terrain>,
    /// Altitude of the level ground, m: a load may lie on it, an aircraft crashes into it. Absent: no ground.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub ground_m: Option<f64>,
    /// Gates that a quadrotor with a slung load must pass.
    #[serde(default, skip_serializing_if = "Vec::is_empty")]
    pub gates: Vec<Gate>,
    /// Volumes that the bodies of vehicles and loads may not leave or may not enter.
    #[serde(default, skip_serializing_if = "Vec::is_empty")]
    pub geofences: Vec<Geofence>,
    /// Moving obstacles, which multirotors must sense.
    #[serde(default, skip_serializing_if = "Vec::is_empty")]
    pub moving: Vec<MovingCylinder>,
    /// Names of the cylinders, boxes and prisms that are unknown until a part of them is within sensor range; `"*"` for all
    /// of them.
    #[serde(default, skip_serializing_if = "Vec::is_empty")]
    pub hidden: Vec<String>,
}

impl World {
    /// A map without obstacles.
    pub fn empty(map: Map) -> Self {
        Self {
            map,
            origin: None,
            cylinders: Vec::new(),
            boxes: Vec::new(),
            prisms: Vec::new(),
            spheres: Vec::new(),
            capsules: Vec::new(),
            cuboids: Vec::new(),
            meshes: Vec::new(),
            terrain: None,
            ground_m: None,
            gates: Vec::new(),
            geofences: Vec::new(),
            moving: Vec::new(),
            hidden: Vec::new(),
        }
    }

    /// Whether the static obstacle of this name is unknown until it is sensed.
    pub fn is_hidden(&self, name: &str) -> bool {
        self.hidden.iter().any(|hidden| hidden == name || hidden == EVERY_OBSTACLE)
    }

    /// What is known before the flight: no hidden and no moving obstacles.
    pub fn known_before_flight(&self) -> Self {
        self.with_static_obstacles(|name| !self.is_hidden(name))
    }

    /// The same map with the cylinders, boxes and prisms whose names are `wanted`, in the same order, and with all obstacles of
    /// other shapes at rest. None of them is hidden.
    pub fn with_static_obstacles(&self, wanted: impl Fn(&str) -> bool) -> Self {
        Self {
            origin: self.origin,
            cylinders: self.cylinders.iter().filter(|it| wanted(&it.name)).cloned().collect(),
            boxes: self.boxes.iter().filter(|it| wanted(&it.name)).cloned().collect(),
            prisms: self.prisms.iter().filter(|it| wanted(&it.name)).cloned().collect(),
            spheres: self.spheres.clone(),
            capsules: self.capsules.clone(),
            cuboids: self.cuboids.clone(),
            meshes: self.meshes.clone(),
            terrain: self.terrain.clone(),
            ground_m: self.ground_m,
            gates: self.gates.clone(),
            geofences: self.geofences.clone(),
            ..Self::empty(self.map.clone())
        }
    }

    /// The obstacles with flat faces as prisms: first the boxes, then the prisms, all with counterclockwise corners.
    pub fn prism_obstacles(&self) -> Vec<Prism> {
        let prisms = self.prisms.iter().map(Prism::counterclockwise);
        self.boxes.iter().map(BoxObstacle::as_prism).chain(prisms).collect()
    }

    /// The obstacles of other shapes at rest: spheres, capsules, cuboids, meshes, terrain.
    ///
    /// # Panics
    ///
    /// Panics if the file of a mesh or of the terrain has not been read, which [`load`](crate::load()) and [`parse`](crate::parse)
    /// exclude: an obstacle that is not there would be no obstacle to anybody.
    pub fn solids(&self) -> Vec<Solid> {
        let unread = self.unread_files();
        assert!(unread.is_empty(), "files that have not been read: {}", unread.join(", "));
        self.read_solids()
    }

    /// Whether there are obstacles of other shapes at rest.
    pub fn has_solids(&self) -> bool {
        self.obstacle_lists().into_iter().skip(UPRIGHT_LISTS).any(|(_, names)| !names.is_empty())
    }

    /// [`solids`](Self::solids) without those whose files could not be read, which is an issue of its own.
    pub(crate) fn read_solids(&self) -> Vec<Solid> {
        let closed_form = self.spheres.iter().map(Sphere::solid).chain(self.capsules.iter().map(Capsule::solid));
        let closed_form = closed_form.chain(self.cuboids.iter().map(Cuboid::solid));
        closed_form
            .chain(self.meshes.iter().filter_map(Mesh::solid))
            .chain(self.terrain.iter().filter_map(Terrain::solid))
            .collect()
    }

    /// The files that have not been read.
    fn unread_files(&self) -> Vec<&str> {
        let meshes = self.meshes.iter().filter(|mesh| mesh.surface.get().is_none()).map(|mesh| mesh.file.as_str());
        let terrain = self.terrain.iter().filter(|terrain| terrain.grid.get().is_none());
        meshes.chain(terrain.map(|terrain| terrain.file.as_str())).collect()
    }

    /// The lists of obstacles by their keys, each with the names in it: the first three may be hidden, the first four are upright.
    pub fn obstacle_lists(&self) -> [(&'static str, Vec<&str>); 9] {
        fn names<T>(list: &[T], name: fn(&T) -> &String) -> Vec<&str> {
            list.iter().map(|it| name(it).as_str()).collect()
        }
        [
            ("cylinders", names(&self.cylinders, |it| &it.name)),
            ("boxes", names(&self.boxes, |it| &it.name)),
            ("prisms", names(&self.prisms, |it| &it.name)),
            ("moving", names(&self.moving, |it| &it.name)),
            ("spheres", names(&self.spheres, |it| &it.name)),
            ("capsules", names(&self.capsules, |it| &it.name)),
            ("cuboids", names(&self.cuboids, |it| &it.name)),
            ("meshes", names(&self.meshes, |it| &it.name)),
            ("terrain", names(self.terrain.as_slice(), |it| &it.name)),
        ]
    }

    /// The names of all obstacles: cylinders, boxes, prisms, moving cylinders, then the other shapes.
    pub fn obstacle_names(&self) -> impl Iterator<Item = &str> {
        self.obstacle_lists().into_iter().flat_map(|(_, names)| names)
    }

    /// The names of the obstacles that may be hidden: cylinders, boxes and prisms.
    pub fn names_that_may_be_hidden(&self) -> impl Iterator<Item = &str> {
        self.obstacle_lists().into_iter().take(LISTS_THAT_MAY_BE_HIDDEN).flat_map(|(_, names)| names)
    }
}

/// An axis-aligned box in the world frame.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields)]
pub struct Map {
    /// West and east limit, m.
    pub x_m: Range,
    /// South and north limit, m.
    pub y_m: Range,
    /// Lowest and highest altitude, m.
    pub z_m: Range,
}

impl Map {
    /// The limits in the order x, y, z.
    pub fn axes(&self) -> [Range; 3] {
        [self.x_m, self.y_m, self.z_m]
    }

    /// The map without a border of this width, m: where the centre of a ball of this radius may be.
    pub fn inset(&self, radius_m: f64) -> Self {
        let [x_m, y_m, z_m] = self.axes().map(|range| Range::new(range.min + radius_m, range.max - radius_m));
        Self { x_m, y_m, z_m }
    }
}

/// A vertical cylinder, unbounded upwards and downwards.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields)]
pub struct Cylinder {
    /// Name, unique among all obstacles.
    pub name: String,
    /// Axis, (x, y) in m.
    pub center_m: [f64; 2],
    /// Radius, m, > 0.
    pub radius_m: f64,
}

impl Cylinder {
    /// Signed horizontal distance from a point to the surface, m; negative inside.
    pub fn signed_distance_m(&self, x_m: f64, y_m: f64) -> f64 {
        (x_m - self.center_m[0]).hypot(y_m - self.center_m[1]) - self.radius_m
    }
}
