use schemars::JsonSchema;
use serde::{Deserialize, Serialize};

use crate::slung_load::Cable;

/// Options of collocation planners.
#[derive(Clone, Debug, Default, PartialEq, Serialize, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields, default)]
pub struct Collocation {
    /// The objective to minimise.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub objective: Option<Objective>,
    /// Flight time, s, if the objective does not determine it.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub flight_time_s: Option<f64>,
    /// Number of segments of the initial mesh, of equal length.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub segments: Option<usize>,
    /// Number of collocation points per segment of the initial mesh.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub points: Option<usize>,
    /// Tolerance of mesh refinement: error of the collocated motion, relative to the largest value of each state. Zero: no
    /// refinement.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub mesh_tolerance: Option<f64>,
    /// Formulation of the slack and taut cable. Absent: phases.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub formulation: Option<Formulation>,
    /// State of the cable in each phase; the switching times are free. A gate is passed between two successive phases of the
    /// same state. Absent: taut from start to goal.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub cable: Option<Vec<Cable>>,
    /// Maximum impulse when the cable becomes taut, N s. Absent: unbounded.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub impact_ns: Option<f64>,
    /// Shape that avoids the obstacles.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub shape: Option<Shape>,
    /// Meaning of the torques of the rotors in the planner's model. Absent: body.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub torques: Option<Torques>,
}

/// Objective of an optimiser.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Serialize, Deserialize, JsonSchema)]
#[serde(rename_all = "kebab-case")]
pub enum Objective {
    /// The paper's weighted integral of squared states and controls, for a fixed flight time.
    Effort,
    /// The flight time.
    Time,
}

/// Formulation of the slack and taut cable.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Serialize, Deserialize, JsonSchema)]
#[serde(rename_all = "kebab-case")]
pub enum Formulation {
    /// Phases in a given order with free switching times. A cable becomes taut in an impact.
    Phases,
    /// The paper's complementarity constraint at every node: the tension is a control, and its product with the slack length
    /// is bounded by a small tolerance. Impacts are not modelled.
    Complementarity,
}

/// Shape that avoids the obstacles.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Serialize, Deserialize, JsonSchema)]
#[serde(rename_all = "kebab-case")]
pub enum Shape {
    /// The envelope circle (Kang, Huang, Wen 2020, eq. 19, 20), which holds the circle of the body and the horizontal reach of
    /// the load, at every altitude; as smooth constraints.
    Envelope,
    /// The same circle by the paper's R-functions, with their kinks.
    RFunction,
    /// Body (as the ball around the rotors), cable and load separately, within the altitudes of the obstacles.
    Parts,
}

/// Meaning of the torques of the rotors.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Serialize, Deserialize, JsonSchema)]
#[serde(rename_all = "kebab-case")]
pub enum Torques {
    /// About the body's axes, as on the vehicle.
    Body,
    /// Generalised torques of yaw, pitch and roll (Kang, Huang, Wen 2020, eq. 5): for small angles, the same.
    Generalised,
}
