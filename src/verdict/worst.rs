//! Of all limited quantities, the one that uses most of its range.

use scenarios::{CheckSpec, Range};

use crate::number_format::given_range;
use crate::verdict::evidence::{Decide, Evidence, Measurement};
use crate::verdict::{Check, LimitKey};

/// How far a node may be outside a planning limit, as a share of the limit's range: what a solver's tolerance leaves.
/// The limit that the check reports includes it. The physical limits know no such mercy.
pub const SOLVER_TOLERANCE: f64 = 1e-6;

/// Something limited to a range.
#[derive(Clone, Copy)]
pub struct Quantity {
    /// What it is.
    pub name: &'static str,
    /// Unit of the range.
    pub unit: &'static str,
    /// What it has to stay inside.
    pub range: Range,
    /// Where the range stands.
    pub key: LimitKey,
}

/// The value that uses most of its range so far.
pub struct Worst<'a> {
    relative: f64,
    /// `None` until something was considered.
    pub found: Option<Found<'a>>,
}

/// A value, and where it was found.
pub struct Found<'a> {
    vehicle: &'a str,
    quantity: Quantity,
    value: f64,
    t_s: f64,
}

impl<'a> Worst<'a> {
    /// Nothing so far.
    pub fn new() -> Self {
        Self { relative: f64::INFINITY, found: None }
    }

    /// Margins of different units are compared as shares of their ranges. NaN is worse than anything.
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
    /// The check of the value found.
    pub fn into_check(self, spec: &CheckSpec) -> Check {
        let Self { vehicle, quantity: Quantity { name: what, unit, range, key }, value, t_s } = self;
        let limit = if value - range.min < range.max - value { range.min } else { range.max };
        let margin = range.margin(value);
        let place = if margin >= 0.0 { "inside" } else { "outside" };
        let remark = format!("{what} {place} {}", given_range(range, unit));
        let measured = Measurement::value(value).at(t_s).with(vehicle).with_reason(remark);
        Check { unit: unit.to_owned(), limit_key: Some(key), ..spec.inside(measured, limit, margin) }
    }
}

/// The check of whichever limited quantity uses most of its range; `look` considers them all.
pub fn check_limits<'a, T: ?Sized>(
    spec: &CheckSpec,
    evidence: Evidence<'_, T>,
    look: impl Fn(&T, &mut Worst<'a>),
) -> Check {
    let mut worst = Worst::new();
    match evidence {
        Err(reason) => spec.fail(reason),
        Ok(evidence) => {
            look(evidence, &mut worst);
            match worst.found {
                None => spec.fail("there was nothing to hold against a limit"),
                Some(found) => found.into_check(spec),
            }
        }
    }
}
