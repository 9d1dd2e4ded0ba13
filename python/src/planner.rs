//! In-loop planners in Python.

use std::sync::Arc;

use harness::plan_source::Guidance;
use harness::plan_source::external::protocol;
use pyo3::prelude::*;
use scenarios::Scenario;
use scenarios::in_loop::{InLoopPlanner, Observation, ReplanResult};

use crate::error::invalid;
use crate::worker::Failure;

/// One planner per vehicle, which call `replan(vehicle, request) -> reply` with the texts of the protocol.
///
/// - `failure`: receives the first exception, which ends the flight
pub fn guidance(scenario: &Scenario, name: String, replan: Py<PyAny>, failure: &Failure) -> Guidance {
    let replan = Arc::new(replan);
    let planner = |vehicle: &scenarios::Vehicle| -> Box<dyn InLoopPlanner> {
        let (vehicle, replan, failure) = (vehicle.name.clone(), Arc::clone(&replan), failure.clone());
        Box::new(PythonPlanner { vehicle, replan, failure, requests: 0 })
    };
    Guidance::InLoop { planner: name, planners: scenario.vehicles.iter().map(planner).collect() }
}

struct PythonPlanner {
    vehicle: String,
    replan: Arc<Py<PyAny>>,
    failure: Failure,
    requests: u64,
}

impl InLoopPlanner for PythonPlanner {
    fn replan(&mut self, observation: &Observation<'_>) -> ReplanResult {
        self.requests += 1;
        let request = protocol::replan_request(self.requests, &self.vehicle, observation);
        let reply: PyResult<String> =
            Python::attach(|py| self.replan.call1(py, (self.vehicle.as_str(), request))?.extract(py));
        let result = reply.and_then(|reply| protocol::read_replan(&reply).map_err(invalid));
        result.unwrap_or_else(|error| self.failure.end_with(error))
    }
}
