//! Obstacles of any shape: meshes, terrain, balls, capsules, boxes, and fixed wings among boxes. The aircraft fly east at y = 0,
//! 200 and 400 m from x = 0, at 400 m; bodies have a radius of 1 m, nodes are 70 m apart.

use harness::verdict::Status;
use scenarios::geometry::{Loaded, Surface, TerrainGrid};
use scenarios::{BoxObstacle, Capsule, Cuboid, Mesh, Range, Sphere, Terrain, World};
use sim::EventKind;

use crate::fleet::Case;

const CHECKS: [&str; 3] = ["nodes.clearance", "plan.clearance", "flight.clearance"];
const CONTINUOUS: [&str; 2] = ["plan.clearance", "flight.clearance"];

fn case(add: impl Fn(&mut World)) -> Case {
    let mut case = Case::good();
    case.scenario.world.cylinders.clear();
    add(&mut case.scenario.world);
    case
}

fn assert_status(case: &Case, checks: &[&str], status: Status, obstacle: &str) {
    let verdict = case.judge();
    for name in checks {
        let check = verdict.check(name).unwrap();
        assert_eq!(check.status, status, "{check:#?}");
        if status == Status::Fail {
            assert_eq!(check.between.last().map(String::as_str), Some(obstacle), "{check:#?}");
            assert!(check.margin.unwrap() < 0.0, "{check:#?}");
        }
    }
}

/// The clearance is this large, within the bounds, which are close.
fn assert_clearance(case: &Case, expected_m: f64) {
    let verdict = case.judge();
    for name in CONTINUOUS {
        let check = verdict.check(name).unwrap();
        let (lower_m, upper_m) = (check.lower.unwrap(), check.upper.unwrap());
        assert!(lower_m <= expected_m + 1e-9 && expected_m <= upper_m + 1e-9, "{expected_m} m: {check:#?}");
        assert!(upper_m - lower_m < 1.1e-3 * expected_m.max(1.0), "{check:#?}");
    }
}

fn mesh(triangles: &[[[f64; 3]; 3]]) -> Mesh {
    let indices: Vec<[u32; 3]> =
        (0..triangles.len() as u32).map(|it| [0, 1, 2].map(|corner| 3 * it + corner)).collect();
    let surface = Loaded::new(Surface::new(&triangles.concat(), &indices).unwrap());
    let (name, file) = ("wall".into(), "wall.stl".into());
    Mesh { name, file, scale: 1.0, rotation_deg: [0.0; 3], offset_m: [0.0; 3], surface }
}

/// A rectangle across the paths.
fn sheet(x: f64, y: [f64; 2], z: [f64; 2]) -> [[[f64; 3]; 3]; 2] {
    let [a, b, c, d] = [[x, y[0], z[0]], [x, y[1], z[0]], [x, y[1], z[1]], [x, y[0], z[1]]];
    [[a, b, c], [a, c, d]]
}

/// A thin wall at x = 105 m, halfway between two nodes, with a square window around the first path.
fn wall_with_window(half_m: f64) -> Mesh {
    let (low, high) = (400.0 - half_m, 400.0 + half_m);
    let parts = [
        sheet(105.0, [-100.0, 100.0], [300.0, low]),
        sheet(105.0, [-100.0, 100.0], [high, 500.0]),
        sheet(105.0, [-100.0, -half_m], [low, high]),
        sheet(105.0, [half_m, 100.0], [low, high]),
    ];
    mesh(&parts.concat())
}

/// A closed box.
fn closed([x, y, z]: [[f64; 2]; 3]) -> Vec<[[f64; 3]; 3]> {
    let corner = |bits: usize| [x[bits & 1], y[bits >> 1 & 1], z[bits >> 2 & 1]];
    let faces = [[0, 4, 6, 2], [1, 3, 7, 5], [0, 1, 5, 4], [2, 6, 7, 3], [0, 2, 3, 1], [4, 5, 7, 6]];
    faces.into_iter().flat_map(|[a, b, c, d]| [[a, b, c], [a, c, d]]).map(|it| it.map(corner)).collect()
}

#[test]
fn a_window_is_passed_and_a_mesh_without_it_is_hit_between_two_nodes() {
    let window = |half_m: f64| case(|world| world.meshes.push(wall_with_window(half_m)));
    assert_status(&window(1.1), &CHECKS, Status::Pass, "");
    assert_clearance(&window(1.1), 0.1);
    assert_status(&window(0.9), &["nodes.clearance"], Status::Pass, "");
    assert_status(&window(0.9), &CONTINUOUS, Status::Fail, "wall");
    let whole = case(|world| world.meshes.push(mesh(&sheet(105.0, [-100.0, 100.0], [300.0, 500.0]))));
    assert_status(&whole, &["nodes.clearance"], Status::Pass, "");
    assert_status(&whole, &CONTINUOUS, Status::Fail, "wall");
    assert_eq!(whole.status("flight.crash"), Status::Fail);
}

/// Inside of a closed mesh there is no way out: the flight starts and ends in it, far from its surface.
#[test]
fn a_flight_inside_a_mesh_fails() {
    let around = [[-900.0, 2000.0], [-900.0, 2000.0], [-900.0, 1900.0]];
    let inside = case(|world| world.meshes.push(mesh(&closed(around))));
    assert_status(&inside, &CHECKS, Status::Fail, "wall");
    // Inside out, it is turned; with a missing triangle or another box across it, only its start tells.
    let mut reversed = closed(around);
    reversed.iter_mut().for_each(|triangle| triangle.swap(0, 1));
    assert_status(&case(|world| world.meshes.push(mesh(&reversed))), &CHECKS, Status::Fail, "wall");
    let open = closed(around)[1..].to_vec();
    assert_status(&case(|world| world.meshes.push(mesh(&open))), &CONTINUOUS, Status::Fail, "wall");
    let crossed = [closed(around), closed([[-50.0, 50.0], [-2000.0, 3000.0], [300.0, 500.0]])].concat();
    assert_status(&case(|world| world.meshes.push(mesh(&crossed))), &CONTINUOUS, Status::Fail, "wall");
}

/// Hills from -500 to 1500 m along both axes, by their height at corners 100 m apart.
pub fn terrain(heights_m: impl Fn(f64, f64) -> f64) -> Terrain {
    let (cell_m, size) = (100.0, [21, 21]);
    let at = |index: usize| {
        (f64::from((index % 21) as u32) * cell_m - 500.0, f64::from((index / 21) as u32) * cell_m - 500.0)
    };
    let heights_m = (0..441).map(at).map(|(x, y)| heights_m(x, y)).collect();
    let grid = Loaded::new(TerrainGrid::new([-500.0, -500.0], cell_m, size, heights_m));
    Terrain { name: "hills".into(), file: "hills.asc".into(), offset_m: [0.0; 3], grid }
}

#[test]
fn terrain_is_an_obstacle() {
    let flat = |z_m: f64| case(|world| world.terrain = Some(terrain(|_, _| z_m)));
    assert_status(&flat(399.01), &CHECKS, Status::Fail, "hills");
    assert_status(&flat(398.99), &CHECKS, Status::Pass, "");
    assert_clearance(&flat(398.9), 0.1);
    // Far below the surface.
    assert_status(&flat(900.0), &CHECKS, Status::Fail, "hills");
}

/// A ridge along x between two paths, its foot 100 m from its crest: shifted by one cell, its crest lies in the second path.
#[test]
fn terrain_shifted_by_a_cell_is_hit() {
    let ridge = |y_m: f64| case(|world| world.terrain = Some(terrain(|_, y| if y == y_m { 450.0 } else { 0.0 })));
    assert_status(&ridge(100.0), &CHECKS, Status::Pass, "");
    assert_status(&ridge(200.0), &CHECKS, Status::Fail, "hills");
    // The slope falls by 450 m in 100 m: at the path, 100 m from the crest, it meets the ground.
    let to_slope_m = 400.0 * 100.0 / 450.0_f64.hypot(100.0);
    assert_clearance(&ridge(100.0), to_slope_m - 1.0);
}

/// A peak of one corner between two nodes.
#[test]
fn a_peak_between_two_nodes_is_hit() {
    let peak =
        |z_m: f64| case(|world| world.terrain = Some(terrain(|x, y| if x == 300.0 && y == 0.0 { z_m } else { 0.0 })));
    assert_status(&peak(397.0), &CHECKS, Status::Pass, "");
    assert_status(&peak(402.0), &["nodes.clearance"], Status::Pass, "");
    assert_status(&peak(402.0), &CONTINUOUS, Status::Fail, "hills");
}

#[test]
fn balls_capsules_and_boxes_are_obstacles() {
    let (name, x_m) = (String::from("thing"), 105.0);
    let ball = |gap_m: f64| {
        let center_m = [x_m, 0.0, 390.0];
        case(|world| world.spheres.push(Sphere { name: name.clone(), center_m, radius_m: 9.0 - gap_m }))
    };
    let capsule = |gap_m: f64| {
        let ends_m = [[x_m, -50.0, 390.0], [x_m, 50.0, 390.0]];
        case(|world| world.capsules.push(Capsule { name: name.clone(), ends_m, radius_m: 9.0 - gap_m }))
    };
    // On its edge: half a diagonal up.
    let cuboid = |gap_m: f64| {
        let half_m = (9.0 - gap_m) / 2.0_f64.sqrt();
        let (center_m, size_m, rotation_deg) = ([x_m, 0.0, 390.0], [2.0 * half_m, 8.0, 2.0 * half_m], [0.0, 45.0, 0.0]);
        case(|world| world.cuboids.push(Cuboid { name: name.clone(), center_m, size_m, rotation_deg }))
    };
    let upright = |gap_m: f64| {
        let (center_m, size_m, z_m) = ([x_m, 0.0], [4.0, 4.0], Some(Range::new(0.0, 399.0 - gap_m)));
        case(|world| world.boxes.push(BoxObstacle { name: name.clone(), center_m, size_m, heading_deg: 20.0, z_m }))
    };
    let shapes: [&dyn Fn(f64) -> Case; 4] = [&ball, &capsule, &cuboid, &upright];
    for shape in shapes {
        assert_status(&shape(0.01), &CHECKS, Status::Pass, "");
        assert_clearance(&shape(0.01), 0.01);
        assert_status(&shape(-0.01), &["nodes.clearance"], Status::Pass, "");
        assert_status(&shape(-0.01), &CONTINUOUS, Status::Fail, "thing");
    }
}

/// The simulator finds the same contacts, between its steps.
#[test]
fn the_simulator_crashes_where_the_judge_says() {
    let thin = mesh(&sheet(105.003, [-100.0, 100.0], [300.0, 500.0]));
    let obstacles: [(&str, Case); 3] = [
        ("wall", case(|world| world.meshes.push(thin.clone()))),
        ("hills", case(|world| world.terrain = Some(terrain(|x, y| if x == 200.0 && y == 0.0 { 450.0 } else { 0.0 })))),
        (
            "ball",
            case(|world| {
                world.spheres.push(Sphere { name: "ball".into(), center_m: [300.0, 0.0, 400.0], radius_m: 2.0 });
            }),
        ),
    ];
    for (name, case) in obstacles {
        let flight = sim::fly(&case.scenario, &case.plan, 0, &mut |_| {});
        let crash = flight.events.iter().find(|event| matches!(event.kind, EventKind::Crash { .. })).unwrap();
        assert_eq!(
            (&crash.kind, crash.vehicles.as_slice()),
            (&EventKind::Crash { obstacle: Some(name.into()) }, &["uav-1".to_owned()][..])
        );
        if name == "wall" {
            assert!((crash.t_s - 104.003 / 35.0).abs() < 1e-3, "{crash:?}");
        }
        let with_flight = Case { flight: Some(flight), ..case };
        assert_eq!(with_flight.status("flight.crash"), Status::Fail);
        assert_eq!(with_flight.status("flight.clearance"), Status::Fail);
    }
    let clear = case(|world| world.meshes.push(wall_with_window(1.1)));
    let flight = sim::fly(&clear.scenario, &clear.plan, 0, &mut |_| {});
    assert!(!flight.events.iter().any(|event| matches!(event.kind, EventKind::Crash { .. })), "{:?}", flight.events);
}
