use schemars::JsonSchema;
use serde::{Deserialize, Serialize};

use crate::slung_load::Cable;

/// Options of planners that optimise a trajectory by collocation.
#[derive(Clone, Debug, Default, PartialEq, Serialize, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields, default)]
pub struct Collocation {
    /// What is made as small as possible.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub objective: Option<Objective>,
    /// Duration of the motion where the objective leaves it open, s.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub flight_time_s: Option<f64>,
    /// Segments of the first mesh, of equal length.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub segments: Option<usize>,
    /// Collocation points of each segment of the first mesh.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub points: Option<usize>,
    /// Error of the collocated motion at which the mesh is fine enough, relative to the largest value of each state. Zero
    /// keeps the first mesh.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub mesh_tolerance: Option<f64>,
    /// How slack and taut are told apart. Absent: phases.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub formulation: Option<Formulation>,
    /// What the cable does, phase after phase; the instants of the switches are free. Two phases in a row that are alike
    /// meet where a gate is passed. Absent: taut from start to goal.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub cable: Option<Vec<Cable>>,
    /// Largest impulse with which the cable may become taut, N s. Absent: as large as it comes.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub impact_ns: Option<f64>,
    /// What is kept clear of the obstacles.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub shape: Option<Shape>,
}

/// What an optimiser makes as small as possible.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Serialize, Deserialize, JsonSchema)]
#[serde(rename_all = "kebab-case")]
pub enum Objective {
    /// The paper's weighted integral of squared states and controls, in a given time.
    Effort,
    /// The duration.
    Time,
}

/// How an optimiser tells a slack cable from a taut one.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Serialize, Deserialize, JsonSchema)]
#[serde(rename_all = "kebab-case")]
pub enum Formulation {
    /// By phases, whose order is given and whose ends are free; a cable that becomes taut does so in an impact.
    Phases,
    /// By the paper's complementarity, node by node: the tension is a control, and its product with the slack length is
    /// next to nothing. It knows of no impact.
    Complementarity,
}

/// What an optimiser keeps clear of the obstacles.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Serialize, Deserialize, JsonSchema)]
#[serde(rename_all = "kebab-case")]
pub enum Shape {
    /// The envelope circle: body or horizontal reach of the load, whichever is larger, at every height.
    Envelope,
    /// Body, cable and load each by itself.
    Parts,
}
