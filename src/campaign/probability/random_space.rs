//! The random fields of a scenario.

use super::splitting::Point;
use crate::campaign::distribution::RandomField;
use crate::campaign::scenario_document::{FieldPath, ScenarioDocument};

/// A scenario of which some fields are random, and the seed of its flight, if it is.
pub struct RandomSpace<'a> {
    document: &'a ScenarioDocument,
    fields: &'a [RandomField],
    any_seed: bool,
}

impl<'a> RandomSpace<'a> {
    /// The space about a scenario.
    ///
    /// - `any_seed`: whether every flight has a random seed, in place of the scenario's
    ///
    /// # Errors
    ///
    /// The first field that the file does not give as a number.
    pub fn new(document: &'a ScenarioDocument, fields: &'a [RandomField], any_seed: bool) -> Result<Self, FieldPath> {
        match fields.iter().find(|field| document.number(&field.path).is_none()) {
            Some(missing) => Err(missing.path.clone()),
            None => Ok(Self { document, fields, any_seed }),
        }
    }

    /// Name of the scenario.
    pub fn scenario_name(&self) -> &str {
        self.document.name()
    }

    /// The random fields.
    pub fn fields(&self) -> &[RandomField] {
        self.fields
    }

    /// Number of random fields.
    pub fn dimension(&self) -> usize {
        self.fields.len()
    }

    /// Whether every flight has a random seed.
    pub fn any_seed(&self) -> bool {
        self.any_seed
    }

    /// The values of the fields at a point.
    pub fn values(&self, point: &Point) -> Vec<f64> {
        self.fields.iter().zip(&point.normals).map(|(field, normal)| field.distribution.value(*normal)).collect()
    }

    /// The scenario at a point, which gives the same flight when it is run as a file.
    pub fn document(&self, point: &Point) -> ScenarioDocument {
        self.document_with(&self.values(point), point.seed)
    }

    /// The scenario with these values, and with this seed if there is one.
    pub fn document_with(&self, values: &[f64], seed: Option<u64>) -> ScenarioDocument {
        let mut document = self.document.clone();
        for (field, value) in self.fields.iter().zip(values) {
            document.set_number(&field.path, *value);
        }
        match seed {
            Some(seed) => document.with_seed(seed),
            None => document,
        }
    }
}
