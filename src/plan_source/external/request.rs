//! The request to an external planner. It is self-contained: models are resolved, defaults are filled in.

pub mod fixed_wing;
pub mod multirotor;
pub mod slung_load;

use scenarios::fixed_wing::GRAVITY_MPS2;
use scenarios::{Scenario, World};
use serde_json::{Value, json};

use super::PROTOCOL;
use crate::families;

/// The request for a plan. Angles are in radians unless the key ends in `_deg`.
///
/// - `scenario`: the planner view, which holds no disturbances and no obstacles that are unknown before the flight
pub(super) fn document(scenario: &Scenario, seed: u64, time_limit_s: f64) -> Value {
    let describe = families::of(scenario.family()).request;
    json!({
        "protocol": PROTOCOL,
        "request": "plan",
        "scenario": scenario.name,
        "seed": seed,
        "time_limit_s": time_limit_s,
        "gravity_mps2": GRAVITY_MPS2,
        "world": world(&scenario.world),
        "vehicles": scenario.vehicles.iter().map(|vehicle| describe(scenario, vehicle)).collect::<Vec<_>>(),
        "fleet": scenario.resolved_fleet(),
        "verdict": scenario.limits(),
        "envelope_m": scenario.verdict.envelope_m,
        "max_duration_s": scenario.simulation.max_duration_s,
        "options": scenario.planner.options,
    })
}

/// Map, origin on the Earth if the scenario gives it, static obstacles (boxes as prisms; files of meshes and terrain by their
/// absolute paths), ground, gates and geofences.
pub(super) fn world(world: &World) -> Value {
    json!({
        "map": world.map,
        "origin": world.origin,
        "cylinders": world.cylinders,
        "prisms": world.prism_obstacles(),
        "spheres": world.spheres,
        "capsules": world.capsules,
        "cuboids": world.cuboids,
        "meshes": world.meshes,
        "terrain": world.terrain,
        "ground_m": world.ground_m,
        "gates": world.gates,
        "geofences": world.geofences,
    })
}
