//! Obstacles of any shape, as triangles; terrain in bands of height.

use scenarios::World;
use scenarios::geometry::Solid;

use super::{Paint, Scene, Triangles, colours, norm};

/// A terrain with more triangles is drawn on a coarser grid.
const MAX_TERRAIN_TRIANGLES: usize = 10_000;
/// Of a larger mesh, the largest triangles are drawn: recordings and pages stay readable.
const MAX_MESH_TRIANGLES: usize = 20_000;
/// Number of colours of a terrain.
const BANDS: usize = 8;

/// Adds all of them.
pub(super) fn add(scene: &mut Scene<'_>, world: &World) {
    for solid in world.solids() {
        if solid.is_terrain() {
            add_terrain(scene, &solid);
        } else {
            let triangles = largest(solid.triangles(MAX_MESH_TRIANGLES), MAX_MESH_TRIANGLES);
            scene.add_item(&["obstacles", solid.name()], shape(triangles, Paint::translucent(colours::OBSTACLE, 0.5)));
        }
    }
}

/// One shape for each band of height, from dark valleys to bright peaks.
fn add_terrain(scene: &mut Scene<'_>, solid: &Solid) {
    let triangles = solid.triangles(MAX_TERRAIN_TRIANGLES);
    let height_m = |triangle: &[[f64; 3]; 3]| triangle.iter().map(|corner| corner[2]).sum::<f64>() / 3.0;
    let heights_m = || triangles.iter().map(height_m);
    let (low_m, high_m) = (heights_m().fold(f64::INFINITY, f64::min), heights_m().fold(f64::NEG_INFINITY, f64::max));
    let mut bands = vec![Vec::new(); BANDS];
    for triangle in &triangles {
        let fraction = (height_m(triangle) - low_m) / (high_m - low_m).max(f64::MIN_POSITIVE);
        bands[((fraction * BANDS as f64) as usize).min(BANDS - 1)].push(*triangle);
    }
    for (index, band) in bands.into_iter().enumerate().filter(|(_, band)| !band.is_empty()) {
        let paint = Paint::opaque(colours::terrain((index as f64 + 0.5) / BANDS as f64));
        scene.add_item(&["obstacles", solid.name(), &format!("band-{index}")], shape(band, paint));
    }
}

fn shape(triangles: Vec<[[f64; 3]; 3]>, paint: Paint) -> Triangles {
    let normals = triangles.iter().map(scaled_normal).map(|it| it.map(|axis| axis / norm(it).max(f64::MIN_POSITIVE)));
    Triangles { normals: normals.collect(), triangles, paint }
}

/// The largest of the triangles, in their order.
fn largest(triangles: Vec<[[f64; 3]; 3]>, max_count: usize) -> Vec<[[f64; 3]; 3]> {
    if triangles.len() <= max_count {
        return triangles;
    }
    let area = |triangle: &[[f64; 3]; 3]| norm(scaled_normal(triangle));
    let mut areas: Vec<f64> = triangles.iter().map(area).collect();
    areas.sort_by(|a, b| b.total_cmp(a));
    let mut rest = max_count;
    let mut is_drawn = |triangle: &[[f64; 3]; 3]| {
        let is_large = area(triangle) >= areas[max_count - 1] && rest > 0;
        rest -= usize::from(is_large);
        is_large
    };
    triangles.into_iter().filter(|triangle| is_drawn(triangle)).collect()
}

/// Perpendicular to a triangle, as long as twice its area.
fn scaled_normal([a, b, c]: &[[f64; 3]; 3]) -> [f64; 3] {
    let [u, v]: [[f64; 3]; 2] = [b, c].map(|corner| std::array::from_fn(|axis| corner[axis] - a[axis]));
    [u[1] * v[2] - u[2] * v[1], u[2] * v[0] - u[0] * v[2], u[0] * v[1] - u[1] * v[0]]
}
