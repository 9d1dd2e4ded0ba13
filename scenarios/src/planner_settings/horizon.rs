use schemars::JsonSchema;
use serde::{Deserialize, Serialize};

/// Options of planners by receding horizon.
#[derive(Clone, Debug, Default, PartialEq, Serialize, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields, default)]
pub struct Horizon {
    /// Sampling time T, s.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub step_s: Option<f64>,
    /// Steps of the horizon H_p, from 1 to 100.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub steps: Option<usize>,
    /// Particles, from 4 to 10000; rounded up to a multiple of four.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub particles: Option<usize>,
    /// Iterations of one search at most, from 1 to 10000.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub iterations: Option<usize>,
    /// A search ends when its best cost has not improved for so many iterations. Absent: it does not.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub stall_iterations: Option<usize>,
    /// What is left to the goal from the end of a horizon.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub cost_map: Option<CostMap>,
    /// How the planner `rhc` searches; the others are named after their search.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub sampler: Option<Sampler>,
    /// The cost of infeasible particles is computed too, though nobody looks at it: to measure what skipping it saves.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub costs_infeasible: Option<bool>,
    /// Positions of the swarm move by w v, as the paper prints its eq. 13, instead of by v.
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
    /// Ways along the corners of the obstacles: short.
    Visibility,
    /// Ways in the middle between the obstacles: safer.
    Voronoi,
}

/// Search for the best controls over one horizon.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Serialize, Deserialize, JsonSchema)]
#[serde(rename_all = "kebab-case")]
pub enum Sampler {
    /// Particle swarm.
    Pso,
    /// Particle swarm in which infeasible particles listen more to the others (eq. 15).
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
    /// Beside a cost map (eq. 16), or instead of it (eq. 17).
    #[serde(skip_serializing_if = "Option::is_none")]
    pub form: Option<PotentialFieldForm>,
    /// Repulsion with the bracket squared (Khatib), or as the paper prints it (eq. 3).
    #[serde(skip_serializing_if = "Option::is_none")]
    pub repulsion: Option<RepulsionForm>,
    /// Gain k_att of the attraction, 1/m.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub attraction: Option<f64>,
    /// Gain k_rep of the repulsion: m³ where the bracket is squared, else m².
    #[serde(skip_serializing_if = "Option::is_none")]
    pub gain: Option<f64>,
    /// Distance d_n within which obstacles repel, from where the planner's clearance ends, m.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub reach_m: Option<f64>,
}

/// What a potential field stands beside.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Serialize, Deserialize, JsonSchema)]
#[serde(rename_all = "kebab-case")]
pub enum PotentialFieldForm {
    /// Repulsion beside a cost map (eq. 16).
    WithCostMap,
    /// Attraction and repulsion, no cost map (eq. 17).
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
