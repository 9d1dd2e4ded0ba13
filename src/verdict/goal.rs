//! Goals: the position in which a vehicle ends and, of fixed wings, its velocity.
//!
//! The parts of a goal have tolerances of different units, so that they are compared as fractions of their tolerances; the
//! check reports the worst one. Headings are compared modulo a full turn. Velocities are over ground. Whether a vehicle that
//! hovers has come to rest is a check of its own.

use scenarios::{AppliedLimits, CheckSpec, Family, Plan, Scenario, Vehicle};
use sim::Sample;

use crate::verdict::arrival::not_arrived;
use crate::verdict::compare::is_larger;
use crate::verdict::evidence::{CheckResult, Decide, Measurement};
use crate::verdict::flown::FlownMotions;
use crate::verdict::missing_evidence::MissingEvidence;
use crate::verdict::motion::Motion;
use crate::verdict::{Check, LimitKey};

/// The last nodes.
pub fn check_nodes(spec: &CheckSpec, scenario: &Scenario, plan: &Plan) -> CheckResult {
    check_worst(spec, scenario, |index| {
        let trajectory = &plan.trajectories[index];
        let last = trajectory.times_s().len().checked_sub(1).ok_or_else(|| ends_early(scenario, index))?;
        let nodes = trajectory.nodes();
        let vehicle = &scenario.vehicles[index];
        Ok(End::at(vehicle, trajectory.times_s()[last], nodes.position_m(last), nodes.velocity_mps(last)))
    })
}

/// The ends of the continuous plan.
pub fn check_planned(spec: &CheckSpec, scenario: &Scenario, motions: &[Motion]) -> CheckResult {
    check_worst(spec, scenario, |index| {
        let last = motions[index].knots().last().ok_or_else(|| ends_early(scenario, index))?;
        Ok(End::at(&scenario.vehicles[index], last.t_s, last.position_m, last.velocity_mps))
    })
}

/// The closest approaches in flight.
pub fn check_flown(spec: &CheckSpec, scenario: &Scenario, flown: &FlownMotions<'_>) -> CheckResult {
    check_worst(spec, scenario, |index| {
        let vehicle = &flown.vehicles[index];
        let approach = vehicle.approach.ok_or_else(|| not_arrived(vehicle))?;
        let velocity_mps = velocity_mps(vehicle.judged, approach.at_s).unwrap_or([f64::NAN; 3]);
        Ok(End { t_s: approach.at_s, distance_m: [approach.lower_m, approach.upper_m], velocity_mps })
    })
}

/// Where and how fast a vehicle ends.
struct End {
    t_s: f64,
    /// Bounds of the distance from the goal, m.
    distance_m: [f64; 2],
    velocity_mps: [f64; 3],
}

impl End {
    fn at(vehicle: &Vehicle, t_s: f64, position_m: [f64; 3], velocity_mps: [f64; 3]) -> Self {
        let goal_m = vehicle.goal.position_m();
        let distance_m = (0..3).map(|axis| (position_m[axis] - goal_m[axis]).powi(2)).sum::<f64>().sqrt();
        Self { t_s, distance_m: [distance_m; 2], velocity_mps }
    }

    /// What is asked of the end of a vehicle.
    fn parts(&self, family: Family, vehicle: &Vehicle, limits: &AppliedLimits) -> Vec<Part> {
        let position = Part {
            name: "position",
            unit: "m",
            off: self.distance_m,
            tolerance: limits.goal_m,
            key: LimitKey::Verdict("goal_m"),
        };
        match family {
            Family::FixedWing => {
                [position].into_iter().chain(velocity_parts(self.velocity_mps, vehicle, limits)).collect()
            }
            Family::SlungLoad | Family::Multirotor => vec![position],
        }
    }
}

/// One quantity of a goal.
struct Part {
    name: &'static str,
    unit: &'static str,
    /// Bounds of the difference from the goal, in `unit`.
    off: [f64; 2],
    tolerance: f64,
    key: LimitKey,
}

impl Part {
    /// The largest possible difference as a fraction of the tolerance.
    fn relative(&self) -> f64 {
        self.off[1] / self.tolerance
    }
}

/// Heading, flight-path angle and speed.
fn velocity_parts([vx, vy, vz]: [f64; 3], vehicle: &Vehicle, limits: &AppliedLimits) -> [Part; 3] {
    let goal = &vehicle.goal;
    let horizontal_mps = vx.hypot(vy);
    let turned_deg = (vy.atan2(vx).to_degrees() - goal.heading_deg).rem_euclid(360.0);
    let part = |name, unit, off: f64, tolerance, key| Part { name, unit, off: [off; 2], tolerance, key };
    [
        part(
            "heading",
            "deg",
            turned_deg.min(360.0 - turned_deg),
            limits.goal_heading_deg,
            LimitKey::Verdict("goal_heading_deg"),
        ),
        part(
            "flight-path angle",
            "deg",
            (vz.atan2(horizontal_mps).to_degrees() - goal.flight_path_deg).abs(),
            limits.goal_flight_path_deg,
            LimitKey::Verdict("goal_flight_path_deg"),
        ),
        part(
            "speed",
            "m/s",
            (horizontal_mps.hypot(vz) - goal.speed_mps).abs(),
            limits.goal_speed_mps,
            LimitKey::Verdict("goal_speed_mps"),
        ),
    ]
}

/// The check of the part, of any vehicle, that uses most of its tolerance.
///
/// - `end`: of the vehicle with this index
fn check_worst(
    spec: &CheckSpec,
    scenario: &Scenario,
    end: impl Fn(usize) -> Result<End, MissingEvidence>,
) -> CheckResult {
    let (family, limits) = (scenario.family(), scenario.limits());
    let mut worst: Option<(Part, f64, &str)> = None;
    for (index, vehicle) in scenario.vehicles.iter().enumerate() {
        let end = end(index)?;
        for part in end.parts(family, vehicle, &limits) {
            if worst.as_ref().is_none_or(|(worst, ..)| is_larger(part.relative(), worst.relative())) {
                worst = Some((part, end.t_s, &vehicle.name));
            }
        }
    }
    let (part, t_s, vehicle) = worst.ok_or(MissingEvidence::NoVehicle)?;
    Ok(check_part(spec, family, &part, t_s, vehicle))
}

fn check_part(spec: &CheckSpec, family: Family, part: &Part, t_s: f64, vehicle: &str) -> Check {
    let [lower, upper] = part.off;
    let measured = if lower == upper { Measurement::value(upper) } else { Measurement::bounds(lower, upper) };
    let measured = measured.at(t_s).with(vehicle);
    let measured = match family {
        Family::FixedWing => measured.with_reason(format!("it is the {}", part.name)),
        Family::SlungLoad | Family::Multirotor => measured,
    };
    Check { unit: part.unit.to_owned(), limit_key: Some(part.key), ..spec.at_most(measured, part.tolerance) }
}

fn ends_early(scenario: &Scenario, index: usize) -> MissingEvidence {
    MissingEvidence::EndsEarly { vehicle: scenario.vehicles[index].name.clone() }
}

/// Velocity at `t_s`, between two samples the interpolated one, m/s.
fn velocity_mps(samples: &[Sample], t_s: f64) -> Option<[f64; 3]> {
    let after = samples.partition_point(|sample| sample.t_s < t_s);
    let [before, after] = [samples.get(after.saturating_sub(1))?, samples.get(after).or(samples.last())?];
    let span_s = after.t_s - before.t_s;
    let fraction = if span_s > 0.0 { (t_s - before.t_s) / span_s } else { 0.0 };
    Some(std::array::from_fn(|axis| {
        before.velocity_mps[axis] + fraction * (after.velocity_mps[axis] - before.velocity_mps[axis])
    }))
}
