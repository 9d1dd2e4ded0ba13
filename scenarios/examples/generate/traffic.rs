//! Dense traffic over a wide area.

use std::f64::consts::TAU;

use rand::{Rng, RngExt};

use super::mission::{Mission, Route, starts_and_ends_apart};

const SEPARATION_M: f64 = 50.0;
/// Area per vehicle, m².
const AREA_M2: f64 = 250_000.0;
const LENGTH_M: [f64; 2] = [2600.0, 3200.0];

/// Random flights whose midpoints fill a disc from the centre outwards: the first n of them fill a smaller disc with the
/// same density.
pub fn traffic(vehicles: usize) -> Mission {
    let mut rng = scenarios::stream(1000, "generate/traffic");
    let disc_m = (vehicles as f64 * AREA_M2 / std::f64::consts::PI).sqrt();
    let mut routes: Vec<Route> = Vec::new();
    while routes.len() < vehicles {
        let route = draw(&mut rng, disc_m * (routes.len() as f64 + 1.0).sqrt() / (vehicles as f64).sqrt());
        if routes.iter().all(|other| starts_and_ends_apart(&route, other, SEPARATION_M)) {
            routes.push(route);
        }
    }
    let half_m = disc_m + LENGTH_M[1] / 2.0 + 500.0;
    let half_m = (half_m / 100.0).ceil() * 100.0;
    Mission {
        name: format!("traffic-{vehicles}"),
        description: format!(
            "{vehicles} aircraft on random straight flights, four per square kilometre: each has few conflicts, the fleet has many."
        ),
        tags: "[\"fleet\", \"large\"]",
        sources: "Ours, except altitude and speed: Wang, Xu, Long, Acta Automatica Sinica (2020). The first n vehicles are\n\
                  a smaller disc of the same density. Written by `cargo run -p scenarios --example generate`.",
        map_m: [[-half_m, half_m]; 2],
        cylinders: Vec::new(),
        separation_m: SEPARATION_M,
        separation_source: "ours",
        simultaneous_arrival: true,
        routes,
        planner: "intervals = 20 # steps of 4 s\n",
    }
}

/// A flight whose midpoint is `from_centre_m` from the centre.
fn draw(rng: &mut impl Rng, from_centre_m: f64) -> Route {
    let (place, heading) = (TAU * rng.random::<f64>(), TAU * rng.random::<f64>());
    let half_m = (LENGTH_M[0] + (LENGTH_M[1] - LENGTH_M[0]) * rng.random::<f64>()) / 2.0;
    let middle_m = [from_centre_m * place.cos(), from_centre_m * place.sin()];
    let along_m = [half_m * heading.cos(), half_m * heading.sin()];
    Route::straight(
        [middle_m[0] - along_m[0], middle_m[1] - along_m[1]],
        [middle_m[0] + along_m[0], middle_m[1] + along_m[1]],
    )
}
