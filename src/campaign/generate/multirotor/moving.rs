//! Moving obstacles in a corridor.

use scenarios::{MovingCylinder, World};

use super::scatter::pillars;
use super::{CLEARANCE_M, EDGE_DISTANCE_M, FREE_RADIUS_M, LEVEL_M, MAX_MAPS, draft, level_map, vehicle};
use crate::campaign::generate::Request;
use crate::campaign::generate::file::Draft;
use crate::campaign::generate::grid_search::Grid;
use crate::campaign::generate::random_stream::{RandomStream, round_to};

/// Width of the corridor, m.
const WIDTH_M: f64 = 10.0;
/// Length of the corridor for each cart that crosses it, m.
const PITCH_M: f64 = 10.0;
/// Distance of the carts' paths from both ends of the corridor, m.
const APPROACH_M: f64 = 5.0;
/// Largest speed of a cart, m/s.
const CART_MPS: f64 = 1.0;
/// Cell of the grid, m.
const STEP_M: f64 = 0.4;
/// Speed along a diagonal of the grid, m/s.
const SPEED_MPS: f64 = 2.0;
/// Longest certified flight, as a multiple of a straight one.
const MAX_DURATION_RATIO: f64 = 4.0;

/// Carts across the corridor, and one along it.
pub fn draw(request: &Request) -> Option<Draft> {
    let mut rng = request.rng("obstacles");
    let length_m = request.size as f64;
    (0..MAX_MAPS).find_map(|_| {
        let mut world = World::empty(level_map(length_m, WIDTH_M));
        let endpoints_m = [EDGE_DISTANCE_M, length_m - EDGE_DISTANCE_M].map(|x| [x, rng.rounded(3.0, WIDTH_M - 3.0, 0.1), LEVEL_M]);
        let mut occupied = endpoints_m.map(|[x, y, _]| ([x, y], FREE_RADIUS_M)).to_vec();
        pillars(&mut rng, &mut world, request.density * length_m * WIDTH_M, [0.3, 0.6], &mut occupied)?;
        let crossing = ((length_m / PITCH_M) as usize).max(1);
        world.moving = (0..crossing).map(|index| across(&mut rng, index, crossing, length_m)).collect();
        world.moving.push(along(&mut rng, length_m));
        let arrival_s = arrival_s(&world, endpoints_m)?;
        let certificate = format!(
            "a search on a grid in space and time, which knows how the carts will move, has found a path of {arrival_s:.0} s at up \
             to {SPEED_MPS} m/s that keeps the centre of the vehicle {CLEARANCE_M} m from everything. No cart comes near start \
             and goal. The search lets the vehicle stop and turn at once."
        );
        let path_length_m = arrival_s * SPEED_MPS;
        Some(draft(request, world, vec![vehicle(0, endpoints_m)], certificate, path_length_m))
    })
}

fn across(rng: &mut RandomStream, index: usize, count: usize, length_m: f64) -> MovingCylinder {
    let free_m = length_m - 2.0 * APPROACH_M;
    let x_m = APPROACH_M + free_m * (index as f64 + rng.between(0.1, 0.9)) / count as f64;
    let slant_m = rng.between(-0.5, 0.5);
    let mut path_m = vec![[x_m - slant_m, 1.0], [x_m + slant_m, WIDTH_M - 1.0]];
    if rng.sign() < 0.0 {
        path_m.reverse();
    }
    cart(rng, index + 1, path_m, WIDTH_M)
}

fn along(rng: &mut RandomStream, length_m: f64) -> MovingCylinder {
    let y_m = rng.between(2.0, WIDTH_M - 2.0);
    let number = ((length_m / PITCH_M) as usize).max(1) + 1;
    cart(rng, number, vec![[length_m - APPROACH_M, y_m], [APPROACH_M, y_m]], length_m)
}

fn cart(rng: &mut RandomStream, number: usize, path_m: Vec<[f64; 2]>, longest_m: f64) -> MovingCylinder {
    MovingCylinder {
        name: format!("cart-{number}"),
        radius_m: rng.rounded(0.4, 0.7, 0.05),
        z_m: None,
        path_m: path_m.into_iter().map(|corner| corner.map(|it| round_to(it, 0.01))).collect(),
        speed_mps: rng.rounded(0.4, CART_MPS, 0.05),
        offset_m: rng.rounded(0.0, longest_m, 0.1),
    }
}

/// Time at which a vehicle that moves to a neighbouring node or waits, step by step, can be at the goal, s.
///
/// Between two steps vehicle and cart approach each other by at most half of what both move, so that much is added to the
/// clearance.
fn arrival_s(world: &World, [start_m, goal_m]: [[f64; 3]; 2]) -> Option<f64> {
    let grid = Grid::new(world, Some(LEVEL_M), STEP_M, CLEARANCE_M);
    let step_s = STEP_M * std::f64::consts::SQRT_2 / SPEED_MPS;
    let needed_m = CLEARANCE_M + (SPEED_MPS + CART_MPS) * step_s / 2.0;
    let is_clear = |node: usize, t_s: f64| {
        let far = |cart: &MovingCylinder| cart.signed_distance_m(t_s, grid.position_m(node)) >= needed_m;
        grid.is_free(node) && world.moving.iter().all(far)
    };
    let goal = grid.nearest(goal_m);
    let mut is_reached = vec![false; grid.len()];
    is_reached[grid.nearest(start_m)] = is_clear(grid.nearest(start_m), 0.0);
    let longest_s = MAX_DURATION_RATIO * (goal_m[0] - start_m[0]) / SPEED_MPS;
    for step in 1..(longest_s / step_s) as usize {
        let t_s = step as f64 * step_s;
        let can_be = |node: usize| is_reached[node] || grid.neighbours(node).any(|(other, _)| is_reached[other]);
        is_reached = (0..grid.len()).map(|node| can_be(node) && is_clear(node, t_s)).collect();
        if is_reached[goal] {
            return Some(t_s);
        }
    }
    None
}
