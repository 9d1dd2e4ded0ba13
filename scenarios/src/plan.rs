use serde::{Deserialize, Serialize};

use crate::Trajectory;

mod diagnostics;

pub use diagnostics::{Alternative, PlanDiagnostics, PlannedEvent};

/// The result of a planner: one trajectory per vehicle, status, history and diagnostics.
///
/// # Examples
///
/// ```
/// use scenarios::multirotor::Trajectory;
/// use scenarios::in_loop::Node;
/// use scenarios::Plan;
///
/// let nodes = [Node::at_rest(0.0, [0.0; 3]), Node::at_rest(4.0, [2.0, 0.0, 0.0])];
/// let trajectory = Trajectory::through("uav-1", &nodes);
/// let plan = Plan { objective: Some(4.0), ..Plan::new("corridor", "by-hand", 0, vec![trajectory.into()]) };
/// assert_eq!(plan.flight_time_s(), Some(4.0));
///
/// let mut csv = Vec::new();
/// plan.write_csv(&mut csv)?;
/// assert!(csv.starts_with(b"vehicle,t_s,x_m,y_m,z_m,vx_mps,vy_mps,vz_mps\nuav-1,0.0,0.0,"));
/// # Ok::<(), std::io::Error>(())
/// ```
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct Plan {
    /// Version of the format: [`Plan::SCHEMA`].
    pub schema: u32,
    /// Name of the scenario.
    pub scenario: String,
    /// Name of the planner.
    pub planner: String,
    /// Seed of the planner.
    pub seed: u64,
    /// Status reported by the planner. The judge ignores it.
    pub status: PlanStatus,
    /// Why the status is not `solved`, as text.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub reason: Option<String>,
    /// Value of the objective in the planner's unit: s for time-optimal planners.
    pub objective: Option<f64>,
    /// One per vehicle, in the order of the scenario; empty without a plan.
    pub trajectories: Vec<Trajectory>,
    /// One entry per iteration of the planner.
    pub history: Vec<Iteration>,
    /// Events and alternatives.
    #[serde(default, rename = "account", skip_serializing_if = "PlanDiagnostics::is_empty")]
    pub diagnostics: PlanDiagnostics,
    /// Planning time.
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

    /// End time of the longest trajectory, s; `None` without a trajectory.
    pub fn flight_time_s(&self) -> Option<f64> {
        self.trajectories.iter().filter_map(Trajectory::end_s).reduce(f64::max)
    }
}

/// Status of a plan, reported by the planner.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Serialize, Deserialize)]
#[serde(rename_all = "kebab-case")]
pub enum PlanStatus {
    /// Converged, and every constraint of the planner holds at its nodes.
    Solved,
    /// There are trajectories, but the iteration has not converged or a constraint is violated.
    NotConverged,
    /// No trajectory was found.
    NoPlan,
    /// Unknown: the plan was imported from a table, which states no status.
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
    /// Objective: for time-optimal planners the flight time of the slowest vehicle, s.
    pub objective: f64,
    /// Largest time step of any vehicle, s.
    pub dt_s: f64,
    /// Largest position defect of an interval: distance between its end and the end propagated from its beginning by the
    /// planner's model, m.
    pub defect_m: f64,
    /// Largest remaining violation of a linearised row in the subproblems, in scaled units, -.
    pub slack: f64,
    /// Smallest horizontal distance between two vehicles at the nodes, m.
    pub separation_m: Option<f64>,
    /// Smallest distance from a body to an obstacle's surface at the nodes, m.
    pub clearance_m: Option<f64>,
    /// Largest change in horizontal position since the previous iteration, m.
    pub change_m: f64,
    /// Half-width of the trust region in x and y, m.
    pub trust_region_m: f64,
    /// Interior-point iterations, summed over the vehicles.
    pub solver_iterations: usize,
    /// Number of subproblems not solved to tolerance.
    pub unsolved: usize,
    /// Wall time of the iteration, s.
    pub wall_s: f64,
    /// Time of the slowest vehicle's subproblem, s: the wall time if every vehicle had its own computer.
    pub distributed_s: f64,
}

/// Planning time on this machine.
#[derive(Clone, Debug, Default, PartialEq, Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct PlanTimings {
    /// Wall time of the whole call, s.
    pub wall_s: f64,
    /// Sum over the iterations of the slowest vehicle's time, s.
    pub distributed_s: f64,
}
