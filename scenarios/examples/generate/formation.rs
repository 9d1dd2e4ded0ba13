//! A rendezvous into a formation.

use super::mission::{Mission, Route};

/// Fifteen aircraft from scattered starts, heading east, into a V formation heading north.
pub fn rendezvous() -> Mission {
    let starts_m = [
        [0.0, 0.0],
        [600.0, -1500.0],
        [300.0, 1250.0],
        [900.0, -700.0],
        [150.0, 650.0],
        [1300.0, -1800.0],
        [-100.0, 1900.0],
        [1100.0, -1150.0],
        [500.0, 350.0],
        [1700.0, -1400.0],
        [850.0, 1600.0],
        [350.0, -900.0],
        [900.0, 900.0],
        [150.0, -450.0],
        [1250.0, -250.0],
    ];
    let route = |(place, start_m): (usize, [f64; 2])| Route {
        start_m,
        start_heading_deg: 0.0,
        goal_m: position_in_formation(place),
        goal_heading_deg: 90.0,
    };
    Mission {
        name: "rendezvous-15".into(),
        description: "Fifteen aircraft from scattered starts among threats into a V formation at right angles to their initial heading, all arriving at the same time.".into(),
        tags: "[\"paper\", \"fleet\"]",
        sources: "Fleet size, headings, speeds, separation and the shape of the formation: Xu, Wang, Cao, Sun, Long, Acta Aeronautica et\n\
                  Astronautica Sinica 43(2) (2022), which shows positions only in a figure: starts, goals and threats are ours, such\n\
                  that the flight takes about as long as the paper's (174.4 s). Altitude: Wang, Xu, Long (2020). Written by\n\
                  `cargo run -p scenarios --example generate`.",
        map_m: [[-1000.0, 8000.0], [-3000.0, 5000.0]],
        cylinders: vec![
            ([2300.0, -500.0], 300.0),
            ([2100.0, 800.0], 300.0),
            ([3300.0, -1300.0], 300.0),
            ([3500.0, 300.0], 300.0),
            ([3300.0, 1800.0], 300.0),
            ([4900.0, 1200.0], 300.0),
        ],
        separation_m: 100.0,
        separation_source: "paper",
        simultaneous_arrival: true,
        routes: starts_m.into_iter().enumerate().map(route).collect(),
        planner: "intervals = 40 # paper\n",
    }
}

/// The leader at the tip, the others alternately left and right, 45 degrees behind.
fn position_in_formation(place: usize) -> [f64; 2] {
    let row = place.div_ceil(2) as f64;
    let side = if place.is_multiple_of(2) { 1.0 } else { -1.0 };
    [5300.0 + side * 150.0 * row, 3700.0 - 150.0 * row]
}
