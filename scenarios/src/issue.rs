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
    /// Where in the field's text it begins, bytes; 0 for the field as a whole.
    pub byte: usize,
}

impl Issue {
    /// An issue with `field`, without a remedy.
    pub fn new(field: impl Into<String>, found: impl Into<String>, expected: impl Into<String>) -> Self {
        Self { field: field.into(), found: found.into(), expected: expected.into(), remedy: String::new(), byte: 0 }
    }

    /// Adds a remedy.
    pub fn remedy(mut self, remedy: impl Into<String>) -> Self {
        self.remedy = remedy.into();
        self
    }

    /// Places it in the text that the field holds, at an offset in bytes.
    pub fn at_byte(mut self, byte: usize) -> Self {
        self.byte = byte;
        self
    }
}

impl fmt::Display for Issue {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        write!(f, "{}: found {}, expected {}", self.field, self.found, self.expected)
    }
}
