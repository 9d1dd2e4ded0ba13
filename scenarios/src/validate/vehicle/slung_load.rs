//! Where the load of a quadrotor begins and ends: within reach of the cable, on the map, above the ground, in the open.

use crate::slung_load::{Model, State};
use crate::{Issue, Waypoint, World};

use super::{inside_obstacle, outside_map};

/// What a file's decimals may leave of a cable beyond its length, m.
const LENGTH_TOLERANCE_M: f64 = 1e-6;

pub(super) fn issues(model: &Model, world: &World, field: &str, waypoint: &Waypoint) -> Vec<Issue> {
    let state = State::at(waypoint, model.cable_length_m);
    let load = format!("{field}.load");
    let mut issues = outside_map(world, &load, state.load_position_m);
    issues.extend(inside_obstacle(world, &load, state.load_position_m));
    if state.cable_length_m() > model.cable_length_m + LENGTH_TOLERANCE_M {
        let found = format!("a load {:.4} m from the quadrotor", state.cable_length_m());
        let expected = format!("{} m at most, the length of the cable", model.cable_length_m);
        issues.push(Issue::new(load.clone(), found, expected).remedy("move the load or the quadrotor"));
    }
    let lowest_m = world.ground_m.map(|ground_m| ground_m + model.load_radius_m);
    if let Some(lowest_m) = lowest_m.filter(|lowest_m| state.load_position_m[2] < lowest_m - LENGTH_TOLERANCE_M) {
        let found = format!("a load whose centre is at {} m", state.load_position_m[2]);
        let expected = format!("{lowest_m} m or more: its radius above the ground");
        issues.push(Issue::new(load, found, expected).remedy("raise the load, or lower world.ground_m"));
    }
    issues
}
