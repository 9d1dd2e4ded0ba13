//! A field of obstacles, crossed from both sides.

use rand::RngExt;

use super::mission::{Mission, Route, distance_m};

const WIDTH_M: f64 = 6000.0;
const HEIGHT_M: f64 = 4000.0;
const OBSTACLES: usize = 40;
const MIN_GAP_M: f64 = 180.0;

/// Half of the fleet flies east, half west, each to a goal that is not straight ahead.
pub fn field(vehicles: usize) -> Mission {
    let mut rng = scenarios::stream(20, "generate/field");
    let mut cylinders: Vec<([f64; 2], f64)> = Vec::new();
    while cylinders.len() < OBSTACLES {
        let center_m =
            [900.0 + rng.random::<f64>() * (WIDTH_M - 1800.0), rng.random::<f64>() * HEIGHT_M].map(f64::round);
        let radius_m = (80.0 + 70.0 * rng.random::<f64>()).round();
        let is_free = |(other_m, other_radius_m): &([f64; 2], f64)| {
            distance_m(center_m, *other_m) > radius_m + other_radius_m + MIN_GAP_M
        };
        if cylinders.iter().all(is_free) {
            cylinders.push((center_m, radius_m));
        }
    }
    let lane_m = HEIGHT_M / (vehicles / 2) as f64;
    let route = |i: usize| {
        let (lane, eastward) = (i / 2, i.is_multiple_of(2));
        // Groups of three neighbours exchange lanes.
        let (first, last) = (lane / 3 * 3, (lane / 3 * 3 + 2).min(vehicles / 2 - 1));
        let goal_lane = first + last - lane;
        let y_m = |lane: usize| (lane as f64 + 0.5) * lane_m;
        let [from_m, to_m] = if eastward { [0.0, WIDTH_M] } else { [WIDTH_M, 0.0] };
        // The starts of one direction lie between the goals of the other.
        let shift_m = if eastward { 0.0 } else { lane_m / 2.0 };
        Route {
            start_m: [from_m, y_m(lane) - shift_m],
            start_heading_deg: if eastward { 0.0 } else { 180.0 },
            goal_m: [to_m, y_m(goal_lane) - shift_m],
            goal_heading_deg: if eastward { 0.0 } else { 180.0 },
        }
    };
    Mission {
        name: format!("field-{vehicles}"),
        description: format!(
            "{vehicles} aircraft cross a field of {OBSTACLES} obstacles from both sides, all arriving at the same time."
        ),
        tags: "[\"fleet\", \"obstacles\"]",
        sources: "Ours, except altitude and speed: Wang, Xu, Long, Acta Automatica Sinica (2020). Written by\n\
                  `cargo run -p scenarios --example generate`.",
        map_m: [[-500.0, WIDTH_M + 500.0], [-1000.0, HEIGHT_M + 1000.0]],
        cylinders,
        separation_m: 50.0,
        separation_source: "ours",
        simultaneous_arrival: true,
        routes: (0..vehicles).map(route).collect(),
        planner: "intervals = 40\n",
    }
}
