use super::round::norm;
use super::surface::nearest_of_triangle;
use super::{Shape, Solid};

/// A convex piece of a solid or of its surface: everything within a radius of the convex hull of its corners.
#[derive(Clone, Debug, PartialEq)]
pub struct ConvexPiece {
    /// Corners of the hull, m: one of a ball, two of a capsule, three of a triangle, eight of a cuboid.
    pub corners_m: Vec<[f64; 3]>,
    /// Radius, m; 0 of flat-faced pieces.
    pub radius_m: f64,
}

impl Solid {
    /// The pieces within reach of a point, for shapes that are larger than a point: those of a mesh or a terrain are its
    /// triangles, any other shape is one piece, near or not.
    ///
    /// - `reach_m`: no nearer piece is left out than this
    pub fn convex_pieces(&self, point_m: [f64; 3], reach_m: f64) -> Vec<ConvexPiece> {
        let whole = |corners_m: Vec<[f64; 3]>, radius_m: f64| vec![ConvexPiece { corners_m, radius_m }];
        let is_near = |triangle: &[[f64; 3]; 3]| {
            let nearest_m = nearest_of_triangle(*triangle, point_m);
            norm(std::array::from_fn(|axis| nearest_m[axis] - point_m[axis])) <= reach_m
        };
        let triangles = match &self.shape {
            Shape::Ball { center_m, radius_m } => return whole(vec![*center_m], *radius_m),
            Shape::Capsule { ends_m, radius_m } => return whole(ends_m.to_vec(), *radius_m),
            Shape::Cuboid { placement, half_size_m } => {
                let corner =
                    |bits: usize| std::array::from_fn(|axis| half_size_m[axis] * [-1.0, 1.0][bits >> axis & 1]);
                return whole((0..8).map(|bits| placement.to_world(corner(bits))).collect(), 0.0);
            }
            Shape::Mesh(surface) => surface.triangles_in_box(point_m, reach_m),
            Shape::Terrain(grid) => grid.triangles_in_box(point_m, reach_m),
        };
        let piece = |triangle: [[f64; 3]; 3]| ConvexPiece { corners_m: triangle.to_vec(), radius_m: 0.0 };
        triangles.into_iter().filter(is_near).map(piece).collect()
    }
}
