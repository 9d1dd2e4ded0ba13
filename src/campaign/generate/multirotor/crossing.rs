//! Several vehicles at once.

use std::f64::consts::{PI, TAU};

use scenarios::{Cylinder, Map, Range, Vehicle, World};

use super::scatter::pillars;
use super::{CLEARANCE_M, FREE_RADIUS_M, LEVEL_M, MAX_MAPS, TOP_M, draft, level_path_length_m, vehicle};
use crate::campaign::generate::Request;
use crate::campaign::generate::file::Draft;
use crate::campaign::generate::random_stream::{RandomStream, round_to};

/// Separation, and the distance of a certified path from vehicles at rest, m.
const SEPARATION_M: f64 = 0.9;
const APART_M: f64 = 1.3;
/// Smallest radius of the circle, the radius for each vehicle, and the free space around the circle, m.
const RADIUS_M: f64 = 9.0;
const RADIUS_PER_VEHICLE_M: f64 = 1.8;
const AROUND_M: f64 = 3.0;
/// Smallest distance between any two starts or goals of different vehicles, m.
const ENDS_APART_M: f64 = 2.5;
/// Attempts to place one more vehicle.
const MAX_ATTEMPTS: usize = 200;

/// Start and goal of a vehicle, m.
type Ends = [[f64; 3]; 2];

/// Starts and goals on a circle, opposite to each other within 40 deg.
pub fn draw(request: &Request) -> Option<Draft> {
    let mut rng = request.rng("vehicles");
    let radius_m = RADIUS_M.max(RADIUS_PER_VEHICLE_M * request.size as f64);
    let half_m = radius_m + AROUND_M;
    let side = Range::new(-half_m, half_m);
    (0..MAX_MAPS).find_map(|_| {
        let mut world = World::empty(Map { x_m: side, y_m: side, z_m: Range::new(0.0, TOP_M) });
        let all_m = ends(&mut rng, request.size, radius_m)?;
        let mut occupied: Vec<([f64; 2], f64)> = all_m.iter().flatten().map(|[x, y, _]| ([*x, *y], FREE_RADIUS_M)).collect();
        pillars(&mut rng, &mut world, request.density * (2.0 * half_m).powi(2), [0.3, 0.6], &mut occupied)?;
        let path_length_m = one_after_the_other_m(&world, &all_m)?;
        let vehicles: Vec<Vehicle> = all_m.iter().enumerate().map(|(index, endpoints_m)| vehicle(index, *endpoints_m)).collect();
        let certificate = format!(
            "the vehicles could fly one after the other, {path_length_m:.1} m in all: for each of them a search on a grid has found a \
             path that keeps its centre {CLEARANCE_M} m from everything, and {APART_M} m from the vehicles that have not \
             started and from those that have arrived."
        );
        let mut draft = draft(request, world, vehicles, certificate, path_length_m);
        draft.fleet = format!("\n[fleet]\nseparation_m = {SEPARATION_M} # in space\nplans_shared = true\n");
        Some(draft)
    })
}

fn ends(rng: &mut RandomStream, count: usize, radius_m: f64) -> Option<Vec<Ends>> {
    let on_circle = |angle_rad: f64| {
        let [x, y] = [radius_m * angle_rad.cos(), radius_m * angle_rad.sin()].map(|it| round_to(it, 0.01));
        [x, y, LEVEL_M]
    };
    let mut all_m: Vec<Ends> = Vec::new();
    for _ in 0..count {
        let mut drawn = (0..MAX_ATTEMPTS).map(|_| {
            let angle_rad = rng.between(0.0, TAU);
            [on_circle(angle_rad), on_circle(angle_rad + PI + rng.between(-0.7, 0.7))]
        });
        all_m.push(drawn.find(|endpoints_m| all_m.iter().all(|other_m| are_apart(endpoints_m, other_m)))?);
    }
    Some(all_m)
}

/// Starts, goals, and the start of one and the goal of another: vehicles wait at either.
fn are_apart(a: &Ends, b: &Ends) -> bool {
    let distance_m = |p: [f64; 3], q: [f64; 3]| (p[0] - q[0]).hypot(p[1] - q[1]);
    a.iter().all(|p| b.iter().all(|q| distance_m(*p, *q) >= ENDS_APART_M))
}

/// Length of all paths if the vehicles fly one after the other, m.
fn one_after_the_other_m(world: &World, all_m: &[Ends]) -> Option<f64> {
    let path_length_m = |index: usize| {
        let arrived_m = all_m[..index].iter().map(|endpoints_m| endpoints_m[1]);
        let waiting_m = all_m[index + 1..].iter().map(|endpoints_m| endpoints_m[0]);
        let at_rest = arrived_m.chain(waiting_m).map(|[x, y, _]| Cylinder {
            name: String::new(),
            center_m: [x, y],
            radius_m: APART_M - CLEARANCE_M,
        });
        let mut world = world.clone();
        world.cylinders.extend(at_rest);
        level_path_length_m(&world, all_m[index])
    };
    (0..all_m.len()).map(path_length_m).sum()
}
