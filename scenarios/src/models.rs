use std::collections::BTreeMap;
use std::fmt;

use schemars::JsonSchema;
use serde::{Deserialize, Serialize};

use crate::{fixed_wing, multirotor, slung_load};

/// Vehicle models by family, then by name: `[models.fixed-wing.NAME]`, `[models.slung-load.NAME]`,
/// `[models.multirotor.NAME]`. A name is unique over all families.
#[derive(Clone, Debug, Default, PartialEq, Serialize, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields)]
pub struct Models {
    /// Fixed-wing point-mass models.
    #[serde(default, rename = "fixed-wing", skip_serializing_if = "BTreeMap::is_empty")]
    pub fixed_wing: BTreeMap<String, fixed_wing::Model>,
    /// Quadrotors that carry a load on a cable.
    #[serde(default, rename = "slung-load", skip_serializing_if = "BTreeMap::is_empty")]
    pub slung_load: BTreeMap<String, slung_load::Model>,
    /// Multirotors without a load.
    #[serde(default, skip_serializing_if = "BTreeMap::is_empty")]
    pub multirotor: BTreeMap<String, multirotor::Model>,
}

/// Kinds of vehicles: each has its own state, control, limits, plant, tracker, and way to be judged and drawn.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Family {
    /// A point mass that is steered by load factors.
    FixedWing,
    /// A quadrotor with a load on a cable.
    SlungLoad,
    /// A multirotor without a load.
    Multirotor,
}

/// A model of some family.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum Model<'a> {
    /// A point mass that is steered by load factors.
    FixedWing(&'a fixed_wing::Model),
    /// A quadrotor with a load on a cable.
    SlungLoad(&'a slung_load::Model),
    /// A multirotor without a load.
    Multirotor(&'a multirotor::Model),
}

impl Models {
    /// The model of this name, of whichever family.
    pub fn get(&self, name: &str) -> Option<Model<'_>> {
        let fixed_wing = || self.fixed_wing.get(name).map(Model::FixedWing);
        let slung_load = || self.slung_load.get(name).map(Model::SlungLoad);
        fixed_wing().or_else(slung_load).or_else(|| self.multirotor.get(name).map(Model::Multirotor))
    }

    /// The names of all models, family by family.
    pub fn names(&self) -> impl Iterator<Item = &str> {
        self.fixed_wing.keys().chain(self.slung_load.keys()).chain(self.multirotor.keys()).map(String::as_str)
    }
}

impl Model<'_> {
    /// Its family.
    pub fn family(&self) -> Family {
        match self {
            Self::FixedWing(_) => Family::FixedWing,
            Self::SlungLoad(_) => Family::SlungLoad,
            Self::Multirotor(_) => Family::Multirotor,
        }
    }

    /// Radius of the sphere about the vehicle's centre that encloses it, its load aside, m.
    pub fn body_radius_m(&self) -> f64 {
        match self {
            Self::FixedWing(model) => model.body_radius_m,
            Self::SlungLoad(model) => model.body_radius_m(),
            Self::Multirotor(model) => model.body_radius_m,
        }
    }
}

impl fmt::Display for Family {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        f.write_str(match self {
            Self::FixedWing => "fixed wing",
            Self::SlungLoad => "quadrotor with a slung load",
            Self::Multirotor => "multirotor",
        })
    }
}
