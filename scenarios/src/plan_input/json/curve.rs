//! A trajectory of a document that is a curve: exactly one of
//!
//! ```text
//! "polynomials": [ { "duration_s": 1.0, "x": [c0, c1, ...], "y": [...], "z": [...] }, ... ]     c_k in m/s^k
//! "bezier":      [ { "duration_s": 1.0, "points_m": [[x, y, z], ...] }, ... ]
//! "b_spline":    { "degree": 3, "interval_s": 0.1, "points_m": [[x, y, z], ...] }               or "knots_s": [...]
//! ```

use serde::Deserialize;
use serde::de::DeserializeOwned;
use serde_json::Value;

use super::{describe, issue};
use crate::Issue;
use crate::curve::{BSpline, Curve, Piece, PieceRounding};

const POLYNOMIALS: &str = "polynomials";
const BEZIER: &str = "bezier";
const B_SPLINE: &str = "b_spline";
/// Keys of the forms.
const FORMS: [&str; 3] = [POLYNOMIALS, BEZIER, B_SPLINE];
/// Highest degree that is read.
const MAX_DEGREE: usize = 31;

#[derive(Deserialize)]
#[serde(deny_unknown_fields)]
struct Polynomial {
    duration_s: f64,
    x: Vec<f64>,
    y: Vec<f64>,
    z: Vec<f64>,
}

#[derive(Deserialize)]
#[serde(deny_unknown_fields)]
struct Bezier {
    duration_s: f64,
    points_m: Vec<[f64; 3]>,
}

#[derive(Deserialize)]
#[serde(deny_unknown_fields)]
struct Spline {
    degree: usize,
    #[serde(default)]
    interval_s: Option<f64>,
    #[serde(default)]
    knots_s: Option<Vec<f64>>,
    points_m: Vec<[f64; 3]>,
}

/// Whether a trajectory is given as a curve.
pub(super) fn is_curve(trajectory: &Value) -> bool {
    FORMS.iter().any(|form| trajectory.get(form).is_some())
}

/// Reads the trajectory at `index` of the document.
pub(super) fn read(trajectory: &Value, index: usize) -> Result<Curve, Issue> {
    let field = format!("trajectories[{index}]");
    let Value::Object(object) = trajectory else { return Err(issue(&field, describe(trajectory), "an object")) };
    let Some(vehicle) = object.get("vehicle").and_then(Value::as_str) else {
        return Err(issue(&format!("{field}.vehicle"), "nothing".into(), "the name of the vehicle"));
    };
    let others = object.keys().filter(|key| !matches!(key.as_str(), "vehicle" | "family"));
    let others: Vec<&String> = others.collect();
    let [form] = others[..] else {
        let names: Vec<String> = others.iter().map(|key| format!("`{key}`")).collect();
        let found = format!("more than one form of the motion, or an unknown key: {}", names.join(", "));
        return Err(issue(&field, found, &format!("`vehicle` and one of {}", FORMS.join(", "))));
    };
    let value = &object[form];
    let field = format!("{field}.{form}");
    let pieces = match form.as_str() {
        POLYNOMIALS => chained(parsed::<Vec<Polynomial>>(value, &field)?.into_iter().map(polynomial), &field)?,
        BEZIER => chained(parsed::<Vec<Bezier>>(value, &field)?.into_iter().map(bezier), &field)?,
        _ => spline(parsed(value, &field)?, &field)?,
    };
    if pieces.is_empty() {
        return Err(issue(&field, "no piece".into(), "at least one piece"));
    }
    Ok(Curve { vehicle: vehicle.to_owned(), pieces })
}

fn parsed<T: DeserializeOwned>(value: &Value, field: &str) -> Result<T, Issue> {
    serde_json::from_value(value.clone()).map_err(|error| issue(field, error.to_string(), "the form in docs/plans.md"))
}

fn polynomial(Polynomial { duration_s, x, y, z }: Polynomial) -> Piece {
    Piece::from_power(0.0, duration_s, &[x, y, z], PieceRounding::default())
}

fn bezier(Bezier { duration_s, points_m }: Bezier) -> Piece {
    Piece { t_s: [0.0, duration_s], points_m, rounding: PieceRounding::default() }
}

/// The pieces one after the other.
fn chained(pieces: impl Iterator<Item = Piece>, field: &str) -> Result<Vec<Piece>, Issue> {
    let mut begin_s = 0.0;
    let place = |(index, piece): (usize, Piece)| {
        let field = |name: &str| format!("{field}[{index}].{name}");
        let duration_s = piece.t_s[1];
        if !(duration_s > 0.0 && duration_s.is_finite()) {
            return Err(issue(&field("duration_s"), format!("{duration_s} s"), "more than 0 s"));
        }
        if !(1..=MAX_DEGREE + 1).contains(&piece.points_m.len()) {
            let found = format!("{} control points or coefficients", piece.points_m.len());
            return Err(issue(&field("degree"), found, &format!("1 to {}", MAX_DEGREE + 1)));
        }
        let t_s = [begin_s, begin_s + duration_s];
        begin_s = t_s[1];
        Ok(Piece { t_s, ..piece })
    };
    pieces.enumerate().map(place).collect()
}

fn spline(spline: Spline, field: &str) -> Result<Vec<Piece>, Issue> {
    let Spline { degree, interval_s, knots_s, points_m } = spline;
    if !(1..=MAX_DEGREE).contains(&degree) {
        return Err(issue(&format!("{field}.degree"), degree.to_string(), &format!("1 to {MAX_DEGREE}")));
    }
    let spline = match (interval_s, knots_s) {
        (Some(interval_s), None) if interval_s > 0.0 && interval_s.is_finite() => {
            BSpline::uniform(degree, interval_s, points_m)
        }
        (None, Some(knots_s)) => BSpline { degree, knots_s, points_m },
        _ => return Err(issue(field, "no interval and no knots, or both".into(), "`interval_s` > 0 or `knots_s`")),
    };
    if !spline.is_consistent() {
        let found = format!("{} knots for {} control points", spline.knots_s.len(), spline.points_m.len());
        let expected = "knots that do not decrease, as many as control points plus degree plus 1";
        return Err(issue(field, found, expected));
    }
    Ok(spline.pieces())
}
