use schemars::JsonSchema;
use serde::{Deserialize, Serialize};

use crate::{
    AppliedLimits, Family, FleetRules, Mismatch, Models, PlannerSettings, Sensors, Simulation, Vehicle, VehicleModel,
    VerdictLimits, World,
};

/// One scenario: everything a planner, the simulator and the judge need to know. One TOML file holds one scenario.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields)]
pub struct Scenario {
    /// Name of the scenario: the same as its file's name without `.toml`, unique over all families. Lower case letters,
    /// digits and `-`.
    pub name: String,
    /// What is hard about it, in a sentence or two; shown by `harness list` and in the recording.
    pub description: String,
    /// Free words to select scenarios by.
    #[serde(default, skip_serializing_if = "Vec::is_empty")]
    pub tags: Vec<String>,
    /// The map and what stands on it.
    pub world: World,
    /// Vehicle models: dynamics and limits, by family and name.
    pub models: Models,
    /// The vehicles: which model, from where, to where. All are of one family.
    pub vehicles: Vec<Vehicle>,
    /// What the vehicles owe to each other.
    #[serde(default)]
    pub fleet: FleetRules,
    /// The planner that answers, unless the command line names another, and its options.
    pub planner: PlannerSettings,
    /// How the plan is flown.
    #[serde(default)]
    pub simulation: Simulation,
    /// The limits that the verdict applies.
    #[serde(default)]
    pub verdict: VerdictLimits,
}

impl Scenario {
    /// The family of its vehicles: validation has seen to it that all are of one.
    pub fn family(&self) -> Family {
        self.model(&self.vehicles[0]).family()
    }

    /// The model of a vehicle. Panics if there is none: validation has seen to that.
    pub fn model(&self, vehicle: &Vehicle) -> &dyn VehicleModel {
        self.models.get(&vehicle.model).unwrap_or_else(|| panic!("there is no model `{}`", vehicle.model))
    }

    /// Is there nothing to gain from altitude: every goal at its start's height, no obstacle that ends below or above?
    pub fn is_planar(&self) -> bool {
        let world = &self.world;
        let ends = world.boxes.iter().map(|it| it.z_m).chain(world.prisms.iter().map(|it| it.z_m));
        let is_level = |vehicle: &Vehicle| vehicle.start.z_m == vehicle.goal.z_m;
        ends.chain(world.moving.iter().map(|it| it.z_m)).all(|z_m| z_m.is_none()) && self.vehicles.iter().all(is_level)
    }

    /// The limits that the verdict applies: those of the file, and for those that it leaves out the family's.
    pub fn limits(&self) -> AppliedLimits {
        self.verdict.applied_to(self.family())
    }
}

/// What a planner is told.
impl Scenario {
    /// The scenario without the obstacles that nobody knows of beforehand, and without what disturbs the flight.
    pub fn planner_view(&self) -> Self {
        let simulation = Simulation {
            wind: None,
            sensors: Sensors::default(),
            mismatch: Mismatch::default(),
            ..self.simulation.clone()
        };
        Self { world: self.world.known_beforehand(), simulation, ..self.clone() }
    }
}

/// The form of a scenario file.
impl Scenario {
    /// The scenario as TOML: loaded again, it is the same.
    ///
    /// Panics on a scenario that has no such form; there is none that can be loaded.
    pub fn to_toml(&self) -> String {
        toml::to_string(self).expect("a scenario is made of tables, lists, numbers and text")
    }
}

/// JSON Schema (draft 2020-12) of a scenario file, generated from these very types.
impl Scenario {
    /// The schema as a JSON value, the same on every call.
    pub fn json_schema() -> serde_json::Value {
        schemars::schema_for!(Self).into()
    }
}
