//! The native part of the Python package `uav_harness`: what the Python files beside it call.
//!
//! Numbers cross as buffers of doubles, everything else as text or JSON. Long calls run on a thread of their own, without
//! the interpreter's lock, see [`worker`]. The documentation for users is in the Python files.

// A test program has no interpreter to link with, and there is nothing to test from Rust: `cargo test --lib` finds an empty crate.
#![cfg(not(test))]
#![expect(clippy::needless_pass_by_value, reason = "Python's arguments arrive as owned values")]

mod arrays;
mod error;
mod flight;
mod geometry;
mod guard;
mod planner;
mod scenario;
mod worker;

use pyo3::prelude::*;

/// The module `uav_harness.native`.
#[pymodule]
mod native {
    #[pymodule_export]
    use super::command;
    #[pymodule_export]
    use super::error::{Bug, InvalidInput};
    #[pymodule_export]
    use super::flight::{
        Flight, Judged, fly_in_loop, fly_plan, judge, read_plan_file, read_plan_reply, read_plan_tables,
    };
    #[pymodule_export]
    use super::flight::{Plan, fly_registered};
    #[pymodule_export]
    use super::geometry::{closest_approach, distances, hermite};
    #[pymodule_export]
    use super::guard::Guard;
    #[pymodule_export]
    use super::scenario::{Scenario, planner_names, shipped_names};
}

/// The command `harness` with its arguments, the program first. Returns the exit code.
#[pyfunction]
fn command(py: Python<'_>, arguments: Vec<String>) -> u8 {
    use harness::cli::Cli;
    use harness::error::Exit;
    py.detach(|| {
        harness::interrupt::watch();
        match Cli::from_arguments(arguments).execute() {
            Ok(exit) => exit.code(),
            Err(error) => {
                harness::console::print_error(error);
                Exit::BadInput.code()
            }
        }
    })
}
