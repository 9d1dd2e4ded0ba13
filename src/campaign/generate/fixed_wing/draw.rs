//! How each kind draws the path of an aircraft.

use std::f64::consts::{FRAC_PI_2, PI, TAU};

use super::aircraft::{Aircraft, SCOUT};
use super::fleet::{APART_M, Member, are_apart, distance_m, first_arrival_s};
use super::path::{Leg, Path, Pose, lane_change, length_m};
use super::{ALTITUDE_M, RandomStream};
use crate::campaign::generate::Request;
use crate::campaign::generate::random_stream::round_to;

/// Duration of the flights, s, where all have the same.
const DURATION_S: f64 = 160.0;
/// Smallest and largest duration of flights that may end at any time, as a fraction of the former.
const FREE_DURATION: [f64; 2] = [0.7, 1.1];
/// Smallest radius of the ring, m.
const RING_M: f64 = 3000.0;
/// Largest deviation of a start on the ring from even spacing, as a fraction of the spacing.
const RING_JITTER: f64 = 0.3;

/// What the rng of one fleet have in common.
pub struct FleetParameters {
    /// Aircraft.
    pub count: usize,
    /// Extent of the area in which paths have their middle, m.
    pub spread_m: f64,
    /// Whether all paths have the same duration.
    pub simultaneous: bool,
}

impl FleetParameters {
    fn duration_s(&self, rng: &mut RandomStream) -> f64 {
        let fraction = rng.between(FREE_DURATION[0], FREE_DURATION[1]);
        if self.simultaneous { DURATION_S } else { DURATION_S * fraction }
    }

    fn middle_m(&self, rng: &mut RandomStream) -> [f64; 2] {
        [0, 1].map(|_| rng.between(-self.spread_m, self.spread_m))
    }
}

/// All fly the same curve around the centre, at the smallest distance at which they are apart.
pub fn ring(request: &Request) -> Option<Vec<Member>> {
    let mut rng = request.rng("paths");
    let spacing_rad = TAU / request.size as f64;
    let radius_m = RING_M.max(APART_M / (1.0 - 2.0 * RING_JITTER) / spacing_rad * 1.1);
    let angles_rad: Vec<f64> =
        (0..request.size).map(|i| spacing_rad * (i as f64 + rng.between(-RING_JITTER, RING_JITTER))).collect();
    let mut aside_m = if request.size == 1 { 0.0 } else { APART_M / 2.0 };
    while aside_m < radius_m {
        let turn_m = SCOUT.turn_radius_m();
        let legs = [lane_change(radius_m, aside_m, turn_m)?, lane_change(radius_m, -aside_m, turn_m)?].concat();
        let member = |angle_rad: &f64| {
            let start = Pose { position_m: on_circle(radius_m, *angle_rad), heading_rad: angle_rad + PI };
            level(SCOUT, Path { start, legs: legs.clone(), speed_mps: SCOUT.cruise_mps })
        };
        let members: Vec<Member> = angles_rad.iter().map(member).collect();
        if (0..members.len()).all(|i| {
            members[..i].iter().all(|other| are_apart(&members[i], other, first_arrival_s(&members[i], other)))
        }) {
            return Some(members);
        }
        aside_m *= 1.1;
    }
    None
}

/// A turn, a straight line, a turn.
pub fn mixed(parameters: &FleetParameters, rng: &mut RandomStream, _: usize) -> Option<Member> {
    let aircraft = Aircraft::ALL[rng.index(Aircraft::ALL.len())];
    let turns_rad = [0, 1].map(|_| rng.sign() * rng.between(0.0, 60_f64.to_radians()));
    turn_line_turn(parameters, rng, aircraft, turns_rad).map(|path| climbing(rng, aircraft, path))
}

/// Any turn at either end.
pub fn headings(parameters: &FleetParameters, rng: &mut RandomStream, _: usize) -> Option<Member> {
    let turns_rad = [0, 1].map(|_| rng.sign() * rng.between(0.1, 150_f64.to_radians()));
    turn_line_turn(parameters, rng, SCOUT, turns_rad).map(|path| climbing(rng, SCOUT, path))
}

/// A long turn, a line and another turn that end close to the start.
pub fn near(parameters: &FleetParameters, rng: &mut RandomStream, _: usize) -> Option<Member> {
    let turns_rad = [[150_f64, 300.0], [0.1, 180.0]]
        .map(|[low, high]| rng.sign() * rng.between(low.to_radians(), high.to_radians()));
    let path = turn_line_turn(parameters, rng, SCOUT, turns_rad)?;
    let away_m = distance_m(path.start.position_m, path.goal().position_m);
    (away_m < 2.0 * SCOUT.turn_radius_m()).then(|| level(SCOUT, path))
}

/// From one lane of a stream to another.
pub fn transit(parameters: &FleetParameters, rng: &mut RandomStream, _: usize) -> Option<Member> {
    let heading_rad = [0.0, PI, FRAC_PI_2][rng.index(3)];
    let across_m = rng.between(-1.5, 1.5) * parameters.spread_m;
    let along_m = rng.between(-800.0, 800.0);
    let aside_m = [0, 1].map(|_| rng.between(-500.0, 500.0));
    let wanted_m = parameters.duration_s(rng) * SCOUT.cruise_mps;
    // The further ahead, the longer.
    let legs = bisect(wanted_m, [0.5 * wanted_m, wanted_m], |ahead_m| {
        two_lane_changes(ahead_m, aside_m, SCOUT.turn_radius_m())
    })?;
    let middle_m = if heading_rad == FRAC_PI_2 { [across_m, along_m] } else { [along_m, across_m] };
    let start = Pose { position_m: [0.0; 2], heading_rad };
    Some(level(SCOUT, Path { start, legs, speed_mps: SCOUT.cruise_mps }.through(middle_m)))
}

/// Into a line of goals, from a distance between half of the largest and the largest.
pub fn uneven(parameters: &FleetParameters, rng: &mut RandomStream, index: usize) -> Option<Member> {
    const LARGEST_M: f64 = 8000.0;
    const GAP_M: f64 = 200.0;
    let ahead_m = LARGEST_M * rng.between(0.5, 1.0);
    let aside_m = rng.between(-1.0, 1.0) * parameters.spread_m;
    let sign = rng.sign();
    let detour_m = rng.between(0.0, 600.0);
    let split = |detour_m: f64| {
        two_lane_changes(
            ahead_m,
            [aside_m / 2.0 + sign * detour_m, aside_m / 2.0 - sign * detour_m],
            SCOUT.turn_radius_m(),
        )
    };
    // The wider the detour, the longer.
    let legs = if parameters.simultaneous {
        bisect(1.05 * LARGEST_M.hypot(parameters.spread_m), [0.0, LARGEST_M], split)?
    } else {
        split(detour_m)?
    };
    let goal_m = [0.0, GAP_M * (index as f64 - (parameters.count - 1) as f64 / 2.0)];
    let start = Pose { position_m: [goal_m[0] - ahead_m, goal_m[1] - aside_m], heading_rad: 0.0 };
    Some(level(SCOUT, Path { start, legs, speed_mps: SCOUT.cruise_mps }))
}

/// The line between two turns is as long as the duration demands; `None` if the turns alone take longer.
fn turn_line_turn(
    parameters: &FleetParameters,
    rng: &mut RandomStream,
    aircraft: &Aircraft,
    turns_rad: [f64; 2],
) -> Option<Path> {
    let radius_m = aircraft.turn_radius_m() * rng.between(1.0, 1.3);
    let turns = turns_rad.map(|angle_rad| Leg::turn(angle_rad, radius_m));
    let straight_m = parameters.duration_s(rng) * aircraft.cruise_mps - length_m(&turns);
    let start = Pose { position_m: [0.0; 2], heading_rad: rng.between(-PI, PI) };
    let legs = vec![turns[0], Leg::straight(straight_m), turns[1]];
    let path = Path { start, legs, speed_mps: aircraft.cruise_mps }.through(parameters.middle_m(rng));
    (straight_m >= 0.0).then_some(path)
}

fn two_lane_changes(ahead_m: f64, aside_m: [f64; 2], radius_m: f64) -> Option<Vec<Leg>> {
    let [first, second] = aside_m.map(|aside_m| lane_change(ahead_m / 2.0, aside_m, radius_m));
    Some([first?, second?].concat())
}

/// The legs of total length `wanted_m`, from a parameter of which the length is an increasing function.
fn bisect(wanted_m: f64, [mut low, mut high]: [f64; 2], legs: impl Fn(f64) -> Option<Vec<Leg>>) -> Option<Vec<Leg>> {
    let excess_m = |value: f64| legs(value).map(|legs| length_m(&legs) - wanted_m);
    if !(excess_m(low)? <= 0.0 && excess_m(high)? >= 0.0) {
        return None;
    }
    for _ in 0..60 {
        let middle = (low + high) / 2.0;
        if excess_m(middle)? <= 0.0 { low = middle } else { high = middle }
    }
    legs(low)
}

fn level(aircraft: &'static Aircraft, path: Path) -> Member {
    Member { aircraft, path, altitude_m: [ALTITUDE_M; 2], beyond_per_m: 0.0 }
}

/// With a start and a goal of altitudes of their own, at most a slope of 2 % apart.
fn climbing(rng: &mut RandomStream, aircraft: &'static Aircraft, path: Path) -> Member {
    let largest_m = (0.02 * path.length_m()).min(80.0);
    let start_m = round_to(rng.between(340.0, 460.0), 1.0);
    let goal_m = round_to((start_m + rng.between(-largest_m, largest_m)).clamp(320.0, 480.0), 1.0);
    Member { aircraft, path, altitude_m: [start_m, goal_m], beyond_per_m: 0.0 }
}

fn on_circle(radius_m: f64, angle_rad: f64) -> [f64; 2] {
    [radius_m * angle_rad.cos(), radius_m * angle_rad.sin()]
}
