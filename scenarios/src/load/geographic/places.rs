//! Where a scenario file may hold positions on the Earth.

use serde_json::Value;

use super::{Table, pair, pairs};

/// A table with a position.
pub(super) struct Place {
    /// Path of the tables; `[]` is every element of an array.
    pub path: &'static str,
    /// Name of their type in the JSON Schema.
    pub definition: &'static str,
    /// Stem of the key: `center` of `center_m` and `center_deg`.
    pub key: &'static str,
    pub shape: Shape,
    /// Whether `altitude_m` may stand for a band `z_m`.
    pub has_band: bool,
}

/// The form of a position.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(super) enum Shape {
    /// `x_m`, `y_m`, `z_m` in a table.
    Point,
    /// Two coordinates.
    Pair,
    /// Three coordinates.
    Triple,
    /// A list of pairs.
    Pairs,
    /// Two triples.
    Triples,
    /// The boundaries of a geofence, also from a GeoJSON file.
    Polygons,
}

pub(super) const PLACES: [Place; 14] = [
    place("vehicles[].start", "Waypoint", "", Shape::Point, false),
    place("vehicles[].goal", "Waypoint", "", Shape::Point, false),
    place("vehicles[].via[]", "ViaPoint", "", Shape::Point, false),
    place("vehicles[].start.load", "LoadPoint", "", Shape::Point, false),
    place("vehicles[].goal.load", "LoadPoint", "", Shape::Point, false),
    place("world.cylinders[]", "Cylinder", "center", Shape::Pair, false),
    place("world.boxes[]", "BoxObstacle", "center", Shape::Pair, true),
    place("world.prisms[]", "Prism", "corners", Shape::Pairs, true),
    place("world.moving[]", "MovingCylinder", "path", Shape::Pairs, true),
    place("world.spheres[]", "Sphere", "center", Shape::Triple, false),
    place("world.capsules[]", "Capsule", "ends", Shape::Triples, false),
    place("world.cuboids[]", "Cuboid", "center", Shape::Triple, false),
    place("world.meshes[]", "Mesh", "offset", Shape::Triple, false),
    place("world.geofences[]", "Geofence", "polygon", Shape::Polygons, true),
];

const fn place(path: &'static str, definition: &'static str, key: &'static str, shape: Shape, has_band: bool) -> Place {
    Place { path, definition, key, shape, has_band }
}

impl Place {
    /// The key in degrees.
    pub fn degrees(&self) -> String {
        format!("{}_deg", self.key)
    }

    /// The key in metres.
    pub fn metres(&self) -> String {
        format!("{}_m", self.key)
    }

    /// Puts a position in metres in the place of that in degrees.
    pub fn replace(&self, table: &mut Table, position_m: impl Into<Value>) {
        table.remove(&self.degrees());
        table.insert(self.metres(), position_m.into());
    }

    /// Two keys that give the same coordinate.
    pub fn given_twice(&self, table: &Table) -> Option<(String, String)> {
        let (degrees, metres) = (self.degrees(), self.metres());
        let pairs: &[(&str, &str)] = match self.shape {
            Shape::Point => &[("latitude_deg", "x_m"), ("longitude_deg", "y_m"), ("altitude_m", "z_m")],
            Shape::Pair | Shape::Pairs => &[(&degrees, &metres), ("altitude_m", "z_m")],
            Shape::Triple | Shape::Triples => {
                &[(&degrees, &metres), ("altitude_m", &metres), ("z_m", &metres), ("altitude_m", "z_m")]
            }
            Shape::Polygons => &[(&degrees, &metres), ("file", &metres), ("file", &degrees), ("altitude_m", "z_m")],
        };
        let both = pairs.iter().find(|(a, b)| table.contains_key(*a) && table.contains_key(*b));
        both.map(|(a, b)| ((*a).to_owned(), (*b).to_owned()))
    }

    /// Points (x, y), m, whose convex hull holds the outline of an obstacle or a volume, after its conversion.
    pub fn outline_m(&self, table: &Table) -> Vec<[f64; 2]> {
        let metres = table.get(&self.metres());
        let corners_m = pairs(metres).or_else(|| pair(metres).map(|it| vec![it])).unwrap_or_default();
        let rings = table.get("rings_m").and_then(Value::as_array).into_iter().flatten();
        let corners_m = corners_m.into_iter().chain(rings.filter_map(|ring| pairs(Some(ring))).flatten());
        let half_size_m = pair(table.get("size_m")).map_or(0.0, |[length_m, width_m]| length_m.hypot(width_m) / 2.0);
        let reach_m = table.get("radius_m").and_then(Value::as_f64).unwrap_or(0.0).max(half_size_m);
        corners_m.flat_map(|it| square(it, reach_m)).collect()
    }
}

/// Corners of the square around a circle.
fn square([x_m, y_m]: [f64; 2], radius_m: f64) -> [[f64; 2]; 4] {
    [[-1.0, -1.0], [1.0, -1.0], [1.0, 1.0], [-1.0, 1.0]].map(|[x, y]| [x_m + x * radius_m, y_m + y * radius_m])
}
