//! Errors as exceptions, with the text of the command line.

use pyo3::create_exception;
use pyo3::exceptions::{PyRuntimeError, PyValueError};
use pyo3::prelude::*;
use scenarios::LoadError;
use scenarios::plan_input::PlanError;

create_exception!(uav_harness, InvalidInput, PyValueError, "A scenario, a plan or an argument is invalid.");
create_exception!(uav_harness, Bug, PyRuntimeError, "A bug of the harness: please report it.");

/// An exception with this text.
pub fn invalid(text: impl ToString) -> PyErr {
    InvalidInput::new_err(text.to_string())
}

/// One line per issue of a scenario.
pub fn of_scenario(error: &LoadError) -> PyErr {
    invalid(error.lines().join("\n"))
}

/// One line per issue of a plan.
pub fn of_plan(error: &PlanError) -> PyErr {
    invalid(error.lines().join("\n"))
}
