use schemars::JsonSchema;
use serde::{Deserialize, Serialize};

use crate::geometry::{Loaded, Solid, Surface, TerrainGrid};

/// Name of a terrain that is given none.
const TERRAIN: &str = "terrain";

/// A ball at rest.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields)]
pub struct Sphere {
    /// Name, unique among all obstacles.
    pub name: String,
    /// Centre (x, y, z), m.
    pub center_m: [f64; 3],
    /// Radius, m, > 0.
    pub radius_m: f64,
}

/// Everything within a radius of a straight line, such as a cable, a boom or a mast.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields)]
pub struct Capsule {
    /// Name, unique among all obstacles.
    pub name: String,
    /// Ends (x, y, z) of the line, m.
    pub ends_m: [[f64; 3]; 2],
    /// Radius, m, > 0.
    pub radius_m: f64,
}

/// A box at any attitude.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields)]
pub struct Cuboid {
    /// Name, unique among all obstacles.
    pub name: String,
    /// Centre (x, y, z), m.
    pub center_m: [f64; 3],
    /// Lengths along its own axes x, y, z, m, each > 0.
    pub size_m: [f64; 3],
    /// Roll, pitch and yaw of its own axes, deg: about x, then about the fixed y, then about the fixed z.
    #[serde(default)]
    pub rotation_deg: [f64; 3],
}

/// A triangle mesh from a file: STL (binary or text) or OBJ.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields)]
pub struct Mesh {
    /// Name, unique among all obstacles.
    pub name: String,
    /// The file, `.stl` or `.obj`, relative to the folder of the scenario file.
    pub file: String,
    /// Factor from the units of the file to metres, > 0: 0.001 for a file in millimetres.
    #[serde(default = "unscaled")]
    pub scale: f64,
    /// Roll, pitch and yaw, deg: about x, then about the fixed y, then about the fixed z, after scaling.
    #[serde(default)]
    pub rotation_deg: [f64; 3],
    /// Where the origin of the file comes to lie (x, y, z), m.
    #[serde(default)]
    pub offset_m: [f64; 3],
    /// Its triangles in the world frame, read with the scenario.
    #[serde(skip)]
    pub surface: Loaded<Surface>,
}

/// Ground of varying height, from an ESRI ASCII grid. It must cover the map. Everything below it is solid.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields)]
pub struct Terrain {
    /// Name, unique among all obstacles.
    #[serde(default = "terrain")]
    pub name: String,
    /// The file, `.asc`, relative to the folder of the scenario file. Heights in m at the corners of triangles.
    pub file: String,
    /// Added to the coordinates (x, y, z) of the file, m: from a map projection to the world frame.
    #[serde(default)]
    pub offset_m: [f64; 3],
    /// Its heights in the world frame, read with the scenario.
    #[serde(skip)]
    pub grid: Loaded<TerrainGrid>,
}

impl Sphere {
    /// Its geometry.
    pub fn solid(&self) -> Solid {
        Solid::ball(&self.name, self.center_m, self.radius_m)
    }
}

impl Capsule {
    /// Its geometry.
    pub fn solid(&self) -> Solid {
        Solid::capsule(&self.name, self.ends_m, self.radius_m)
    }
}

impl Cuboid {
    /// Its geometry.
    pub fn solid(&self) -> Solid {
        Solid::cuboid(&self.name, self.center_m, self.size_m, self.rotation_deg.map(f64::to_radians))
    }
}

impl Mesh {
    /// Its geometry; `None` if its file has not been read.
    pub fn solid(&self) -> Option<Solid> {
        Some(Solid::mesh(&self.name, self.surface.get()?))
    }
}

impl Terrain {
    /// Its geometry; `None` if its file has not been read.
    pub fn solid(&self) -> Option<Solid> {
        Some(Solid::terrain(&self.name, self.grid.get()?))
    }
}

fn unscaled() -> f64 {
    1.0
}

fn terrain() -> String {
    TERRAIN.to_owned()
}
