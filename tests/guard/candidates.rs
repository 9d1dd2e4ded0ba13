//! Candidates of 5 s for a multirotor among 50 prisms, for the tests and the benchmark of the guard.

use harness::guard::Knot;
use scenarios::{Prism, Range, Scenario};

/// Duration of a candidate, s, and time between two of its knots, s.
const DURATION_S: f64 = 5.0;
const INTERVAL_S: f64 = 0.1;

/// A scenario with one multirotor, at rest, among 50 prisms of 3 to 6 corners on a map of 60 m by 60 m.
pub fn scenario() -> Scenario {
    let file = std::path::Path::new(env!("CARGO_MANIFEST_DIR")).join("scenarios/multirotor/canyon-3d.toml");
    let mut scenario = scenarios::load(&file).expect("a shipped scenario");
    let world = &mut scenario.world;
    (world.cylinders, world.boxes, world.moving, world.hidden) = (vec![], vec![], vec![], vec![]);
    world.map.x_m = Range::new(0.0, 60.0);
    world.map.y_m = Range::new(0.0, 60.0);
    world.map.z_m = Range::new(0.0, 12.0);
    let mut random = Random(7);
    world.prisms = (0..50).map(|index| prism(index, &mut random)).collect();
    scenario
}

/// In the cell `index` of a grid of 7 by 8.
fn prism(index: usize, random: &mut Random) -> Prism {
    let center_m = [4.0 + 8.0 * (index % 7) as f64, 4.0 + 7.5 * (index / 7) as f64];
    let (corners, radius_m) = (3 + index % 4, random.between(0.8, 2.0));
    let first_rad = random.between(0.0, 1.0);
    let corner = |corner: usize| {
        let angle_rad = first_rad + std::f64::consts::TAU * corner as f64 / corners as f64;
        [center_m[0] + radius_m * angle_rad.cos(), center_m[1] + radius_m * angle_rad.sin()]
    };
    let z_m = (!index.is_multiple_of(3)).then(|| Range::new(0.0, random.between(4.0, 12.0)));
    Prism { name: format!("prism-{index}"), corners_m: (0..corners).map(corner).collect(), z_m }
}

/// The candidate number `seed`: a sinusoidal path that begins and ends at rest, in any direction through the prisms; every
/// fourth one runs along the lane between two rows of them.
pub fn candidate(seed: u64) -> Vec<Knot> {
    let mut random = Random(seed.wrapping_mul(0x9e37_79b9) + 1);
    let lane = seed.is_multiple_of(4);
    let length_m = random.between(2.0, 6.0);
    let heading_rad = if lane { 0.0 } else { random.between(0.0, std::f64::consts::TAU) };
    let begin_m = [random.between(8.0, 44.0), random.between(8.0, 48.0), random.between(1.5, 10.0)];
    let begin_m = if lane { [begin_m[0], 7.75 + 7.5 * (seed / 4 % 6) as f64, begin_m[2]] } else { begin_m };
    let sway_m = if lane { 0.0 } else { random.between(0.0, 0.5) };
    let knot = |step: usize| {
        let t_s = step as f64 * INTERVAL_S;
        // s = 3 u² - 2 u³ from 0 to 1, at rest at both ends.
        let u = t_s / DURATION_S;
        let (s, ds_per_s) = (u * u * (3.0 - 2.0 * u), 6.0 * u * (1.0 - u) / DURATION_S);
        let turn = std::f64::consts::TAU * s;
        let (forward_m, side_m) = (length_m * s, sway_m * (1.0 - turn.cos()));
        let (forward_mps, side_mps) = (length_m * ds_per_s, sway_m * turn.sin() * std::f64::consts::TAU * ds_per_s);
        let (sin, cos) = heading_rad.sin_cos();
        Knot {
            t_s,
            position_m: [
                begin_m[0] + cos * forward_m - sin * side_m,
                begin_m[1] + sin * forward_m + cos * side_m,
                begin_m[2],
            ],
            velocity_mps: [cos * forward_mps - sin * side_mps, sin * forward_mps + cos * side_mps, 0.0],
        }
    };
    (0..=(DURATION_S / INTERVAL_S).round() as usize).map(knot).collect()
}

/// Numbers that are spread well enough for a benchmark (SplitMix64).
struct Random(u64);

impl Random {
    fn between(&mut self, low: f64, high: f64) -> f64 {
        self.0 = self.0.wrapping_add(0x9e37_79b9_7f4a_7c15);
        let mut z = self.0;
        z = (z ^ (z >> 30)).wrapping_mul(0xbf58_476d_1ce4_e5b9);
        z = (z ^ (z >> 27)).wrapping_mul(0x94d0_49bb_1331_11eb);
        low + (high - low) * ((z ^ (z >> 31)) >> 11) as f64 / (1u64 << 53) as f64
    }
}
