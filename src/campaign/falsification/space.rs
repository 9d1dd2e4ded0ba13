//! The fields that a search varies, each within its range.

use std::str::FromStr;

use crate::campaign::scenario_document::{FieldPath, ScenarioDocument};

/// One field and its range: `world.cylinders.tree-1.radius_m=0.2..0.8`.
#[derive(Clone, Debug, PartialEq)]
pub struct VariedField {
    /// The field.
    pub path: FieldPath,
    /// Its smallest and largest value, in its unit.
    pub range: [f64; 2],
}

impl FromStr for VariedField {
    type Err = String;

    fn from_str(text: &str) -> Result<Self, String> {
        let read = || {
            let (path, range) = text.split_once('=')?;
            let (low, high) = range.split_once("..")?;
            let range: [f64; 2] = [low.parse().ok()?, high.parse().ok()?];
            let is_range = range.iter().all(|bound| bound.is_finite()) && range[0] < range[1];
            Some(Self { path: FieldPath::parse(path)?, range }).filter(|_| is_range)
        };
        read().ok_or_else(|| "expected a field and its range, as `world.cylinders.tree-1.radius_m=0.2..0.8`".to_owned())
    }
}

/// Points are given as fractions of the ranges, from 0 to 1.
pub struct Space<'a> {
    document: &'a ScenarioDocument,
    fields: &'a [VariedField],
}

impl<'a> Space<'a> {
    /// The space about a scenario.
    ///
    /// # Errors
    ///
    /// The first field that the file does not give as a number.
    pub fn new(document: &'a ScenarioDocument, fields: &'a [VariedField]) -> Result<Self, FieldPath> {
        match fields.iter().find(|field| document.number(&field.path).is_none()) {
            Some(missing) => Err(missing.path.clone()),
            None => Ok(Self { document, fields }),
        }
    }

    /// Name of the scenario.
    pub fn scenario_name(&self) -> &str {
        self.document.name()
    }

    /// The paths of the fields.
    pub fn field_names(&self) -> Vec<String> {
        self.fields.iter().map(|field| field.path.to_string()).collect()
    }

    /// Number of fields.
    pub fn dimension(&self) -> usize {
        self.fields.len()
    }

    /// The scenario as it is; fields outside of their ranges at the nearest end.
    pub fn origin(&self) -> Vec<f64> {
        let fraction = |field: &VariedField| {
            let [low, high] = field.range;
            let number = self.document.number(&field.path).unwrap_or(low);
            ((number - low) / (high - low)).clamp(0.0, 1.0)
        };
        self.fields.iter().map(fraction).collect()
    }

    /// The values of the fields at a point. Beyond 0 and 1 it is reflected.
    pub fn values(&self, point: &[f64]) -> Vec<f64> {
        let value = |(field, fraction): (&VariedField, &f64)| {
            let [low, high] = field.range;
            low + reflected(*fraction) * (high - low)
        };
        self.fields.iter().zip(point).map(value).collect()
    }

    /// The scenario with these values.
    pub fn document(&self, values: &[f64]) -> ScenarioDocument {
        let mut document = self.document.clone();
        for (field, value) in self.fields.iter().zip(values) {
            document.set_number(&field.path, *value);
        }
        document
    }
}

/// A coordinate folded back into 0..1.
fn reflected(fraction: f64) -> f64 {
    let folded = fraction.rem_euclid(2.0);
    if folded > 1.0 { 2.0 - folded } else { folded }
}

#[cfg(test)]
mod tests {
    use scenarios::ScenarioFile;

    use super::{Space, VariedField, reflected};
    use crate::campaign::scenario_document::ScenarioDocument;

    #[test]
    fn points_are_scenarios_within_the_ranges() {
        let document = ScenarioDocument::of(&ScenarioFile::new("a.toml", "name = \"a\"\n[wind]\nx = 4\ny = 1.0\n"));
        let fields: Vec<VariedField> = ["wind.x=0..8", "wind.y=-2..0"].map(|text| text.parse().unwrap()).into();
        let space = Space::new(&document, &fields).unwrap();
        assert_eq!(space.origin(), [0.5, 1.0]);
        assert_eq!(space.values(&[0.25, 1.25]), [2.0, -0.5]);
        assert_eq!(space.document(&[2.5, -0.5]).text(), "name = \"a\"\n\n[wind]\nx = 2.5\ny = -0.5\n");
        let missing = ["wind.z=0..1".parse().unwrap()];
        assert_eq!(Space::new(&document, &missing).err().unwrap().to_string(), "wind.z");
    }

    #[test]
    fn ranges_are_read_and_wrong_ones_refused() {
        assert!(["a=1..2", "a[0].b=-1e3..2.5"].iter().all(|text| text.parse::<VariedField>().is_ok()));
        assert!(
            ["a", "a=1", "a=2..1", "a=1..1", "a=0..inf", "=0..1", "a=x..1"]
                .iter()
                .all(|text| text.parse::<VariedField>().is_err())
        );
        assert_eq!([-0.25, 0.25, 1.25, 2.25].map(reflected), [0.25, 0.25, 0.75, 0.25]);
    }
}
