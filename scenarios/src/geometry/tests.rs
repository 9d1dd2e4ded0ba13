//! Distances of solids against those of the upright shapes, and what every signed distance has to keep.

use std::sync::Arc;

use rand::RngExt;
use rand_chacha::ChaCha8Rng;

use super::round::{box_triangles, capsule_triangles, difference, norm};
use super::{Solid, Surface, TerrainGrid};
use crate::{Prism, Range, stream};

fn surface(triangles: &[[[f64; 3]; 3]]) -> Surface {
    let indices: Vec<[u32; 3]> =
        (0..triangles.len() as u32).map(|it| [0, 1, 2].map(|corner| 3 * it + corner)).collect();
    Surface::new(&triangles.concat(), &indices).unwrap()
}

fn mesh(triangles: &[[[f64; 3]; 3]]) -> Solid {
    Solid::mesh("mesh", Arc::new(surface(triangles)))
}

/// A prism as a closed mesh: fans at top and bottom, two triangles for each side.
fn prism_triangles(corners_m: &[[f64; 2]], z_m: Range) -> Vec<[[f64; 3]; 3]> {
    let n = corners_m.len();
    let at = |index: usize, z: f64| [corners_m[index % n][0], corners_m[index % n][1], z];
    let (low, high) = (z_m.min, z_m.max);
    let side = |i: usize| {
        let [a, b, c, d] = [at(i, low), at(i + 1, low), at(i + 1, high), at(i, high)];
        [[a, b, c], [a, c, d]]
    };
    let fan = |i: usize| [[at(0, high), at(i, high), at(i + 1, high)], [at(0, low), at(i + 1, low), at(i, low)]];
    (0..n).flat_map(side).chain((1..n - 1).flat_map(fan)).collect()
}

fn point(rng: &mut ChaCha8Rng, half_m: f64) -> [f64; 3] {
    std::array::from_fn(|_| rng.random_range(-half_m..half_m))
}

fn all_shapes() -> Vec<Solid> {
    let heights_m = (0..81).map(|index| f64::from(index * 37 % 11) * 0.3 - 2.0).collect();
    vec![
        Solid::ball("ball", [1.0, -1.0, 0.5], 1.3),
        Solid::capsule("capsule", [[-2.0, 0.0, -1.0], [2.0, 1.0, 1.0]], 0.4),
        Solid::cuboid("cuboid", [0.3, 0.2, -0.4], [3.0, 1.0, 2.0], [0.4, -0.7, 2.1]),
        mesh(&prism_triangles(&[[-2.0, -1.0], [2.0, -1.5], [1.0, 1.0]], Range::new(-1.0, 1.5))),
        mesh(&box_triangles([1.0; 3])[2..]),
        Solid::terrain("terrain", Arc::new(TerrainGrid::new([-8.0, -8.0], 2.0, [9, 9], heights_m))),
    ]
}

/// A prism and a box, and the same as meshes: 200 000 points, inside and outside.
#[test]
fn a_mesh_is_as_far_as_the_prism_that_it_is() {
    let corners_m = vec![[-2.0, -1.0], [2.0, -1.5], [2.5, 0.5], [0.5, 2.0]];
    let z_m = Range::new(-1.0, 1.5);
    let prism = Prism { name: "prism".into(), corners_m: corners_m.clone(), z_m: Some(z_m) };
    let solid = mesh(&prism_triangles(&corners_m, z_m));
    let mut rng = stream(1, "points");
    let mut worst_m = 0.0_f64;
    for _ in 0..200_000 {
        let point_m = point(&mut rng, 4.0);
        let difference_m = solid.signed_distance_m(point_m) - prism.signed_distance_in_space_m(point_m);
        worst_m = worst_m.max(difference_m.abs());
    }
    assert!(worst_m < 1e-12, "{worst_m:e} m");
}

#[test]
fn the_closed_forms_are_those_of_fine_meshes() {
    let cuboid = Solid::cuboid("c", [0.0; 3], [2.0, 3.0, 4.0], [0.0; 3]);
    let as_mesh = mesh(&box_triangles([1.0, 1.5, 2.0]));
    let ends_m = [[0.0, 0.0, -1.0], [1.0, 0.5, 1.0]];
    let (capsule, inscribed) = (Solid::capsule("c", ends_m, 0.8), mesh(&capsule_triangles(ends_m, 0.8)));
    let mut rng = stream(2, "points");
    for _ in 0..20_000 {
        let point_m = point(&mut rng, 3.0);
        assert!((cuboid.signed_distance_m(point_m) - as_mesh.signed_distance_m(point_m)).abs() < 1e-12);
        // From outside, the polyhedron is farther away than the capsule, by no more than its facets are flat.
        let distance_m = capsule.signed_distance_m(point_m);
        let gap_m = inscribed.signed_distance_m(point_m) - distance_m;
        assert!(distance_m < 0.0 || (-1e-12..0.04).contains(&gap_m), "{gap_m} m at {point_m:?}");
    }
}

/// Between any two points the signed distance changes by no more than they are apart, and the nearest point is as far away as
/// it says and on the surface. 360 000 pairs. Far from the terrain's edge, below which its solid has no side.
#[test]
fn a_signed_distance_changes_by_no_more_than_the_point_moves() {
    for solid in all_shapes() {
        let mut rng = stream(3, solid.name());
        for _ in 0..60_000 {
            let from_m = point(&mut rng, 3.5);
            let length_m = rng.random_range(1e-6..1.0);
            let step_m = point(&mut rng, length_m);
            let to_m: [f64; 3] = std::array::from_fn(|axis| from_m[axis] + step_m[axis]);
            let (here, there) = (solid.nearest(from_m), solid.signed_distance_m(to_m));
            let change_m = (here.signed_distance_m - there).abs();
            assert!(change_m <= norm(step_m) + 1e-12, "{}: {change_m} m over {step_m:?} from {from_m:?}", solid.name());
            let gap_m = norm(difference(from_m, here.point_m));
            assert!((gap_m - here.signed_distance_m.abs()).abs() < 1e-12, "{}: {here:?}", solid.name());
            assert!(solid.signed_distance_m(here.point_m).abs() < 1e-9, "{}: {here:?}", solid.name());
        }
    }
}

/// Where two points of the surface are equally near, within a step, the slope is another one: at fewer than 1 in 100 points.
#[test]
fn the_outward_direction_is_the_gradient() {
    let step_m = 1e-6;
    for solid in all_shapes() {
        let mut rng = stream(4, solid.name());
        let is_gradient = |point_m: [f64; 3]| {
            let outward = solid.nearest(point_m).outward(point_m).unwrap();
            let ahead_m: [f64; 3] = std::array::from_fn(|axis| point_m[axis] + step_m * outward[axis]);
            (solid.signed_distance_m(ahead_m) - solid.signed_distance_m(point_m)) / step_m > 1.0 - 1e-6
        };
        let count = (0..2000).filter(|_| is_gradient(point(&mut rng, 3.0))).count();
        assert!(count > 1980, "{}: {count} of 2000", solid.name());
    }
}

#[test]
fn meshes_that_are_open_inside_out_or_degenerate_keep_their_stated_meaning() {
    let whole = box_triangles([1.0; 3]);
    let reversed: Vec<[[f64; 3]; 3]> = whole.iter().map(|[a, b, c]| [*a, *c, *b]).collect();
    let turned = surface(&reversed);
    assert!(turned.is_closed() && turned.nearest([0.0, 0.0, 0.9]).signed_distance_m < 0.0, "turned outside");
    let mut flipped = whole.clone();
    flipped[3].swap(0, 1);
    for broken in [whole[2..].to_vec(), flipped, [&whole[..], &whole[..1]].concat()] {
        let open = surface(&broken);
        assert!(!open.is_closed());
        let inside = open.nearest([0.0, 0.5, 0.0]).signed_distance_m;
        assert!((inside - 0.5).abs() < 1e-12, "distance to the surface, from both sides: {inside}");
    }
    // Without one side it still encloses its middle: five sixths of all directions meet it.
    let missing_side = mesh(&whole[2..]);
    assert!(missing_side.encloses([0.0; 3]) && !missing_side.encloses([0.0, 0.0, 3.0]));
    let sliver = [[[0.0; 3], [1.0, 0.0, 0.0], [0.5, 0.0, 0.0]], [[0.0; 3], [1.0, 0.0, 0.0], [0.0, 1.0, 0.0]]];
    assert_eq!(surface(&sliver).triangle_count(), 1);
    assert!(Surface::new(&[[0.0; 3]; 3], &[[0, 1, 2]]).is_err() && Surface::new(&[[0.0; 3]; 3], &[[0, 1, 3]]).is_err());
}

/// Two boxes that overlap: between their walls the nearest surface is a wall that one of them has inside of the other.
#[test]
fn a_mesh_that_intersects_itself_still_encloses() {
    let shifted = |by_m: f64| box_triangles([1.0; 3]).into_iter().map(move |it| it.map(|[x, y, z]| [x + by_m, y, z]));
    let both = mesh(&shifted(0.0).chain(shifted(1.5)).collect::<Vec<_>>());
    for inside_m in [[0.0; 3], [0.75, 0.0, 0.0], [2.0, 0.0, 0.0], [0.45, 0.0, 0.0]] {
        assert!(both.encloses(inside_m), "{inside_m:?}");
    }
    assert!(!both.encloses([0.75, 0.0, 1.01]) && !both.encloses([2.6, 0.0, 0.0]));
}

#[test]
fn what_is_not_finite_has_no_distance() {
    for solid in all_shapes() {
        for bad in [f64::NAN, f64::INFINITY] {
            assert!(solid.signed_distance_m([0.0, bad, 0.0]).is_nan(), "{}", solid.name());
        }
    }
}

/// No point of a solid is outside of the prisms that enclose it, and they reach no farther than stated.
#[test]
fn enclosing_prisms_contain_the_solid_and_little_more() {
    for solid in all_shapes() {
        let prisms: Vec<Prism> = solid.enclosing_prisms().iter().map(Prism::counterclockwise).collect();
        assert!(!prisms.is_empty() && prisms.len() <= 144, "{}: {}", solid.name(), prisms.len());
        let mut rng = stream(5, solid.name());
        for _ in 0..20_000 {
            let point_m = point(&mut rng, 3.5);
            let enclosed_m =
                prisms.iter().map(|it| it.signed_distance_in_space_m(point_m)).fold(f64::INFINITY, f64::min);
            let distance_m = solid.signed_distance_m(point_m);
            assert!(distance_m > 0.0 || enclosed_m <= 1e-12, "{}: {point_m:?} is outside", solid.name());
            let is_terrain = solid.is_terrain();
            assert!(
                is_terrain || enclosed_m > 0.0 || distance_m < 1.0,
                "{}: {distance_m} m at {point_m:?}",
                solid.name()
            );
        }
    }
}
