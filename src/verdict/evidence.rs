//! Comparison of a measured value with a limit. NaN never passes.

use std::fmt;

use scenarios::CheckSpec;

use crate::verdict::closest::ClosestApproach;
use crate::verdict::missing_evidence::MissingEvidence;
use crate::verdict::{Check, Status, tolerance};

/// What a check measures, or why it is missing.
pub type Evidence<'a, T> = Result<&'a T, &'a MissingEvidence>;

/// A check, or why there is nothing to measure; then the check fails.
pub type CheckResult = Result<Check, MissingEvidence>;

/// The worst value found: its bounds (equal for a value known exactly), its time, and what it is between.
#[derive(Clone, Debug, PartialEq)]
pub struct Measurement {
    lower: f64,
    upper: f64,
    /// Whether only bounds are known.
    is_bounded: bool,
    at_s: Option<f64>,
    between: Vec<String>,
    reason: Option<String>,
}

impl Measurement {
    /// A value known exactly.
    pub fn value(value: f64) -> Self {
        Self { lower: value, upper: value, is_bounded: false, at_s: None, between: Vec::new(), reason: None }
    }

    /// A value known within bounds.
    pub fn bounds(lower: f64, upper: f64) -> Self {
        Self { lower, is_bounded: true, ..Self::value(upper) }
    }

    /// A distance known within bounds, at its time.
    pub fn approach(approach: &ClosestApproach) -> Self {
        Self::bounds(approach.lower_m, approach.upper_m).at(approach.at_s)
    }

    /// Adds the time, s.
    pub fn at(mut self, t_s: f64) -> Self {
        self.at_s = t_s.is_finite().then_some(t_s);
        self
    }

    /// Adds one more vehicle or obstacle concerned.
    pub fn with(mut self, name: &str) -> Self {
        self.between.push(name.to_owned());
        self
    }

    /// Adds a remark for the reader of the report.
    pub fn with_reason(mut self, reason: impl Into<String>) -> Self {
        self.reason = Some(reason.into());
        self
    }
}

/// Compares the measurement of a declared check with its limit.
pub trait Decide {
    /// Passes if the lower bound is at least `limit`, up to the [`tolerance`]; undecided if `limit` lies between the bounds.
    /// The check reports the lower bound, the conservative one.
    fn at_least(&self, measured: Measurement, limit: f64) -> Check;

    /// Passes if the upper bound is at most `limit`, up to the [`tolerance`]; undecided if `limit` lies between the bounds.
    /// The check reports the upper bound, the conservative one.
    fn at_most(&self, measured: Measurement, limit: f64) -> Check;

    /// The check of a value with a known `margin` to `limit`, positive inside.
    fn inside(&self, measured: Measurement, limit: f64, margin: f64) -> Check;

    /// The check does not apply, for this reason.
    fn skip(&self, reason: impl fmt::Display) -> Check;

    /// The check fails without a value, for this reason.
    fn fail(&self, reason: impl fmt::Display) -> Check;
}

impl Decide for CheckSpec {
    fn at_least(&self, measured: Measurement, limit: f64) -> Check {
        let status = status_at_least(self, [measured.lower, measured.upper], limit);
        let (value, margin) = (measured.lower, measured.lower - limit);
        compared(self, status, value, limit, margin, measured)
    }

    fn at_most(&self, measured: Measurement, limit: f64) -> Check {
        let status = status_at_most(self, [measured.lower, measured.upper], limit);
        let (value, margin) = (measured.upper, limit - measured.upper);
        compared(self, status, value, limit, margin, measured)
    }

    fn inside(&self, measured: Measurement, limit: f64, margin: f64) -> Check {
        let value = measured.lower;
        compared(self, status_inside(self, limit, margin), value, limit, margin, measured)
    }

    fn skip(&self, reason: impl fmt::Display) -> Check {
        without_value(self, Status::Skip, reason)
    }

    fn fail(&self, reason: impl fmt::Display) -> Check {
        without_value(self, Status::Fail, reason)
    }
}

fn without_value(spec: &CheckSpec, status: Status, reason: impl fmt::Display) -> Check {
    Check {
        name: spec.name.to_owned(),
        status,
        value: None,
        lower: None,
        upper: None,
        limit: None,
        margin: None,
        unit: spec.unit.to_owned(),
        at_s: None,
        between: Vec::new(),
        advisory: false,
        reason: Some(reason.to_string()),
        limit_key: None,
    }
}

fn compared(spec: &CheckSpec, status: Status, value: f64, limit: f64, margin: f64, measured: Measurement) -> Check {
    let Measurement { lower, upper, is_bounded, at_s, between, reason } = measured;
    if !(value.is_finite() && limit.is_finite() && margin.is_finite()) {
        let failed = spec.fail(reason.unwrap_or_else(|| "the measured value is not a finite number".to_owned()));
        return Check { at_s, between, ..failed };
    }
    let undecided = || format!("between {lower} and {upper} {}: the limit lies between the bounds", spec.unit);
    let reason = if status == Status::Undecided { Some(undecided()) } else { reason };
    let [lower, upper] = [lower, upper].map(|bound| Some(bound).filter(|bound| is_bounded && bound.is_finite()));
    // Beyond the limit by no more than the tolerance is at the limit.
    let margin = if status == Status::Pass { margin.max(0.0) } else { margin };
    let (value, limit, margin) = (Some(value), Some(limit), Some(margin));
    Check { status, value, lower, upper, limit, margin, at_s, between, reason, ..without_value(spec, status, "") }
}

/// Whether bounds, lower and upper, are at least `limit`, up to the [`tolerance`]. NaN fails.
pub fn status_at_least(spec: &CheckSpec, [lower, upper]: [f64; 2], limit: f64) -> Status {
    let least = limit - tolerance::limit_tolerance(spec, limit);
    decide(lower >= least, lower < least && upper >= least)
}

/// Whether bounds, lower and upper, are at most `limit`, up to the [`tolerance`]. NaN fails.
pub fn status_at_most(spec: &CheckSpec, [lower, upper]: [f64; 2], limit: f64) -> Status {
    let most = limit + tolerance::limit_tolerance(spec, limit);
    decide(upper <= most, upper > most && lower <= most)
}

/// Whether a `margin` to `limit` is kept, up to the [`tolerance`]. NaN fails.
pub fn status_inside(spec: &CheckSpec, limit: f64, margin: f64) -> Status {
    decide(margin >= -tolerance::limit_tolerance(spec, limit), false)
}

/// Neither comparison holds for NaN, which leaves a failure.
fn decide(pass: bool, is_undecided: bool) -> Status {
    if pass {
        Status::Pass
    } else if is_undecided {
        Status::Undecided
    } else {
        Status::Fail
    }
}

#[cfg(test)]
mod tests {
    use scenarios::{CheckSpec, check_spec};

    use super::{Decide, Measurement};
    use crate::verdict::Status;
    use crate::verdict::closest::ClosestApproach;

    fn spec() -> &'static CheckSpec {
        check_spec("plan.separation").expect("a declared check")
    }

    fn bounds(lower_m: f64, upper_m: f64) -> Measurement {
        Measurement::approach(&ClosestApproach { lower_m, upper_m, at_s: 1.0, who: [0, 1] })
    }

    #[test]
    fn a_bound_on_each_side_of_the_limit_is_undecided() {
        let at_least = |lower, upper| spec().at_least(bounds(lower, upper), 100.0).status;
        assert_eq!(at_least(100.0, 101.0), Status::Pass);
        assert_eq!(at_least(99.0, 100.0), Status::Undecided);
        assert_eq!(at_least(98.0, 99.0), Status::Fail);
        let at_most = |lower, upper| spec().at_most(bounds(lower, upper), 100.0).status;
        assert_eq!(at_most(99.0, 100.0), Status::Pass);
        assert_eq!(at_most(99.0, 101.0), Status::Undecided);
        assert_eq!(at_most(101.0, 102.0), Status::Fail);
    }

    #[test]
    fn what_is_not_a_finite_number_fails_every_comparison() {
        for bad in [f64::NAN, f64::INFINITY, f64::NEG_INFINITY] {
            for check in [
                spec().at_least(Measurement::value(bad), 0.0),
                spec().at_most(Measurement::value(bad), 0.0),
                spec().inside(Measurement::value(bad), 0.0, 1.0),
                spec().at_least(Measurement::value(0.0), bad),
                spec().at_most(Measurement::value(0.0), bad),
                spec().inside(Measurement::value(0.0), 0.0, bad),
            ] {
                assert_eq!((check.status, check.value), (Status::Fail, None), "{bad}");
                assert!(check.reason.is_some());
            }
        }
        assert_eq!(spec().at_least(bounds(f64::NAN, 200.0), 100.0).status, Status::Fail);
        assert_eq!(spec().at_most(bounds(0.0, f64::NAN), 100.0).status, Status::Fail);
    }

    #[test]
    fn margins_are_positive_on_the_good_side() {
        assert_eq!(spec().at_least(Measurement::value(104.0), 100.0).margin, Some(4.0));
        assert_eq!(spec().at_most(Measurement::value(104.0), 100.0).margin, Some(-4.0));
    }
}
