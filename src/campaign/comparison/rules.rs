//! Directions and tolerances of the compared figures.

/// Prefix of the names of margins among the figures, before the name of the check.
pub const MARGIN_OF: &str = "margin of ";
/// Name of the planned flight time among the figures.
pub const PLANNED_TIME: &str = "planned flight time";
/// Name of the flown time among the figures.
pub const FLOWN_TIME: &str = "flown time";
/// Name of the largest distance from the plan among the figures.
pub const TRACKING_MAX: &str = "tracking error, largest";
/// Name of the root mean square of that distance among the figures.
pub const TRACKING_RMS: &str = "tracking error, rms";
/// Name of the planning time among the figures.
pub const PLANNING_TIME: &str = "planning time";

/// How one figure is compared.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Rule {
    /// Whether larger values are better.
    pub more_is_better: bool,
    /// Absolute tolerance, in the unit of the figure.
    pub absolute: f64,
    /// Tolerance relative to the old figure.
    pub relative: f64,
    /// Whether a change for the worse fails the comparison.
    pub decides: bool,
}

impl Rule {
    /// Largest tolerated change.
    pub fn tolerance(&self, old: f64) -> f64 {
        self.absolute.max(self.relative * old.abs())
    }

    /// Whether a change is for the better. NaN is not.
    pub fn is_gain(&self, change: f64) -> bool {
        if self.more_is_better { change > 0.0 } else { change < 0.0 }
    }
}

/// The rule of a figure; every other figure is the margin of a check.
pub fn rule(name: &str, unit: &str) -> Rule {
    let less = |absolute, relative| Rule { more_is_better: false, absolute, relative, decides: true };
    match name {
        PLANNED_TIME | FLOWN_TIME => less(0.05, 0.005),
        TRACKING_MAX | TRACKING_RMS => less(0.005, 0.02),
        // It depends on the machine and its load.
        PLANNING_TIME => Rule { more_is_better: false, absolute: 0.1, relative: 1.0, decides: false },
        _ => {
            let absolute = match unit {
                "m" | "m/s" | "deg" | "s" | "N" => 0.01,
                _ => 1e-3,
            };
            Rule { more_is_better: true, absolute, relative: 0.02, decides: true }
        }
    }
}
