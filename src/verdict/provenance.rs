//! What a plan gives, and what had to be reconstructed: a check never claims more than the plan gives.

use scenarios::curve::CubicsError;
use schemars::JsonSchema;
use serde::{Deserialize, Serialize};

use crate::number_format::quantity;
use crate::verdict::CurveAsCubics;
use crate::verdict::compare::is_larger;
use crate::verdict::{Check, Status};

/// What a plan gives.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct Provenance {
    /// What was missing and has been reconstructed, with the largest errors of all vehicles; `None` if the plan was whole.
    pub reconstruction: Option<Reconstruction>,
    /// Rows that were left out as rounding, of all vehicles.
    pub rounded: Option<RoundedRows>,
    /// Polynomial pieces that are judged as cubics, with the largest errors of all vehicles.
    pub curve: Option<CurveAsCubics>,
    /// What the user should know of how the file was read.
    pub remarks: Vec<String>,
    /// Vehicle by vehicle, in the order of the scenario; empty if the plan was whole.
    vehicles: Vec<VehicleProvenance>,
}

/// What a plan gives of one vehicle.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct VehicleProvenance {
    /// What its rows give.
    pub given: GivenRows,
    /// What was missing and has been reconstructed.
    pub reconstruction: Option<Reconstruction>,
    /// Rows that were left out as rounding.
    pub rounded: Option<RoundedRows>,
    /// Polynomial pieces that are judged as cubics.
    pub curve: Option<CurveAsCubics>,
}

/// Rows of a table whose numbers were rounded, and those of them that were kept: differences of the others are noise.
#[derive(Clone, Copy, Debug, PartialEq, Serialize, Deserialize, JsonSchema)]
pub struct RoundedRows {
    /// Number of rows in the table.
    pub given: usize,
    /// Number of rows that were kept.
    pub kept: usize,
    /// Half a unit in the last decimal of a position, m.
    pub rounding_m: f64,
}

/// What the rows of a trajectory give.
#[derive(Clone, Debug, Default, PartialEq)]
pub enum GivenRows {
    /// Positions. Velocities and controls are reconstructed.
    Positions,
    /// Positions and these velocities, world frame, m/s. Controls are reconstructed.
    States(Vec<[f64; 3]>),
    /// The whole motion.
    #[default]
    Everything,
}

/// How well what was reconstructed fits what was given, and what may lie between the rows.
///
/// Load factors are sought that lead, through the simulator's equations, from each node to the next. The residuals are
/// stated here, and no check may be decided by less than they are.
#[derive(Clone, Copy, Debug, Default, PartialEq, Serialize, Deserialize, JsonSchema)]
pub struct Reconstruction {
    /// Were the velocities missing too, not only the controls?
    pub velocities: bool,
    /// Largest distance by which an interval's end misses the next node, m.
    pub position_m: f64,
    /// Largest difference of velocities there, m/s.
    pub velocity_mps: f64,
    /// Largest change of a load factor that would take up what is missed within its interval, -.
    pub load_factor: f64,
    /// Largest interval between two rows, s.
    #[serde(default)]
    pub row_interval_s: f64,
    /// Largest distance from the curve through the rows that the vehicle's limits allow between two of them, m.
    #[serde(default)]
    pub between_rows_m: f64,
}

impl Provenance {
    /// The plan was whole.
    pub fn whole() -> Self {
        Self::default()
    }

    /// Adds the next vehicle.
    pub fn add(&mut self, vehicle: VehicleProvenance) {
        self.reconstruction = Reconstruction::larger(self.reconstruction, vehicle.reconstruction);
        self.rounded = match (self.rounded, vehicle.rounded) {
            (Some(a), Some(b)) => Some(RoundedRows {
                given: a.given + b.given,
                kept: a.kept + b.kept,
                rounding_m: a.rounding_m.max(b.rounding_m),
            }),
            (a, b) => a.or(b),
        };
        self.curve = CurveAsCubics::sum(self.curve, vehicle.curve);
        self.vehicles.push(vehicle);
    }

    /// How far a vehicle's cubics may be from the curve that they stand for.
    pub fn curve_error(&self, vehicle: usize) -> CubicsError {
        let curve = self.vehicles.get(vehicle).and_then(|vehicle| vehicle.curve);
        curve.map_or_else(CubicsError::default, |curve| curve.error())
    }

    /// What the rows of a vehicle give.
    ///
    /// - `vehicle`: its index in the scenario
    pub fn given(&self, vehicle: usize) -> &GivenRows {
        self.vehicles.get(vehicle).map_or(&GivenRows::Everything, |vehicle| &vehicle.given)
    }

    /// How far the rows of a vehicle may be from its motion because they were rounded, m.
    pub fn rounding_m(&self, vehicle: usize) -> f64 {
        let rounded = self.vehicles.get(vehicle).and_then(|vehicle| vehicle.rounded);
        rounded.map_or(0.0, |rounded| 3.0_f64.sqrt() * rounded.rounding_m)
    }

    /// Corrects the checks of an incomplete plan: those of what was not given are skipped, and those that are decided by less
    /// than the residual of the reconstruction become undecided. What may lie between the rows is part of the distances
    /// already.
    pub(super) fn mark_undecided(&self, checks: &mut [Check]) {
        let Some(reconstruction) = &self.reconstruction else { return };
        for check in checks {
            match check.name.as_str() {
                "nodes.control_limits" => skip(check, "the plan gives no controls"),
                "nodes.state_limits" if reconstruction.velocities => skip(check, "the plan gives no velocities"),
                "plan.rollout" => {
                    skip(check, "the plan gives no controls, and reconstructed ones say nothing open loop");
                }
                "plan.dynamics" if check.is_bad() => {
                    let remark = "no controls were given, and none were found that lead from node to node: if the plan \
                                  is right, give its controls, or nodes closer together";
                    check.reason = Some(remark.into());
                }
                "plan.goal" | "plan.control_limits" => reconstruction.mark_undecided(check),
                _ => {}
            }
        }
    }
}

impl RoundedRows {
    /// In words, for people.
    pub fn describe(&self) -> String {
        let rounding = quantity(self.rounding_m, "m");
        format!(
            "{} of {} rows kept: the others, rounded to ±{rounding}, have noise for accelerations",
            self.kept, self.given
        )
    }
}

impl Reconstruction {
    /// The larger errors of two vehicles. NaN counts as larger than any number.
    fn larger(a: Option<Self>, b: Option<Self>) -> Option<Self> {
        let larger = |a: f64, b: f64| if is_larger(b, a) { b } else { a };
        match (a, b) {
            (Some(a), Some(b)) => Some(Self {
                velocities: a.velocities || b.velocities,
                position_m: larger(a.position_m, b.position_m),
                velocity_mps: larger(a.velocity_mps, b.velocity_mps),
                load_factor: larger(a.load_factor, b.load_factor),
                row_interval_s: larger(a.row_interval_s, b.row_interval_s),
                between_rows_m: larger(a.between_rows_m, b.between_rows_m),
            }),
            (a, b) => a.or(b),
        }
    }

    /// Whether the limit is kept cannot be told if the margin is smaller than the error.
    fn mark_undecided(&self, check: &mut Check) {
        let error = match check.unit.as_str() {
            "m" => self.position_m,
            "-" => self.load_factor,
            _ => return,
        };
        let is_decided = check.margin.is_none_or(|margin| margin.abs() > error);
        if !is_decided {
            check.status = Status::Undecided;
            let remark =
                format!("reconstructed to {} only: closer to the limit than that", quantity(error, &check.unit));
            let before = check.reason.take().map_or_else(String::new, |reason| format!("{reason}; "));
            check.reason = Some(before + &remark);
        }
    }

    /// Whether it is that of a vehicle whose plan has no controls, by its positions.
    fn is_of_positions(&self) -> bool {
        self.velocities && self.position_m == 0.0 && self.load_factor == 0.0
    }

    /// In words, for people.
    pub fn describe(&self) -> String {
        let what = if self.velocities { "velocities and controls" } else { "controls" };
        if self.is_of_positions() {
            return format!(
                "velocities reconstructed; rows up to {} apart: between them the motion is known to {}",
                quantity(self.row_interval_s, "s"),
                quantity(self.between_rows_m, "m"),
            );
        }
        format!(
            "{what} reconstructed: they miss the nodes by {}, load factors to ±{}; rows up to {} apart: between them the \
             motion is known to {}",
            quantity(self.position_m, "m"),
            quantity(self.load_factor, "-"),
            quantity(self.row_interval_s, "s"),
            quantity(self.between_rows_m, "m"),
        )
    }
}

fn skip(check: &mut Check, reason: &str) {
    let Check { name, unit, .. } = check.clone();
    *check = Check {
        name,
        status: Status::Skip,
        value: None,
        lower: None,
        upper: None,
        limit: None,
        margin: None,
        unit,
        at_s: None,
        between: Vec::new(),
        advisory: false,
        reason: Some(reason.to_owned()),
        limit_key: None,
    };
}

#[cfg(test)]
mod tests {
    use super::{Provenance, Reconstruction, VehicleProvenance};
    use scenarios::check_spec;

    use crate::verdict::evidence::{Decide, Measurement};
    use crate::verdict::{Check, Status};

    fn given(velocities: bool) -> Provenance {
        let residual = Reconstruction { velocities, position_m: 0.5, velocity_mps: 0.1, ..Reconstruction::default() };
        let mut provenance = Provenance::whole();
        provenance.add(VehicleProvenance { reconstruction: Some(residual), ..VehicleProvenance::default() });
        provenance
    }

    fn qualified(provenance: &Provenance, check: Check) -> Check {
        let mut checks = [check];
        provenance.mark_undecided(&mut checks);
        let [check] = checks;
        check
    }

    fn goal(value_m: f64) -> Check {
        check_spec("plan.goal").unwrap().at_most(Measurement::value(value_m), 5.0)
    }

    #[test]
    fn what_lies_within_the_residual_of_the_reconstruction_is_undecided_on_either_side() {
        let status = |value_m| qualified(&given(false), goal(value_m)).status;
        assert_eq!(status(4.4), Status::Pass);
        assert_eq!(status(4.6), Status::Undecided);
        assert_eq!(status(5.4), Status::Undecided);
        assert_eq!(status(5.6), Status::Fail);
        assert_eq!(qualified(&Provenance::whole(), goal(4.6)).status, Status::Pass);
    }

    #[test]
    fn an_error_that_is_no_number_decides_nothing() {
        let mut provenance = given(false);
        if let Some(reconstruction) = &mut provenance.reconstruction {
            reconstruction.position_m = f64::NAN;
        }
        assert_eq!(qualified(&provenance, goal(0.0)).status, Status::Undecided);
    }

    #[test]
    fn what_was_not_given_is_not_asked() {
        let node_check = |name| check_spec(name).unwrap().at_most(Measurement::value(0.0), 1.0);
        let rollout = check_spec("plan.rollout").unwrap().at_most(Measurement::value(0.0), 1.0);
        for (velocities, check, status) in [
            (false, node_check("nodes.control_limits"), Status::Skip),
            (false, node_check("nodes.state_limits"), Status::Pass),
            (true, node_check("nodes.state_limits"), Status::Skip),
            (false, rollout, Status::Skip),
        ] {
            let answer = qualified(&given(velocities), check);
            assert_eq!((answer.status, answer.reason.is_some()), (status, status == Status::Skip), "{}", answer.name);
        }
    }

    #[test]
    fn what_was_flown_is_not_doubted() {
        let flown = check_spec("flight.separation").unwrap().at_least(Measurement::value(100.1), 100.0);
        assert_eq!(qualified(&given(true), flown).status, Status::Pass);
    }
}
