//! A quadrotor with a slung load: worlds across which a load that hangs straight down can be carried slowly.

mod blocks;
mod gates;
mod passages;

use scenarios::{Family, LoadPoint, Map, Range, Vehicle, Waypoint, World};

use super::file::Draft;
use super::grid_search::Grid;
use super::random_stream::round_to;
use super::{Density, Kind, Request, Size};

/// Distance that a certified path keeps from the cable's axis to everything, m: the radius of the body, the planner's margin
/// and 5 cm.
const CLEARANCE_M: f64 = 0.452;
/// Length of the cable, m.
const CABLE_M: f64 = 0.65;
/// Altitudes of the quadrotor at start and goal, m.
const START_Z_M: f64 = 1.3;
const GOAL_Z_M: f64 = 1.5;
/// Half of the side of the map, m.
const HALF_MAP_M: f64 = 5.0;
/// Distance of starts and goals from the middle of the map, m.
const ENDS_M: f64 = 3.2;
/// Mean speed along the certified path from which the flight time follows, m/s, and the shortest flight time, s.
const SPEED_MPS: f64 = 0.9;
const MIN_TIME_S: f64 = 4.0;
/// Cell of the grid, m.
const STEP_M: f64 = 0.1;
/// Worlds that are drawn before a request is given up.
const MAX_WORLDS: usize = 100;

const BLOCKS: Size = Size { meaning: "blocks", min: 1, max: 5, default: 2, suite: [1, 2, 3] };
const COVERED: Density =
    Density { meaning: "fraction of 16 m² between start and goal that blocks cover", max: 0.35, default: 0.2 };

/// The kinds of this family.
pub const KINDS: &[Kind] = &[
    kind("blocks", "Turned blocks stand between start and goal.", BLOCKS, COVERED, blocks::carry),
    kind(
        "passages",
        "Walls across the map leave one passage each, hardly wider than the quadrotor.",
        Size { meaning: "walls", min: 1, max: 3, default: 2, suite: [1, 2, 3] },
        Density { meaning: "none, there are no other obstacles", max: 0.0, default: 0.0 },
        passages::draw,
    ),
    kind(
        "gates",
        "Quadrotor and load must be in the windows of each gate at one instant.",
        Size { meaning: "gates", min: 1, max: 3, default: 2, suite: [1, 2, 3] },
        Density { meaning: "none, there are no other obstacles", max: 0.0, default: 0.0 },
        gates::draw,
    ),
    kind("pick-up", "A load on the ground is picked up and carried between blocks.", BLOCKS, COVERED, blocks::pick_up),
    kind(
        "drop",
        "A load is released above the full length of its cable, falls, is caught and carried.",
        BLOCKS,
        COVERED,
        blocks::drop,
    ),
];

const fn kind(
    name: &'static str,
    summary: &'static str,
    size: Size,
    density: Density,
    draw: fn(&Request) -> Option<Draft>,
) -> Kind {
    Kind { name, family: Family::SlungLoad, summary, size, density, variant: None, draw }
}

/// How a flight begins.
struct InitialCondition {
    /// Altitude of the quadrotor, m.
    z_m: f64,
    /// Length by which the cable is slack, m.
    slack_m: f64,
    /// Altitude of the ground, m.
    ground_m: f64,
}

impl InitialCondition {
    /// With the load hanging straight down.
    const HANGING: Self = Self { z_m: START_Z_M, slack_m: 0.0, ground_m: -0.5 };
}

fn empty_world(initial: &InitialCondition) -> World {
    let side = Range::new(-HALF_MAP_M, HALF_MAP_M);
    let map = Map { x_m: side, y_m: side, z_m: Range::new(-0.5, 4.0) };
    World { ground_m: Some(initial.ground_m), ..World::empty(map) }
}

/// Length of a path for the hanging load and the body, m.
fn path_length_m(world: &World, [start_m, goal_m]: [[f64; 2]; 2]) -> Option<f64> {
    let at = |[x, y]: [f64; 2]| [x, y, START_Z_M];
    Grid::new(world, Some(START_Z_M), STEP_M, CLEARANCE_M).path_length_m(at(start_m), at(goal_m))
}

fn carrier(initial: &InitialCondition, [start_m, goal_m]: [[f64; 2]; 2]) -> Vehicle {
    let [x_m, y_m] = start_m;
    let load_z_m = round_to(initial.z_m - CABLE_M + initial.slack_m, 1e-3);
    let load = (initial.slack_m > 0.0).then_some(LoadPoint { x_m, y_m, z_m: load_z_m });
    Vehicle {
        name: "carrier".to_owned(),
        model: "quadrotor".to_owned(),
        start: Waypoint { load, ..Waypoint::at_rest([x_m, y_m, initial.z_m]) },
        goal: Waypoint::at_rest([goal_m[0], goal_m[1], GOAL_Z_M]),
        via: Vec::new(),
    }
}

/// - `path_length_m`: length of the certified path, m
/// - `certificate`: what else is known of it
fn draft(request: &Request, world: World, vehicle: Vehicle, path_length_m: f64, certificate: &str) -> Draft {
    let time_s = round_to((path_length_m / SPEED_MPS).max(MIN_TIME_S), 0.1);
    let is_slack = vehicle.start.load.is_some();
    let cable = if is_slack { "cable = [\"slack\", \"taut\"]\n" } else { "" };
    Draft {
        summary: request.kind.summary.trim_end_matches('.').to_owned(),
        certificate: certificate.to_owned(),
        tags: vec![if is_slack { "slack" } else { "taut" }],
        world,
        models: MODEL.to_owned(),
        fleet: String::new(),
        vehicles: vec![vehicle],
        settings: format!(
            "\n[planner]\nname = \"slung-lgr\"\nmargin_m = 0.05\n\n[planner.collocation]\nobjective = \"effort\" # or \
             \"time\", without a flight time\nflight_time_s = {time_s} # {SPEED_MPS} m/s along the certified path\n{cable}\n\
             [verdict]\nenvelope_m = 0.049 # the planner's margin minus 1 mm\n"
        ),
    }
}

const MODEL: &str = "
[models.slung-load.quadrotor] # Kang, Huang, Wen (2020), section 4, unless noted
mass_kg = 1.32
inertia_kgm2 = [0.01768, 0.01764, 0.026432]
arm_m = 0.225
torque_per_thrust_m = 1 # paper; 0.01 to 0.02 is typical
propeller_radius_m = 0.127 # ours: not given in the paper
load_mass_kg = 0.2
load_radius_m = 0.03 # ours
cable_length_m = 0.65

# Physical limits (ours): a margin for the tracker around the paper's bounds.
[models.slung-load.quadrotor.limits]
thrust_n = [0.2, 7]
attitude_deg = [-60, 60]
cable_deg = [-80, 80]
tension_n = 40

[models.slung-load.quadrotor.planning_limits]
thrust_n = [1, 5]
attitude_deg = [-45, 45]
cable_deg = [-60, 60]
tension_n = 20 # ours
";
