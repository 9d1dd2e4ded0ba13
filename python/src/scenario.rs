//! Scenarios.

use std::path::PathBuf;
use std::sync::Arc;

use harness::plan_source::external::protocol;
use pyo3::prelude::*;
use scenarios::{ScenarioFile, shipped};
use serde_json::Value;

use crate::error::{invalid, of_scenario};

/// A valid scenario.
#[pyclass(frozen, module = "uav_harness.native")]
pub struct Scenario {
    pub(crate) scenario: Arc<scenarios::Scenario>,
}

#[pymethods]
impl Scenario {
    /// Reads a file, or a shipped scenario by `shipped:NAME`.
    #[staticmethod]
    fn load(path: PathBuf) -> PyResult<Self> {
        scenarios::load(&path).map(Self::from).map_err(|error| of_scenario(&error))
    }

    /// Reads the text of a scenario file. `name` is its name in messages; the stem must be that of the scenario.
    #[staticmethod]
    fn from_toml(name: &str, text: &str) -> PyResult<Self> {
        scenarios::parse(name, text).map(Self::from).map_err(|error| of_scenario(&error))
    }

    /// Reads a scenario as JSON, with the keys of a scenario file.
    #[staticmethod]
    fn from_json(text: &str) -> PyResult<Self> {
        let value: Value = serde_json::from_str(text).map_err(|error| invalid(error.to_string()))?;
        let name = value.get("name").and_then(Value::as_str).unwrap_or("scenario").to_owned();
        let table = toml::to_string(&without_nulls(value)).map_err(|error| invalid(error.to_string()))?;
        let file = ScenarioFile::new(format!("{name}.toml"), table);
        file.scenario().map(Self::from).map_err(|error| of_scenario(&error))
    }

    fn to_json(&self) -> String {
        serde_json::to_string(&*self.scenario).expect("a scenario has no keys but text")
    }

    fn to_toml(&self) -> String {
        self.scenario.to_toml()
    }

    /// The request that an external planner receives, JSON.
    fn request(&self, seed: Option<u64>, time_limit_s: f64) -> String {
        let seed = seed.unwrap_or(self.scenario.simulation.seed);
        protocol::plan_request(&self.scenario, seed, time_limit_s).to_string()
    }

    #[getter]
    fn name(&self) -> &str {
        &self.scenario.name
    }

    #[getter]
    fn family(&self) -> &'static str {
        self.scenario.family().key()
    }

    #[getter]
    fn vehicles(&self) -> Vec<&str> {
        self.scenario.vehicles.iter().map(|vehicle| vehicle.name.as_str()).collect()
    }

    #[getter]
    fn planner(&self) -> &str {
        &self.scenario.planner.name
    }

    #[getter]
    fn seed(&self) -> u64 {
        self.scenario.simulation.seed
    }
}

impl From<scenarios::Scenario> for Scenario {
    fn from(scenario: scenarios::Scenario) -> Self {
        Self { scenario: Arc::new(scenario) }
    }
}

/// TOML has no null: such a key is absent.
fn without_nulls(value: Value) -> Value {
    match value {
        Value::Object(map) => {
            let kept = map.into_iter().filter(|(_, value)| !value.is_null());
            Value::Object(kept.map(|(key, value)| (key, without_nulls(value))).collect())
        }
        Value::Array(values) => Value::Array(values.into_iter().map(without_nulls).collect()),
        value => value,
    }
}

/// Names of the shipped scenarios.
#[pyfunction]
pub fn shipped_names() -> Vec<&'static str> {
    shipped::all().map(|file| file.name()).collect()
}

/// Names of the registered planners, and whether each plans in the loop.
#[pyfunction]
pub fn planner_names() -> Vec<(&'static str, bool)> {
    planners::registry().iter().map(|planner| (planner.name, planner.plans_in_the_loop())).collect()
}
