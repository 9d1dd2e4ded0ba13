//! Tracking of the setpoints that a log gives: the distance of the flown motion from them, over continuous time.
//!
//! A setpoint is linear in time between two that the log gives. The flown motion p is known up to the tube around the curve q,
//! so that with the setpoint r
//!
//! ```text
//! max |q - r| - tube ≤ max |p - r| ≤ max |q - r| + tube          |rms(p - r) - rms(q - r)| ≤ rms(tube)      [Minkowski]
//! ```

use nalgebra::Vector3;
use scenarios::CheckSpec;
use scenarios::plan_input::Setpoints;

use crate::verdict::compare::is_larger;
use crate::verdict::evidence::{CheckResult, Decide, Measurement};
use crate::verdict::motion::{Motion, Segment};
use crate::verdict::recorded::RecordedFlight;
use crate::verdict::{Check, Status};

/// Why tracking is skipped.
const NO_SETPOINTS: &str = "the log gives no setpoints (reference_x_m, reference_y_m, reference_z_m)";
/// Setpoints may begin and end this much after and before the motion that is judged, s.
const MAX_UNCOVERED_S: f64 = 1.0;
/// Abscissae and weights of the Gauss-Legendre rule on [0, 1] with 4 points, exact for polynomials of degree 7.
const GAUSS: [(f64, f64); 4] = [
    (0.069_431_844_202_973_71, 0.173_927_422_568_726_93),
    (0.330_009_478_207_571_87, 0.326_072_577_431_273_07),
    (0.669_990_521_792_428_1, 0.326_072_577_431_273_07),
    (0.930_568_155_797_026_3, 0.173_927_422_568_726_93),
];

/// The tracking error of one vehicle.
#[derive(Clone, Copy, Debug)]
struct TrackingError {
    /// Bounds of the largest, m.
    largest_m: [f64; 2],
    /// Its time, s.
    at_s: f64,
    /// Bounds of the root mean square, m.
    rms_m: [f64; 2],
    /// Time that the setpoints do not cover, s.
    uncovered_s: f64,
}

/// Largest distance from the setpoints.
pub fn check_largest(spec: &CheckSpec, log: &RecordedFlight<'_>, motions: &[Motion]) -> CheckResult {
    let limit_m = log.scenario.limits().tracking_max_m;
    Ok(check_worst(spec, log, motions, |error| (error.largest_m, Some(error.at_s)), limit_m))
}

/// Root mean square of the distance from the setpoints.
pub fn check_root_mean_square(spec: &CheckSpec, log: &RecordedFlight<'_>, motions: &[Motion]) -> CheckResult {
    let limit_m = log.scenario.limits().tracking_rms_m;
    Ok(check_worst(spec, log, motions, |error| (error.rms_m, None), limit_m))
}

/// The check of the worst vehicle. One whose setpoints are missing, wholly or in part, does not let it pass.
fn check_worst(
    spec: &CheckSpec,
    log: &RecordedFlight<'_>,
    motions: &[Motion],
    measure: impl Fn(&TrackingError) -> ([f64; 2], Option<f64>),
    limit_m: f64,
) -> Check {
    let mut worst: Option<([f64; 2], Option<f64>, &str)> = None;
    let mut unknown: Option<String> = None;
    for (motion, setpoints) in motions.iter().zip(log.setpoints) {
        let error = setpoints.as_ref().and_then(|setpoints| tracking_error(motion, setpoints));
        let Some(error) = error else {
            unknown.get_or_insert_with(|| format!("the log gives no setpoints of {}", motion.vehicle()));
            continue;
        };
        if error.uncovered_s > MAX_UNCOVERED_S {
            let lacking = || format!("{:.3} s of {} have no setpoints", error.uncovered_s, motion.vehicle());
            unknown.get_or_insert_with(lacking);
        }
        let (bounds_m, at_s) = measure(&error);
        if worst.is_none_or(|(worst_m, ..)| is_larger(bounds_m[1], worst_m[1])) {
            worst = Some((bounds_m, at_s, motion.vehicle()));
        }
    }
    let Some(([lower_m, upper_m], at_s, vehicle)) = worst else {
        let are_given = log.setpoints.iter().any(Option::is_some);
        return if are_given {
            spec.fail("no setpoint is given for any time of the flight")
        } else {
            spec.skip(NO_SETPOINTS)
        };
    };
    let measured = at_s.into_iter().fold(Measurement::bounds(lower_m, upper_m).with(vehicle), Measurement::at);
    let check = spec.at_most(measured, limit_m);
    match unknown {
        Some(reason) if check.status == Status::Pass => {
            Check { status: Status::Undecided, reason: Some(reason), ..check }
        }
        _ => check,
    }
}

/// `None` if no setpoint is given during the motion.
fn tracking_error(motion: &Motion, setpoints: &Setpoints) -> Option<TrackingError> {
    let (mut largest_m, mut at_s) = ([0.0_f64; 2], f64::NAN);
    let (mut square_m2s, mut tube_m2s, mut covered_s) = (0.0, 0.0, 0.0);
    for segment in motion.segments().filter(Segment::lasts) {
        for pair in pairs_during(setpoints, segment.t_s) {
            let part = segment.during(pair.t_s[0].max(segment.t_s[0]), pair.t_s[1].min(segment.t_s[1]));
            if !part.lasts() {
                continue;
            }
            let (deviation_m, duration_s) = (segment.deviation_m, part.t_s[1] - part.t_s[0]);
            let apart = pair.apart(&part);
            let hull_m = apart.iter().map(Vector3::norm).fold(0.0, f64::max);
            let ends_m = apart[0].norm().max(apart[3].norm());
            largest_m[0] = largest_m[0].max(ends_m - deviation_m);
            if is_larger(hull_m + deviation_m, largest_m[1]) {
                (largest_m[1], at_s) = (hull_m + deviation_m, part.t_s[0]);
            }
            square_m2s +=
                duration_s * GAUSS.iter().map(|(u, weight)| weight * cubic(&apart, *u).norm_squared()).sum::<f64>();
            tube_m2s += duration_s * deviation_m * deviation_m;
            covered_s += duration_s;
        }
    }
    let [rms_m, tube_m] = [square_m2s, tube_m2s].map(|sum: f64| (sum / covered_s).sqrt());
    let uncovered_s = motion.end_s() - motion.knots()[0].t_s - covered_s;
    let rms_m = [(rms_m - tube_m).max(0.0), rms_m + tube_m];
    (covered_s > 0.0).then_some(TrackingError { largest_m, at_s, rms_m, uncovered_s })
}

/// Two setpoints, one after the other.
struct Pair {
    t_s: [f64; 2],
    positions_m: [Vector3<f64>; 2],
}

impl Pair {
    /// Control points of the difference between a curve and the setpoint, m.
    fn apart(&self, part: &Segment) -> [Vector3<f64>; 4] {
        let [begin_s, end_s] = part.t_s;
        std::array::from_fn(|point| {
            let t_s = begin_s + (end_s - begin_s) * point as f64 / 3.0;
            let u = (t_s - self.t_s[0]) / (self.t_s[1] - self.t_s[0]);
            Vector3::from(part.points_m[point]) - self.positions_m[0].lerp(&self.positions_m[1], u)
        })
    }
}

/// The pairs of setpoints that touch an interval of time.
fn pairs_during(setpoints: &Setpoints, [from_s, to_s]: [f64; 2]) -> impl Iterator<Item = Pair> + '_ {
    let Setpoints { times_s, positions_m } = setpoints;
    let count = times_s.len().min(positions_m.len());
    let first = times_s[..count].partition_point(|t_s| *t_s <= from_s).saturating_sub(1);
    let pairs = (first..count.saturating_sub(1)).take_while(move |index| times_s[*index] < to_s);
    pairs.filter(|index| times_s[*index] < times_s[index + 1]).map(|index| Pair {
        t_s: [times_s[index], times_s[index + 1]],
        positions_m: [positions_m[index], positions_m[index + 1]].map(Vector3::from),
    })
}

/// The cubic with these control points at the fraction `u`.
fn cubic(points: &[Vector3<f64>; 4], u: f64) -> Vector3<f64> {
    let v = 1.0 - u;
    points[0] * (v * v * v) + points[1] * (3.0 * v * v * u) + points[2] * (3.0 * v * u * u) + points[3] * (u * u * u)
}

#[cfg(test)]
mod tests {
    use super::{Setpoints, tracking_error};
    use crate::verdict::motion::{Knot, Motion};

    /// Along x at 2 m/s for 4 s.
    fn motion() -> Motion {
        let knot = |t_s: f64| Knot { t_s, position_m: [2.0 * t_s, 0.0, 0.0], velocity_mps: [2.0, 0.0, 0.0] };
        Motion::new("uav", vec![knot(0.0), knot(1.0), knot(4.0)]).unwrap()
    }

    fn setpoints(times_s: &[f64], off_m: impl Fn(f64) -> f64) -> Setpoints {
        let positions_m = times_s.iter().map(|t_s| [2.0 * t_s, off_m(*t_s), 0.0]).collect();
        Setpoints { times_s: times_s.to_vec(), positions_m }
    }

    #[test]
    fn the_error_is_that_between_the_samples_too() {
        // Off by up to 3 m at 2.5 s, which is no sample of the motion; linear up and down.
        let given = setpoints(&[0.0, 2.5, 4.0], |t_s| if t_s == 2.5 { 3.0 } else { 0.0 });
        let error = tracking_error(&motion(), &given).unwrap();
        assert!(error.largest_m.iter().all(|it| (it - 3.0).abs() < 1e-12), "{error:?}");
        assert!(error.rms_m.iter().all(|it| (it - 3.0_f64.sqrt()).abs() < 1e-12), "{error:?}");
        assert!(error.uncovered_s.abs() < 1e-12, "{error:?}");
    }

    #[test]
    fn what_is_not_known_of_the_motion_widens_both() {
        let error = tracking_error(&motion().within(|_| 0.5), &setpoints(&[0.0, 4.0], |_| 2.0)).unwrap();
        let close = |found: [f64; 2]| (found[0] - 1.5).abs() < 1e-12 && (found[1] - 2.5).abs() < 1e-12;
        assert!(close(error.largest_m) && close(error.rms_m), "{error:?}");
    }

    #[test]
    fn setpoints_that_end_early_leave_the_rest_unknown() {
        let error = tracking_error(&motion(), &setpoints(&[0.5, 2.0], |_| 1.0)).unwrap();
        assert!((error.uncovered_s - 2.5).abs() < 1e-12, "{error:?}");
        assert!(tracking_error(&motion(), &setpoints(&[5.0, 6.0], |_| 1.0)).is_none());
        assert!(tracking_error(&motion(), &Setpoints::default()).is_none());
    }
}
