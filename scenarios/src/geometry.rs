//! Obstacles of any shape at rest: balls, capsules, boxes at any attitude, triangle meshes, terrain.
//!
//! Judge, simulator and recordings ask a [`Solid`] and never its shape. The signed distance from a point is exact up to
//! rounding ([`ROUNDING`]) and changes by no more than the point moves, which is what a search over continuous time
//! needs. Only this module uses parry: its bounding volume hierarchy and its projection of points on triangles.

mod convex_piece;
mod enclosure;
mod files;
mod placement;
mod round;
mod surface;
mod terrain_grid;

use std::fmt;
use std::sync::Arc;

pub use convex_piece::ConvexPiece;
pub(crate) use files::{FileError, read_mesh, read_terrain};
pub(crate) use placement::Placement;
pub use surface::{Surface, SurfaceError};
pub use terrain_grid::TerrainGrid;

/// Error of a signed distance by rounding, as a fraction of the largest coordinate. Measured on random meshes: below 1e-14.
pub const ROUNDING: f64 = 1e-13;

/// An obstacle of any shape, at rest.
#[derive(Clone, Debug)]
pub struct Solid {
    name: String,
    shape: Shape,
}

#[derive(Clone, Debug)]
enum Shape {
    Ball { center_m: [f64; 3], radius_m: f64 },
    Capsule { ends_m: [[f64; 3]; 2], radius_m: f64 },
    Cuboid { placement: Placement, half_size_m: [f64; 3] },
    Mesh(Arc<Surface>),
    Terrain(Arc<TerrainGrid>),
}

/// The point of a surface that is nearest to a point.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct NearestPoint {
    /// Distance from the surface, m; negative inside. NaN if the point is not finite.
    pub signed_distance_m: f64,
    /// The nearest point of the surface, m.
    pub point_m: [f64; 3],
}

impl NearestPoint {
    /// The unit vector along which the signed distance grows fastest; `None` on the surface.
    pub fn outward(&self, from_m: [f64; 3]) -> Option<[f64; 3]> {
        let distance_m = self.signed_distance_m;
        (distance_m != 0.0).then(|| std::array::from_fn(|axis| (from_m[axis] - self.point_m[axis]) / distance_m))
    }
}

impl Solid {
    pub(crate) fn ball(name: &str, center_m: [f64; 3], radius_m: f64) -> Self {
        Self { name: name.to_owned(), shape: Shape::Ball { center_m, radius_m } }
    }

    pub(crate) fn capsule(name: &str, ends_m: [[f64; 3]; 2], radius_m: f64) -> Self {
        Self { name: name.to_owned(), shape: Shape::Capsule { ends_m, radius_m } }
    }

    pub(crate) fn cuboid(name: &str, center_m: [f64; 3], size_m: [f64; 3], rotation_rad: [f64; 3]) -> Self {
        let placement = Placement::new(1.0, rotation_rad, center_m);
        Self { name: name.to_owned(), shape: Shape::Cuboid { placement, half_size_m: size_m.map(|size| size / 2.0) } }
    }

    pub(crate) fn mesh(name: &str, surface: Arc<Surface>) -> Self {
        Self { name: name.to_owned(), shape: Shape::Mesh(surface) }
    }

    pub(crate) fn terrain(name: &str, grid: Arc<TerrainGrid>) -> Self {
        Self { name: name.to_owned(), shape: Shape::Terrain(grid) }
    }

    /// Its name.
    pub fn name(&self) -> &str {
        &self.name
    }

    /// What it is, in words: `a mesh`.
    pub fn kind(&self) -> &'static str {
        match self.shape {
            Shape::Ball { .. } => "a sphere",
            Shape::Capsule { .. } => "a capsule",
            Shape::Cuboid { .. } => "a cuboid",
            Shape::Mesh(_) => "a mesh",
            Shape::Terrain(_) => "a terrain",
        }
    }

    /// Whether it is terrain, below which everything is solid.
    pub fn is_terrain(&self) -> bool {
        matches!(self.shape, Shape::Terrain(_))
    }

    /// The heights of a terrain; `None` of other shapes.
    pub fn terrain_grid(&self) -> Option<&TerrainGrid> {
        match &self.shape {
            Shape::Terrain(grid) => Some(grid),
            _ => None,
        }
    }

    /// The nearest point of its surface, and the signed distance from it. A mesh that is not closed has no inside.
    pub fn nearest(&self, point_m: [f64; 3]) -> NearestPoint {
        if !point_m.iter().all(|coordinate| coordinate.is_finite()) {
            return NearestPoint { signed_distance_m: f64::NAN, point_m };
        }
        match &self.shape {
            Shape::Ball { center_m, radius_m } => round::to_ball(point_m, *center_m, *radius_m),
            Shape::Capsule { ends_m, radius_m } => round::to_capsule(point_m, *ends_m, *radius_m),
            Shape::Cuboid { placement, half_size_m } => {
                let local = round::to_box(placement.to_local(point_m), *half_size_m);
                NearestPoint { point_m: placement.to_world(local.point_m), ..local }
            }
            Shape::Mesh(surface) => surface.nearest(point_m),
            Shape::Terrain(grid) => grid.nearest(point_m),
        }
    }

    /// Signed distance from a point to its surface, m; negative inside.
    pub fn signed_distance_m(&self, point_m: [f64; 3]) -> f64 {
        self.nearest(point_m).signed_distance_m
    }

    /// Whether a point is enclosed, also by a mesh that intersects itself or has small holes: there, if the surface fills more
    /// than half of the directions as seen from the point.
    pub fn encloses(&self, point_m: [f64; 3]) -> bool {
        match &self.shape {
            Shape::Mesh(surface) => surface.winding_number(point_m).abs() > 0.5,
            _ => self.signed_distance_m(point_m) < 0.0,
        }
    }

    /// Triangles of its surface, m, for drawing: balls and capsules as polyhedra.
    ///
    /// - `max_count`: of a terrain with more triangles, a coarser grid is drawn
    pub fn triangles(&self, max_count: usize) -> Vec<[[f64; 3]; 3]> {
        match &self.shape {
            Shape::Ball { center_m, radius_m } => round::capsule_triangles([*center_m; 2], *radius_m),
            Shape::Capsule { ends_m, radius_m } => round::capsule_triangles(*ends_m, *radius_m),
            Shape::Cuboid { placement, half_size_m } => {
                let to_world = |triangle: [[f64; 3]; 3]| triangle.map(|corner| placement.to_world(corner));
                round::box_triangles(*half_size_m).into_iter().map(to_world).collect()
            }
            Shape::Mesh(surface) => surface.triangles().collect(),
            Shape::Terrain(grid) => grid.triangles(max_count),
        }
    }
}

/// What was read from a file beside the scenario. Two are equal: the fields of the scenario say which file it is.
#[derive(Clone)]
pub struct Loaded<T>(Option<Arc<T>>);

impl<T> Loaded<T> {
    /// The content of a file.
    pub fn new(content: T) -> Self {
        Self(Some(Arc::new(content)))
    }

    /// The content; `None` if the file has not been read.
    pub fn get(&self) -> Option<Arc<T>> {
        self.0.clone()
    }
}

impl<T> Default for Loaded<T> {
    fn default() -> Self {
        Self(None)
    }
}

impl<T> PartialEq for Loaded<T> {
    fn eq(&self, _: &Self) -> bool {
        true
    }
}

impl<T> fmt::Debug for Loaded<T> {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        f.write_str(if self.0.is_some() { "Loaded" } else { "NotLoaded" })
    }
}

#[cfg(test)]
mod tests;
