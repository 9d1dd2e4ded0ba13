//! Dead ends in a row.

use scenarios::{BoxObstacle, World};

use super::scatter::pillars;
use super::{EDGE_DISTANCE_M, FREE_RADIUS_M, LEVEL_M, MAX_MAPS, draft_of_one, level_map, level_path_length_m};
use crate::campaign::generate::Request;
use crate::campaign::generate::file::Draft;
use crate::campaign::generate::random_stream::{RandomStream, round_to};

/// Length of the map for each courtyard, and before the first and after the last, m.
const PITCH_M: f64 = 12.0;
const APPROACH_M: f64 = 4.0;
/// Width of the map, m.
const WIDTH_M: f64 = 24.0;
/// Thickness of walls, m.
const WALL_M: f64 = 0.6;
/// Area of circles that keep pillars out of a courtyard's walls: radius, m.
const NEAR_WALL_M: f64 = 0.5;

/// Three walls, open towards the start, at a random angle.
pub fn draw(request: &Request) -> Option<Draft> {
    let mut rng = request.rng("obstacles");
    let length_m = PITCH_M * request.size as f64 + 2.0 * APPROACH_M;
    (0..MAX_MAPS).find_map(|_| {
        let mut world = World::empty(level_map(length_m, WIDTH_M));
        for index in 0..request.size {
            let x_m = APPROACH_M + PITCH_M * (index as f64 + 0.5);
            // Near enough to the straight line between start and goal to stand in its path.
            let y_m = WIDTH_M / 2.0 + rng.between(-2.5, 2.5);
            let courtyard = courtyard(&mut rng, index + 1, [x_m, y_m]);
            world.boxes.extend(courtyard);
        }
        let endpoints_m =
            [EDGE_DISTANCE_M, length_m - EDGE_DISTANCE_M].map(|x| [x, round_to(WIDTH_M / 2.0, 0.1), LEVEL_M]);
        let mut occupied: Vec<([f64; 2], f64)> = endpoints_m.map(|[x, y, _]| ([x, y], FREE_RADIUS_M)).to_vec();
        occupied.extend(world.boxes.iter().flat_map(along));
        pillars(&mut rng, &mut world, request.density * length_m * WIDTH_M, [0.3, 0.6], &mut occupied)?;
        let path_length_m = level_path_length_m(&world, endpoints_m)?;
        Some(draft_of_one(request, world, endpoints_m, path_length_m))
    })
}

fn courtyard(rng: &mut RandomStream, number: usize, center_m: [f64; 2]) -> [BoxObstacle; 3] {
    let (width_m, depth_m) = (rng.rounded(7.0, 10.0, 0.1), rng.rounded(5.0, 8.0, 0.1));
    let heading_deg = rng.rounded(-25.0, 25.0, 1.0);
    let (sin, cos) = heading_deg.to_radians().sin_cos();
    let wall = |part: &str, [x, y]: [f64; 2], size_m: [f64; 2]| BoxObstacle {
        name: format!("courtyard-{number}-{part}"),
        center_m: [center_m[0] + cos * x - sin * y, center_m[1] + sin * x + cos * y].map(|it| round_to(it, 1e-3)),
        size_m: size_m.map(|it| round_to(it, 1e-3)),
        heading_deg,
        z_m: None,
    };
    let arm_m = [depth_m, WALL_M];
    [
        wall("back", [depth_m / 2.0, 0.0], [WALL_M, width_m + WALL_M]),
        wall("left", [0.0, width_m / 2.0], arm_m),
        wall("right", [0.0, -width_m / 2.0], arm_m),
    ]
}

/// Circles along a wall.
fn along(wall: &BoxObstacle) -> Vec<([f64; 2], f64)> {
    let (sin, cos) = wall.heading_deg.to_radians().sin_cos();
    let is_long = wall.size_m[0] > wall.size_m[1];
    let (length_m, direction) = if is_long { (wall.size_m[0], [cos, sin]) } else { (wall.size_m[1], [-sin, cos]) };
    let count = (length_m / NEAR_WALL_M).ceil() as usize;
    let offset_m = |i: usize| length_m * (i as f64 / count as f64 - 0.5);
    let at = |i: usize| [0, 1].map(|axis| wall.center_m[axis] + direction[axis] * offset_m(i));
    (0..=count).map(|i| (at(i), NEAR_WALL_M)).collect()
}
