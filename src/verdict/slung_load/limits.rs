//! Do states and thrusts stay inside their limits?
//!
//! As for fixed wings: the planning limits at the planner's nodes, the physical ones between them and in flight, the map in
//! all three, for quadrotor and load. Positions are judged over continuous time, the attitude at every instant of the plan
//! (5 ms apart at most) and at every step of the flight, in Euler angles (Z-Y-X). Thrusts run linearly between the nodes of
//! a plan, so that they are extreme at nodes; in flight those that the rotors were given are judged.

use nalgebra::{Quaternion, UnitQuaternion};
use scenarios::slung_load::{Limits, Trajectory};
use scenarios::{CheckSpec, Range, Scenario, Vehicle};
use sim::slung_load::SlungLoadState;
use sim::{Actuation, VehicleLog};

use super::{FlownMotion, PlannedMotion};
use crate::verdict::LimitKey;
use crate::verdict::evidence::CheckResult;
use crate::verdict::map_bounds::MapBounds;
use crate::verdict::tolerance::SOLVER_TOLERANCE;
use crate::verdict::worst::{Quantity, Worst, check_limits};

/// A vehicle and what it has to stay inside.
pub struct LimitChecks<'a> {
    vehicle: &'a str,
    /// Of the quadrotor and of the load.
    maps: [MapBounds<'a>; 2],
    promised: Limits,
    physical: Limits,
}

impl<'a> LimitChecks<'a> {
    /// A vehicle of the scenario.
    pub fn new(scenario: &'a Scenario, vehicle: &'a Vehicle) -> Self {
        let model = scenario.slung_load_model(vehicle);
        let widened = |range: Range| {
            let tolerance = SOLVER_TOLERANCE * range.width();
            Range::new(range.min - tolerance, range.max + tolerance)
        };
        let Limits { thrust_n, attitude_deg, cable_deg, tension_n } = model.planning_limits;
        Self {
            vehicle: &vehicle.name,
            maps: [model.body_radius_m(), model.load_radius_m]
                .map(|radius_m| MapBounds::new(scenario, &vehicle.name, radius_m)),
            promised: Limits {
                thrust_n: widened(thrust_n),
                attitude_deg: widened(attitude_deg),
                cable_deg: widened(cable_deg),
                tension_n,
            },
            physical: model.limits.clone(),
        }
    }

    /// States at the planner's nodes against the planning limits.
    pub fn check_node_states(&self, spec: &CheckSpec, trajectory: &Trajectory) -> CheckResult {
        check_limits(spec, |worst| {
            for node in trajectory.planner_nodes() {
                let (state, t_s) = (&trajectory.states[node], trajectory.times_s[node]);
                for (map, position_m) in self.maps.iter().zip([state.position_m, state.load_position_m]) {
                    map.place(worst, position_m, t_s);
                }
                self.attitude(worst, &SlungLoadState::from(state).attitude, self.promised.attitude_deg, t_s);
                self.cable(worst, &SlungLoadState::from(state), self.promised.cable_deg, t_s);
            }
        })
    }

    /// States of the continuous plan against the physical limits.
    pub fn check_planned_states(&self, spec: &CheckSpec, planned: &PlannedMotion) -> CheckResult {
        check_limits(spec, |worst| {
            for (map, motion) in self.maps.iter().zip(&planned.motions) {
                map.path(worst, motion);
            }
            for knot in &planned.knots {
                self.attitude(worst, &knot.state.attitude, self.physical.attitude_deg, knot.t_s);
            }
        })
    }

    /// Flown states against the physical limits.
    pub fn check_flown_states(&self, spec: &CheckSpec, flown: &FlownMotion<'_>) -> CheckResult {
        check_limits(spec, |worst| {
            for (map, motion) in self.maps.iter().zip(&flown.motions) {
                map.path(worst, motion);
            }
            for sample in &flown.log.samples {
                let attitude = UnitQuaternion::from_quaternion(Quaternion::from(sample.world_from_body));
                self.attitude(worst, &attitude, self.physical.attitude_deg, sample.t_s);
            }
        })
    }

    /// Thrusts at the planner's nodes against the planning limits.
    pub fn check_node_thrusts(&self, spec: &CheckSpec, trajectory: &Trajectory) -> CheckResult {
        check_limits(spec, |worst| {
            for node in trajectory.planner_nodes() {
                let thrust_n = trajectory.controls[node].thrust_n;
                self.thrusts(worst, thrust_n, self.promised.thrust_n, trajectory.times_s[node]);
            }
        })
    }

    /// Thrusts of the continuous plan against the physical limits.
    pub fn check_planned_thrusts(&self, spec: &CheckSpec, trajectory: &Trajectory) -> CheckResult {
        check_limits(spec, |worst| {
            for (control, &t_s) in trajectory.controls.iter().zip(&trajectory.times_s) {
                self.thrusts(worst, control.thrust_n, self.physical.thrust_n, t_s);
            }
        })
    }

    /// Thrusts that acted in flight against the physical limits.
    pub fn check_flown_thrusts(&self, spec: &CheckSpec, log: &VehicleLog) -> CheckResult {
        check_limits(spec, |worst| {
            for sample in &log.samples {
                let thrust_n = match &sample.actuation {
                    Actuation::Thrusts(thrusts) => thrusts.control.thrust_n,
                    // A log with another vehicle's controls is no log of this one.
                    Actuation::LoadFactors(_) | Actuation::Acceleration(_) => [f64::NAN; 4],
                };
                self.thrusts(worst, thrust_n, self.physical.thrust_n, sample.t_s);
            }
        })
    }

    /// Cable angles of the continuous plan against the physical limits.
    pub fn check_planned_swing(&self, spec: &CheckSpec, planned: &PlannedMotion) -> CheckResult {
        check_limits(spec, |worst| {
            for knot in &planned.knots {
                self.cable(worst, &knot.state, self.physical.cable_deg, knot.t_s);
            }
        })
    }

    /// Cable angles in flight against the physical limits.
    pub fn check_flown_swing(&self, spec: &CheckSpec, flown: &FlownMotion<'_>) -> CheckResult {
        check_limits(spec, |worst| {
            for sample in flown.motion.samples() {
                self.cable(worst, &sample.body, self.physical.cable_deg, sample.t_s);
            }
        })
    }

    fn attitude(&self, worst: &mut Worst<'a>, attitude: &UnitQuaternion<f64>, range: Range, t_s: f64) {
        let (roll, pitch, yaw) = attitude.euler_angles();
        for (name, angle) in [("roll", roll), ("pitch", pitch), ("yaw", yaw)] {
            worst.consider(
                self.vehicle,
                Quantity { name, unit: "deg", range, key: LimitKey::Limits("attitude_deg") },
                angle.to_degrees(),
                t_s,
            );
        }
    }

    fn cable(&self, worst: &mut Worst<'a>, body: &SlungLoadState, range: Range, t_s: f64) {
        for (name, angle) in ["cable angle alpha", "cable angle beta"].into_iter().zip(body.cable_angles_rad()) {
            worst.consider(
                self.vehicle,
                Quantity { name, unit: "deg", range, key: LimitKey::Limits("cable_deg") },
                angle.to_degrees(),
                t_s,
            );
        }
    }

    fn thrusts(&self, worst: &mut Worst<'a>, thrust_n: [f64; 4], range: Range, t_s: f64) {
        for (name, value) in ["F_1", "F_2", "F_3", "F_4"].into_iter().zip(thrust_n) {
            worst.consider(
                self.vehicle,
                Quantity { name, unit: "N", range, key: LimitKey::Limits("thrust_n") },
                value,
                t_s,
            );
        }
    }
}
