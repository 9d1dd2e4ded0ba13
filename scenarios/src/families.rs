//! The vehicle families. Everything in this crate that lists them stands in this file; everything that differs between
//! them stands in their own modules, behind [`FamilySpec`] and two traits.

mod spec;

use std::collections::BTreeMap;
use std::fmt;

use schemars::JsonSchema;
use serde::{Deserialize, Serialize};

pub use spec::VehicleModel;
pub(crate) use spec::{FamilySpec, surplus};

use crate::{TrajectoryNodes, fixed_wing, multirotor, slung_load};

/// A kind of vehicle. Each has its own state, control, limits, plant, tracker and checks.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Family {
    /// A fixed-wing point mass controlled by load factors.
    FixedWing,
    /// A quadrotor with a load on a cable.
    SlungLoad,
    /// A multirotor without a load.
    Multirotor,
}

impl Family {
    /// All families, in the order in which models are listed.
    pub const ALL: [Self; 3] = [Self::FixedWing, Self::SlungLoad, Self::Multirotor];

    /// The family's key in scenario and plan files: `fixed-wing`.
    pub fn key(self) -> &'static str {
        self.spec().key
    }

    /// Whether a vehicle hovers at its goal once it has arrived; otherwise it flies on.
    pub fn hovers(self) -> bool {
        self.spec().hovers
    }

    /// Whether a vehicle carries a load.
    pub fn carries_load(self) -> bool {
        self.spec().carries_load
    }

    /// Whether a vehicle senses obstacles and other vehicles in flight.
    pub fn senses_obstacles(self) -> bool {
        self.spec().senses_obstacles
    }

    /// What differs between the families.
    pub(crate) fn spec(self) -> &'static FamilySpec {
        match self {
            Self::FixedWing => &fixed_wing::FAMILY,
            Self::SlungLoad => &slung_load::FAMILY,
            Self::Multirotor => &multirotor::FAMILY,
        }
    }
}

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

impl Models {
    /// Every model with its name, family by family, then by name.
    pub fn iter(&self) -> impl Iterator<Item = (&str, &dyn VehicleModel)> {
        let fixed_wing = named(&self.fixed_wing);
        fixed_wing.chain(named(&self.slung_load)).chain(named(&self.multirotor))
    }

    /// The model of this name.
    pub fn get(&self, name: &str) -> Option<&dyn VehicleModel> {
        self.iter().find(|(other, _)| *other == name).map(|(_, model)| model)
    }

    /// The names of all models, family by family.
    pub fn names(&self) -> impl Iterator<Item = &str> {
        self.iter().map(|(name, _)| name)
    }
}

fn named<M: VehicleModel>(models: &BTreeMap<String, M>) -> impl Iterator<Item = (&str, &dyn VehicleModel)> {
    models.iter().map(|(name, model)| (name.as_str(), model as &dyn VehicleModel))
}

/// The planned motion of one vehicle, given at nodes, with the state and control of its family.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
#[serde(tag = "family", rename_all = "kebab-case")]
pub enum Trajectory {
    /// Of a fixed wing.
    FixedWing(fixed_wing::Trajectory),
    /// Of a quadrotor with a load.
    SlungLoad(slung_load::Trajectory),
    /// Of a multirotor.
    Multirotor(multirotor::Trajectory),
}

impl Trajectory {
    /// What the trajectories of all families have in common.
    pub fn nodes(&self) -> &dyn TrajectoryNodes {
        match self {
            Self::FixedWing(trajectory) => trajectory,
            Self::SlungLoad(trajectory) => trajectory,
            Self::Multirotor(trajectory) => trajectory,
        }
    }
}

/// The family in prose: `fixed wing`.
impl fmt::Display for Family {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        f.write_str(self.spec().name)
    }
}
