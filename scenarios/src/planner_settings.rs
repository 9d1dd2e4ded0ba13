mod collocation;
mod coordination;
mod horizon;
mod search;

use std::collections::BTreeMap;

use schemars::JsonSchema;
use serde::{Deserialize, Serialize};

pub use collocation::{Collocation, Formulation, Objective, Shape, Torques};
pub use coordination::Coordination;
pub use horizon::{
    AttractionAlong, CostMap, Horizon, PotentialField, PotentialFieldForm, RepelledBy, RepulsionForm, Sampler, Swarm,
    ViolationWeights,
};
pub use search::{PathTiming, Search};

/// The planner and its options. The default of an option depends on the planner, and is mostly the value of its paper
/// (`harness list` shows the planners).
#[derive(Clone, Debug, Default, PartialEq, Serialize, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields)]
pub struct PlannerSettings {
    /// Name of the planner. With a `command`, any name: that of the folder for the results.
    pub name: String,
    /// An external planner: program and arguments. It reads one JSON request from standard input and writes one JSON reply to
    /// standard output. It is started in `folder`.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub command: Option<Vec<String>>,
    /// Folder in which a `command` is started, relative to that of the scenario file. [default: that of the scenario file]
    #[serde(skip_serializing_if = "Option::is_none")]
    pub folder: Option<String>,
    /// Time after which a planner with a `command` is terminated, s. [default: 60] In the loop: time for one reply, s.
    /// [default: 10]
    #[serde(skip_serializing_if = "Option::is_none")]
    pub time_limit_s: Option<f64>,
    /// Whether the `command` is an in-loop planner. It then reads one JSON request per line while its vehicles fly, and
    /// replies to each with one line.
    #[serde(default, skip_serializing_if = "std::ops::Not::not")]
    pub in_loop: bool,
    /// Options of a planner with a `command`, passed on unchanged.
    #[serde(default, skip_serializing_if = "BTreeMap::is_empty")]
    pub options: BTreeMap<String, serde_json::Value>,
    /// Transcription of the equations of motion.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub transcription: Option<Transcription>,
    /// Solver of the convex subproblems.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub solver: Option<Solver>,
    /// Where that solver starts. [default: feasible]
    #[serde(skip_serializing_if = "Option::is_none")]
    pub solver_start: Option<SolverStart>,
    /// Number of intervals K between the nodes, from 2 to 1000.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub intervals: Option<usize>,
    /// Distance that the planner adds to the separation and to every obstacle's surface, m.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub margin_m: Option<f64>,
    /// Weight μ of the exact penalty on violated rows, in s of time step per unit of violation: per SI unit (m, m/s, rad) for
    /// the papers' planners, per scaled unit (km, 100 m, 10 m/s, rad, 0.1 rad) for `fleet-scp`.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub penalty: Option<f64>,
    /// Fraction by which the common lower bound of the fleet's flight time decreases when it is active for all vehicles, in
    /// [0, 1). Zero is the paper's rule: the bound never decreases.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub time_bound_release: Option<f64>,
    /// Maximum number of iterations of the sequential convex program.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub max_iterations: Option<usize>,
    /// Trust region of the states.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub trust_region: Option<TrustRegion>,
    /// Convergence tolerances.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub convergence: Option<Convergence>,
    /// Thresholds of priorities and of the common arrival.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub coordination: Option<Coordination>,
    /// Options of collocation planners.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub collocation: Option<Collocation>,
    /// Options of receding-horizon planners.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub horizon: Option<Horizon>,
    /// Options of planners that search for a path.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub search: Option<Search>,
}

/// Transcription of the equations of motion.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Serialize, Deserialize, JsonSchema)]
#[serde(rename_all = "kebab-case")]
pub enum Transcription {
    /// Trapezoid rule over each interval (Wang, Xu, Long 2020, eq. 5).
    Trapezoid,
    /// Multiple shooting with first-order-hold controls.
    Shooting,
}

/// Solver of the convex subproblems.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Serialize, Deserialize, JsonSchema)]
#[serde(rename_all = "kebab-case")]
pub enum Solver {
    /// Interior-point method that exploits the block structure.
    Block,
    /// The same, with the Newton direction by method I of Wang, Xu, Long (2020): sparse LDL^T of the reduced matrix.
    SparseLdl,
    /// The same, with the Newton direction by method II of Wang, Xu, Long (2020): the dense reduced matrix.
    DenseReduced,
    /// Clarabel, a general interior-point method: the baseline.
    Clarabel,
}

/// Where the solver of the convex subproblems starts.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, Serialize, Deserialize, JsonSchema)]
#[serde(rename_all = "kebab-case")]
pub enum SolverStart {
    /// At a strictly feasible point; every iterate is feasible.
    #[default]
    Feasible,
    /// At a point that violates the linear equations, as in the loop of Wang, Xu, Long (2020), section 4: the residuals vanish
    /// with the gap. Only with the solvers `sparse-ldl` and `dense-reduced`.
    Infeasible,
}

/// Half-widths ρ of the trust region, and their reduction.
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
    /// Factor applied to all half-widths after each iteration, in (0, 1].
    pub shrink: f64,
}

/// Convergence tolerances: maximum change of each state between two iterations.
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
