//! Fleets of fixed wings, built around paths that they can fly: first the paths, all clear of each other, then the starts and
//! goals at their ends, then the threats where no path passes.

mod aircraft;
mod draw;
mod fleet;
mod path;
mod threats;

use scenarios::{Family, Map, Range, World};

use self::aircraft::Aircraft;
use self::draw::FleetParameters;
use self::fleet::Member;
use super::file::Draft;
use super::random_stream::{RandomStream, round_to};
use super::{Density, Kind, Request, Size, Variant};

/// Separation of the fleets, m.
const SEPARATION_M: f64 = 50.0;
/// Free space around the paths on the map, m.
const MAP_MARGIN_M: f64 = 1000.0;
/// Altitude at which starts and goals lie, unless a kind varies it, m.
const ALTITUDE_M: f64 = 400.0;

const SIZE: Size = Size { meaning: "aircraft", min: 1, max: 100, default: 8, suite: [3, 8, 20] };
const DENSITY: Density = Density { meaning: "fraction of the flown area that threats cover", max: 0.1, default: 0.05 };

/// The kinds of this family.
pub const KINDS: &[Kind] = &[
    kind("ring", "Aircraft cross a circle to the opposite point: every straight path meets every other.", |it| {
        draft(it, &draw::ring(it)?)
    }),
    kind("mixed", "Aircraft of three sizes and speed ranges cross each other.", |it| {
        draft(it, &sample_fleet(it, draw::mixed)?)
    }),
    kind("transit", "Streams from west, east and south cross; each aircraft changes to another lane.", |it| {
        draft(it, &sample_fleet(it, draw::transit)?)
    }),
    kind("uneven", "Aircraft at very different distances gather into a formation.", |it| {
        draft(it, &sample_fleet(it, draw::uneven)?)
    }),
    kind("headings", "Starts and goals have any heading, and altitudes of their own.", |it| {
        draft(it, &sample_fleet(it, draw::headings)?)
    }),
    kind("near", "Goals lie within two turning radii of the starts: an aircraft must fly a loop.", |it| {
        draft(it, &sample_fleet(it, draw::near)?)
    }),
];

const fn kind(name: &'static str, summary: &'static str, draw: fn(&Request) -> Option<Draft>) -> Kind {
    let variant = Some(Variant::FreeArrival);
    Kind { name, family: Family::FixedWing, summary, size: SIZE, density: DENSITY, variant, draw }
}

fn sample_fleet(
    request: &Request,
    draw: fn(&FleetParameters, &mut RandomStream, usize) -> Option<Member>,
) -> Option<Vec<Member>> {
    let simultaneous = request.variant() != Some(Variant::FreeArrival);
    fleet::sample_fleet(request, !simultaneous, |spread_m, rng, index| {
        draw(&FleetParameters { count: request.size, spread_m, simultaneous }, rng, index)
    })
}

fn draft(request: &Request, members: &[Member]) -> Option<Draft> {
    let simultaneous_arrival = request.variant() != Some(Variant::FreeArrival);
    let end_s = if simultaneous_arrival { 0.0 } else { fleet::last_arrival_s(members) };
    let mut world = World::empty(map(members, end_s));
    world.cylinders = threats::draw(request, members, end_s)?;
    let is_used = |model: &&Aircraft| members.iter().any(|member| member.aircraft.name == model.name);
    Some(Draft {
        summary: summary(request, members),
        certificate: certificate(members, simultaneous_arrival),
        tags: vec!["fleet"],
        world,
        models: Aircraft::ALL.into_iter().filter(is_used).map(Aircraft::to_toml).collect(),
        fleet: format!(
            "\n[fleet]\nseparation_m = {SEPARATION_M} # horizontal\nsimultaneous_arrival = {simultaneous_arrival}\n"
        ),
        vehicles: members.iter().enumerate().map(|(index, member)| member.vehicle(index)).collect(),
        settings: "\n[planner]\nname = \"fleet-scp\"\n".to_owned(),
    })
}

fn summary(request: &Request, members: &[Member]) -> String {
    let summary = request.kind.summary.trim_end_matches('.');
    match members.len() {
        1 => format!("One aircraft. {summary}"),
        count => format!("{count} aircraft. {summary}"),
    }
}

fn certificate(members: &[Member], simultaneous_arrival: bool) -> String {
    let is_level = members.iter().all(|member| member.altitude_m[0] == member.altitude_m[1]);
    let slope = if is_level { "level" } else { "with a slope of at most 2 %" };
    let (duration, until) = if simultaneous_arrival {
        ("all of the same duration", "until one of them has arrived")
    } else {
        ("of any duration, with a circle beyond the goal", "until the last one of the fleet has arrived")
    };
    format!(
        "the starts and goals are the ends of paths of straight lines and arcs, {slope}, flown at constant speed, with at most 80 % of \
         the planning limit of n_y, {duration}. On them any two aircraft stay {} m apart at all times {until}, and every threat is {} m \
         away. Planners do not know these paths.",
        fleet::APART_M,
        threats::CLEAR_M
    )
}

/// The map around all paths until a time, s.
fn map(members: &[Member], end_s: f64) -> Map {
    let corners = fleet::bounds(members, end_s);
    let axis = |axis: usize| {
        let [low, high] = corners.map(|corner| corner[axis]);
        Range::new(round_to(low - MAP_MARGIN_M, 10.0), round_to(high + MAP_MARGIN_M, 10.0))
    };
    Map { x_m: axis(0), y_m: axis(1), z_m: Range::new(0.0, 1000.0) }
}
