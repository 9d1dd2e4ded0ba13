//! The limited quantity that uses most of its range.

use scenarios::{CheckSpec, Range};

use crate::number_format::given_range;
use crate::verdict::evidence::{CheckResult, Decide, Measurement};
use crate::verdict::missing_evidence::MissingEvidence;
use crate::verdict::{Check, LimitKey};

/// How far a node may be outside a planning limit, as a fraction of the limit's range: the tolerance of a solver.
/// The limit that a check reports includes it. The physical limits have no tolerance.
pub const SOLVER_TOLERANCE: f64 = 1e-6;

/// Something limited to a range.
#[derive(Clone, Copy)]
pub struct Quantity {
    /// Its name, with which the remark of the check begins.
    pub name: &'static str,
    /// Unit of the range.
    pub unit: &'static str,
    /// Its limits, in `unit`.
    pub range: Range,
    /// Where the range stands.
    pub key: LimitKey,
}

/// The value that uses most of its range so far.
pub struct Worst<'a> {
    relative: f64,
    found: Option<Found<'a>>,
}

/// A value of a vehicle at a time.
struct Found<'a> {
    vehicle: &'a str,
    quantity: Quantity,
    value: f64,
    t_s: f64,
}

impl<'a> Worst<'a> {
    fn new() -> Self {
        Self { relative: f64::INFINITY, found: None }
    }

    /// Keeps `value` if it uses more of its range than those before it. Margins of different units are compared as fractions of
    /// their ranges. NaN counts as the worst.
    pub fn consider(&mut self, vehicle: &'a str, quantity: Quantity, value: f64, t_s: f64) {
        let Range { min, max } = quantity.range;
        let margin = (value - min).min(max - value);
        let width = max - min;
        let relative = if width > 0.0 && width.is_finite() { margin / width } else { margin };
        if relative >= self.relative {
            return;
        }
        self.relative = if relative.is_nan() { f64::NEG_INFINITY } else { relative };
        self.found = Some(Found { vehicle, quantity, value, t_s });
    }
}

impl Found<'_> {
    fn into_check(self, spec: &CheckSpec) -> Check {
        let Self { vehicle, quantity: Quantity { name: what, unit, range, key }, value, t_s } = self;
        let limit = if value - range.min < range.max - value { range.min } else { range.max };
        let margin = range.margin(value);
        let place = if margin >= 0.0 { "inside" } else { "outside" };
        let remark = format!("{what} {place} {}", given_range(range, unit));
        let measured = Measurement::value(value).at(t_s).with(vehicle).with_reason(remark);
        Check { unit: unit.to_owned(), limit_key: Some(key), ..spec.inside(measured, limit, margin) }
    }
}

/// The check of the limited quantity that uses most of its range; `consider` passes each one to [`Worst::consider`].
pub fn check_limits<'a>(spec: &CheckSpec, consider: impl FnOnce(&mut Worst<'a>)) -> CheckResult {
    let mut worst = Worst::new();
    consider(&mut worst);
    Ok(worst.found.ok_or(MissingEvidence::NoValue)?.into_check(spec))
}
