//! Fleets whose paths are clear of each other.

use scenarios::{Vehicle, Waypoint};

use super::SEPARATION_M;
use super::aircraft::Aircraft;
use super::path::Path;
use crate::campaign::generate::Request;
use crate::campaign::generate::random_stream::{RandomStream, round_to};

/// Distance between any two aircraft on their paths, m: the separation and a margin.
pub const APART_M: f64 = 1.2 * SEPARATION_M;
/// Smallest step of the search for the closest approach, s. Two aircraft come at most half of it closer than is seen.
const STEP_S: f64 = 0.05;
/// Time after the arrival of the first of two aircraft during which they stay apart too, s.
const COAST_S: f64 = 2.0;
/// Attempts to draw one aircraft, and to draw a fleet, each on a larger area.
const MAX_ATTEMPTS: usize = 300;
const MAX_FLEETS: usize = 12;
/// Factor by which the area of a fleet grows with each attempt, in length.
const SPREAD_GROWTH: f64 = 1.12;

/// An aircraft and its path.
#[derive(Clone, Debug)]
pub struct Member {
    pub aircraft: &'static Aircraft,
    pub path: Path,
    /// Altitudes of start and goal, m.
    pub altitude_m: [f64; 2],
}

impl Member {
    /// The vehicle in the scenario: start and goal are the ends of the path.
    pub fn vehicle(&self, index: usize) -> Vehicle {
        let [start, goal] = [(self.path.start, self.altitude_m[0]), (self.path.goal(), self.altitude_m[1])].map(
            |(pose, altitude_m)| Waypoint {
                speed_mps: self.aircraft.cruise_mps,
                heading_deg: round_to(wrapped_deg(pose.heading_rad.to_degrees()), 1e-6),
                ..Waypoint::at_rest([
                    round_to(pose.position_m[0], 1e-3),
                    round_to(pose.position_m[1], 1e-3),
                    altitude_m,
                ])
            },
        );
        Vehicle { name: format!("uav-{}", index + 1), model: self.aircraft.name.to_owned(), start, goal }
    }
}

/// In (-180, 180].
fn wrapped_deg(angle_deg: f64) -> f64 {
    180.0 - (180.0 - angle_deg).rem_euclid(360.0)
}

/// A fleet of the requested size from `draw`, which receives the extent of the area, m, and the index of the aircraft.
pub fn sample_fleet(
    request: &Request,
    mut draw: impl FnMut(f64, &mut RandomStream, usize) -> Option<Member>,
) -> Option<Vec<Member>> {
    let mut rng = request.rng("paths");
    let mut spread_m = 350.0 * (request.size as f64).sqrt();
    for _ in 0..MAX_FLEETS {
        let mut members: Vec<Member> = Vec::new();
        for index in 0..request.size {
            let mut drawn = (0..MAX_ATTEMPTS).filter_map(|_| draw(spread_m, &mut rng, index));
            members.extend(drawn.find(|member| members.iter().all(|other| are_apart(member, other))));
        }
        if members.len() == request.size {
            return Some(members);
        }
        spread_m *= SPREAD_GROWTH;
    }
    None
}

/// Whether two aircraft keep [`APART_M`] until one of them has arrived, and whether their starts and goals do.
pub fn are_apart(a: &Member, b: &Member) -> bool {
    let [a, b] = [&a.path, &b.path];
    let last_s = a.duration_s().min(b.duration_s()) + COAST_S;
    let mut t_s = 0.0;
    while t_s < last_s {
        let beyond_m = distance_m(a.at(t_s).position_m, b.at(t_s).position_m) - APART_M;
        if beyond_m < 0.0 {
            return false;
        }
        t_s += (beyond_m / (a.speed_mps + b.speed_mps)).max(STEP_S);
    }
    distance_m(a.goal().position_m, b.goal().position_m) >= APART_M
}

/// The corners of the rectangle around all paths, m.
pub fn bounds(members: &[Member]) -> [[f64; 2]; 2] {
    let positions = members.iter().flat_map(|member| member.path.samples(50.0)).map(|pose| pose.position_m);
    positions.fold([[f64::INFINITY; 2], [f64::NEG_INFINITY; 2]], |[low, high], position| {
        [
            std::array::from_fn(|axis| low[axis].min(position[axis])),
            std::array::from_fn(|axis| high[axis].max(position[axis])),
        ]
    })
}

pub fn distance_m(a: [f64; 2], b: [f64; 2]) -> f64 {
    (a[0] - b[0]).hypot(a[1] - b[1])
}
