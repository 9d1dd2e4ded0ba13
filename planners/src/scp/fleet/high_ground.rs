//! Terrain as cylinders: the ground that reaches above the lowest planned altitude is covered by them, and lower ground is no
//! obstacle.
//!
//! It is safe: a vehicle that clears the cylinders, and flies at its planned altitudes, is farther from all of the ground than
//! its body and margin. It is coarse: an aircraft does not fly over a ridge that it could climb above.

use std::borrow::Cow;

use scenarios::{Cylinder, Scenario, Terrain, Vehicle, World};

/// Squares of ground along the longer side of the terrain.
const SQUARES: usize = 128;
/// A cylinder that covers high ground may be this many times larger than it.
const MAX_WASTE: f64 = 2.0;

/// A square of ground, from (x, y) to (x, y), m.
type Square = [[f64; 2]; 2];

/// The scenario with cylinders over high ground in place of its terrain.
pub(super) fn as_cylinders(scenario: &Scenario) -> Cow<'_, Scenario> {
    let Some(terrain) = &scenario.world.terrain else { return Cow::Borrowed(scenario) };
    let high = cylinders(terrain, min_altitude_m(scenario));
    let world = &scenario.world;
    let cylinders = world.cylinders.iter().cloned().chain(high).collect();
    let world = World { cylinders, terrain: None, ..world.clone() };
    Cow::Owned(Scenario { world, ..scenario.clone() })
}

/// Why the terrain cannot be avoided in this way; `None` if it can, or if there is none.
pub(super) fn unsupported_reason(scenario: &Scenario) -> Option<String> {
    let terrain = scenario.world.terrain.as_ref()?;
    let (high, altitude_m) = (cylinders(terrain, min_altitude_m(scenario)), min_altitude_m(scenario));
    let mut ends = scenario.vehicles.iter().flat_map(|it| [(it, "starts", &it.start), (it, "has its goal", &it.goal)]);
    let is_near = |vehicle: &Vehicle, [x_m, y_m, _]: [f64; 3]| {
        let clearance_m = scenario.fixed_wing_model(vehicle).body_radius_m + margin_m(scenario);
        high.iter().any(|it| it.signed_distance_m(x_m, y_m) < clearance_m)
    };
    let (vehicle, what, _) = ends.find(|(vehicle, _, end)| is_near(vehicle, end.position_m()))?;
    Some(format!(
        "`{}` {what} beside ground of `{}` that is higher than {altitude_m:.1} m, the lowest planned altitude without body and \
         margin: it flies around such ground, not over it",
        vehicle.name, terrain.name
    ))
}

/// The lowest altitude of any part of a vehicle and its margin, m.
fn min_altitude_m(scenario: &Scenario) -> f64 {
    let lowest_m = |vehicle: &Vehicle| {
        let model = scenario.fixed_wing_model(vehicle);
        model.planning_limits.altitude_m.min - model.body_radius_m
    };
    scenario.vehicles.iter().map(lowest_m).fold(f64::INFINITY, f64::min) - margin_m(scenario)
}

fn margin_m(scenario: &Scenario) -> f64 {
    super::Options::fleet(&scenario.planner).margin_m
}

/// Cylinders that cover all ground above an altitude.
fn cylinders(terrain: &Terrain, altitude_m: f64) -> Vec<Cylinder> {
    let grid = terrain.grid.get().expect("files are read when a scenario is loaded");
    let boxes = grid.block_boxes(SQUARES).into_iter().filter(|[_, top_m]| top_m[2] >= altitude_m);
    let squares = boxes.map(|corners| corners.map(|[x, y, _]| [x, y])).collect();
    let circles = connected(squares).into_iter().flat_map(covered);
    let cylinder = |(index, (center_m, radius_m)): (usize, ([f64; 2], f64))| Cylinder {
        name: format!("{}-{}", terrain.name, index + 1),
        center_m,
        radius_m,
    };
    circles.enumerate().map(cylinder).collect()
}

/// Groups of squares that touch each other.
fn connected(mut squares: Vec<Square>) -> Vec<Vec<Square>> {
    let mut groups = Vec::new();
    while let Some(first) = squares.pop() {
        let mut group = vec![first];
        let mut next = 0;
        while let Some(square) = group.get(next).copied() {
            let (touching, others) = squares.into_iter().partition(|other| touch(&square, other));
            group.extend::<Vec<Square>>(touching);
            squares = others;
            next += 1;
        }
        groups.push(group);
    }
    groups
}

fn touch([a_low, a_high]: &Square, [b_low, b_high]: &Square) -> bool {
    (0..2).all(|axis| a_low[axis] <= b_high[axis] && b_low[axis] <= a_high[axis])
}

/// Circles, by centre and radius, m, that cover a group of squares: one, or those of its two halves if one would be too large.
fn covered(mut group: Vec<Square>) -> Vec<([f64; 2], f64)> {
    let corners = || group.iter().flat_map(|[low, high]| [*low, *high, [low[0], high[1]], [high[0], low[1]]]);
    let extreme =
        |axis: usize, pick: fn(f64, f64) -> f64| corners().map(|it| it[axis]).reduce(pick).unwrap_or(f64::NAN);
    let [low_m, high_m] = [f64::min, f64::max].map(|pick| [0, 1].map(|axis| extreme(axis, pick)));
    let center_m = [0, 1].map(|axis| f64::midpoint(low_m[axis], high_m[axis]));
    let radius_m = corners().map(|[x, y]| (x - center_m[0]).hypot(y - center_m[1])).fold(0.0, f64::max);
    let area_m2: f64 = group.iter().map(|[low, high]| (high[0] - low[0]) * (high[1] - low[1])).sum();
    if group.len() == 1 || std::f64::consts::PI * radius_m * radius_m <= MAX_WASTE * area_m2 {
        return vec![(center_m, radius_m)];
    }
    let axis = usize::from(high_m[1] - low_m[1] > high_m[0] - low_m[0]);
    group.sort_by(|a, b| a[0][axis].total_cmp(&b[0][axis]).then(a[0][1 - axis].total_cmp(&b[0][1 - axis])));
    let rest = group.split_off(group.len() / 2);
    covered(group).into_iter().chain(covered(rest)).collect()
}
