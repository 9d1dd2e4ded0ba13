//! Multirotors: a map is drawn until a search on a grid finds a path across it.

mod building;
mod courtyard;
mod crossing;
mod moving;
mod scatter;

use scenarios::{Family, Map, Range, Vehicle, Waypoint, World};

use super::file::Draft;
use super::grid_search::Grid;
use super::{Density, Kind, Request, Size, Variant};

/// Distance that a certified path keeps from the centre of the vehicle to everything, m: the body's radius, and the margin
/// that the planners keep by default.
const CLEARANCE_M: f64 = 0.6;
/// Altitude of level flights, and of the map's top, m.
const LEVEL_M: f64 = 2.0;
const TOP_M: f64 = 4.0;
/// Distance of starts and goals from the edge of the map, m.
const EDGE_DISTANCE_M: f64 = 1.5;
/// Radius around starts and goals without obstacles, m.
const FREE_RADIUS_M: f64 = 1.5;
/// Cell of the grid for level paths, m.
const STEP_M: f64 = 0.2;
/// Maps that are drawn before a request is given up.
const MAX_MAPS: usize = 200;
/// Speed at which the longest flight that is allowed follows the certified path, m/s, and the shortest allowance, s.
const SLOW_MPS: f64 = 0.5;
const MIN_DURATION_S: f64 = 60.0;

/// The kinds of this family.
pub const KINDS: &[Kind] = &[
    Kind {
        size: side(60, 40, [20, 40, 60]),
        density: Density { meaning: "fraction of the area that boxes and pillars cover", max: 0.2, default: 0.12 },
        variant: Some(Variant::Hidden),
        ..kind("field", "Boxes at any heading and pillars stand between start and goal.", scatter::field)
    },
    Kind {
        size: side(60, 40, [20, 40, 60]),
        density: Density { meaning: "fraction of the area that trunks cover", max: 0.25, default: 0.15 },
        variant: Some(Variant::Hidden),
        ..kind("forest", "Trunks stand between start and goal.", scatter::forest)
    },
    Kind {
        size: Size { meaning: "rooms along each side", min: 2, max: 6, default: 3, suite: [2, 3, 4] },
        density: Density { meaning: "fraction of the volume of walls, floors and furniture", max: 0.2, default: 0.15 },
        variant: Some(Variant::Hidden),
        ..kind("building", "Two floors of rooms with doors: the goal is on the upper floor.", building::draw)
    },
    Kind {
        size: side(80, 40, [20, 40, 60]),
        density: Density { meaning: "fraction of the area that pillars cover", max: 0.08, default: 0.02 },
        variant: None,
        ..kind("moving", "Carts cross a corridor, and one comes the other way.", moving::draw)
    },
    Kind {
        size: Size { meaning: "vehicles", min: 1, max: 8, default: 4, suite: [2, 4, 8] },
        density: Density { meaning: "fraction of the area that pillars cover", max: 0.08, default: 0.0 },
        variant: None,
        ..kind(
            "crossing",
            "Vehicles cross a circle between random points and tell each other their plans.",
            crossing::draw,
        )
    },
    Kind {
        size: Size { meaning: "courtyards in a row", min: 1, max: 5, default: 2, suite: [1, 2, 4] },
        density: Density { meaning: "fraction of the area that pillars cover", max: 0.1, default: 0.02 },
        variant: Some(Variant::Hidden),
        ..kind(
            "courtyard",
            "Courtyards that open towards the start are dead ends on the way to the goal.",
            courtyard::draw,
        )
    },
];

const fn side(max: usize, default: usize, suite: [usize; 3]) -> Size {
    Size { meaning: "length of the map in m", min: 12, max, default, suite }
}

/// A kind whose size, density and variant are to be replaced.
const fn kind(name: &'static str, summary: &'static str, draw: fn(&Request) -> Option<Draft>) -> Kind {
    let size = side(60, 40, [20, 40, 60]);
    let density = Density { meaning: "", max: 0.0, default: 0.0 };
    Kind { name, family: Family::Multirotor, summary, size, density, variant: None, draw }
}

/// A map of this length and width with level flights.
fn level_map(length_m: f64, width_m: f64) -> Map {
    Map { x_m: Range::new(0.0, length_m), y_m: Range::new(0.0, width_m), z_m: Range::new(0.0, TOP_M) }
}

/// A vehicle that starts and ends at rest.
fn vehicle(index: usize, [start_m, goal_m]: [[f64; 3]; 2]) -> Vehicle {
    let [start, goal] = [start_m, goal_m].map(Waypoint::at_rest);
    Vehicle { name: format!("uav-{}", index + 1), model: "quad".to_owned(), start, goal, via: Vec::new() }
}

/// Length of the level path of a vehicle in a world, m.
fn level_path_length_m(world: &World, [start_m, goal_m]: [[f64; 3]; 2]) -> Option<f64> {
    Grid::new(world, Some(LEVEL_M), STEP_M, CLEARANCE_M).path_length_m(start_m, goal_m)
}

/// The scenario of one vehicle, of which a path of `path_length_m` is known.
fn draft_of_one(request: &Request, world: World, endpoints_m: [[f64; 3]; 2], path_length_m: f64) -> Draft {
    let certificate = format!(
        "a search on a grid has found a path of {path_length_m:.1} m that keeps the centre of the vehicle {CLEARANCE_M} m from everything \
         (body radius 0.35 m and a margin of 0.25 m)."
    );
    draft(request, world, vec![vehicle(0, endpoints_m)], certificate, path_length_m)
}

/// - `path_length_m`: length of the certified paths, m, which determines the longest flight allowed
fn draft(
    request: &Request,
    mut world: World,
    vehicles: Vec<Vehicle>,
    certificate: String,
    path_length_m: f64,
) -> Draft {
    let hidden = request.variant() == Some(Variant::Hidden);
    if hidden {
        world.hidden = vec!["*".to_owned()];
    }
    let duration_s = (path_length_m / SLOW_MPS).max(MIN_DURATION_S).ceil();
    let summary = request.kind.summary.trim_end_matches('.');
    Draft {
        summary: if hidden {
            format!("{summary}; none of it is known before it is sensed")
        } else {
            summary.to_owned()
        },
        certificate,
        tags: vec!["multirotor"],
        world,
        models: MODEL.to_owned(),
        fleet: String::new(),
        vehicles,
        settings: format!(
            "\n[planner]\nname = \"rhc\"\n\n[simulation]\nmax_duration_s = {duration_s}\ncoast_s = 1\n\
             tracker = {{ natural_frequency_radps = 2.5, damping_ratio = 0.9 }}\n"
        ),
    }
}

const MODEL: &str = "
[models.multirotor.quad]
plant = \"point-mass\" # `quadrotor` tilts in order to accelerate, and needs an airframe
mass_kg = 1.5
body_radius_m = 0.35
sensor_range_m = 8
# Physical limits: a margin for the tracker around the planning limits.
limits = { speed_mps = 4.5, acceleration_mps2 = 5 }
planning_limits = { speed_mps = 3, acceleration_mps2 = 3 }
";
