//! What a plan gives, and what had to be reconstructed: a check never claims more than the plan gives.

use scenarios::curve::CubicsError;
use schemars::JsonSchema;
use serde::{Deserialize, Serialize};

use crate::number_format::quantity;
use crate::verdict::CurveAsCubics;
use crate::verdict::compare::is_larger;
use crate::verdict::{Check, Status};

/// Why a check of controls is skipped.
pub const NO_CONTROLS: &str = "the plan gives no controls";

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
    /// Whether its rows give no controls.
    pub lacks_controls: bool,
    /// Of rows without velocities: what they tell of the last velocity.
    pub end_velocity: Option<EndVelocity>,
    /// Polynomial pieces that are judged as cubics.
    pub curve: Option<CurveAsCubics>,
}

/// What positions tell of the velocity at the last of them.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct EndVelocity {
    /// World frame, m/s.
    pub velocity_mps: [f64; 3],
    /// How far the true one may be from it, m/s.
    pub error_mps: f64,
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

    /// Whether the rows of a vehicle give controls.
    ///
    /// - `vehicle`: its index in the scenario
    pub fn gives_controls(&self, vehicle: usize) -> bool {
        self.vehicles.get(vehicle).is_none_or(|vehicle| !vehicle.lacks_controls)
    }

    /// Whether the rows of a vehicle give velocities.
    ///
    /// - `vehicle`: its index in the scenario
    pub fn gives_velocities(&self, vehicle: usize) -> bool {
        *self.given(vehicle) != GivenRows::Positions
    }

    /// What the positions of a vehicle tell of its last velocity; `None` if velocities are given.
    ///
    /// - `vehicle`: its index in the scenario
    pub fn end_velocity(&self, vehicle: usize) -> Option<EndVelocity> {
        self.vehicles.get(vehicle)?.end_velocity
    }

    /// How far the rows of a vehicle may be from its motion because they were rounded, m.
    pub fn rounding_m(&self, vehicle: usize) -> f64 {
        let rounded = self.vehicles.get(vehicle).and_then(|vehicle| vehicle.rounded);
        rounded.map_or(0.0, |rounded| 3.0_f64.sqrt() * rounded.rounding_m)
    }

    /// Reconstructed controls decide nothing by less than their error.
    pub(super) fn mark_controls_undecided(&self, check: &mut Check) {
        if let Some(reconstruction) = &self.reconstruction {
            reconstruction.mark_undecided(check);
        }
    }

    /// Corrects the checks of an incomplete plan: reconstructed controls decide nothing by less than their error. What may
    /// lie between the rows is part of the distances already.
    pub(super) fn mark_undecided(&self, checks: &mut [Check]) {
        let Some(reconstruction) = &self.reconstruction else { return };
        for check in checks {
            match check.name.as_str() {
                "plan.dynamics" if check.is_bad() => {
                    let remark = "no controls were given, and none were found that lead from node to node: if the plan \
                                  is right, give its controls, or nodes closer together";
                    check.reason = Some(remark.into());
                }
                "plan.control_limits" => reconstruction.mark_undecided(check),
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

    /// Whether a load factor keeps its limit cannot be told if the margin is smaller than the error.
    fn mark_undecided(&self, check: &mut Check) {
        let error = self.load_factor;
        let is_decided = check.margin.is_none_or(|margin| margin.abs() > error);
        if !is_decided {
            check.status = Status::Undecided;
            let remark =
                format!("reconstructed to {} only: closer to the limit than that", quantity(error, &check.unit));
            let before = check.reason.take().map_or_else(String::new, |reason| format!("{reason}; "));
            check.reason = Some(before + &remark);
        }
    }

    /// Whether only velocities were reconstructed, of a multirotor's positions: there are no controls that miss the nodes.
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

#[cfg(test)]
mod tests {
    use super::{GivenRows, Provenance, Reconstruction, VehicleProvenance};
    use scenarios::check_spec;

    use crate::verdict::Status;
    use crate::verdict::evidence::{Decide, Measurement};

    fn given(load_factor: f64) -> Provenance {
        let residual = Reconstruction { load_factor, ..Reconstruction::default() };
        let mut provenance = Provenance::whole();
        provenance.add(VehicleProvenance {
            reconstruction: Some(residual),
            lacks_controls: true,
            ..VehicleProvenance::default()
        });
        provenance
    }

    fn status(provenance: &Provenance, load_factor: f64) -> Status {
        let mut checks = [check_spec("plan.control_limits").unwrap().at_most(Measurement::value(load_factor), 2.0)];
        provenance.mark_undecided(&mut checks);
        checks[0].status
    }

    #[test]
    fn what_lies_within_the_error_of_a_load_factor_is_undecided_on_either_side() {
        let given = given(0.5);
        for (load_factor, expected) in
            [(1.4, Status::Pass), (1.6, Status::Undecided), (2.4, Status::Undecided), (2.6, Status::Fail)]
        {
            assert_eq!(status(&given, load_factor), expected, "{load_factor}");
        }
        assert_eq!(status(&Provenance::whole(), 1.6), Status::Pass);
    }

    #[test]
    fn an_error_that_is_no_number_decides_nothing() {
        assert_eq!(status(&given(f64::NAN), 0.0), Status::Undecided);
    }

    #[test]
    fn each_vehicle_is_asked_for_what_it_gives() {
        let mut provenance = given(0.5);
        provenance.add(VehicleProvenance::default());
        assert_eq!([0, 1].map(|vehicle| provenance.gives_controls(vehicle)), [false, true]);
        provenance.add(VehicleProvenance { given: GivenRows::Positions, ..VehicleProvenance::default() });
        assert_eq!([1, 2].map(|vehicle| provenance.gives_velocities(vehicle)), [true, false]);
        assert!(Provenance::whole().gives_controls(7) && Provenance::whole().gives_velocities(7));
    }

    #[test]
    fn what_was_flown_is_not_doubted() {
        let mut checks = [check_spec("flight.separation").unwrap().at_least(Measurement::value(100.1), 100.0)];
        given(0.5).mark_undecided(&mut checks);
        assert_eq!(checks[0].status, Status::Pass);
    }

    #[test]
    fn of_two_reconstructions_the_worse_half_of_each_counts() {
        let positions = Reconstruction { position_m: 2.0, velocity_mps: 0.1, ..Reconstruction::default() };
        let velocities = Reconstruction { velocities: true, velocity_mps: 0.3, ..Reconstruction::default() };
        for (a, b) in [(positions, velocities), (velocities, positions)] {
            let larger = Reconstruction::larger(Some(a), Some(b)).expect("two");
            assert!(larger.velocities && larger.position_m == 2.0 && larger.velocity_mps == 0.3, "{larger:?}");
        }
    }
}
