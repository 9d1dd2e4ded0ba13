//! How far would the flight be somewhere else if another integrator had flown it?
//!
//! Cheap: the replay of `flight.dynamics`. Full: the whole flight again, feedback, wind and noise included, with the
//! plant's steps halved and quartered, and the turbulence sampled as much more often. What was planned in the loop is
//! followed again. A margin that is smaller than what two integrators disagree on decides nothing.

use schemars::JsonSchema;
use serde::{Deserialize, Serialize};
use sim::{Flight, VehicleLog};

use crate::number_format::quantity;
use crate::verdict::compare::{exceeds, is_larger};
use crate::verdict::{Check, Status};

/// What two integrators disagree on.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize, JsonSchema)]
pub struct Integration {
    /// How it was found.
    pub method: Method,
    /// Largest distance between the flight and what the other integrator makes of it, m; absent where the two flights cannot
    /// be compared, because only one of them ends in a crash.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub disagreement_m: Option<f64>,
    /// Of the full form: largest distance between the flights with half and with a quarter of the plant's step, m. For an
    /// integrator of second order it is a fifth of the above; in turbulence, which is rough at every scale, it is more.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub half_to_quarter_m: Option<f64>,
}

/// Ways to find the disagreement.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Serialize, Deserialize, JsonSchema)]
#[serde(rename_all = "kebab-case")]
pub enum Method {
    /// Logged controls and air, through an integrator of order 6, restarted in windows.
    Replay,
    /// The flight repeated with half and a quarter of the plant's step; of one that was planned in the loop, with the same
    /// references.
    FinerSteps,
}

impl Integration {
    /// The cheap form, from the check of the flight's dynamics; `None` if that did not pass: what its log does not explain is
    /// not the integrator's doing, and has failed already.
    pub fn by_replay(checks: &[Check]) -> Option<Self> {
        let check = checks.iter().find(|check| check.name == DYNAMICS && check.status == Status::Pass)?;
        let disagreement_m = Some(check.value?);
        Some(Self { method: Method::Replay, disagreement_m, half_to_quarter_m: None })
    }

    /// The full form: a flight, and the same with half and with a quarter of the plant's step.
    pub fn by_finer_steps(flight: &Flight, [half, quarter]: [&Flight; 2]) -> Self {
        let disagreement_m = distance_m(flight, quarter);
        Self { method: Method::FinerSteps, disagreement_m, half_to_quarter_m: distance_m(half, quarter) }
    }

    /// Takes back what is decided by less than the disagreement: checks of the flight that are in metres.
    pub fn mark_undecided(&self, checks: &mut [Check]) {
        let of_flight =
            |check: &&mut Check| check.name.starts_with("flight.") && check.name != DYNAMICS && check.unit == "m";
        for check in checks.iter_mut().filter(of_flight) {
            let decided = matches!(check.status, Status::Pass | Status::Fail);
            let Some(margin_m) = check.margin.filter(|_| decided) else { continue };
            let (unsure, by) = match self.disagreement_m {
                Some(most_m) => (exceeds(most_m, margin_m.abs()), quantity(most_m, "m")),
                None => (true, "more than a crash".to_owned()),
            };
            if unsure {
                check.status = Status::Undecided;
                check.reason = Some(format!("two integrators disagree on the flight by {by}, more than the margin"));
            }
        }
    }
}

const DYNAMICS: &str = "flight.dynamics";

/// Largest distance between vehicles and loads of two flights at the same instants, m. `None` if they do not hold the same
/// instants.
fn distance_m(one: &Flight, other: &Flight) -> Option<f64> {
    let logs = one.vehicles.iter().zip(&other.vehicles);
    logs.map(|(one, other)| log_distance_m(one, other)).try_fold(0.0, |largest, distance_m| {
        let distance_m = distance_m?;
        Some(if is_larger(distance_m, largest) { distance_m } else { largest })
    })
}

fn log_distance_m(one: &VehicleLog, other: &VehicleLog) -> Option<f64> {
    if one.samples.len() != other.samples.len() || one.loads.len() != other.loads.len() {
        return None;
    }
    let vehicles = one.samples.iter().zip(&other.samples).map(|(a, b)| (a.position_m, b.position_m));
    let loads = one.loads.iter().zip(&other.loads).map(|(a, b)| (a.position_m, b.position_m));
    let distance = |(a, b): ([f64; 3], [f64; 3])| (0..3).map(|axis| (a[axis] - b[axis]).powi(2)).sum::<f64>().sqrt();
    Some(
        vehicles
            .chain(loads)
            .map(distance)
            .fold(0.0, |worst, value| if is_larger(value, worst) { value } else { worst }),
    )
}

#[cfg(test)]
mod tests {
    use super::{Integration, Method};
    use scenarios::check_spec;

    use crate::verdict::evidence::{Decide, Measurement};
    use crate::verdict::{Check, Status};

    fn clearance(value_m: f64) -> Check {
        check_spec("flight.clearance").unwrap().at_least(Measurement::value(value_m), 0.0)
    }

    fn doubted(disagreement_m: Option<f64>, mut check: Check) -> Status {
        let integration = Integration { method: Method::FinerSteps, disagreement_m, half_to_quarter_m: None };
        integration.mark_undecided(std::slice::from_mut(&mut check));
        check.status
    }

    #[test]
    fn a_margin_below_the_disagreement_decides_nothing() {
        for value_m in [0.9e-3, -0.9e-3] {
            assert_eq!(doubted(Some(1e-3), clearance(value_m)), Status::Undecided);
        }
        assert_eq!(doubted(Some(1e-3), clearance(1.1e-3)), Status::Pass);
        assert_eq!(doubted(Some(1e-3), clearance(-1.1e-3)), Status::Fail);
        assert_eq!(doubted(Some(f64::NAN), clearance(5.0)), Status::Undecided);
        assert_eq!(doubted(None, clearance(5.0)), Status::Undecided);
    }

    #[test]
    fn what_was_not_flown_or_is_not_a_distance_is_not_doubted() {
        let planned = check_spec("plan.clearance").unwrap().at_least(Measurement::value(1e-9), 0.0);
        assert_eq!(doubted(Some(1.0), planned), Status::Pass);
        let late = check_spec("flight.duration").unwrap().at_most(Measurement::value(1.0), 1.0);
        assert_eq!(doubted(Some(1.0), late), Status::Pass);
        let failed = check_spec("flight.separation").unwrap().fail("no log");
        assert_eq!(doubted(Some(1.0), failed), Status::Fail);
    }
}
