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
    /// Whether positions of the swarm are updated by w v, as printed in eq. 13 of the paper, instead of by v.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub moves_as_printed: Option<bool>,
    /// Potential field of the planner `rhc-apf`.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub field: Option<PotentialField>,
}

/// Cost map of a receding horizon.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Serialize, Deserialize, JsonSchema)]
#[serde(rename_all = "kebab-case")]
pub enum CostMap {
    /// Visibility graph along the corners of the obstacles: short paths.
    Visibility,
    /// Voronoi diagram between the obstacles: safer paths.
    Voronoi,
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
