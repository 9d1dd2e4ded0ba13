//! Walls with one passage each.

use scenarios::BoxObstacle;

use super::{
    CLEARANCE_M, ENDS_M, HALF_MAP_M, InitialCondition, MAX_WORLDS, carrier, draft, empty_world, path_length_m,
};
use crate::campaign::generate::Request;
use crate::campaign::generate::file::Draft;
use crate::campaign::generate::random_stream::round_to;

/// Thickness of a wall, m.
const WALL_M: f64 = 0.3;
/// Width of a passage, m: at least twice the clearance and a cell of the grid.
const WIDTH_M: [f64; 2] = [1.2, 1.8];
/// Largest distance of the middle of a passage from the middle of the map, m.
const ASIDE_M: f64 = 1.2;

/// Walls at equal distances.
pub fn draw(request: &Request) -> Option<Draft> {
    let mut rng = request.rng("walls");
    (0..MAX_WORLDS).find_map(|_| {
        let mut world = empty_world(&InitialCondition::HANGING);
        for index in 0..request.size {
            let x_m = ENDS_M * (2.0 * (index + 1) as f64 / (request.size + 1) as f64 - 1.0);
            let (middle_m, width_m) = (rng.rounded(-ASIDE_M, ASIDE_M, 0.05), rng.rounded(WIDTH_M[0], WIDTH_M[1], 0.05));
            let part = |side: &str, from_m: f64, to_m: f64| BoxObstacle {
                name: format!("wall-{}-{side}", index + 1),
                center_m: [round_to(x_m, 0.01), round_to((from_m + to_m) / 2.0, 1e-3)],
                size_m: [WALL_M, round_to(to_m - from_m, 1e-3)],
                heading_deg: 0.0,
                z_m: None,
            };
            world.boxes.push(part("south", -HALF_MAP_M, middle_m - width_m / 2.0));
            world.boxes.push(part("north", middle_m + width_m / 2.0, HALF_MAP_M));
        }
        let endpoints_m = [-ENDS_M, ENDS_M].map(|x| [x, rng.rounded(-1.0, 1.0, 0.1)]);
        let path_length_m = path_length_m(&world, endpoints_m)?;
        let certificate = format!(
            "a search on a grid has found a path of {path_length_m:.1} m on which the cable's axis is {CLEARANCE_M} m from every wall: body \
             (0.352 m), planner's margin and 0.05 m. A load that is carried slowly hangs straight down."
        );
        Some(draft(request, world, carrier(&InitialCondition::HANGING, endpoints_m), path_length_m, &certificate))
    })
}
