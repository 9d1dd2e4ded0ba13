//! Faults of obstacles of any shape: a body reaches into one, although its centre does not.

use scenarios::geometry::{Loaded, Surface, TerrainGrid};
use scenarios::{Mesh, Sphere, Terrain};

use super::super::{Fault, NearMiss, ReferenceCase};
use super::bodies::{FAR_M, Placed, end_m, near_body, occupied};

/// Checks of clearance: at the nodes, between them and in flight.
const CHECKS: [&str; 3] = ["nodes.clearance", "plan.clearance", "flight.clearance"];

const NEAR_GOAL: &[(&str, Placed)] = &[
    ("a mesh has a wall where a window was", |world, [x_m, ..], near_m| world.meshes.push(sheet(x_m + near_m))),
    ("a hill is higher than planned", |world, [x_m, y_m, z_m], near_m| {
        world.terrain = Some(hill([x_m, y_m, z_m - near_m]));
    }),
    ("a ball of 2 cm is within the body", |world, [x_m, y_m, z_m], near_m| {
        let (name, center_m) = ("planted".to_owned(), [x_m, y_m - near_m - 0.01, z_m]);
        world.spheres.push(Sphere { name, center_m, radius_m: 0.01 });
    }),
];

/// The faults of plans that were made before the flight, and of their flights.
pub fn faults() -> Vec<Fault> {
    CHECKS.into_iter().flat_map(|check| NEAR_GOAL.iter().map(move |placed| near_body(check, placed))).collect()
}

/// The faults of flights that were planned in the loop.
pub fn flown_faults() -> Vec<Fault> {
    NEAR_GOAL.iter().map(|placed| near_body(CHECKS[2], placed)).collect()
}

/// Obstacles just beyond all bodies, as far as a vehicle may be off its plan.
pub fn near_misses() -> Vec<NearMiss> {
    vec![
        NearMiss::new("a mesh just beside the bodies", |it: &mut ReferenceCase| {
            let [x_m, ..] = occupied(it);
            it.scenario.world.meshes.push(sheet(x_m.max));
        }),
        NearMiss::new("a hill just below the bodies", |it| {
            let ([x_m, y_m, _], [.., z_m]) = (end_m(it, CHECKS[2]), occupied(it));
            it.scenario.world.terrain = Some(hill([x_m, y_m, z_m.min]));
        }),
    ]
}

/// A wall across the whole map.
fn sheet(x_m: f64) -> Mesh {
    let corners_m = [[-FAR_M, -FAR_M], [FAR_M, -FAR_M], [FAR_M, FAR_M], [-FAR_M, FAR_M]].map(|[y, z]| [x_m, y, z]);
    let surface = Surface::new(&corners_m, &[[0, 1, 2], [0, 2, 3]]).expect("a square has an area");
    let (name, file) = ("planted".to_owned(), "planted.stl".to_owned());
    Mesh { name, file, scale: 1.0, rotation_deg: [0.0; 3], offset_m: [0.0; 3], surface: Loaded::new(surface) }
}

/// A hill with its peak here, and slopes of 45 degrees under the whole map.
fn hill([x_m, y_m, z_m]: [f64; 3]) -> Terrain {
    let heights_m = (0..9).map(|corner| if corner == 4 { z_m } else { z_m - FAR_M }).collect();
    let grid = TerrainGrid::new([x_m - FAR_M, y_m - FAR_M], FAR_M, [3, 3], heights_m);
    Terrain { name: "planted".to_owned(), file: "planted.asc".to_owned(), offset_m: [0.0; 3], grid: Loaded::new(grid) }
}
