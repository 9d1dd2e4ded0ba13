//! The mesh of an aircraft: fuselage, wings, tailplane, fin. Body frame x forward, y left, z up; wing span 1.

use super::super::{Paint, Triangles};

type Point = [f64; 3];

/// Fuselage: nose, waist in a ring, tail.
const NOSE: Point = [0.52, 0.0, 0.0];
const TAIL: Point = [-0.5, 0.0, 0.04];
const WAIST: [Point; 4] = [[0.22, 0.075, 0.0], [0.22, 0.0, 0.075], [0.22, -0.075, 0.0], [0.22, 0.0, -0.06]];

/// Flat surfaces as leading root, leading tip, trailing tip, trailing root. Left side; the right one is its mirror image.
const WING: [Point; 4] = [[0.24, 0.0, 0.0], [0.0, 0.5, 0.04], [-0.12, 0.5, 0.04], [-0.08, 0.0, 0.0]];
const TAILPLANE: [Point; 4] = [[-0.3, 0.0, 0.04], [-0.44, 0.19, 0.05], [-0.52, 0.19, 0.05], [-0.5, 0.0, 0.04]];
const FIN: [Point; 4] = [[-0.26, 0.0, 0.05], [-0.46, 0.0, 0.24], [-0.54, 0.0, 0.24], [-0.5, 0.0, 0.04]];

/// The mesh with wing span `span_m`, in one colour.
pub(super) fn mesh(span_m: f64, colour: [u8; 3]) -> Triangles {
    let unit_triangles = triangles();
    let scaled = |triangle: &[Point; 3]| triangle.map(|corner| corner.map(|x| x * span_m));
    Triangles {
        triangles: unit_triangles.iter().map(scaled).collect(),
        normals: unit_triangles.iter().map(normal).collect(),
        paint: Paint::opaque(colour),
    }
}

fn triangles() -> Vec<[Point; 3]> {
    let ring = (0..4).map(|i| (WAIST[i], WAIST[(i + 1) % 4]));
    let fuselage = ring.flat_map(|(a, b)| [[NOSE, a, b], [TAIL, b, a]]);
    let surfaces = [WING, WING.map(mirrored), TAILPLANE, TAILPLANE.map(mirrored), FIN];
    fuselage.chain(surfaces.into_iter().flat_map(|[a, b, c, d]| [[a, b, c], [a, c, d]])).collect()
}

fn mirrored([x, y, z]: Point) -> Point {
    [x, -y, z]
}

/// Unit normal of a triangle, pointing upwards, so that flat surfaces are lit from above whatever the order of their corners.
fn normal([a, b, c]: &[Point; 3]) -> Point {
    let u: Point = std::array::from_fn(|i| b[i] - a[i]);
    let v: Point = std::array::from_fn(|i| c[i] - a[i]);
    let cross = [u[1] * v[2] - u[2] * v[1], u[2] * v[0] - u[0] * v[2], u[0] * v[1] - u[1] * v[0]];
    let length = cross.iter().map(|x| x * x).sum::<f64>().sqrt();
    let upwards = if cross[2] < 0.0 { -1.0 } else { 1.0 };
    cross.map(|x| upwards * x / length)
}

#[cfg(test)]
mod tests {
    use super::{normal, triangles};

    #[test]
    fn the_mesh_is_symmetric_with_span_one_and_no_degenerate_triangle() {
        let triangles = triangles();
        let y = || triangles.iter().flatten().map(|corner| corner[1]);
        assert_eq!(y().fold(f64::MAX, f64::min), -0.5);
        assert_eq!(y().fold(f64::MIN, f64::max), 0.5);
        for triangle in &triangles {
            let length = normal(triangle).iter().map(|x| x * x).sum::<f64>().sqrt();
            assert!((length - 1.0).abs() < 1e-12, "{triangle:?} has no area");
        }
    }
}
