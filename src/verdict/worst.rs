//! The limited quantity that uses most of its range.

use scenarios::{CheckSpec, Range};

use crate::number_format::given_range;
use crate::verdict::evidence::{CheckResult, Decide, Measurement};
use crate::verdict::missing_evidence::MissingEvidence;
use crate::verdict::{Check, LimitKey, Status};

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
    /// The worst that is possible.
    possible: Candidate<'a>,
    /// The worst that is certain: not the same where values are known up to an error.
    certain: Candidate<'a>,
}

/// A value and its margin as a fraction of its range.
#[derive(Clone)]
struct Candidate<'a> {
    relative: f64,
    found: Option<Found<'a>>,
}

/// A value of a vehicle at a time.
#[derive(Clone)]
pub struct Found<'a> {
    vehicle: &'a str,
    geofence: Option<&'a str>,
    /// What is limited.
    pub quantity: Quantity,
    /// Its value, in the unit of the quantity.
    pub value: f64,
    error: f64,
    /// When, s.
    pub t_s: f64,
}

impl<'a> Worst<'a> {
    /// Nothing has been considered.
    pub fn new() -> Self {
        let none = Candidate { relative: f64::INFINITY, found: None };
        Self { possible: none.clone(), certain: none }
    }

    /// The value that decides; `None` if there was none.
    pub fn into_deciding(self) -> Option<Found<'a>> {
        let Worst { possible, certain } = self;
        let decides = if certain.relative < 0.0 { certain } else { possible };
        decides.found
    }

    /// Keeps `value` if it uses more of its range than those before it. Margins of different units are compared as fractions of
    /// their ranges. NaN counts as the worst.
    pub fn consider(&mut self, vehicle: &'a str, quantity: Quantity, value: f64, t_s: f64) {
        self.consider_within(vehicle, quantity, (value, 0.0), t_s);
    }

    /// [`consider`](Self::consider), of a value that is known up to an error.
    pub fn consider_within(&mut self, vehicle: &'a str, quantity: Quantity, (value, error): (f64, f64), t_s: f64) {
        self.compare(&Found { vehicle, geofence: None, quantity, value, error, t_s });
    }

    /// [`consider_within`](Self::consider_within), of the margin to a geofence.
    pub fn consider_geofence(
        &mut self,
        [vehicle, geofence]: [&'a str; 2],
        quantity: Quantity,
        (value, error): (f64, f64),
        t_s: f64,
    ) {
        self.compare(&Found { vehicle, geofence: Some(geofence), quantity, value, error, t_s });
    }

    fn compare(&mut self, found: &Found<'a>) {
        let (Range { min, max }, value, error) = (found.quantity.range, found.value, found.error);
        let margin = (value - min).min(max - value);
        let width = max - min;
        let relative = |margin: f64| if width > 0.0 && width.is_finite() { margin / width } else { margin };
        self.possible.keep(relative(margin - error), found);
        self.certain.keep(relative(margin + error), found);
    }
}

impl<'a> Candidate<'a> {
    fn keep(&mut self, relative: f64, found: &Found<'a>) {
        if relative >= self.relative {
            return;
        }
        self.relative = if relative.is_nan() { f64::NEG_INFINITY } else { relative };
        self.found = Some(found.clone());
    }
}

impl Found<'_> {
    /// The end of the range that is nearer.
    pub fn limit(&self) -> f64 {
        let Range { min, max } = self.quantity.range;
        if self.value - min < max - self.value { min } else { max }
    }

    fn into_check(self, spec: &CheckSpec) -> Check {
        let limit = self.limit();
        let Self { vehicle, geofence, quantity: Quantity { name: what, unit, range, key }, value, error, t_s } = self;
        let is_low = value - range.min < range.max - value;
        let named =
            |measured: Measurement| [vehicle].into_iter().chain(geofence).fold(measured.at(t_s), Measurement::with);
        let exact = named(Measurement::value(value));
        let bounded = named(Measurement::bounds(value - error, value + error));
        let spec = &CheckSpec { unit, ..*spec };
        let mut check = match is_low {
            _ if error == 0.0 => spec.inside(exact, limit, range.margin(value)),
            true => spec.at_least(bounded, limit),
            false => spec.at_most(bounded, limit),
        };
        let limits = given_range(range, unit);
        let remark = |place: &str| match geofence {
            Some(name) => format!("{what} {name} {}", if place == "inside" { "kept" } else { "violated" }),
            None => format!("{what} {place} {limits}"),
        };
        match check.status {
            Status::Undecided => {}
            Status::Pass | Status::Skip => check.reason = Some(remark("inside")),
            Status::Fail => check.reason = Some(remark("outside")),
        }
        Check { limit_key: Some(key), ..check }
    }
}

/// The check of the limited quantity that uses most of its range; `consider` passes each one to [`Worst::consider`].
pub fn check_limits<'a>(spec: &CheckSpec, consider: impl FnOnce(&mut Worst<'a>)) -> CheckResult {
    let mut worst = Worst::new();
    consider(&mut worst);
    Ok(worst.into_deciding().ok_or(MissingEvidence::NoValue)?.into_check(spec))
}
