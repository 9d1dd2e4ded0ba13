use schemars::JsonSchema;
use serde::{Deserialize, Serialize};

use crate::requirement::Requirement;
use crate::{
    AppliedLimits, Family, FleetRules, Mismatch, Models, PlannerSettings, Sensors, Simulation, Vehicle, VehicleModel,
    VerdictLimits, World,
};

/// One scenario: everything that a planner, the simulator and the judge need. A TOML file holds one scenario.
///
/// # Examples
///
/// ```
/// use std::path::Path;
///
/// let file = Path::new(env!("CARGO_MANIFEST_DIR")).join("fixed-wing/rendezvous-2.toml");
/// let scenario = scenarios::load(&file)?;
/// assert_eq!(scenario.vehicles.len(), 2);
/// assert_eq!(scenario.family(), scenarios::Family::FixedWing);
/// assert_eq!(scenarios::parse("rendezvous-2.toml", &scenario.to_toml())?, scenario);
/// # Ok::<(), scenarios::LoadError>(())
/// ```
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields)]
pub struct Scenario {
    /// Name: that of the file without `.toml`, unique over all families. Lower case letters, digits and `-`.
    pub name: String,
    /// What makes it difficult, in one or two sentences; shown by `harness list` and in the recording.
    pub description: String,
    /// Arbitrary words for selecting scenarios.
    #[serde(default, skip_serializing_if = "Vec::is_empty")]
    pub tags: Vec<String>,
    /// Map and obstacles.
    pub world: World,
    /// Vehicle models: dynamics and limits, by family and name.
    pub models: Models,
    /// Vehicles: model, start and goal. All are of one family.
    pub vehicles: Vec<Vehicle>,
    /// Requirements between the vehicles.
    #[serde(default)]
    pub fleet: FleetRules,
    /// The planner, unless the command line names another, and its options.
    pub planner: PlannerSettings,
    /// Settings and disturbances of the simulated flight.
    #[serde(default)]
    pub simulation: Simulation,
    /// Limits of the verdict.
    #[serde(default)]
    pub verdict: VerdictLimits,
    /// Requirements in the user's own words, as formulas of signal temporal logic.
    #[serde(default, skip_serializing_if = "Vec::is_empty")]
    pub requirements: Vec<Requirement>,
}

impl Scenario {
    /// The family of the vehicles, which validation ensures is the same for all.
    ///
    /// # Panics
    ///
    /// Panics if there is no vehicle or its model is unknown, which validation excludes.
    pub fn family(&self) -> Family {
        self.model(&self.vehicles[0]).family()
    }

    /// The model of a vehicle.
    ///
    /// # Panics
    ///
    /// Panics if the model is unknown, which validation excludes.
    pub fn model(&self, vehicle: &Vehicle) -> &dyn VehicleModel {
        self.models.get(&vehicle.model).unwrap_or_else(|| panic!("there is no model `{}`", vehicle.model))
    }

    /// Whether the problem is planar: every goal is at the altitude of its start, and no obstacle has a top or bottom.
    pub fn is_planar(&self) -> bool {
        let world = &self.world;
        let ends = world.boxes.iter().map(|it| it.z_m).chain(world.prisms.iter().map(|it| it.z_m));
        let is_level = |vehicle: &Vehicle| {
            let start_m = vehicle.start.z_m;
            vehicle.goal.z_m == start_m && vehicle.via.iter().all(|via| via.z_m == start_m)
        };
        ends.chain(world.moving.iter().map(|it| it.z_m)).all(|z_m| z_m.is_none())
            && !world.has_solids()
            && self.vehicles.iter().all(is_level)
    }

    /// Limits of the verdict: those of the file, and the defaults of the family for those that it omits.
    pub fn limits(&self) -> AppliedLimits {
        self.verdict.applied_to(self.family())
    }
}

/// What a planner sees.
impl Scenario {
    /// The scenario without obstacles that are unknown before the flight, and without disturbances.
    pub fn planner_view(&self) -> Self {
        let simulation = Simulation {
            wind: None,
            sensors: Sensors::default(),
            mismatch: Mismatch::default(),
            ..self.simulation.clone()
        };
        Self { world: self.world.known_before_flight(), simulation, ..self.clone() }
    }
}

/// Scenario files.
impl Scenario {
    /// The scenario as TOML, which loads as an equal scenario.
    ///
    /// # Panics
    ///
    /// Panics if the scenario cannot be written as TOML, which is impossible for a scenario that was loaded.
    pub fn to_toml(&self) -> String {
        toml::to_string(self).expect("a scenario consists of tables, lists, numbers and text")
    }
}

/// JSON Schema of scenario files.
impl Scenario {
    /// JSON Schema (draft 2020-12) of a scenario file, generated from these types, with the keys of positions on the Earth.
    pub fn json_schema() -> serde_json::Value {
        crate::load::geographic::with_geographic_keys(schemars::schema_for!(Self).into())
    }
}
