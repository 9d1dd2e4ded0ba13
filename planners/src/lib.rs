//! The trajectory planners and their solvers. Planners never see the simulator or its models.
//!
//! [`registry`] lists the planners. Every family of planners is a module with a list `PLANNERS`, so a planner is added in
//! two places: a file of its own, and its family's list. A new family is added to `FAMILIES` below.

#![expect(confusable_idents, reason = "γ is the flight-path angle and y a multiplier, as in the papers")]

pub mod convex;
mod decoupled_lgr;
pub mod free_space;
pub mod horizon;
pub mod multirotor;
pub mod nlp;
mod open_list;
mod planner;
pub mod pseudospectral;
pub mod roadmap;
pub mod scp;
pub mod search;
mod simd;
pub mod slung;

use std::sync::LazyLock;

pub use planner::{Planner, PlanningMode, Progress};

/// The families of planners, in the order in which they are listed.
const FAMILIES: [&[Planner]; 5] =
    [scp::PLANNERS, decoupled_lgr::PLANNERS, slung::PLANNERS, horizon::PLANNERS, search::PLANNERS];

/// All planners.
pub fn registry() -> &'static [Planner] {
    static PLANNERS: LazyLock<Vec<Planner>> = LazyLock::new(|| FAMILIES.concat());
    &PLANNERS
}

/// The planner of that name; `None` if there is none.
pub fn find(name: &str) -> Option<&'static Planner> {
    registry().iter().find(|planner| planner.name == name)
}
