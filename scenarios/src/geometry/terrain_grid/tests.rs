use super::TerrainGrid;
use crate::geometry::round::{difference, norm};
use crate::geometry::surface::nearest_of_triangle;
use rand::RngExt;

fn rugged(size: [usize; 2]) -> TerrainGrid {
    let mut rng = crate::stream(7, "terrain");
    let heights_m = (0..size[0] * size[1]).map(|_| rng.random_range(0.0..40.0)).collect();
    TerrainGrid::new([-20.0, 5.0], 3.0, size, heights_m)
}

/// The nearest point of all triangles, without the pyramid, and the sign by the height.
#[test]
fn the_pyramid_finds_what_a_search_of_all_triangles_finds() {
    for size in [[2, 2], [9, 4], [17, 23]] {
        let grid = rugged(size);
        let mut rng = crate::stream(8, "points");
        for _ in 0..500 {
            let point_m =
                [rng.random_range(-40.0..60.0), rng.random_range(-20.0..100.0), rng.random_range(-20.0..90.0)];
            let to_triangle = |it: [[f64; 3]; 3]| norm(difference(point_m, nearest_of_triangle(it, point_m)));
            let expected_m = grid.triangles(usize::MAX).into_iter().map(to_triangle).fold(f64::INFINITY, f64::min);
            let found = grid.nearest(point_m);
            assert!((found.signed_distance_m.abs() - expected_m).abs() < 1e-12, "{point_m:?}: {found:?}");
            let is_below = grid.height_m(point_m[0], point_m[1]).is_some_and(|height_m| point_m[2] < height_m);
            assert_eq!(found.signed_distance_m < 0.0, is_below);
        }
    }
}

#[test]
fn a_slope_is_as_far_as_geometry_says() {
    // z = x, so that the distance is the height over it, times cos 45°.
    let heights_m = (0..12).map(|index| f64::from(index % 4) * 2.0).collect();
    let slope = TerrainGrid::new([0.0, 0.0], 2.0, [4, 3], heights_m);
    let distance_m = |x: f64, z: f64| slope.nearest([x, 2.0, z]).signed_distance_m;
    assert!((distance_m(3.0, 5.0) - 2.0_f64.sqrt()).abs() < 1e-12);
    assert!((distance_m(3.0, 2.0) + 0.5_f64.sqrt()).abs() < 1e-12);
    assert_eq!((slope.height_m(2.5, 1.3), slope.height_m(-0.1, 1.0)), (Some(2.5), None));
}

#[test]
fn cells_without_data_are_holes_and_coarse_drawings_are_small() {
    let mut heights_m = vec![1.0; 25];
    heights_m[12] = f64::NAN;
    let grid = TerrainGrid::new([0.0, 0.0], 1.0, [5, 5], heights_m);
    // Six of the eight triangles around the gap have it as a corner; distances leave out the other two as well.
    assert_eq!(grid.triangles(usize::MAX).len(), 32 - 6);
    assert_eq!(grid.nearest([2.0, 2.0, 1.0]).signed_distance_m, 1.0);
    assert!(rugged([90, 70]).triangles(1000).len() <= 1000);
}
