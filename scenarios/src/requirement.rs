//! Requirements in the user's own words: signal temporal logic over continuous time.
//!
//! A [`Requirement`] holds the text of a formula; [`Requirement::formula`] parses it (`parser`), resolves its names against
//! the scenario and checks its dimensions (`resolve`).
//!
//! Maler, Nickovic (2004), Monitoring temporal properties of continuous signals, FORMATS. Donzé, Maler (2010), Robust
//! satisfaction of temporal logic over real-valued signals, FORMATS.

mod formula;
mod parser;
mod resolve;
mod signals;
mod syntax;
mod units;

use std::fmt;
use std::ops::Range;

use schemars::JsonSchema;
use serde::{Deserialize, Serialize};

use crate::{Group, Scenario};

pub use formula::{Clause, Formula, Predicate, Quantifier, Signal, Subject, Target, Term, Window};
pub use signals::{Quantity, SIGNALS, SignalSpec, TargetKind};

/// A requirement on the motion of the vehicles, as a formula of signal temporal logic. It becomes the checks
/// `plan.requirement.NAME` and `flight.requirement.NAME`.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields)]
pub struct Requirement {
    /// Name, unique among the requirements: letters, digits, `-` and `_`.
    pub name: String,
    /// The formula, as `always altitude > 50 m`: see docs/requirements.md.
    pub formula: String,
    /// Where it comes from, or what it is for.
    #[serde(default, skip_serializing_if = "String::is_empty")]
    pub description: String,
    /// Whether it is shown and counted without deciding.
    #[serde(default, skip_serializing_if = "std::ops::Not::not")]
    pub advisory: bool,
    /// The motions that it is about.
    #[serde(default, skip_serializing_if = "AppliesTo::is_default")]
    pub applies_to: AppliesTo,
}

/// The motions that a requirement is about.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, Serialize, Deserialize, JsonSchema)]
#[serde(rename_all = "kebab-case")]
pub enum AppliesTo {
    /// Planned and flown.
    #[default]
    Both,
    /// The planned motion only.
    Plan,
    /// The flown motion only.
    Flight,
}

impl AppliesTo {
    fn is_default(&self) -> bool {
        *self == Self::Both
    }

    /// Whether it covers the checks of `group`.
    pub fn covers(self, group: Group) -> bool {
        match group {
            Group::Nodes => false,
            Group::Plan => self != Self::Flight,
            Group::Flight => self != Self::Plan,
        }
    }
}

/// What is wrong with a formula.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct FormulaError {
    /// Bytes of the formula's text concerned.
    pub span: Range<usize>,
    /// What stands there.
    pub found: String,
    /// What was expected.
    pub expected: String,
    /// How to correct it; empty if `expected` says it all.
    pub remedy: String,
}

impl fmt::Display for FormulaError {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        write!(f, "at byte {}: found {}, expected {}", self.span.start, self.found, self.expected)
    }
}

impl Requirement {
    /// The formula, with its names resolved against `scenario`.
    ///
    /// # Errors
    ///
    /// The text is no formula, names something that the scenario does not have, or mixes dimensions.
    pub fn formula(&self, scenario: &Scenario) -> Result<Formula, FormulaError> {
        resolve::resolve(&parser::parse(&self.formula)?, &self.formula, scenario)
    }

    /// The full names of its checks, in the order of a verdict.
    pub fn check_names(&self) -> impl Iterator<Item = String> + '_ {
        let groups = [Group::Plan, Group::Flight].into_iter().filter(|group| self.applies_to.covers(*group));
        groups.map(|group| format!("{group}.requirement.{}", self.name))
    }
}

#[cfg(test)]
mod tests;
