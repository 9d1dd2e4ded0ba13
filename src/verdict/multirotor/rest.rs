//! Do the vehicles come to rest where they end?

use scenarios::{CheckSpec, Plan, Scenario};

use crate::verdict::compare::is_larger;
use crate::verdict::evidence::{Decide, Evidence, Measurement};
use crate::verdict::motion::Motion;
use crate::verdict::{Check, FlownMotions};

/// Speed at the end of the plan.
pub fn check_planned(spec: &CheckSpec, scenario: &Scenario, motions: Evidence<'_, [Motion]>) -> Check {
    answer(spec, scenario, motions, |motions, index| {
        let last = motions.get(index)?.knots().last()?;
        Some((last.velocity_mps, last.t_s))
    })
}

/// Speed in flight when the plan ends.
pub fn check_flown(spec: &CheckSpec, scenario: &Scenario, plan: &Plan, flown: Evidence<'_, FlownMotions<'_>>) -> Check {
    answer(spec, scenario, flown, |flown, index| {
        let end_s = plan.trajectories.get(index)?.end_s()?;
        // A thousandth of a millisecond is rounding, not time.
        let sample = flown.vehicles.get(index)?.judged.iter().find(|sample| sample.t_s >= end_s - 1e-6)?;
        Some((sample.velocity_mps, sample.t_s))
    })
}

fn answer<T: ?Sized>(
    spec: &CheckSpec,
    scenario: &Scenario,
    evidence: Evidence<'_, T>,
    end: impl Fn(&T, usize) -> Option<([f64; 3], f64)>,
) -> Check {
    let evidence = match evidence {
        Err(reason) => return spec.fail(reason),
        Ok(evidence) => evidence,
    };
    let mut fastest: Option<(f64, f64, &str)> = None;
    for (index, vehicle) in scenario.vehicles.iter().enumerate() {
        let Some((velocity_mps, t_s)) = end(evidence, index) else {
            return spec.fail(format!("the motion of {} ends before its plan does", vehicle.name));
        };
        let speed_mps = velocity_mps.iter().map(|component| component * component).sum::<f64>().sqrt();
        if fastest.is_none_or(|(worst_mps, ..)| is_larger(speed_mps, worst_mps)) {
            fastest = Some((speed_mps, t_s, &vehicle.name));
        }
    }
    match fastest {
        None => spec.fail("there is no vehicle"),
        Some((speed_mps, t_s, vehicle)) => {
            spec.at_most(Measurement::value(speed_mps).at(t_s).with(vehicle), scenario.limits().rest_mps)
        }
    }
}
