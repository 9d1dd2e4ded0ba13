use schemars::JsonSchema;
use serde::{Deserialize, Serialize};

/// A closed interval, written `[min, max]` in files; both ends in the unit of the field.
#[derive(Clone, Copy, Debug, PartialEq, Serialize, Deserialize, JsonSchema)]
#[serde(from = "[f64; 2]", into = "[f64; 2]")]
#[schemars(with = "[f64; 2]")]
pub struct Range {
    /// Lower end.
    pub min: f64,
    /// Upper end.
    pub max: f64,
}

impl Range {
    /// The interval from `min` to `max`.
    pub const fn new(min: f64, max: f64) -> Self {
        Self { min, max }
    }

    /// Whether `value` lies inside, ends included; false for NaN.
    pub fn contains(&self, value: f64) -> bool {
        self.min <= value && value <= self.max
    }

    /// Whether `inner` lies inside, ends included.
    pub fn encloses(&self, inner: &Range) -> bool {
        self.min <= inner.min && inner.max <= self.max
    }

    /// Distance from `value` to the nearer end: positive inside, negative outside.
    pub fn margin(&self, value: f64) -> f64 {
        (value - self.min).min(self.max - value)
    }

    /// `max - min`.
    pub fn width(&self) -> f64 {
        self.max - self.min
    }

    /// The interval with both ends multiplied by `factor` > 0.
    pub fn scaled(&self, factor: f64) -> Self {
        Self::new(self.min * factor, self.max * factor)
    }

    /// The interval converted from degrees to radians.
    pub fn to_radians(&self) -> Self {
        Self::new(self.min.to_radians(), self.max.to_radians())
    }
}

impl From<[f64; 2]> for Range {
    fn from([min, max]: [f64; 2]) -> Self {
        Self { min, max }
    }
}

impl From<Range> for [f64; 2] {
    fn from(range: Range) -> Self {
        [range.min, range.max]
    }
}

impl std::fmt::Display for Range {
    fn fmt(&self, f: &mut std::fmt::Formatter<'_>) -> std::fmt::Result {
        write!(f, "[{}, {}]", self.min, self.max)
    }
}
