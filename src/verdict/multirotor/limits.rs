//! Do states and controls stay inside their limits?
//!
//! As for the other families: the planning limits at the planner's nodes, the physical ones between them and in flight, the
//! map in all three. Positions and planned speeds are judged over continuous time; in flight the speed is that through the
//! air, at every step and at the peaks of gusts. Of a point mass the acceleration that acted is judged, of a quadrotor its tilt and the thrusts.

use nalgebra::{Quaternion, UnitQuaternion, Vector3};
use scenarios::multirotor::{Airframe, Limits, Model, Plant};
use scenarios::{CheckSpec, Group, Range, Scenario, Vehicle};
use sim::{Actuation, Commanded, Sample};

use super::between_nodes::{BetweenNodes, Bounded};
use super::rest::RECORD;
use crate::number_format::quantity;
use crate::verdict::airspeed::air_velocities;
use crate::verdict::bernstein;
use crate::verdict::compare::exceeds;
use crate::verdict::evidence::CheckResult;
use crate::verdict::map_bounds::MapBounds;
use crate::verdict::motion::{Knot, Motion, Segment};
use crate::verdict::tolerance::SOLVER_TOLERANCE;
use crate::verdict::worst::{Quantity, Worst, check_limits};
use crate::verdict::{Check, FlownMotions, LimitKey};

/// What rounding leaves of the length of a quaternion that is a rotation.
const ROTATION_TOLERANCE: f64 = 1e-6;
/// Nodes at one time that differ by less than this, m and m/s, are the same: rounding.
const SAME_NODE: f64 = 1e-9;
/// Distance between the bounds of an extreme squared speed that counts as close enough, m²/s².
const RESOLUTION_M2PS2: f64 = 1e-9;

/// States at the nodes against the planning limits.
///
/// - `between`: what the plan gives of each vehicle; speeds that it does not give are not judged here
pub fn check_node_states(
    spec: &CheckSpec,
    scenario: &Scenario,
    motions: &[Motion],
    between: &[BetweenNodes],
) -> CheckResult {
    check_limits(spec, |worst| {
        for ((limited, motion), between) in limited_vehicles(scenario).zip(motions).zip(between) {
            for knot in motion.knots() {
                limited.map.place(worst, knot.position_m, knot.t_s);
                if between.gives_velocities() {
                    limited.speed(worst, (norm(knot.velocity_mps), 0.0), limited.promised.speed_mps, knot.t_s);
                }
            }
        }
    })
}

/// States of the continuous plan against the physical limits.
pub fn check_planned_states(
    spec: &CheckSpec,
    scenario: &Scenario,
    motions: &[Motion],
    between: &[BetweenNodes],
) -> CheckResult {
    check_limits(spec, |worst| {
        for ((limited, motion), between) in limited_vehicles(scenario).zip(motions).zip(between) {
            limited.planned_states(worst, motion, between);
        }
    })
}

/// Flown states against the physical limits.
///
/// - `motions`: the flown ones, as far as the plan is known
pub fn check_flown_states(
    spec: &CheckSpec,
    scenario: &Scenario,
    flown: &FlownMotions<'_>,
    motions: &[Motion],
) -> CheckResult {
    check_limits(spec, |worst| {
        let logs = motions.iter().zip(&flown.vehicles);
        for (limited, (motion, vehicle)) in limited_vehicles(scenario).zip(logs) {
            limited.map.path(worst, motion);
            for sample in vehicle.judged {
                limited.tilt(worst, sample);
            }
            for (t_s, air_velocity_mps) in air_velocities(scenario, vehicle.judged) {
                limited.speed(worst, (norm(air_velocity_mps), 0.0), limited.physical().speed_mps, t_s);
            }
        }
    })
}

/// Accelerations of the cubics between the nodes, against the planning limits for [`Group::Nodes`] and the physical ones for
/// [`Group::Plan`]. An acceleration is linear in time and largest at an end. Two nodes that share a time and differ in
/// position or velocity need an infinite one.
///
/// - `between`: how well each motion is known
pub fn check_accelerations(
    spec: &CheckSpec,
    scenario: &Scenario,
    motions: &[Motion],
    between: &[BetweenNodes],
) -> CheckResult {
    let jumps = || motions.iter().flat_map(|motion| motion.knots().windows(2).filter(|pair| is_jump(pair)));
    let check = check_limits(spec, |worst| {
        for ((limited, motion), between) in limited_vehicles(scenario).zip(motions).zip(between) {
            let limits = if spec.group == Group::Nodes { limited.promised } else { *limited.physical() };
            limited.planned_accelerations(worst, motion, between, limits.acceleration_mps2);
        }
    })?;
    Ok(Check { reason: jumps().next().map(jump_remark).or(check.reason), ..check })
}

/// Why a jump fails, with a remark on the recorded plan of an in-loop flight.
fn jump_remark(pair: &[Knot]) -> String {
    let apart = |a: [f64; 3], b: [f64; 3]| norm([a[0] - b[0], a[1] - b[1], a[2] - b[2]]);
    let jump_m = quantity(apart(pair[0].position_m, pair[1].position_m), "m");
    let jump_mps = quantity(apart(pair[0].velocity_mps, pair[1].velocity_mps), "m/s");
    format!("it jumps by {jump_m} and {jump_mps} at one time; {RECORD}")
}

/// What acted in flight against the physical limits.
pub fn check_flown_controls(spec: &CheckSpec, scenario: &Scenario, flown: &FlownMotions<'_>) -> CheckResult {
    check_limits(spec, |worst| {
        for (limited, vehicle) in limited_vehicles(scenario).zip(&flown.vehicles) {
            for sample in vehicle.judged {
                limited.control(worst, sample);
            }
        }
    })
}

fn limited_vehicles(scenario: &Scenario) -> impl Iterator<Item = Limited<'_>> {
    scenario.vehicles.iter().map(|vehicle| Limited::new(scenario, vehicle))
}

/// A vehicle and what it has to stay inside.
pub struct Limited<'a> {
    vehicle: &'a str,
    map: MapBounds<'a>,
    model: &'a Model,
    /// What its planner promised to keep, widened by what a solver may leave.
    promised: Limits,
}

impl<'a> Limited<'a> {
    /// A vehicle of `scenario`.
    pub fn new(scenario: &'a Scenario, vehicle: &'a Vehicle) -> Self {
        let model = scenario.multirotor_model(vehicle);
        let widened = |value: f64| value * (1.0 + SOLVER_TOLERANCE);
        let Limits { speed_mps, acceleration_mps2 } = model.planning_limits;
        let promised = Limits { speed_mps: widened(speed_mps), acceleration_mps2: widened(acceleration_mps2) };
        Self { vehicle: &vehicle.name, map: MapBounds::new(scenario, &vehicle.name), model, promised }
    }

    /// Considers position and speed of a planned motion over continuous time, against the physical limits.
    pub fn planned_states(&self, worst: &mut Worst<'a>, motion: &Motion, between: &BetweenNodes) {
        self.map.path(worst, motion);
        for segment in motion.segments().filter(Segment::lasts) {
            let (fastest_mps, t_s) = fastest(&segment);
            let speed_mps = between.speed_mps(&segment, fastest_mps);
            self.speed(worst, speed_mps, self.physical().speed_mps, t_s);
        }
    }

    /// Considers the accelerations of a planned motion, jumps included.
    pub fn planned_accelerations(
        &self,
        worst: &mut Worst<'a>,
        motion: &Motion,
        between: &BetweenNodes,
        limit_mps2: f64,
    ) {
        for (index, segment) in motion.segments().enumerate().filter(|(_, segment)| segment.lasts()) {
            let ends = accelerations_mps2(&segment).into_iter().zip(segment.t_s).zip([index, index + 1]);
            for ((value, t_s), knot) in ends {
                let value_mps2 = without_rounding(norm(value), limit_mps2, &segment);
                let value_mps2 = between.acceleration_mps2(motion, knot, value_mps2, limit_mps2);
                self.acceleration(worst, value_mps2, limit_mps2, t_s);
            }
        }
        for jump in motion.knots().windows(2).filter(|pair| is_jump(pair)) {
            self.acceleration(worst, (f64::INFINITY, 0.0), limit_mps2, jump[0].t_s);
        }
    }

    /// The physical limits.
    pub fn physical(&self) -> &Limits {
        &self.model.limits
    }

    fn speed(&self, worst: &mut Worst<'a>, speed_mps: Bounded, most_mps: f64, t_s: f64) {
        worst.consider_within(
            self.vehicle,
            up_to("speed", "m/s", most_mps, LimitKey::Limits("speed_mps")),
            speed_mps,
            t_s,
        );
    }

    fn acceleration(&self, worst: &mut Worst<'a>, value_mps2: Bounded, most_mps2: f64, t_s: f64) {
        worst.consider_within(
            self.vehicle,
            up_to("acceleration", "m/s²", most_mps2, LimitKey::Limits("acceleration_mps2")),
            value_mps2,
            t_s,
        );
    }

    /// The airframe, of a quadrotor.
    fn airframe(&self) -> Option<&'a Airframe> {
        self.model.airframe.as_ref().filter(|_| self.model.plant == Plant::Quadrotor)
    }

    fn tilt(&self, worst: &mut Worst<'a>, sample: &Sample) {
        let Some(airframe) = self.airframe() else { return };
        let attitude = Quaternion::from(sample.world_from_body);
        // What is no rotation has no tilt.
        let is_rotation = !exceeds((attitude.norm() - 1.0).abs(), ROTATION_TOLERANCE);
        let body_z = UnitQuaternion::from_quaternion(attitude) * Vector3::z();
        let tilt_deg = if is_rotation { body_z.z.clamp(-1.0, 1.0).acos().to_degrees() } else { f64::NAN };
        worst.consider(
            self.vehicle,
            up_to("tilt", "deg", airframe.tilt_deg, LimitKey::Airframe("tilt_deg")),
            tilt_deg,
            sample.t_s,
        );
    }

    fn control(&self, worst: &mut Worst<'a>, sample: &Sample) {
        match (&sample.actuation, self.airframe()) {
            (Actuation::Thrusts(Commanded { control, .. }), Some(airframe)) => {
                let named = ["F_1", "F_2", "F_3", "F_4"].into_iter().zip(control.thrust_n);
                for (name, value) in named {
                    let quantity =
                        Quantity { name, unit: "N", range: airframe.thrust_n, key: LimitKey::Airframe("thrust_n") };
                    worst.consider(self.vehicle, quantity, value, sample.t_s);
                }
            }
            (Actuation::Acceleration(Commanded { control, .. }), None) => {
                self.acceleration(worst, (norm(*control), 0.0), self.physical().acceleration_mps2, sample.t_s);
            }
            // A log with another vehicle's controls is no log of this one.
            _ => self.acceleration(worst, (f64::NAN, 0.0), self.physical().acceleration_mps2, sample.t_s),
        }
    }
}

/// A magnitude: the range goes as far below 0 as above, so that small ones are far inside.
fn up_to(name: &'static str, unit: &'static str, most: f64, key: LimitKey) -> Quantity {
    Quantity { name, unit, range: Range::new(-most, most), key }
}

fn norm([x, y, z]: [f64; 3]) -> f64 {
    (x * x + y * y + z * z).sqrt()
}

/// Largest speed in a segment, m/s, and when, s: the squared speed is a polynomial of degree 4.
fn fastest(segment: &Segment) -> (f64, f64) {
    const SHARES: [[f64; 3]; 3] = [[1.0, 0.5, 1.0 / 6.0], [0.5, 2.0 / 3.0, 0.5], [1.0 / 6.0, 0.5, 1.0]];
    let duration_s = segment.t_s[1] - segment.t_s[0];
    let v: [[f64; 3]; 3] = std::array::from_fn(|i| {
        std::array::from_fn(|axis| (segment.points_m[i + 1][axis] - segment.points_m[i][axis]) * 3.0 / duration_s)
    });
    // c_k = Σ_{i+j=k} C(2,i) C(2,j) / C(4,k) v_i·v_j, with the sign turned: the minimum is sought.
    let mut c = [0.0; 5];
    for i in 0..3 {
        for j in 0..3 {
            let dot: f64 = (0..3).map(|axis| v[i][axis] * v[j][axis]).sum();
            c[i + j] -= SHARES[i][j] * dot;
        }
    }
    let minimum = bernstein::minimise(&c, f64::INFINITY, |_| RESOLUTION_M2PS2);
    ((-minimum.lower).sqrt(), minimum.at.map_or(segment.t_s[0], |u| segment.instant_s(u)))
}

/// Accelerations at both ends of a segment, m/s².
fn accelerations_mps2(segment: &Segment) -> [[f64; 3]; 2] {
    let duration_s = segment.t_s[1] - segment.t_s[0];
    let second = |first: usize| {
        std::array::from_fn(|axis| {
            let [a, b, c] = [0, 1, 2].map(|i| segment.points_m[first + i][axis]);
            6.0 * (a - 2.0 * b + c) / (duration_s * duration_s)
        })
    };
    [second(0), second(1)]
}

/// Whether two knots share a time, but not position and velocity.
fn is_jump(pair: &[Knot]) -> bool {
    let differ = |a: [f64; 3], b: [f64; 3]| exceeds(norm([a[0] - b[0], a[1] - b[1], a[2] - b[2]]), SAME_NODE);
    pair[0].t_s == pair[1].t_s
        && (differ(pair[0].position_m, pair[1].position_m) || differ(pair[0].velocity_mps, pair[1].velocity_mps))
}

/// An acceleration, m/s², less what rounding of positions and times may contribute, where that decides.
///
/// ```text
/// δa = 6/h² (4 ε |p| + |v| ε t)                          ε of double precision, over an interval of length h
/// ```
///
/// Rows some nanoseconds apart have second differences that are all rounding.
fn without_rounding(value_mps2: f64, limit_mps2: f64, segment: &Segment) -> f64 {
    let [from_s, to_s] = segment.t_s;
    let duration_s = to_s - from_s;
    let position_m = segment.points_m.iter().map(|point| norm(*point)).fold(0.0, f64::max);
    let leg_m = |first: usize| {
        norm(std::array::from_fn(|axis| segment.points_m[first + 1][axis] - segment.points_m[first][axis]))
    };
    // The speeds of the nodes, not the distance between them: a jump must not excuse itself.
    let time_error_m = 3.0 * leg_m(0).max(leg_m(2)) / duration_s * to_s.abs() * f64::EPSILON;
    let rounding_mps2 = 6.0 * (4.0 * f64::EPSILON * position_m + time_error_m) / (duration_s * duration_s);
    let decides = exceeds(value_mps2, limit_mps2) && !exceeds(value_mps2 - rounding_mps2, limit_mps2);
    if decides { (value_mps2 - rounding_mps2).max(0.0) } else { value_mps2 }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn speed_and_acceleration_of_a_cubic_are_found_between_its_ends() {
        // x = 6 t² - 4 t³ on [0, 1]: v = 12 t (1 - t), largest 3 m/s in the middle; a = 12 - 24 t.
        let knot = |t_s: f64| Knot {
            t_s,
            position_m: [6.0 * t_s * t_s - 4.0 * t_s.powi(3), 0.0, 0.0],
            velocity_mps: [12.0 * t_s * (1.0 - t_s), 0.0, 0.0],
        };
        let segment = Segment::between(&knot(0.0), &knot(1.0));
        let (speed_mps, at_s) = fastest(&segment);
        assert!((speed_mps - 3.0).abs() < 1e-6 && (at_s - 0.5).abs() < 1e-3, "{speed_mps} at {at_s}");
        let [first, last] = accelerations_mps2(&segment);
        assert!((first[0] - 12.0).abs() < 1e-12 && (last[0] + 12.0).abs() < 1e-12, "{first:?} {last:?}");
    }

    #[test]
    fn a_jump_needs_an_infinite_acceleration_and_rounding_none() {
        let knot =
            |t_s: f64, x_m: f64, v_mps: f64| Knot { t_s, position_m: [x_m, 0.0, 0.0], velocity_mps: [v_mps, 0.0, 0.0] };
        assert!(is_jump(&[knot(1.0, 2.0, 1.0), knot(1.0, 2.5, 1.0)]));
        assert!(is_jump(&[knot(1.0, 2.0, 1.0), knot(1.0, 2.0, -1.0)]));
        assert!(!is_jump(&[knot(1.0, 2.0, 1.0), knot(1.0, 2.0, 1.0)]));
        assert!(!is_jump(&[knot(1.0, 2.0, 1.0), knot(1.1, 2.5, 1.0)]));
        // 3 ns on a motion at constant velocity: the second difference is rounding.
        let [a, b] = [4.0, 4.0 + 3e-9].map(|t_s| knot(t_s, 0.7 * t_s, 0.7));
        let segment = Segment::between(&a, &b);
        for value in accelerations_mps2(&segment) {
            assert!(without_rounding(norm(value), 3.0, &segment) <= 3.0, "{value:?}");
        }
        // A hop of a micrometre within the same interval is no rounding.
        let hop = Segment::between(&a, &knot(b.t_s, b.position_m[0] + 1e-6, 0.7));
        assert!(accelerations_mps2(&hop).iter().all(|value| without_rounding(norm(*value), 3.0, &hop) > 1e6));
        // Nor is one between two neighbouring numbers of time.
        let hop = Segment::between(&a, &knot(a.t_s.next_up(), a.position_m[0] + 0.5, 0.7));
        assert!(accelerations_mps2(&hop).iter().all(|value| without_rounding(norm(*value), 3.0, &hop) > 1e6));
    }
}
