//! Polynomial pieces as a text table: the format of uav_trajectories and Crazyswarm, one line per piece.
//!
//! ```text
//! duration, x^0, x^1, ..., y^0, y^1, ..., z^0, z^1, ..., yaw^0, yaw^1, ...
//! ```
//!
//! x^k is the coefficient of τ^k, in m/s^k, with τ the time since the beginning of the piece, s. Columns of the yaw are not used.
//! A column `vehicle` tells several vehicles apart.

use csv::StringRecord;

use super::digits::Digits;
use super::layout::Layout;
use super::{PlanDocument, PlanIssue};
use crate::curve::{Curve, Piece, PieceRounding};
use crate::{Issue, Scenario};

/// Name of the column with the duration of a piece, s.
const DURATION: &str = "duration";
/// Highest degree that is read.
const MAX_DEGREE: usize = 31;

/// Whether these are the columns of polynomial pieces.
pub(super) fn is_header(names: &[String]) -> bool {
    let has = |wanted: &str| names.iter().any(|name| name.eq_ignore_ascii_case(wanted));
    has(DURATION) && has("x^0")
}

/// Reads the pieces.
pub(super) fn read(layout: &Layout, scenario: &Scenario) -> Result<PlanDocument, Vec<PlanIssue>> {
    let header = Header::read(layout, scenario)
        .map_err(|issue| vec![PlanIssue::new(format!(":{}", layout.header_line), issue)])?;
    let mut curves: Vec<Curve> = Vec::new();
    let mut issues = Vec::new();
    let records: Vec<_> = layout.records().collect();
    let digits = Digits::of(records.iter().flatten().flat_map(|(_, record)| header.numbers(record)));
    for record in &records {
        let piece = match record {
            Ok((line, record)) => header.piece(record, digits).map_err(|issue| (format!(":{line}"), issue)),
            Err(error) => Err((String::new(), Issue::new("CSV syntax", error.to_string(), "valid CSV"))),
        };
        match piece {
            Ok((vehicle, piece)) => append(&mut curves, &vehicle, piece),
            Err((place, issue)) => issues.push(PlanIssue::new(place, issue)),
        }
    }
    if !issues.is_empty() {
        return Err(issues);
    }
    let mut document = PlanDocument { curves, ..PlanDocument::default() };
    if header.has_yaw {
        document.header.remarks.push("columns not used: yaw^0, yaw^1, ...".to_owned());
    }
    Ok(document)
}

/// Adds a piece that begins at 0 after the last one of its vehicle.
fn append(curves: &mut Vec<Curve>, vehicle: &str, piece: Piece) {
    let index = curves.iter().position(|curve| curve.vehicle == vehicle).unwrap_or_else(|| {
        curves.push(Curve { vehicle: vehicle.to_owned(), pieces: Vec::new() });
        curves.len() - 1
    });
    let begin_s = curves[index].end_s();
    curves[index].pieces.push(Piece { t_s: piece.t_s.map(|t_s| t_s + begin_s), ..piece });
}

/// Where the columns are.
struct Header {
    width: usize,
    duration: usize,
    vehicle: Option<usize>,
    only_vehicle: Option<String>,
    /// The columns of the coefficients of x, y and z, by their powers.
    coefficients: [Vec<usize>; 3],
    has_yaw: bool,
}

impl Header {
    fn read(layout: &Layout, scenario: &Scenario) -> Result<Self, Issue> {
        let names: Vec<String> = layout.names.iter().map(|name| name.to_lowercase()).collect();
        let place = |wanted: &str| names.iter().position(|name| name == wanted);
        let powers =
            |axis: &str| -> Vec<usize> { (0..).map_while(|power| place(&format!("{axis}^{power}"))).collect() };
        let coefficients = ["x", "y", "z"].map(powers);
        let duration = place(DURATION);
        if let Some(axis) = (0..3).find(|axis| coefficients[*axis].is_empty()) {
            let missing = format!("{}^0", ["x", "y", "z"][axis]);
            return Err(Issue::new(missing, "nothing", "a column for every power of x, y and z, from ^0 on"));
        }
        let of_axes = names.iter().filter(|name| ["x^", "y^", "z^"].iter().any(|axis| name.starts_with(axis))).count();
        if of_axes != coefficients.iter().map(Vec::len).sum::<usize>() {
            let expected = "x^0, x^1, ... without a gap, and likewise y and z";
            return Err(Issue::new("header", "a power without the ones below it, or twice", expected));
        }
        if coefficients.iter().any(|powers| powers.len() > MAX_DEGREE + 1) {
            return Err(Issue::new("header", "a higher power", format!("powers up to {MAX_DEGREE}")));
        }
        let only_vehicle = (scenario.vehicles.len() == 1).then(|| scenario.vehicles[0].name.clone());
        let vehicle = place("vehicle");
        if vehicle.is_none() && only_vehicle.is_none() {
            let expected = "a column `vehicle` with the vehicle's name: the scenario has several";
            let remedy = "put the pieces of all vehicles into one file, with this column";
            return Err(Issue::new("vehicle", "nothing", expected).remedy(remedy));
        }
        let duration = duration.ok_or_else(|| Issue::new(DURATION, "nothing", "a column of this name"))?;
        let has_yaw = place("yaw^0").is_some();
        Ok(Self { width: names.len(), duration, vehicle, only_vehicle, coefficients, has_yaw })
    }

    /// The piece in a row, beginning at 0 s, and its vehicle.
    fn piece(&self, cells: &StringRecord, digits: Digits) -> Result<(String, Piece), Issue> {
        if cells.len() != self.width {
            let expected = format!("{}, one per column", self.width);
            return Err(Issue::new("line", format!("{} values", cells.len()), expected));
        }
        let duration_s = number(DURATION, &cells[self.duration])?;
        if duration_s <= 0.0 {
            return Err(Issue::new(DURATION, format!("{duration_s} s"), "more than 0 s"));
        }
        let mut coefficients: [Vec<f64>; 3] = Default::default();
        for (axis, powers) in self.coefficients.iter().enumerate() {
            for (power, column) in powers.iter().enumerate() {
                let name = format!("{}^{power}", ["x", "y", "z"][axis]);
                coefficients[axis].push(number(&name, &cells[*column])?);
            }
        }
        let piece = Piece::from_power(0.0, duration_s, &coefficients, PieceRounding::default());
        let rounding = Self::rounding(digits, &coefficients, &piece);
        let vehicle = self.vehicle.map(|column| cells[column].to_owned());
        let vehicle = vehicle.or_else(|| self.only_vehicle.clone()).unwrap_or_default();
        Ok((vehicle, Piece { rounding, ..piece }))
    }

    /// What the digits of a row leave open: half a unit in the last digit of every coefficient and of the duration T.
    ///
    /// ```text
    /// δ = |(Σ_k ε_k T^k)| + max|p'| ε_T        δ' = |(Σ_k k ε_k T^(k-1))| + max|p''| ε_T
    /// ```
    fn rounding(digits: Digits, coefficients: &[Vec<f64>; 3], piece: &Piece) -> PieceRounding {
        let duration_s = piece.duration_s();
        let sum = |order: usize| {
            let axis = |axis: &Vec<f64>| -> f64 {
                let term = |(power, value): (usize, &f64)| {
                    let falling: f64 = (0..order).map(|i| (power - i) as f64).product();
                    falling * digits.half_unit(*value) * duration_s.powi((power - order) as i32)
                };
                axis.iter().enumerate().skip(order).map(term).sum()
            };
            coefficients.iter().map(|values| axis(values).powi(2)).sum::<f64>().sqrt()
        };
        let of_time_s = digits.half_unit(duration_s);
        PieceRounding {
            position_m: sum(0) + of_time_s * piece.max_derivative(1),
            velocity_mps: sum(1) + of_time_s * piece.max_derivative(2),
        }
    }

    /// The numbers of a row.
    fn numbers<'a>(&'a self, record: &'a StringRecord) -> impl Iterator<Item = &'a str> + Clone {
        let columns = std::iter::once(&self.duration).chain(self.coefficients.iter().flatten());
        columns.filter_map(|column| record.get(*column))
    }
}

fn number(name: &str, cell: &str) -> Result<f64, Issue> {
    let found = || if cell.is_empty() { "nothing".to_owned() } else { format!("\"{cell}\"") };
    let value = cell.parse::<f64>().ok().filter(|value| value.is_finite() && value.abs() < 1e12);
    value.ok_or_else(|| Issue::new(name, found(), "a finite number"))
}
