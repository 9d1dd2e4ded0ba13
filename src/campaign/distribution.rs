//! Probability distributions of the fields of a scenario.
//!
//! A value is a function of a standard normal variable u, so that a search may move in the space of independent normals:
//! F(x) = Φ(u). Both tails are exact to rounding, whatever the distribution.

use std::fmt;
use std::str::FromStr;

use serde::{Serialize, Serializer};
use statrs::distribution::{ContinuousCDF, Normal};
use statrs::function::erf::erfc;
use thiserror::Error;

use crate::campaign::scenario_document::FieldPath;

/// The distribution of one number, in the unit of its field.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum Distribution {
    /// `LOW..HIGH`: uniform.
    Uniform {
        /// Smallest and largest value.
        range: [f64; 2],
    },
    /// `normal(MEAN, DEVIATION)`, or `normal(MEAN, DEVIATION, LOW..HIGH)`: truncated to a range.
    Normal {
        /// Mean, before truncation.
        mean: f64,
        /// Standard deviation, before truncation; > 0.
        deviation: f64,
        /// Smallest and largest value; infinite without truncation.
        range: [f64; 2],
    },
    /// `lognormal(MEDIAN, SPREAD)`: the logarithm is normal.
    LogNormal {
        /// Median; > 0.
        median: f64,
        /// Standard deviation of the natural logarithm; > 0.
        spread: f64,
    },
    /// `weibull(SHAPE, SCALE)`: P(x > t) = exp(-(t / scale)^shape), as mean wind speeds over a year.
    Weibull {
        /// Shape k; > 0. 2 is the Rayleigh distribution, 1 the exponential one.
        shape: f64,
        /// Scale, in the unit of the field; > 0.
        scale: f64,
    },
}

/// One field and its distribution: `simulation.wind.mean_mps[0]=normal(0, 3)`.
#[derive(Clone, Debug, PartialEq)]
pub struct RandomField {
    /// The field.
    pub path: FieldPath,
    /// Its distribution.
    pub distribution: Distribution,
}

/// Why a text is not a field and its distribution.
#[derive(Clone, Debug, PartialEq, Eq, Error)]
pub enum DistributionError {
    /// There is no `=`, or the path before it is malformed.
    #[error("expected a field and its distribution, as `simulation.wind.mean_mps[0]=normal(0, 3)`")]
    Field,
    /// What follows `=` is no distribution.
    #[error(
        "found `{found}`, expected LOW..HIGH, normal(MEAN, DEVIATION), normal(MEAN, DEVIATION, LOW..HIGH), \
         lognormal(MEDIAN, SPREAD) or weibull(SHAPE, SCALE)"
    )]
    Form {
        /// The text.
        found: String,
    },
    /// A parameter is out of its range.
    #[error("found `{found}`: {what}")]
    Parameter {
        /// The text.
        found: String,
        /// What is expected of it.
        what: &'static str,
    },
}

impl Distribution {
    /// The value at a standard normal `u`: the x with F(x) = Φ(u). It grows with `u`.
    pub fn value(&self, u: f64) -> f64 {
        match *self {
            Self::Uniform { range: [low, high] } if u <= 0.0 => low + (high - low) * lower_tail(u),
            Self::Uniform { range: [low, high] } => high - (high - low) * lower_tail(-u),
            Self::Normal { mean, deviation, range } if range[0].is_infinite() && range[1].is_infinite() => {
                mean + deviation * u
            }
            Self::Normal { mean, deviation, range: [low, high] } => {
                let within = [low, high].map(|bound| (bound - mean) / deviation);
                (mean + deviation * truncated(u, within)).clamp(low, high)
            }
            Self::LogNormal { median, spread } => median * (spread * u).exp(),
            Self::Weibull { shape, scale } => {
                let log_upper = if u <= 0.0 { (-lower_tail(u)).ln_1p() } else { lower_tail(-u).ln() };
                scale * (-log_upper).powf(shape.recip())
            }
        }
    }

    /// What its parameters lack; `None` if it is a distribution with finite values.
    fn issue(&self) -> Option<&'static str> {
        let (numbers, positive): (Vec<f64>, Vec<f64>) = match *self {
            Self::Uniform { range } => (range.into(), vec![range[1] - range[0]]),
            Self::Normal { mean, deviation, range } => (vec![mean, deviation], vec![deviation, range[1] - range[0]]),
            Self::LogNormal { median, spread } => (vec![median, spread], vec![median, spread]),
            Self::Weibull { shape, scale } => (vec![shape, scale], vec![shape, scale]),
        };
        if !numbers.iter().all(|number| number.is_finite()) {
            return Some("expected finite numbers");
        }
        if !positive.iter().all(|number| *number > 0.0) {
            return Some("expected LOW below HIGH, and deviation, median, spread, shape and scale above 0");
        }
        match *self {
            Self::Normal { mean, deviation, range: [low, high] }
                if low > mean + FARTHEST * deviation || high < mean - FARTHEST * deviation =>
            {
                Some("the range is more than 30 standard deviations from the mean")
            }
            _ => None,
        }
    }
}

/// Largest distance of a truncated range from the mean, in standard deviations.
const FARTHEST: f64 = 30.0;

/// Φ(u) = erfc(-u / √2) / 2, exact to rounding for u <= 0.
fn lower_tail(u: f64) -> f64 {
    0.5 * erfc(-u / std::f64::consts::SQRT_2)
}

/// The z in [α, β] of which the truncated normal distribution has Φ(u) below it:
///
/// ```text
/// Φ(z) = Φ(α) + Φ(u) (Φ(β) - Φ(α))
/// ```
///
/// It is solved in the tail that is smaller at z, so that nothing cancels.
fn truncated(u: f64, [alpha, beta]: [f64; 2]) -> f64 {
    if alpha > 0.0 {
        return -truncated(-u, [-beta, -alpha]);
    }
    let below = lower_tail(alpha);
    let mass = if beta > 0.0 { 1.0 - lower_tail(-beta) - below } else { lower_tail(beta) - below };
    let lower = below + lower_tail(u) * mass;
    if lower <= 0.5 {
        return standard_quantile(lower);
    }
    -standard_quantile(lower_tail(-beta) + lower_tail(-u) * mass)
}

/// The z with Φ(z) = p, by a library's first guess and Newton's method on ln Φ.
///
/// - `p`: in [0, 0.5]
fn standard_quantile(p: f64) -> f64 {
    if p <= 0.0 {
        return f64::NEG_INFINITY;
    }
    let mut z: f64 = Normal::standard().inverse_cdf(p);
    for _ in 0..4 {
        let phi = lower_tail(z);
        let density = (-0.5 * z * z).exp() / (2.0 * std::f64::consts::PI).sqrt();
        let step = phi * (phi / p).ln() / density;
        if step.is_finite() {
            z -= step;
        }
    }
    z
}

impl FromStr for Distribution {
    type Err = DistributionError;

    fn from_str(text: &str) -> Result<Self, DistributionError> {
        let form = || DistributionError::Form { found: text.to_owned() };
        let distribution = parse(text.trim()).ok_or_else(form)?;
        match distribution.issue() {
            Some(what) => Err(DistributionError::Parameter { found: text.to_owned(), what }),
            None => Ok(distribution),
        }
    }
}

fn parse(text: &str) -> Option<Distribution> {
    let Some((name, parameters)) = text.split_once('(') else {
        return range(text).map(|range| Distribution::Uniform { range });
    };
    let parameters: Vec<&str> = parameters.strip_suffix(')')?.split(',').map(str::trim).collect();
    let number = |index: usize| parameters.get(index)?.parse::<f64>().ok();
    match (name.trim(), parameters.len()) {
        ("normal", 2 | 3) => {
            let whole = [f64::NEG_INFINITY, f64::INFINITY];
            let range = parameters.get(2).map_or(Some(whole), |text| range(text))?;
            Some(Distribution::Normal { mean: number(0)?, deviation: number(1)?, range })
        }
        ("lognormal", 2) => Some(Distribution::LogNormal { median: number(0)?, spread: number(1)? }),
        ("weibull", 2) => Some(Distribution::Weibull { shape: number(0)?, scale: number(1)? }),
        _ => None,
    }
}

fn range(text: &str) -> Option<[f64; 2]> {
    let (low, high) = text.split_once("..")?;
    Some([low.trim().parse().ok()?, high.trim().parse().ok()?])
}

impl fmt::Display for Distribution {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        match self {
            Self::Uniform { range: [low, high] } => write!(f, "{low}..{high}"),
            Self::Normal { mean, deviation, range: [low, high] } if low.is_infinite() && high.is_infinite() => {
                write!(f, "normal({mean}, {deviation})")
            }
            Self::Normal { mean, deviation, range: [low, high] } => {
                write!(f, "normal({mean}, {deviation}, {low}..{high})")
            }
            Self::LogNormal { median, spread } => write!(f, "lognormal({median}, {spread})"),
            Self::Weibull { shape, scale } => write!(f, "weibull({shape}, {scale})"),
        }
    }
}

impl FromStr for RandomField {
    type Err = DistributionError;

    fn from_str(text: &str) -> Result<Self, DistributionError> {
        let (path, distribution) = text.split_once('=').ok_or(DistributionError::Field)?;
        let path = FieldPath::parse(path.trim()).ok_or(DistributionError::Field)?;
        Ok(Self { path, distribution: distribution.parse()? })
    }
}

impl fmt::Display for RandomField {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        write!(f, "{}={}", self.path, self.distribution)
    }
}

impl Serialize for RandomField {
    fn serialize<S: Serializer>(&self, serializer: S) -> Result<S::Ok, S::Error> {
        serializer.collect_str(self)
    }
}

#[cfg(test)]
mod tests;
