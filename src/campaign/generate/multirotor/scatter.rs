//! Obstacles at random places, which do not overlap.

use std::f64::consts::PI;

use scenarios::{BoxObstacle, Cylinder, World};

use super::{EDGE_DISTANCE_M, FREE_RADIUS_M, LEVEL_M, MAX_MAPS, draft_of_one, level_map, level_path_length_m};
use crate::campaign::generate::Request;
use crate::campaign::generate::file::Draft;
use crate::campaign::generate::random_stream::{RandomStream, round_to};

/// Width of the map relative to its length.
const WIDTH: f64 = 0.6;
/// Attempts to place one more obstacle.
const MAX_ATTEMPTS: usize = 2000;

/// Boxes and pillars.
pub fn field(request: &Request) -> Option<Draft> {
    draw(request, |rng, world, wanted_m2, occupied| {
        let pillars_m2 = wanted_m2 * rng.between(0.2, 0.5);
        pillars(rng, world, pillars_m2, [0.4, 1.0], occupied)?;
        boxes(rng, world, wanted_m2 - pillars_m2, occupied)
    })
}

/// Trunks. Thin ones that cover more than 15 % of the area leave no path; beyond, they are thicker and fewer.
pub fn forest(request: &Request) -> Option<Draft> {
    let scale = 1.0 + 5.0 * (request.density - 0.15).max(0.0);
    let radius_m = [0.3, 0.9].map(|it| round_to(scale * it, 0.01));
    draw(request, |rng, world, wanted_m2, occupied| pillars(rng, world, wanted_m2, radius_m, occupied))
}

/// Centres and radii of circles that nothing else may overlap.
pub type Occupied = Vec<([f64; 2], f64)>;

fn draw(
    request: &Request,
    fill: impl Fn(&mut RandomStream, &mut World, f64, &mut Occupied) -> Option<()>,
) -> Option<Draft> {
    let mut rng = request.rng("obstacles");
    let length_m = request.size as f64;
    let width_m = round_to(WIDTH * length_m, 0.1);
    (0..MAX_MAPS).find_map(|_| {
        let mut world = World::empty(level_map(length_m, width_m));
        let endpoints_m = [EDGE_DISTANCE_M, length_m - EDGE_DISTANCE_M]
            .map(|x| [x, rng.rounded(EDGE_DISTANCE_M, width_m - EDGE_DISTANCE_M, 0.1), LEVEL_M]);
        let mut occupied: Occupied = endpoints_m.map(|[x, y, _]| ([x, y], FREE_RADIUS_M)).to_vec();
        fill(&mut rng, &mut world, request.density * length_m * width_m, &mut occupied)?;
        let path_length_m = level_path_length_m(&world, endpoints_m)?;
        Some(draft_of_one(request, world, endpoints_m, path_length_m))
    })
}

/// Pillars that cover this area.
///
/// - `radius_m`: smallest and largest radius
pub fn pillars(
    rng: &mut RandomStream,
    world: &mut World,
    area_m2: f64,
    radius_m: [f64; 2],
    occupied: &mut Occupied,
) -> Option<()> {
    let mut covered_m2 = 0.0;
    while covered_m2 < area_m2 {
        let (center_m, radius_m) = place(rng, world, occupied, |rng| {
            let radius_m = rng.rounded(radius_m[0], radius_m[1], 0.01);
            (radius_m, radius_m)
        })?;
        covered_m2 += PI * radius_m * radius_m;
        let name = format!("pillar-{}", world.cylinders.len() + 1);
        world.cylinders.push(Cylinder { name, center_m, radius_m });
    }
    Some(())
}

fn boxes(rng: &mut RandomStream, world: &mut World, area_m2: f64, occupied: &mut Occupied) -> Option<()> {
    let mut covered_m2 = 0.0;
    while covered_m2 < area_m2 {
        let (center_m, size_m) = place(rng, world, occupied, |rng| {
            let size_m = [0, 1].map(|_| rng.rounded(0.8, 2.5, 0.1));
            (size_m, size_m[0].hypot(size_m[1]) / 2.0)
        })?;
        covered_m2 += size_m[0] * size_m[1];
        let name = format!("box-{}", world.boxes.len() + 1);
        let heading_deg = rng.rounded(-45.0, 45.0, 1.0);
        world.boxes.push(BoxObstacle { name, center_m, size_m, heading_deg, z_m: None });
    }
    Some(())
}

/// A place on the map for a shape, drawn with the radius of the circle around it.
fn place<T>(
    rng: &mut RandomStream,
    world: &World,
    occupied: &mut Occupied,
    shape: impl Fn(&mut RandomStream) -> (T, f64),
) -> Option<([f64; 2], T)> {
    for _ in 0..MAX_ATTEMPTS {
        let center_m = [world.map.x_m, world.map.y_m].map(|range| rng.rounded(range.min, range.max, 0.1));
        let (shape, radius_m) = shape(rng);
        let is_free =
            |([x, y], other_m): &([f64; 2], f64)| (center_m[0] - x).hypot(center_m[1] - y) >= radius_m + other_m;
        if occupied.iter().all(is_free) {
            occupied.push((center_m, radius_m));
            return Some((center_m, shape));
        }
    }
    None
}
