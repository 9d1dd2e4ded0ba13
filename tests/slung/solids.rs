//! Slung loads among meshes and other shapes. Body, cable and load are kept clear of them as of prisms.

use harness::verdict::{Check, Status};
use scenarios::geometry::{Loaded, Surface};
use scenarios::{Capsule, Cuboid, Mesh, Prism, Range, Sphere};

use crate::case::Case;

const CHECKS: [&str; 2] = ["plan.clearance", "flight.clearance"];

fn wall(y_m: f64, thickness_m: f64) -> Prism {
    let corners_m = vec![[-9.0, y_m], [9.0, y_m], [9.0, y_m + thickness_m], [-9.0, y_m + thickness_m]];
    Prism { name: "wall".into(), corners_m, z_m: Some(Range::new(-9.0, 9.0)) }
}

/// A prism as a closed mesh.
fn mesh(prism: &Prism) -> Mesh {
    let (n, z_m) = (prism.corners_m.len(), prism.z_m.unwrap());
    let at = |index: usize, z: f64| [prism.corners_m[index % n][0], prism.corners_m[index % n][1], z];
    let (low, high) = (z_m.min, z_m.max);
    let side = |i: usize| [[at(i, low), at(i + 1, low), at(i + 1, high)], [at(i, low), at(i + 1, high), at(i, high)]];
    let fan = |i: usize| [[at(0, high), at(i, high), at(i + 1, high)], [at(0, low), at(i + 1, low), at(i, low)]];
    let triangles: Vec<[[f64; 3]; 3]> = (0..n).flat_map(side).chain((1..n - 1).flat_map(fan)).collect();
    let indices: Vec<[u32; 3]> =
        (0..triangles.len() as u32).map(|it| [0, 1, 2].map(|corner| 3 * it + corner)).collect();
    let surface = Surface::new(&triangles.concat(), &indices).unwrap();
    assert!(surface.is_closed());
    let (name, file) = (prism.name.clone(), "wall.stl".into());
    Mesh { name, file, scale: 1.0, rotation_deg: [0.0; 3], offset_m: [0.0; 3], surface: Loaded::new(surface) }
}

fn checks(change: impl Fn(&mut Case)) -> Vec<Check> {
    let mut case = Case::good();
    case.scenario.world.boxes.clear();
    case.scenario.world.prisms.clear();
    change(&mut case);
    let verdict = case.judge();
    CHECKS.iter().map(|name| verdict.check(name).unwrap().clone()).collect()
}

/// Walls beside the path, some of them through it.
#[test]
fn a_mesh_is_as_far_as_the_prism_that_it_is() {
    for y_m in [-3.0, -1.2, 0.5, 0.9, 2.0] {
        let of_prism = checks(|case| case.scenario.world.prisms.push(wall(y_m, 0.2)));
        let of_mesh = checks(|case| case.scenario.world.meshes.push(mesh(&wall(y_m, 0.2))));
        for (prism, mesh) in of_prism.iter().zip(&of_mesh) {
            assert_eq!((prism.status, &prism.between), (mesh.status, &mesh.between), "{y_m}: {prism:#?} {mesh:#?}");
            let [a, b] = [prism, mesh].map(|check| check.value.unwrap());
            // Overlaps have another depth: that of a surface.
            assert!((a - b).abs() < 3e-6 || (a < 0.0 && b < 0.0), "{y_m}: {a} m, {b} m");
        }
    }
}

/// Things through the middle of the cable's path: a small ball, a boom, a thin plate. None of them is near body or load.
#[test]
fn a_cable_that_meets_a_thing_is_found() {
    let case = Case::good();
    let start = case.scenario.vehicles[0].start.position_m();
    let middle_m = [start[0], start[1], start[2] - 0.35];
    let name = String::from("thing");
    let ball = |radius_m: f64| {
        checks(|case| case.scenario.world.spheres.push(Sphere { name: name.clone(), center_m: middle_m, radius_m }))
    };
    let beside_m = |by_m: f64| [middle_m[0], middle_m[1] + by_m, middle_m[2]];
    let boom = |by_m: f64| {
        let ends_m = [-0.2, 0.2].map(|x| [beside_m(by_m)[0] + x, beside_m(by_m)[1], beside_m(by_m)[2]]);
        checks(|case| case.scenario.world.capsules.push(Capsule { name: name.clone(), ends_m, radius_m: 0.01 }))
    };
    let plate = checks(|case| {
        let (center_m, size_m, rotation_deg) = (middle_m, [0.1, 0.1, 0.01], [10.0, 0.0, 0.0]);
        case.scenario.world.cuboids.push(Cuboid { name: name.clone(), center_m, size_m, rotation_deg });
    });
    for found in [ball(0.02), boom(0.0), plate] {
        for check in found {
            assert_eq!((check.status, check.reason.as_deref()), (Status::Fail, Some("it is the cable")), "{check:#?}");
        }
    }
}
