mod collocation;
mod horizon;

use std::collections::BTreeMap;

use schemars::JsonSchema;
use serde::{Deserialize, Serialize};

pub use collocation::{Collocation, Formulation, Objective, Shape};
pub use horizon::{CostMap, Horizon, PotentialField, PotentialFieldForm, RepulsionForm, Sampler};

/// Which planner answers, and its options. An option that is absent takes the planner's own default, in most cases the
/// value of its paper (`harness list` shows the planners).
#[derive(Clone, Debug, Default, PartialEq, Serialize, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields)]
pub struct PlannerSettings {
    /// Name of the planner. With a `command`, any name: results go into a folder of that name.
    pub name: String,
    /// A planner outside the harness: program and arguments. It reads one JSON request from its standard input and writes
    /// one JSON reply to its standard output. It is started in the folder of the scenario file.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub command: Option<Vec<String>>,
    /// Time after which a planner with a `command` is ended, s. [default: 60] In the loop: time for one answer, s.
    /// [default: 10]
    #[serde(skip_serializing_if = "Option::is_none")]
    pub time_limit_s: Option<f64>,
    /// Does the `command` plan in the loop? Then it reads one JSON request per line for as long as its vehicles fly, and
    /// answers each with one line.
    #[serde(default, skip_serializing_if = "std::ops::Not::not")]
    pub in_loop: bool,
    /// Options of a planner with a `command`, handed over as they are.
    #[serde(default, skip_serializing_if = "BTreeMap::is_empty")]
    pub options: BTreeMap<String, serde_json::Value>,
    /// How the equations of motion become rows of the subproblem.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub transcription: Option<Transcription>,
    /// Who solves the convex subproblems.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub solver: Option<Solver>,
    /// Number of intervals K between the nodes, from 2 to 1000.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub intervals: Option<usize>,
    /// Distance that the planner keeps beyond the separation and beyond every obstacle's surface, m.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub margin_m: Option<f64>,
    /// Weight μ of the exact penalty on violated rows: seconds of step length per scaled unit of violation.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub penalty: Option<f64>,
    /// Share by which the fleet's common lower bound of the flight time falls whenever all vehicles sit on it, in
    /// [0, 1). Zero is the paper's rule, by which the bound never falls.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub time_bound_release: Option<f64>,
    /// Most iterations of the sequential convex programme.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub max_iterations: Option<usize>,
    /// How far one iteration may move each state.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub trust_region: Option<TrustRegion>,
    /// When the sequence has converged.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub convergence: Option<Convergence>,
    /// Options of planners by collocation.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub collocation: Option<Collocation>,
    /// Options of planners by receding horizon.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub horizon: Option<Horizon>,
}

/// Transcription of the equations of motion.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Serialize, Deserialize, JsonSchema)]
#[serde(rename_all = "kebab-case")]
pub enum Transcription {
    /// Trapezoid rule over each interval (Wang, Xu, Long 2020, eq. 5).
    Trapezoid,
    /// Multiple shooting: the flow of the equations under first-order-hold controls.
    Shooting,
}

/// Solver of the convex subproblems.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Serialize, Deserialize, JsonSchema)]
#[serde(rename_all = "kebab-case")]
pub enum Solver {
    /// The customised interior-point method on the block structure.
    Block,
    /// Clarabel, a general interior-point method: the baseline.
    Clarabel,
}

/// Half-widths ρ of the trust region, and how they shrink.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields)]
pub struct TrustRegion {
    /// x and y, m.
    pub position_m: f64,
    /// Altitude, m.
    pub altitude_m: f64,
    /// Speed, m/s.
    pub speed_mps: f64,
    /// Heading, deg.
    pub heading_deg: f64,
    /// Flight-path angle, deg.
    pub flight_path_deg: f64,
    /// Factor on all of them after each iteration, in (0, 1].
    pub shrink: f64,
}

/// Largest change of any state between two iterations for which the sequence counts as converged.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields)]
pub struct Convergence {
    /// x and y, m.
    pub position_m: f64,
    /// Altitude, m.
    pub altitude_m: f64,
    /// Speed, m/s.
    pub speed_mps: f64,
    /// Heading, deg.
    pub heading_deg: f64,
    /// Flight-path angle, deg.
    pub flight_path_deg: f64,
}
