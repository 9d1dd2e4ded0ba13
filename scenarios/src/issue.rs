use std::fmt;

/// What is wrong with one field of an input.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct Issue {
    /// Path of the field from the root of the document: `vehicles[3].start.x_m`.
    pub field: String,
    /// The value found there.
    pub found: String,
    /// The expected value.
    pub expected: String,
    /// How to correct it; empty if `expected` says it all.
    pub remedy: String,
}

impl Issue {
    /// An issue with `field`, without a remedy.
    pub fn new(field: impl Into<String>, found: impl Into<String>, expected: impl Into<String>) -> Self {
        Self { field: field.into(), found: found.into(), expected: expected.into(), remedy: String::new() }
    }

    /// Adds a remedy.
    pub fn remedy(mut self, remedy: impl Into<String>) -> Self {
        self.remedy = remedy.into();
        self
    }
}

impl fmt::Display for Issue {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        write!(f, "{}: found {}, expected {}", self.field, self.found, self.expected)
    }
}
