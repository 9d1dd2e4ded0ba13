use schemars::JsonSchema;
use serde::{Deserialize, Serialize};

/// Options of receding-horizon planners.
#[derive(Clone, Debug, Default, PartialEq, Serialize, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields, default)]
pub struct Horizon {
    /// Sampling time T, s.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub step_s: Option<f64>,
    /// Number of steps of the horizon H_p, from 1 to 100.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub steps: Option<usize>,
    /// Number of particles, from 4 to 10000, rounded up to a multiple of four.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub particles: Option<usize>,
    /// Maximum number of iterations of one search, from 1 to 10000.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub iterations: Option<usize>,
    /// Number of iterations without improvement of the best cost after which a search ends. Absent: no such criterion.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub stall_iterations: Option<usize>,
    /// Cost-to-go from the end of the horizon.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub cost_map: Option<CostMap>,
    /// Search method of the planner `rhc`; the other planners are named after theirs.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub sampler: Option<Sampler>,
    /// Whether the unused cost of infeasible particles is computed too, to measure the time saved by skipping it.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub costs_infeasible: Option<bool>,
    /// Parameters of the particle swarm.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub swarm: Option<Swarm>,
    /// Weights of what an infeasible particle violates (eq. 12).
    #[serde(skip_serializing_if = "Option::is_none")]
    pub violation_weights: Option<ViolationWeights>,
    /// Weight of the mean cost-to-go over the horizon, relative to the one at its end (eq. 10), -. [default: 1]
    #[serde(skip_serializing_if = "Option::is_none")]
    pub stage_weight: Option<f64>,
    /// Whether the stopping distance is part of the cost of a horizon that can reach the goal, for planners that do not end
    /// every horizon with a stop: not in the paper. [default: true; false for `rhc-fpso-plain`]
    #[serde(skip_serializing_if = "Option::is_none")]
    pub brakes_at_goal: Option<bool>,
    /// Whether positions of the swarm are updated by w v, as printed in eq. 13 of the paper, instead of by v.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub moves_as_printed: Option<bool>,
    /// Potential field of the planner `rhc-apf`.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub field: Option<PotentialField>,
}

/// Parameters of a particle swarm (eq. 13 to 15). The paper's values are lost; the defaults are ours.
#[derive(Clone, Debug, Default, PartialEq, Serialize, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields, default)]
pub struct Swarm {
    /// c_1: attraction by the particle's own best position, -. [default: 1.5]
    #[serde(skip_serializing_if = "Option::is_none")]
    pub cognitive: Option<f64>,
    /// c_2: attraction by the swarm's best position, -. [default: 1.5]
    #[serde(skip_serializing_if = "Option::is_none")]
    pub social: Option<f64>,
    /// w_max: inertia weight of the first iteration, -; not below `inertia_min`. [default: 0.9]
    #[serde(skip_serializing_if = "Option::is_none")]
    pub inertia_max: Option<f64>,
    /// w_min: inertia weight after the last iteration, -. [default: 0.4]
    #[serde(skip_serializing_if = "Option::is_none")]
    pub inertia_min: Option<f64>,
    /// Largest change of a control in one iteration, as a fraction of its bound, -. [default: 0.5]
    #[serde(skip_serializing_if = "Option::is_none")]
    pub velocity_fraction: Option<f64>,
    /// Whether the best particle so far takes the place of the last one in every iteration: not in the paper. [default: true;
    /// false for `rhc-fpso-plain`]
    #[serde(skip_serializing_if = "Option::is_none")]
    pub keeps_best: Option<bool>,
}

/// Weights of the violations (eq. 12). The paper's values are lost; the defaults are ours.
#[derive(Clone, Debug, Default, PartialEq, Serialize, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields, default)]
pub struct ViolationWeights {
    /// w_1: of the distance to an obstacle or to the map's bounds, 1/m. [default: 1]
    #[serde(skip_serializing_if = "Option::is_none")]
    pub distance: Option<f64>,
    /// w_2: of the speed, s/m. [default: 0.3]
    #[serde(skip_serializing_if = "Option::is_none")]
    pub speed: Option<f64>,
    /// w_3: of the acceleration, s²/m. [default: 0.1]
    #[serde(skip_serializing_if = "Option::is_none")]
    pub acceleration: Option<f64>,
}

/// Cost map of a receding horizon.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Serialize, Deserialize, JsonSchema)]
#[serde(rename_all = "kebab-case")]
pub enum CostMap {
    /// Visibility graph along the corners of the obstacles: short paths.
    Visibility,
    /// Edges of the Voronoi diagram of sampled boundaries, midway between the obstacles: safer paths.
    Voronoi,
    /// The paper's: the sites are the obstacles' corners and those of the map; a visibility graph over the Voronoi vertices.
    VoronoiVertices,
}

/// Search for the best controls over one horizon.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Serialize, Deserialize, JsonSchema)]
#[serde(rename_all = "kebab-case")]
pub enum Sampler {
    /// Particle swarm.
    Pso,
    /// Particle swarm with a smaller inertia weight for infeasible particles (eq. 15).
    Fpso,
    /// Cross-entropy method.
    Cem,
    /// Model predictive path integral.
    Mppi,
    /// Covariance matrix adaptation.
    CmaEs,
}

/// Potential field.
#[derive(Clone, Debug, Default, PartialEq, Serialize, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields, default)]
pub struct PotentialField {
    /// With a cost map (eq. 16), or instead of it (eq. 17).
    #[serde(skip_serializing_if = "Option::is_none")]
    pub form: Option<PotentialFieldForm>,
    /// Repulsion with the bracket squared (Khatib), or as printed in the paper (eq. 3).
    #[serde(skip_serializing_if = "Option::is_none")]
    pub repulsion: Option<RepulsionForm>,
    /// Gain k_att of the attraction, 1/m.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub attraction: Option<f64>,
    /// Where the goal attracts (eq. 2).
    #[serde(skip_serializing_if = "Option::is_none")]
    pub attraction_along: Option<AttractionAlong>,
    /// What repels (eq. 3).
    #[serde(skip_serializing_if = "Option::is_none")]
    pub repelled_by: Option<RepelledBy>,
    /// Gain k_rep of the repulsion: m³ if the bracket is squared, otherwise m².
    #[serde(skip_serializing_if = "Option::is_none")]
    pub gain: Option<f64>,
    /// Range d_n of the repulsion beyond the planner's clearance, m.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub reach_m: Option<f64>,
}

/// Combination of a potential field with a cost map.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Serialize, Deserialize, JsonSchema)]
#[serde(rename_all = "kebab-case")]
pub enum PotentialFieldForm {
    /// Repulsion and a cost map (eq. 16).
    WithCostMap,
    /// Attraction and repulsion without a cost map (eq. 17).
    Alone,
}

/// Form of the repulsion.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Serialize, Deserialize, JsonSchema)]
#[serde(rename_all = "kebab-case")]
pub enum RepulsionForm {
    /// 1/2 k (1/d - 1/d_n)².
    Squared,
    /// 1/2 k (1/d - 1/d_n).
    Printed,
}

/// Where the attraction by the goal applies.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Serialize, Deserialize, JsonSchema)]
#[serde(rename_all = "kebab-case")]
pub enum AttractionAlong {
    /// At the end of the horizon.
    End,
    /// On average over the steps of the horizon.
    Horizon,
}

/// What repels the vehicle at a step.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Serialize, Deserialize, JsonSchema)]
#[serde(rename_all = "kebab-case")]
pub enum RepelledBy {
    /// The nearest obstacle, or the map's bounds if they are nearer.
    Nearest,
    /// All obstacles within range, and the map's bounds.
    All,
}
