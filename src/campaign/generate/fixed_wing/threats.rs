//! Threats where no path passes.

use scenarios::Cylinder;

use super::fleet::{Member, bounds, distance_m};
use crate::campaign::generate::Request;

/// Distance of every path from every threat, m.
pub const CLEAR_M: f64 = 60.0;
/// Radii of threats, m.
const RADIUS_M: [f64; 2] = [80.0, 200.0];
/// Distance between samples of a path, m, and its contribution to the required distance.
const STEP_M: f64 = 20.0;
/// Attempts to place one more threat.
const MAX_ATTEMPTS: usize = 3000;

/// Threats that cover the requested fraction of the rectangle around the paths. They do not overlap.
///
/// - `end_s`: until when the aircraft fly at least, s
pub fn draw(request: &Request, members: &[Member], end_s: f64) -> Option<Vec<Cylinder>> {
    let mut rng = request.rng("threats");
    let [low, high] = bounds(members, end_s);
    let wanted_m2 = request.density * (high[0] - low[0]) * (high[1] - low[1]);
    let samples: Vec<[f64; 2]> = members.iter().flat_map(|member| member.samples(STEP_M, end_s)).collect();
    let mut threats: Vec<Cylinder> = Vec::new();
    let mut covered_m2 = 0.0;
    while covered_m2 < wanted_m2 {
        let mut candidates = (0..MAX_ATTEMPTS).map(|_| {
            let center_m = [0, 1].map(|axis| rng.rounded(low[axis], high[axis], 1.0));
            (center_m, rng.rounded(RADIUS_M[0], RADIUS_M[1], 1.0))
        });
        let (center_m, radius_m) = candidates.find(|(center_m, radius_m)| {
            let is_off =
                |position_m: &[f64; 2]| distance_m(*position_m, *center_m) >= radius_m + CLEAR_M + STEP_M / 2.0;
            let is_beside = |other: &Cylinder| distance_m(other.center_m, *center_m) >= radius_m + other.radius_m;
            threats.iter().all(is_beside) && samples.iter().all(is_off)
        })?;
        covered_m2 += std::f64::consts::PI * radius_m * radius_m;
        threats.push(Cylinder { name: format!("threat-{}", threats.len() + 1), center_m, radius_m });
    }
    Some(threats)
}
