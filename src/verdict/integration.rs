//! Integration error of the flight: its distance from the same flight by another integrator.
//!
//! Cheap: the replay of `flight.dynamics`. Full: the whole flight again, feedback, wind and noise included, with the
//! plant's steps halved and quartered, and the turbulence sampled at the finer steps. References that were planned in the
//! loop are followed again. A check whose margin is smaller than the difference is undecided.

use scenarios::check_spec;
use schemars::JsonSchema;
use serde::{Deserialize, Serialize};
use sim::{Flight, VehicleLog};

use crate::number_format::quantity;
use crate::verdict::compare::{exceeds, is_larger};
use crate::verdict::tolerance::limit_tolerance;
use crate::verdict::{Check, Status};

/// The difference between two integrators.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize, JsonSchema)]
pub struct Integration {
    /// How it was found.
    pub method: Method,
    /// Largest distance between the flight and that of the other integrator, m; absent if the two cannot be compared because
    /// only one of them ends in a crash.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub disagreement_m: Option<f64>,
    /// Full form only: largest distance between the flights with half and with a quarter of the plant's step, m. For a
    /// second-order integrator it is a fifth of the distance above; in turbulence, which is rough at every scale, it is larger.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub half_to_quarter_m: Option<f64>,
}

/// Ways to estimate the difference.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Serialize, Deserialize, JsonSchema)]
#[serde(rename_all = "kebab-case")]
pub enum Method {
    /// Logged controls and air, integrated by a method of order 6, restarted in windows.
    Replay,
    /// The flight repeated with half and a quarter of the plant's step; if it was planned in the loop, with the same
    /// references.
    FinerSteps,
}

impl Integration {
    /// The cheap form, from the check of the flight's dynamics; `None` if that did not pass: such a difference is not an
    /// integration error, and has failed already.
    pub fn by_replay(checks: &[Check]) -> Option<Self> {
        let check = checks.iter().find(|check| check.name == DYNAMICS && check.status == Status::Pass)?;
        let disagreement_m = Some(check.value?);
        Some(Self { method: Method::Replay, disagreement_m, half_to_quarter_m: None })
    }

    /// The full form: from a flight, and the same flight with half and with a quarter of the plant's step.
    pub fn by_finer_steps(flight: &Flight, [half, quarter]: [&Flight; 2]) -> Self {
        let disagreement_m = distance_m(flight, quarter);
        Self { method: Method::FinerSteps, disagreement_m, half_to_quarter_m: distance_m(half, quarter) }
    }

    /// Marks as undecided every check of the flight in metres whose margin is smaller than the difference.
    pub fn mark_undecided(&self, checks: &mut [Check]) {
        let of_flight =
            |check: &&mut Check| check.name.starts_with("flight.") && check.name != DYNAMICS && check.unit == "m";
        for check in checks.iter_mut().filter(of_flight) {
            let decided = matches!(check.status, Status::Pass | Status::Fail);
            let Some(margin_m) = check.margin.filter(|_| decided) else { continue };
            let (is_unsure, by) = match self.disagreement_m {
                Some(max_m) => (exceeds(max_m, margin_m.abs().max(rounding_m(check))), quantity(max_m, "m")),
                None => (true, "more than a crash".to_owned()),
            };
            if is_unsure {
                check.status = Status::Undecided;
                check.reason = Some(format!("two integrators disagree on the flight by {by}, more than the margin"));
            }
        }
    }
}

/// By how much a check may be beyond its limit all the same, m.
fn rounding_m(check: &Check) -> f64 {
    let spec = check_spec(&check.name);
    spec.zip(check.limit).map_or(0.0, |(spec, limit_m)| limit_tolerance(spec, limit_m))
}

const DYNAMICS: &str = "flight.dynamics";

/// Largest distance between vehicles and loads of two flights at the same instants, m. `None` if their instants differ.
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

    fn status_after(disagreement_m: Option<f64>, mut check: Check) -> Status {
        let integration = Integration { method: Method::FinerSteps, disagreement_m, half_to_quarter_m: None };
        integration.mark_undecided(std::slice::from_mut(&mut check));
        check.status
    }

    #[test]
    fn flights_are_compared_sample_by_sample_and_loads_as_well() {
        let file = std::path::Path::new(env!("CARGO_MANIFEST_DIR")).join("scenarios/slung/rectangle.toml");
        let scenario = scenarios::load(&file).unwrap();
        let planner = planners::find("slung-lgr").unwrap();
        let plan = planner.plan(&scenario, 0, &mut |_| {});
        let flight = sim::fly(&scenario, &plan, 0, &mut |_| {});
        assert_eq!(super::distance_m(&flight, &flight), Some(0.0));
        let changed = |change: fn(&mut sim::VehicleLog)| {
            let mut other = flight.clone();
            change(&mut other.vehicles[0]);
            super::distance_m(&flight, &other)
        };
        assert_eq!(changed(|log| log.samples.truncate(9)), None);
        assert_eq!(changed(|log| log.loads.truncate(9)), None);
        let moved = changed(|log| log.loads[7].position_m[2] += 0.25).unwrap();
        assert!((moved - 0.25).abs() < 1e-12, "{moved}");
        assert!(changed(|log| log.samples[7].position_m[1] = f64::NAN).unwrap().is_nan());
    }

    #[test]
    fn a_margin_below_the_disagreement_is_undecided() {
        for value_m in [0.9e-3, -0.9e-3] {
            assert_eq!(status_after(Some(1e-3), clearance(value_m)), Status::Undecided);
        }
        assert_eq!(status_after(Some(1e-3), clearance(1.1e-3)), Status::Pass);
        assert_eq!(status_after(Some(1e-3), clearance(-1.1e-3)), Status::Fail);
        assert_eq!(status_after(Some(f64::NAN), clearance(5.0)), Status::Undecided);
        assert_eq!(status_after(None, clearance(5.0)), Status::Undecided);
    }

    #[test]
    fn checks_of_the_plan_and_other_units_keep_their_status() {
        let planned = check_spec("plan.clearance").unwrap().at_least(Measurement::value(1e-9), 0.0);
        assert_eq!(status_after(Some(1.0), planned), Status::Pass);
        let late = check_spec("flight.duration").unwrap().at_most(Measurement::value(1.0), 1.0);
        assert_eq!(status_after(Some(1.0), late), Status::Pass);
        let failed = check_spec("flight.separation").unwrap().fail("no log");
        assert_eq!(status_after(Some(1.0), failed), Status::Fail);
    }
}
