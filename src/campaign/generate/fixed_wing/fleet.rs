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
/// Time after the arrival until which two aircraft have to stay apart during which they do, too, s.
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
    /// Curvature of the path beyond the goal, 1/m, positive to the left.
    pub beyond_per_m: f64,
}

impl Member {
    /// The position at a time, s.
    pub fn position_m(&self, t_s: f64) -> [f64; 2] {
        let beyond_s = t_s - self.path.duration_s();
        if beyond_s <= 0.0 {
            return self.path.at(t_s).position_m;
        }
        self.path.goal().after(self.path.speed_mps * beyond_s, self.beyond_per_m).position_m
    }

    /// Positions at most `step_m` apart, until the goal or, if that is later, until `end_s`.
    pub fn samples(&self, step_m: f64, end_s: f64) -> impl Iterator<Item = [f64; 2]> + '_ {
        let beyond_m = (end_s - self.path.duration_s()) * self.path.speed_mps;
        let beyond = (1..=(beyond_m / step_m).ceil().max(0.0) as usize).map(move |step| {
            let along_m = (step as f64 * step_m).min(beyond_m);
            self.path.goal().after(along_m, self.beyond_per_m).position_m
        });
        self.path.samples(step_m).map(|pose| pose.position_m).chain(beyond)
    }

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
        Vehicle {
            name: format!("uav-{}", index + 1),
            model: self.aircraft.name.to_owned(),
            start,
            goal,
            via: Vec::new(),
        }
    }
}

/// In (-180, 180].
fn wrapped_deg(angle_deg: f64) -> f64 {
    180.0 - (180.0 - angle_deg).rem_euclid(360.0)
}

/// A fleet of the requested size from `draw`, which receives the extent of the area, m, and the index of the aircraft.
///
/// - `holds`: whether the aircraft that have arrived circle until the last one has arrived
pub fn sample_fleet(
    request: &Request,
    holds: bool,
    mut draw: impl FnMut(f64, &mut RandomStream, usize) -> Option<Member>,
) -> Option<Vec<Member>> {
    let mut rng = request.rng("paths");
    let mut spread_m = 350.0 * (request.size as f64).sqrt();
    for _ in 0..MAX_FLEETS {
        let mut members: Vec<Member> = Vec::new();
        for index in 0..request.size {
            let mut drawn = (0..MAX_ATTEMPTS).filter_map(|_| {
                let mut member = draw(spread_m, &mut rng, index)?;
                if holds {
                    member.beyond_per_m = rng.sign() / member.aircraft.turn_radius_m();
                }
                Some(member)
            });
            members.extend(drawn.find(|member| is_apart(member, &members, holds)));
        }
        if members.len() == request.size {
            return Some(members);
        }
        spread_m *= SPREAD_GROWTH;
    }
    None
}

/// Whether one more aircraft leaves all apart: any two until one of them has arrived or, if they hold, until the last one of
/// the fleet has arrived.
fn is_apart(member: &Member, members: &[Member], holds: bool) -> bool {
    if !holds {
        return members.iter().all(|other| are_apart(member, other, first_arrival_s(member, other)));
    }
    let (before_s, own_s) = (last_arrival_s(members), member.path.duration_s());
    let end_s = own_s.max(before_s) + COAST_S;
    let stay_apart = |(i, one): (usize, &Member)| members[..i].iter().all(|other| are_apart(one, other, end_s));
    members.iter().all(|other| are_apart(member, other, end_s))
        && (own_s <= before_s || members.iter().enumerate().all(stay_apart))
}

/// Shortly after the first of two aircraft has arrived, s.
pub fn first_arrival_s(a: &Member, b: &Member) -> f64 {
    a.path.duration_s().min(b.path.duration_s()) + COAST_S
}

/// When the last aircraft has arrived, s.
pub fn last_arrival_s(members: &[Member]) -> f64 {
    members.iter().map(|member| member.path.duration_s()).fold(0.0, f64::max)
}

/// Whether two aircraft keep [`APART_M`] until a time, s, and whether their starts and goals do.
pub fn are_apart(a: &Member, b: &Member, end_s: f64) -> bool {
    let mut t_s = 0.0;
    while t_s < end_s {
        let beyond_m = distance_m(a.position_m(t_s), b.position_m(t_s)) - APART_M;
        if beyond_m < 0.0 {
            return false;
        }
        t_s += (beyond_m / (a.path.speed_mps + b.path.speed_mps)).max(STEP_S);
    }
    distance_m(a.path.goal().position_m, b.path.goal().position_m) >= APART_M
}

/// The corners of the rectangle around all paths until a time, s, in m.
pub fn bounds(members: &[Member], end_s: f64) -> [[f64; 2]; 2] {
    let positions = members.iter().flat_map(|member| member.samples(50.0, end_s));
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
