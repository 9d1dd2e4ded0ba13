//! Fleets on a circle.

use std::f64::consts::{PI, TAU};

use rand::RngExt;

use super::mission::{Mission, Route, starts_and_ends_apart};

const RADIUS_M: f64 = 3000.0;

/// All vehicles fly to the opposite point.
pub fn exchange(vehicles: usize) -> Mission {
    let on_circle = |turn: f64| [RADIUS_M * (TAU * turn).cos(), RADIUS_M * (TAU * turn).sin()];
    let route = |i: usize| {
        let turn = i as f64 / vehicles as f64;
        Route::straight(on_circle(turn), on_circle(turn + 0.5))
    };
    Mission {
        name: format!("exchange-{vehicles}"),
        description: format!(
            "{vehicles} aircraft, evenly spaced on a circle, all fly to the opposite point and would meet in the centre at the same time."
        ),
        tags: if vehicles == 100 { "[\"paper\", \"fleet\", \"large\"]" } else { "[\"fleet\"]" },
        sources: "Circle, separation, speed and headings at both ends: Xu, Wang, Cao, Sun, Long, Acta Aeronautica et Astronautica\n\
                  Sinica 43(2) (2022), which flies 100 vehicles; smaller fleets are ours. Altitude: Wang, Xu, Long (2020). Written by\n\
                  `cargo run -p scenarios --example generate`.",
        map_m: [[-3500.0, 3500.0]; 2],
        cylinders: Vec::new(),
        separation_m: 10.0,
        separation_source: "paper",
        simultaneous_arrival: true,
        routes: (0..vehicles).map(route).collect(),
        planner: "intervals = 40 # paper\n",
    }
}

/// Random starts and goals on the circle.
pub fn crossing(vehicles: usize) -> Mission {
    let mut rng = scenarios::stream(30, "generate/crossing");
    let mut routes: Vec<Route> = Vec::new();
    while routes.len() < vehicles {
        let from: f64 = rng.random::<f64>() * TAU;
        // A chord of at least 4.8 km: on a shorter one a flight could not last as long as on a diameter.
        let to = from + PI + (rng.random::<f64>() - 0.5) * 2.0 * 75_f64.to_radians();
        let on_circle = |angle: f64| [RADIUS_M * angle.cos(), RADIUS_M * angle.sin()];
        let route = Route::straight(on_circle(from), on_circle(to));
        if routes.iter().all(|other| starts_and_ends_apart(&route, other, SEPARATION_M)) {
            routes.push(route);
        }
    }
    Mission {
        name: format!("crossing-{vehicles}"),
        description: format!(
            "{vehicles} aircraft cross a circle between random points, all arriving at the same time."
        ),
        tags: "[\"fleet\"]",
        sources: "Ours, except altitude and speed: Wang, Xu, Long, Acta Automatica Sinica (2020). Written by\n\
                  `cargo run -p scenarios --example generate`.",
        map_m: [[-3500.0, 3500.0]; 2],
        cylinders: Vec::new(),
        separation_m: SEPARATION_M,
        separation_source: "ours",
        simultaneous_arrival: true,
        routes,
        planner: "intervals = 40\n",
    }
}

const SEPARATION_M: f64 = 50.0;
