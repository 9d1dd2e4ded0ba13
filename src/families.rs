//! The one table of vehicle families: what the harness does with each of them.

use scenarios::{Family, Plan, Scenario, Vehicle};
use serde_json::Value;
use sim::Flight;

use crate::campaign::failure_threshold::TypicalDisturbances;
use crate::metrics::{self, Metrics};
use crate::output::scene::{self, FamilyScene};
use crate::plan_source::external::request;
use crate::verdict::case::Case;
use crate::verdict::{self, Check};

/// What the harness does with the vehicles of one family.
pub struct VehicleFamily {
    /// The family.
    pub family: Family,
    /// Every check that is put to it, in the order of a verdict.
    pub checks: for<'a> fn(&Case<'a>) -> Vec<Check>,
    /// The figures of a flyable plan and, if there is one, its flight.
    pub measure: fn(&Scenario, &Plan, Option<&Flight>) -> Metrics,
    /// A vehicle as external planners are told of it.
    pub request: fn(&Scenario, &Vehicle) -> Value,
    /// The disturbances at which `stress` begins and which `sweep` draws.
    pub typical_disturbances: TypicalDisturbances,
    /// What it adds to the scene that recordings draw.
    pub scene: FamilyScene,
}

static FAMILIES: [VehicleFamily; 3] = [
    VehicleFamily {
        family: Family::FixedWing,
        checks: verdict::fixed_wing::checks,
        measure: metrics::fixed_wing::measure,
        request: request::fixed_wing::vehicle,
        typical_disturbances: TypicalDisturbances { wind_mps: 3.0, position_noise_m: 0.25 },
        scene: scene::fixed_wing::SCENE,
    },
    VehicleFamily {
        family: Family::SlungLoad,
        checks: verdict::slung_load::checks,
        measure: metrics::slung_load::measure,
        request: request::slung_load::vehicle,
        typical_disturbances: TypicalDisturbances { wind_mps: 1.0, position_noise_m: 0.002 },
        scene: scene::slung_load::SCENE,
    },
    VehicleFamily {
        family: Family::Multirotor,
        checks: verdict::multirotor::checks,
        measure: metrics::multirotor::measure,
        request: request::multirotor::vehicle,
        typical_disturbances: TypicalDisturbances { wind_mps: 1.0, position_noise_m: 0.002 },
        scene: scene::multirotor::SCENE,
    },
];

/// The entry of a family.
///
/// # Panics
///
/// If the table has none, which is a bug.
pub fn of(family: Family) -> &'static VehicleFamily {
    FAMILIES.iter().find(|entry| entry.family == family).expect("every family has an entry")
}
