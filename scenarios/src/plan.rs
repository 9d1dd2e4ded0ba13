use serde::{Deserialize, Serialize};

use crate::Trajectory;

mod diagnostics;

pub use diagnostics::{Alternative, PlanDiagnostics, PlannedEvent};

/// A planner's answer: one trajectory for every vehicle, and how it was found.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct Plan {
    /// Version of this form: 1.
    pub schema: u32,
    /// Name of the scenario that it answers.
    pub scenario: String,
    /// Name of the planner.
    pub planner: String,
    /// Seed that it was made with.
    pub seed: u64,
    /// What the planner says of it. The judge does not ask.
    pub status: PlanStatus,
    /// Why the status is not `solved`, for a person to read.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub reason: Option<String>,
    /// Value of the planner's objective, in the planner's unit (for time-optimal planners s).
    pub objective: Option<f64>,
    /// One per vehicle, in the order of the scenario; empty when there is no plan.
    pub trajectories: Vec<Trajectory>,
    /// How the planner got there, one entry per iteration.
    pub history: Vec<Iteration>,
    /// What the planner tells beyond its trajectories.
    #[serde(default, rename = "account", skip_serializing_if = "PlanDiagnostics::is_empty")]
    pub diagnostics: PlanDiagnostics,
    /// Time that planning took.
    pub timings: PlanTimings,
}

impl Plan {
    /// Version of the plan file format.
    pub const SCHEMA: u32 = 1;

    /// A solved plan without a reported objective, history, diagnostics or timings.
    ///
    /// - `trajectories`: one per vehicle, in the order of the scenario
    pub fn new(
        scenario: impl Into<String>,
        planner: impl Into<String>,
        seed: u64,
        trajectories: Vec<Trajectory>,
    ) -> Self {
        Self {
            schema: Self::SCHEMA,
            scenario: scenario.into(),
            planner: planner.into(),
            seed,
            status: PlanStatus::Solved,
            reason: None,
            objective: None,
            trajectories,
            history: Vec::new(),
            diagnostics: PlanDiagnostics::default(),
            timings: PlanTimings::default(),
        }
    }

    /// The result of a planner that found no trajectories, with the reason.
    pub fn no_plan(
        scenario: impl Into<String>,
        planner: impl Into<String>,
        seed: u64,
        reason: impl Into<String>,
    ) -> Self {
        let reason = Some(reason.into());
        Self { status: PlanStatus::NoPlan, reason, ..Self::new(scenario, planner, seed, Vec::new()) }
    }

    /// Time at which the last vehicle reaches the end of its trajectory, s; `None` without a trajectory.
    pub fn flight_time_s(&self) -> Option<f64> {
        self.trajectories.iter().filter_map(Trajectory::end_s).reduce(f64::max)
    }
}

/// What a planner says of its own plan.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Serialize, Deserialize)]
#[serde(rename_all = "kebab-case")]
pub enum PlanStatus {
    /// Converged, and every constraint that the planner knows holds at its nodes.
    Solved,
    /// Trajectories are there, but the iteration had not come to rest, or a constraint is still violated.
    NotConverged,
    /// Nothing that could be flown.
    NoPlan,
    /// Nothing: the plan was read from a table, which says nothing of itself.
    Unstated,
}

impl std::fmt::Display for PlanStatus {
    fn fmt(&self, f: &mut std::fmt::Formatter<'_>) -> std::fmt::Result {
        f.write_str(match self {
            Self::Solved => "solved",
            Self::NotConverged => "not converged",
            Self::NoPlan => "no plan",
            Self::Unstated => "not stated",
        })
    }
}

/// One iteration of an iterative planner.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct Iteration {
    /// Objective: for time-optimal planners the longest flight time of the fleet, s.
    pub objective: f64,
    /// Largest step length of any vehicle, s.
    pub dt_s: f64,
    /// Largest difference between the end of an interval and where the planner's own equations lead from its
    /// beginning, position part, m.
    pub defect_m: f64,
    /// Largest violation of a linearised row that the penalty left in the subproblems, in scaled units, -.
    pub slack: f64,
    /// Smallest horizontal distance between two vehicles at the nodes, m.
    pub separation_m: Option<f64>,
    /// Smallest distance to an obstacle's surface at the nodes, m.
    pub clearance_m: Option<f64>,
    /// Largest change of a horizontal position since the last iteration, m.
    pub change_m: f64,
    /// Half-width of the trust region in x and y, m.
    pub trust_region_m: f64,
    /// Interior-point iterations, summed over the vehicles.
    pub solver_iterations: usize,
    /// Subproblems that the solver did not bring to its tolerance.
    pub unsolved: usize,
    /// Wall time of the iteration, s.
    pub wall_s: f64,
    /// Time of the slowest vehicle's subproblem: the iteration's time if every vehicle had its own computer, s.
    pub distributed_s: f64,
}

/// Time that planning took on the machine at hand.
#[derive(Clone, Debug, Default, PartialEq, Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct PlanTimings {
    /// From the call to the answer, s.
    pub wall_s: f64,
    /// Sum over the iterations of the slowest vehicle's time, s.
    pub distributed_s: f64,
}
