//! Turned blocks, and how the load comes onto its cable before them.

use scenarios::{BoxObstacle, World};

use super::{CABLE_M, CLEARANCE_M, ENDS_M, InitialCondition, MAX_WORLDS, carrier, draft, empty_world, path_length_m};
use crate::campaign::generate::Request;
use crate::campaign::generate::file::Draft;
use crate::campaign::generate::random_stream::{RandomStream, round_to};

/// Half of the side of the area in which blocks have their middle, m.
const HALF_AREA_M: f64 = 2.0;
/// Distance of blocks from start and goal, m.
const FREE_RADIUS_M: f64 = 0.8;
/// Attempts to place one more block.
const MAX_ATTEMPTS: usize = 500;
/// Radius of the load, m, and its altitude on the ground.
const LOAD_RADIUS_M: f64 = 0.03;
/// Masses of quadrotor and load, kg.
const MASSES_KG: [f64; 2] = [1.32, 0.2];

/// The load hangs straight down at the start.
pub fn carry(request: &Request) -> Option<Draft> {
    draw(request, |_| InitialCondition::HANGING, |_| String::new())
}

/// The load lies on the ground.
pub fn pick_up(request: &Request) -> Option<Draft> {
    let initial = |rng: &mut RandomStream| {
        let slack_m = rng.rounded(0.1, 0.3, 0.01);
        InitialCondition { z_m: round_to(CABLE_M - slack_m, 1e-3), slack_m, ground_m: -LOAD_RADIUS_M }
    };
    let certificate =
        |_: &InitialCondition| "The load can be lifted as gently as wanted, by rising slowly above it. ".to_owned();
    draw(request, initial, certificate)
}

/// The load falls into its cable.
pub fn drop(request: &Request) -> Option<Draft> {
    let initial = |rng: &mut RandomStream| InitialCondition {
        slack_m: rng.rounded(0.05, 0.3, 0.01),
        ..InitialCondition::HANGING
    };
    draw(request, initial, |initial| {
        let speed_mps = (2.0 * scenarios::GRAVITY_MPS2 * initial.slack_m).sqrt();
        let [quadrotor_kg, load_kg] = MASSES_KG;
        let impulse_ns = quadrotor_kg * load_kg / (quadrotor_kg + load_kg) * speed_mps;
        format!("A load that falls below a hovering quadrotor is caught with an impulse of {impulse_ns:.2} N s. ")
    })
}

fn draw(
    request: &Request,
    initial: impl Fn(&mut RandomStream) -> InitialCondition,
    certificate: impl Fn(&InitialCondition) -> String,
) -> Option<Draft> {
    let mut rng = request.rng("blocks");
    (0..MAX_WORLDS).find_map(|_| {
        let initial = initial(&mut rng);
        let endpoints_m = [-ENDS_M, ENDS_M].map(|x| [x, rng.rounded(-1.0, 1.0, 0.1)]);
        let mut world = empty_world(&initial);
        blocks(request, &mut rng, &mut world, endpoints_m)?;
        let path_length_m = path_length_m(&world, endpoints_m)?;
        let certificate = format!(
            "{}A search on a grid has found a path of {path_length_m:.1} m on which the cable's axis is {CLEARANCE_M} m from every block: \
             body (0.352 m), planner's margin and 0.05 m. A load that is carried slowly hangs straight down.",
            certificate(&initial)
        );
        Some(draft(request, world, carrier(&initial, endpoints_m), path_length_m, &certificate))
    })
}

/// Blocks of about equal area.
fn blocks(request: &Request, rng: &mut RandomStream, world: &mut World, endpoints_m: [[f64; 2]; 2]) -> Option<()> {
    let area_m2 = request.density * 4.0 * HALF_AREA_M * HALF_AREA_M / request.size as f64;
    let mut occupied: Vec<([f64; 2], f64)> = endpoints_m.map(|end_m| (end_m, FREE_RADIUS_M)).to_vec();
    let count = if request.density > 0.0 { request.size } else { 0 };
    for number in 1..=count {
        let mut drawn = (0..MAX_ATTEMPTS).map(|_| {
            let aspect = rng.between(1.0, 2.0).sqrt();
            let size_m = [area_m2.sqrt() * aspect, area_m2.sqrt() / aspect].map(|it| round_to(it, 0.01).max(0.05));
            let center_m = [0, 1].map(|_| rng.rounded(-HALF_AREA_M, HALF_AREA_M, 0.05));
            (center_m, size_m, size_m[0].hypot(size_m[1]) / 2.0)
        });
        let (center_m, size_m, radius_m) = drawn.find(|(center_m, _, radius_m)| {
            let is_free =
                |([x, y], other_m): &([f64; 2], f64)| (center_m[0] - x).hypot(center_m[1] - y) >= radius_m + other_m;
            occupied.iter().all(is_free)
        })?;
        occupied.push((center_m, radius_m));
        let heading_deg = rng.rounded(-90.0, 90.0, 1.0);
        world.boxes.push(BoxObstacle { name: format!("block-{number}"), center_m, size_m, heading_deg, z_m: None });
    }
    Some(())
}
