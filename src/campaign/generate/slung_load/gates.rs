//! Gates around a load that hangs straight down.

use scenarios::{Gate, Range, Window};

use super::{CABLE_M, ENDS_M, GOAL_Z_M, InitialCondition, START_Z_M, carrier, draft, empty_world};
use crate::campaign::generate::Request;
use crate::campaign::generate::file::Draft;
use crate::campaign::generate::random_stream::{RandomStream, round_to};

/// Largest distance of a gate from the middle of the map, m, and its altitudes for the quadrotor, m.
const ASIDE_M: f64 = 1.0;
const ALTITUDE_M: [f64; 2] = [1.0, 2.2];
/// Half of the size of a window, m.
const HALF_WINDOW_M: [f64; 2] = [0.12, 0.3];

/// Gates at equal distances.
pub fn draw(request: &Request) -> Option<Draft> {
    let mut rng = request.rng("gates");
    let endpoints_m = [-ENDS_M, ENDS_M].map(|x| [x, rng.rounded(-1.0, 1.0, 0.1)]);
    let mut world = empty_world(&InitialCondition::HANGING);
    let mut corners_m = vec![[endpoints_m[0][0], endpoints_m[0][1], START_Z_M]];
    for index in 0..request.size {
        let x_m = round_to(ENDS_M * (2.0 * (index + 1) as f64 / (request.size + 1) as f64 - 1.0), 0.01);
        let at_m = [x_m, rng.rounded(-ASIDE_M, ASIDE_M, 0.05), rng.rounded(ALTITUDE_M[0], ALTITUDE_M[1], 0.05)];
        corners_m.push(at_m);
        world.gates.push(gate(&mut rng, index + 1, at_m));
    }
    corners_m.push([endpoints_m[1][0], endpoints_m[1][1], GOAL_Z_M]);
    let leg_m = |ends: &[[f64; 3]]| (0..3).map(|axis| (ends[1][axis] - ends[0][axis]).powi(2)).sum::<f64>().sqrt();
    let path_length_m: f64 = corners_m.windows(2).map(leg_m).sum();
    let certificate = format!(
        "a load that is carried slowly hangs straight down, and the middles of the two windows of each gate are {CABLE_M} m \
         above each other: straight lines of {path_length_m:.1} m in all lead through all gates, one after the other."
    );
    Some(draft(request, world, carrier(&InitialCondition::HANGING, endpoints_m), path_length_m, &certificate))
}

fn gate(rng: &mut RandomStream, number: usize, quadrotor_m: [f64; 3]) -> Gate {
    let half_m = [0, 1, 2].map(|_| rng.rounded(HALF_WINDOW_M[0], HALF_WINDOW_M[1], 0.01));
    let window = |[x, y, z]: [f64; 3]| {
        let range = |axis: usize, middle_m: f64| {
            Some(Range::new(round_to(middle_m - half_m[axis], 1e-3), round_to(middle_m + half_m[axis], 1e-3)))
        };
        Window { x_m: range(0, x), y_m: range(1, y), z_m: range(2, z) }
    };
    let [x, y, z] = quadrotor_m;
    Gate { name: format!("gate-{number}"), quadrotor: window(quadrotor_m), load: window([x, y, z - CABLE_M]) }
}
