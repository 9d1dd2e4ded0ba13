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
use super::cubic::{accelerations_mps2, fastest, is_jump, norm, without_rounding};
use super::rest::RECORD;
use crate::number_format::quantity;
use crate::verdict::airspeed::air_velocities;
use crate::verdict::compare::exceeds;
use crate::verdict::evidence::CheckResult;
use crate::verdict::map_bounds::MapBounds;
use crate::verdict::motion::{Knot, Motion, Segment};
use crate::verdict::tolerance::SOLVER_TOLERANCE;
use crate::verdict::worst::{Quantity, Worst, check_limits};
use crate::verdict::{Check, FlownMotions, LimitKey};

/// What rounding leaves of the length of a quaternion that is a rotation.
const ROTATION_TOLERANCE: f64 = 1e-6;

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
/// - `between`: how well each motion is known; accelerations at the nodes are those of vehicles whose velocities are given
pub fn check_accelerations(
    spec: &CheckSpec,
    scenario: &Scenario,
    motions: &[Motion],
    between: &[BetweenNodes],
) -> CheckResult {
    let jumps = || motions.iter().flat_map(|motion| motion.knots().windows(2).filter(|pair| is_jump(pair)));
    let check = check_limits(spec, |worst| {
        for ((limited, motion), between) in limited_vehicles(scenario).zip(motions).zip(between) {
            let is_of_nodes = spec.group == Group::Nodes;
            if is_of_nodes && !between.gives_velocities() {
                continue;
            }
            let limits = if is_of_nodes { limited.promised } else { *limited.physical() };
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
        let map = MapBounds::new(scenario, &vehicle.name, model.body_radius_m);
        Self { vehicle: &vehicle.name, map, model, promised }
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
