//! The one table of vehicle families: what the harness does with each of them.

use scenarios::{Family, Plan, Scenario, Vehicle};
use serde_json::Value;
use sim::Flight;

use crate::campaign::bench::min_flight_time;
use crate::campaign::typical_disturbances::TypicalDisturbances;
use crate::metrics::figures::Metrics;
use crate::output::scene::FamilyScene;
use crate::verdict::Check;
use crate::verdict::case::Case;
use crate::verdict::recorded::RecordedFlight;

/// What the harness does with the vehicles of one family.
pub struct VehicleFamily {
    /// The family.
    pub family: Family,
    /// Makes every check that applies to it, in the order of a verdict.
    pub checks: for<'a> fn(&Case<'a>) -> Vec<Check>,
    /// Makes every check that applies to a flight flown elsewhere; `None` if it cannot be judged by its log.
    pub recorded_checks: Option<for<'a> fn(&RecordedFlight<'a>) -> Vec<Check>>,
    /// The figures of a flyable plan and, if there is one, its flight.
    pub measure: fn(&Scenario, &Plan, Option<&Flight>) -> Metrics,
    /// A vehicle as the request to external planners describes it.
    pub request: fn(&Scenario, &Vehicle) -> Value,
    /// The disturbances at which `stress` begins and which `sweep` draws.
    pub typical_disturbances: TypicalDisturbances,
    /// Lower bound of the flight time of a vehicle, s; `None` where the scenario gives the flight time.
    pub min_flight_time_s: Option<fn(&Scenario, &Vehicle) -> f64>,
    /// What it adds to the scene that recordings draw.
    pub scene: FamilyScene,
}

static FAMILIES: [VehicleFamily; 3] = [FIXED_WING, SLUNG_LOAD, MULTIROTOR];

const FIXED_WING: VehicleFamily = {
    use crate::metrics::fixed_wing::measure;
    use crate::output::scene::fixed_wing::SCENE;
    use crate::plan_source::external::request::fixed_wing::vehicle as request;
    use crate::verdict::fixed_wing::{checks, recorded_checks};

    VehicleFamily {
        family: Family::FixedWing,
        checks,
        recorded_checks: Some(recorded_checks),
        measure,
        request,
        typical_disturbances: TypicalDisturbances { wind_mps: 3.0, position_noise_m: 0.25 },
        min_flight_time_s: Some(min_flight_time::fixed_wing_s),
        scene: SCENE,
    }
};

const SLUNG_LOAD: VehicleFamily = {
    use crate::metrics::slung_load::measure;
    use crate::output::scene::slung_load::SCENE;
    use crate::plan_source::external::request::slung_load::vehicle as request;
    use crate::verdict::slung_load::checks;

    VehicleFamily {
        family: Family::SlungLoad,
        checks,
        recorded_checks: None,
        measure,
        request,
        typical_disturbances: TypicalDisturbances { wind_mps: 1.0, position_noise_m: 0.002 },
        min_flight_time_s: None,
        scene: SCENE,
    }
};

const MULTIROTOR: VehicleFamily = {
    use crate::metrics::multirotor::measure;
    use crate::output::scene::multirotor::SCENE;
    use crate::plan_source::external::request::multirotor::vehicle as request;
    use crate::verdict::multirotor::{checks, recorded_checks};

    VehicleFamily {
        family: Family::Multirotor,
        checks,
        recorded_checks: Some(recorded_checks),
        measure,
        request,
        typical_disturbances: TypicalDisturbances { wind_mps: 1.0, position_noise_m: 0.002 },
        min_flight_time_s: Some(min_flight_time::multirotor_s),
        scene: SCENE,
    }
};

/// The entry of a family.
///
/// # Panics
///
/// If the table has none, which is a bug.
pub fn of(family: Family) -> &'static VehicleFamily {
    FAMILIES.iter().find(|entry| entry.family == family).expect("every family has an entry")
}
