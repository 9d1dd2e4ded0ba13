use std::collections::HashMap;
use std::sync::OnceLock;

use parry3d_f64::bounding_volume::Aabb;
use parry3d_f64::math::Vector;
use parry3d_f64::query::{PointQuery, PointQueryWithLocation};
use parry3d_f64::shape::{TriMesh, TriMeshFlags, Triangle};
use thiserror::Error;

use super::NearestPoint;
use super::round::{cross, difference, dot, norm};

/// Why triangles are no surface.
#[derive(Clone, Debug, PartialEq, Eq, Error)]
pub enum SurfaceError {
    /// There are no triangles, or all of them are degenerate.
    #[error("no triangle with an area")]
    NoArea,
    /// A triangle refers to a corner that does not exist.
    #[error("a triangle with corner {index} of {count} (counted from 0)")]
    NoCorner {
        /// Index of the corner.
        index: u32,
        /// Number of corners.
        count: usize,
    },
    /// parry cannot build its hierarchy, for this reason.
    #[error("{0}")]
    Rejected(String),
}

/// A surface of triangles. If it is closed, it has an inside; otherwise distances are to the surface, from both sides.
#[derive(Clone)]
pub struct Surface {
    mesh: TriMesh,
    is_closed: bool,
    /// Boxes that contain it, computed when they are first asked for.
    enclosure: OnceLock<Vec<[[f64; 3]; 2]>>,
}

impl Surface {
    /// The surface of these triangles. Corners at exactly the same place are one. Triangles without area are left out. A
    /// closed surface that is inside out is turned.
    ///
    /// - `corners_m`: finite
    /// - `triangles`: indices of corners
    ///
    /// # Errors
    ///
    /// No triangle has an area, or an index is out of range.
    pub fn new(corners_m: &[[f64; 3]], triangles: &[[u32; 3]]) -> Result<Self, SurfaceError> {
        if let Some(&index) = triangles.iter().flatten().find(|index| **index as usize >= corners_m.len()) {
            return Err(SurfaceError::NoCorner { index, count: corners_m.len() });
        }
        let (corners_m, mut triangles) = merged(corners_m, triangles);
        triangles.retain(|[a, b, c]| a != b && b != c && a != c);
        let is_manifold = has_each_edge_once_in_each_direction(&triangles);
        let count = triangles.len();
        triangles.retain(|triangle| doubled_area_m2(&corners_m, *triangle) > 0.0);
        if triangles.is_empty() {
            return Err(SurfaceError::NoArea);
        }
        // The sign of the distance comes from the normals of adjacent triangles, which slivers do not have.
        let is_closed = is_manifold && triangles.len() == count;
        if is_closed && volume_m3(&corners_m, &triangles) < 0.0 {
            triangles.iter_mut().for_each(|triangle| triangle.swap(1, 2));
        }
        let flags = if is_closed { TriMeshFlags::ORIENTED } else { TriMeshFlags::empty() };
        let corners_m = corners_m.iter().map(|[x, y, z]| Vector::new(*x, *y, *z)).collect();
        let mesh = TriMesh::with_flags(corners_m, triangles, flags)
            .map_err(|error| SurfaceError::Rejected(error.to_string()))?;
        Ok(Self { mesh, is_closed, enclosure: OnceLock::new() })
    }

    /// Whether every edge joins two triangles of the same orientation, so that there is an inside.
    pub fn is_closed(&self) -> bool {
        self.is_closed
    }

    /// Number of triangles.
    pub fn triangle_count(&self) -> usize {
        self.mesh.num_triangles()
    }

    /// Smallest and largest coordinates, m.
    pub fn bounds_m(&self) -> [[f64; 3]; 2] {
        let bounds = self.mesh.local_aabb();
        [bounds.mins, bounds.maxs].map(|corner| [corner.x, corner.y, corner.z])
    }

    /// Its triangles, m.
    pub fn triangles(&self) -> impl Iterator<Item = [[f64; 3]; 3]> + '_ {
        self.mesh.triangles().map(|Triangle { a, b, c }| [a, b, c].map(|corner| [corner.x, corner.y, corner.z]))
    }

    /// The triangles that reach into a cube around a point, m.
    pub(super) fn triangles_in_box(&self, [x, y, z]: [f64; 3], half_m: f64) -> Vec<[[f64; 3]; 3]> {
        let (center, half) = (Vector::new(x, y, z), Vector::splat(half_m));
        let bounds = Aabb::new(center - half, center + half);
        let triangles = self.mesh.bvh().intersect_aabb(&bounds).map(|index| self.mesh.triangle(index));
        triangles.map(|Triangle { a, b, c }| [a, b, c].map(|corner| [corner.x, corner.y, corner.z])).collect()
    }

    /// Boxes that contain it, as `compute` finds them at the first call.
    pub(super) fn enclosure(&self, compute: impl FnOnce() -> Vec<[[f64; 3]; 2]>) -> &[[[f64; 3]; 2]] {
        self.enclosure.get_or_init(compute)
    }

    /// The nearest point, by parry's bounding volume hierarchy. The sign of the distance is that of the angle-weighted
    /// pseudonormal there.                                                                      [Bærentzen & Aanæs 2005]
    pub(super) fn nearest(&self, [x, y, z]: [f64; 3]) -> NearestPoint {
        let point = Vector::new(x, y, z);
        let (projection, _) = self.mesh.project_local_point_and_get_location(point, false);
        let distance_m = (point - projection.point).length();
        let is_inside = self.is_closed && projection.is_inside;
        NearestPoint {
            signed_distance_m: if is_inside { -distance_m } else { distance_m },
            point_m: [projection.point.x, projection.point.y, projection.point.z],
        }
    }

    /// How often the surface winds around a point: 1 inside a closed one, 0 outside, a fraction where it has holes.
    ///
    /// ```text
    /// w = 1/4π Σ Ω,   tan(Ω/2) = a·(b×c) / (|a||b||c| + (a·b)|c| + (b·c)|a| + (c·a)|b|)   [Van Oosterom & Strackee 1983]
    /// ```
    pub(super) fn winding_number(&self, point_m: [f64; 3]) -> f64 {
        let [min_m, max_m] = self.bounds_m();
        if (0..3).any(|axis| point_m[axis] < min_m[axis] || point_m[axis] > max_m[axis]) {
            // From outside of the hull, at most half of the directions meet the surface.
            return 0.0;
        }
        let solid_angle = |triangle: [[f64; 3]; 3]| {
            let [a, b, c] = triangle.map(|corner| difference(corner, point_m));
            let (la, lb, lc) = (norm(a), norm(b), norm(c));
            let cosine = la * lb * lc + dot(a, b) * lc + dot(b, c) * la + dot(c, a) * lb;
            2.0 * dot(a, cross(b, c)).atan2(cosine)
        };
        self.triangles().map(solid_angle).sum::<f64>() / (4.0 * std::f64::consts::PI)
    }
}

impl std::fmt::Debug for Surface {
    fn fmt(&self, f: &mut std::fmt::Formatter<'_>) -> std::fmt::Result {
        write!(f, "Surface({} triangles, closed: {})", self.triangle_count(), self.is_closed)
    }
}

/// The point of a triangle that is nearest to a point, m.
pub(super) fn nearest_of_triangle(corners_m: [[f64; 3]; 3], [x, y, z]: [f64; 3]) -> [f64; 3] {
    let [a, b, c] = corners_m.map(|[x, y, z]| Vector::new(x, y, z));
    let nearest = Triangle::new(a, b, c).project_local_point(Vector::new(x, y, z), false).point;
    [nearest.x, nearest.y, nearest.z]
}

/// The same triangles with one corner at every place.
fn merged(corners_m: &[[f64; 3]], triangles: &[[u32; 3]]) -> (Vec<[f64; 3]>, Vec<[u32; 3]>) {
    let mut places: HashMap<[u64; 3], u32> = HashMap::with_capacity(corners_m.len());
    let mut unique_m = Vec::new();
    let index_of = |corner_m: &[f64; 3]| {
        // 0.0 and -0.0 are the same place.
        *places.entry(corner_m.map(|it| (it + 0.0).to_bits())).or_insert_with(|| {
            unique_m.push(*corner_m);
            unique_m.len() as u32 - 1
        })
    };
    let indices: Vec<u32> = corners_m.iter().map(index_of).collect();
    let triangles = triangles.iter().map(|triangle| triangle.map(|corner| indices[corner as usize])).collect();
    (unique_m, triangles)
}

/// Whether the triangles form a closed surface with one orientation.
fn has_each_edge_once_in_each_direction(triangles: &[[u32; 3]]) -> bool {
    let mut edges: Vec<[u32; 2]> = triangles.iter().flat_map(|&[a, b, c]| [[a, b], [b, c], [c, a]]).collect();
    edges.sort_unstable();
    let is_unique = edges.windows(2).all(|pair| pair[0] != pair[1]);
    is_unique && edges.iter().all(|&[a, b]| edges.binary_search(&[b, a]).is_ok())
}

fn doubled_area_m2(corners_m: &[[f64; 3]], triangle: [u32; 3]) -> f64 {
    let [a, b, c] = triangle.map(|corner| corners_m[corner as usize]);
    norm(cross(difference(b, a), difference(c, a)))
}

/// The volume inside a closed surface, negative if it is inside out.
fn volume_m3(corners_m: &[[f64; 3]], triangles: &[[u32; 3]]) -> f64 {
    let origin_m = corners_m[triangles[0][0] as usize];
    let signed = |triangle: &[u32; 3]| {
        let [a, b, c] = triangle.map(|corner| difference(corners_m[corner as usize], origin_m));
        dot(a, cross(b, c)) / 6.0
    };
    triangles.iter().map(signed).sum()
}
