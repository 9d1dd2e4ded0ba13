//! Do states and controls stay inside their limits?
//!
//! At the planner's nodes the vehicle's planning limits count: they are the planner's own promise. The plan between the
//! nodes and the flight are judged by the physical limits, which lie farther out so that a tracker has authority left.
//! The map's limits are state limits in all three.
//!
//! Positions are judged over continuous time; speed and flight-path angle at every knot (50 ms apart at most) of the
//! plan and at every step of the flight and at the peaks of gusts, where they are those of the velocity through the air. Controls run linearly
//! between nodes, so that they are extreme at the nodes; in flight the controls that acted are judged.

use scenarios::fixed_wing::{Control, Limits, Model, Trajectory};
use scenarios::{CheckSpec, Plan, Range, Scenario};

use crate::verdict::LimitKey;
use crate::verdict::airspeed::air_velocities;
use crate::verdict::evidence::{CheckResult, Decide};
use crate::verdict::extreme::Extreme;
use crate::verdict::fixed_wing::between_rows::RowTube;
use crate::verdict::flown::FlownMotions;
use crate::verdict::map_bounds::MapBounds;
use crate::verdict::motion::Motion;
use crate::verdict::provenance::{GivenRows, NO_CONTROLS, Provenance};
use crate::verdict::reconstruction::max_turn_deg;
use crate::verdict::tolerance::SOLVER_TOLERANCE;
use crate::verdict::worst::{Quantity, Worst, check_limits};

/// States at the nodes against the planning limits. Velocities that the plan gives count as they are given; it is skipped
/// if no vehicle's are.
pub fn check_node_states(spec: &CheckSpec, scenario: &Scenario, plan: &Plan, provenance: &Provenance) -> CheckResult {
    if (0..scenario.vehicles.len()).all(|index| !provenance.gives_velocities(index)) {
        return Ok(spec.skip("the plan gives no velocities"));
    }
    check_limits(spec, |worst| {
        for (index, (limited, trajectory)) in limited_vehicles(scenario, promised).zip(&plan.trajectories).enumerate() {
            let trajectory = trajectory.fixed_wing();
            for (node, (state, &t_s)) in trajectory.states.iter().zip(&trajectory.times_s).enumerate() {
                limited.place(worst, state.position_m(), t_s);
                match provenance.given(index) {
                    GivenRows::Positions => {}
                    GivenRows::States(given_mps) => limited.velocity_vector(worst, given_mps[node], 0.0, t_s),
                    GivenRows::Everything => {
                        let flight_path_deg = state.flight_path_rad.to_degrees();
                        limited.velocity(worst, (state.speed_mps, 0.0), (flight_path_deg, 0.0), t_s);
                    }
                }
            }
        }
    })
}

/// States of the continuous plan against the physical limits.
///
/// - `coast`: how the vehicles go on after the first arrival, until the last
pub fn check_planned_states(
    spec: &CheckSpec,
    scenario: &Scenario,
    motions: &[Motion],
    coast: &[Motion],
    tubes: &[RowTube],
) -> CheckResult {
    check_limits(spec, |worst| {
        limited_vehicles(scenario, physical).zip(coast).for_each(|(limited, motion)| limited.path(worst, motion));
        for ((limited, motion), tube) in limited_vehicles(scenario, physical).zip(motions).zip(tubes) {
            limited.path(worst, motion);
            for knot in motion.knots() {
                limited.velocity_vector(worst, knot.velocity_mps, tube.tube.velocity_mps(knot.t_s), knot.t_s);
            }
        }
    })
}

/// Flown states against the physical limits.
///
/// - `motions`, `coast`: until the arrivals, and from the first arrival until the last
pub fn check_flown_states(
    spec: &CheckSpec,
    scenario: &Scenario,
    flown: &FlownMotions<'_>,
    (motions, coast): (&[Motion], &[Motion]),
    tubes: &[RowTube],
) -> CheckResult {
    check_limits(spec, |worst| {
        limited_vehicles(scenario, physical).zip(coast).for_each(|(limited, motion)| limited.path(worst, motion));
        let logs = motions.iter().zip(&flown.vehicles).zip(tubes);
        for (limited, ((motion, vehicle), tube)) in limited_vehicles(scenario, physical).zip(logs) {
            limited.path(worst, motion);
            for (t_s, air_velocity_mps) in air_velocities(scenario, vehicle.judged) {
                limited.velocity_vector(worst, air_velocity_mps, tube.tube.velocity_mps(t_s), t_s);
            }
        }
    })
}

/// Controls at the nodes, as far as vehicles give any, against the planning limits.
pub fn check_node_controls(spec: &CheckSpec, scenario: &Scenario, plan: &Plan, provenance: &Provenance) -> CheckResult {
    if (0..scenario.vehicles.len()).all(|index| !provenance.gives_controls(index)) {
        return Ok(spec.skip(NO_CONTROLS));
    }
    check_limits(spec, |worst| {
        for (index, (limited, trajectory)) in limited_vehicles(scenario, promised).zip(&plan.trajectories).enumerate() {
            if provenance.gives_controls(index) {
                limited.controls(worst, trajectory.fixed_wing());
            }
        }
    })
}

/// Controls at the nodes, reconstructed ones too, against the physical limits.
pub fn check_planned_controls(spec: &CheckSpec, scenario: &Scenario, plan: &Plan) -> CheckResult {
    check_limits(spec, |worst| {
        for (limited, trajectory) in limited_vehicles(scenario, physical).zip(&plan.trajectories) {
            limited.controls(worst, trajectory.fixed_wing());
        }
    })
}

/// Controls that acted in flight against the physical limits.
pub fn check_flown_controls(spec: &CheckSpec, scenario: &Scenario, flown: &FlownMotions<'_>) -> CheckResult {
    check_limits(spec, |worst| {
        for (limited, vehicle) in limited_vehicles(scenario, physical).zip(&flown.vehicles) {
            for sample in vehicle.judged {
                limited.control(worst, &sample.load_factors().control, sample.t_s);
            }
        }
    })
}

/// The limits that a planner promised to keep, widened by what its solver may leave.
fn promised(model: &Model) -> Limits {
    let widened = |range: Range| {
        let tolerance = SOLVER_TOLERANCE * range.width();
        if tolerance.is_finite() { Range::new(range.min - tolerance, range.max + tolerance) } else { range }
    };
    let Limits { altitude_m, speed_mps, flight_path_deg, n_x, n_y, n_z } = model.planning_limits;
    Limits {
        altitude_m: widened(altitude_m),
        speed_mps: widened(speed_mps),
        flight_path_deg: widened(flight_path_deg),
        n_x: widened(n_x),
        n_y: widened(n_y),
        n_z: widened(n_z),
    }
}

fn physical(model: &Model) -> Limits {
    model.limits.clone()
}

fn limited_vehicles<'a>(
    scenario: &'a Scenario,
    limits: impl Fn(&Model) -> Limits + 'a,
) -> impl Iterator<Item = Limited<'a>> {
    scenario.vehicles.iter().map(move |vehicle| Limited {
        vehicle: &vehicle.name,
        map: MapBounds::new(scenario, &vehicle.name, scenario.fixed_wing_model(vehicle).body_radius_m),
        limits: limits(scenario.fixed_wing_model(vehicle)),
    })
}

/// A vehicle and what it has to stay inside.
struct Limited<'a> {
    vehicle: &'a str,
    map: MapBounds<'a>,
    limits: Limits,
}

impl<'a> Limited<'a> {
    fn place(&self, worst: &mut Worst<'a>, position_m: [f64; 3], t_s: f64) {
        self.map.place(worst, position_m, t_s);
        self.altitude(worst, position_m[2], t_s);
    }

    fn path(&self, worst: &mut Worst<'a>, motion: &Motion) {
        for Extreme { value, error, t_s } in self.map.path(worst, motion) {
            worst.consider_within(self.vehicle, self.altitude_quantity(), (value, error), t_s);
        }
    }

    fn altitude(&self, worst: &mut Worst<'a>, value: f64, t_s: f64) {
        worst.consider(self.vehicle, self.altitude_quantity(), value, t_s);
    }

    fn altitude_quantity(&self) -> Quantity {
        Quantity { name: "altitude", unit: "m", range: self.limits.altitude_m, key: LimitKey::Limits("altitude_m") }
    }

    /// - `speed_mps`, `flight_path_deg`: each with its error
    fn velocity(&self, worst: &mut Worst<'a>, speed_mps: (f64, f64), flight_path_deg: (f64, f64), t_s: f64) {
        let speed =
            Quantity { name: "speed", unit: "m/s", range: self.limits.speed_mps, key: LimitKey::Limits("speed_mps") };
        let flight_path = Quantity {
            name: "flight-path angle",
            unit: "deg",
            range: self.limits.flight_path_deg,
            key: LimitKey::Limits("flight_path_deg"),
        };
        worst.consider_within(self.vehicle, speed, speed_mps, t_s);
        worst.consider_within(self.vehicle, flight_path, flight_path_deg, t_s);
    }

    fn velocity_vector(&self, worst: &mut Worst<'a>, [x, y, z]: [f64; 3], error_mps: f64, t_s: f64) {
        let horizontal = (x * x + y * y).sqrt();
        let speed_mps = (x * x + y * y + z * z).sqrt();
        let error_deg = max_turn_deg(error_mps, speed_mps);
        let flight_path_deg = z.atan2(horizontal).to_degrees();
        self.velocity(worst, (speed_mps, error_mps), (flight_path_deg, error_deg), t_s);
    }

    fn controls(&self, worst: &mut Worst<'a>, trajectory: &Trajectory) {
        for (control, &t_s) in trajectory.controls.iter().zip(&trajectory.times_s) {
            self.control(worst, control, t_s);
        }
    }

    fn control(&self, worst: &mut Worst<'a>, control: &Control, t_s: f64) {
        let named = ["n_x", "n_y", "n_z"].into_iter().zip(self.limits.controls());
        for ((name, range), value) in named.zip(control.to_array()) {
            worst.consider(self.vehicle, Quantity { name, unit: "-", range, key: LimitKey::Limits(name) }, value, t_s);
        }
    }
}
