//! Replay of a slung-load log.
//!
//! Momentum: the logged thrusts, tension and air determine the motion of quadrotor and load. Complementarity of the cable: it
//! is never longer than its length, never pushes, and pulls only at its full length.

use nalgebra::Vector3;
use scenarios::slung_load::{GRAVITY_MPS2, Trajectory};
use scenarios::{CheckSpec, Plan, Scenario, Vehicle, Wind};
use sim::slung_load::{AppliedControls, Plant, Replay, SlungLoadState};
use sim::{Actuation, Flight, LoggedAir, VehicleLog};

use super::flown::motion_sample;
use crate::verdict::compare::{is_larger, larger};
use crate::verdict::evidence::CheckResult;
use crate::verdict::missing_evidence::MissingEvidence;
use crate::verdict::physics::{Defect, check_largest, difference_m};
use crate::verdict::rotors::Rotors;

/// Length of the windows at whose beginning the replay is restarted, s: about the time constant of the feedback.
const WINDOW_S: f64 = 0.1;
/// The ground may support a load that is this close to its resting height, and the log does not contain that force, m. From
/// there it also supports the load for an unknown part of the step in which the cable lifts it off.
const NEAR_GROUND_M: f64 = 1e-3;
/// Tension below which a cable does not pull, N: rounding.
const MIN_PULL_N: f64 = 1e-6;

/// Largest distance between the log and the motion that results from its thrusts, tension and air, restarted at the beginning
/// of every window.
pub fn check(spec: &CheckSpec, scenario: &Scenario, plan: &Plan, flight: &Flight) -> CheckResult {
    check_largest(spec, scenario, flight, |vehicle, log| {
        LogReplay::new(scenario, vehicle, plan.trajectories[0].slung_load()).largest_defect(log)
    })
}

/// A vehicle and the models that its log is compared with.
struct LogReplay<'a> {
    replay: Replay,
    plant: Plant,
    /// At the beginning of the flight: with the first thrust of the plan.
    rotors: Rotors,
    wind: Option<&'a Wind>,
    vehicle: &'a str,
}

impl<'a> LogReplay<'a> {
    /// A vehicle of the scenario on a trajectory.
    fn new(scenario: &'a Scenario, vehicle: &'a Vehicle, trajectory: &Trajectory) -> Self {
        let (model, mismatch) = (scenario.slung_load_model(vehicle), &scenario.simulation.mismatch);
        let nominal = Plant::nominal(model, scenario.world.ground_m);
        let plant = Plant {
            mass_kg: nominal.mass_kg * mismatch.mass_ratio,
            load_mass_kg: nominal.load_mass_kg * mismatch.load_mass_ratio,
            ..nominal
        };
        let first_n = trajectory.controls.first().map_or(f64::NAN, |control| control.thrust_n.iter().sum());
        Self {
            replay: Replay::new(model, &plant),
            plant,
            rotors: Rotors::new(first_n, model.rotor_time_constant_s),
            wind: scenario.simulation.wind.as_ref(),
            vehicle: &vehicle.name,
        }
    }

    /// Largest defect of a log. `None` if it has no step.
    ///
    /// The log does not contain the instants within a step at which the cable pulled. The displacement that this leaves open,
    /// half a step times the change of velocity by what the tension differs from that of the steps around, is subtracted.
    fn largest_defect(&self, log: &VehicleLog) -> Result<Option<Defect>, MissingEvidence> {
        let (samples, loads) = (log.samples.len(), log.loads.len());
        if loads != samples {
            return Err(MissingEvidence::LoadSampleCount { vehicle: self.vehicle.to_owned(), samples, loads });
        }
        let bodies: Vec<SlungLoadState> =
            log.samples.iter().zip(&log.loads).map(|both| motion_sample(both).body).collect();
        let mut rotors = self.rotors;
        let (mut motion, mut began_s, mut allowance_m) = (None, f64::NEG_INFINITY, 0.0);
        let mut worst: Option<Defect> = None;
        for step in 1..log.samples.len() {
            let (from, to) = (&log.samples[step - 1], &log.samples[step]);
            let step_s = to.t_s - from.t_s;
            let supported_s = if self.is_near_ground(&bodies[step - 1]) { step_s } else { 0.0 };
            let has_lifted_off = step > 1 && self.is_near_ground(&bodies[step - 2]);
            if from.t_s - began_s >= WINDOW_S || supported_s > 0.0 || has_lifted_off {
                (motion, began_s, allowance_m) = (None, from.t_s, 0.0);
            }
            let tension_n = log.loads[step].tension_n;
            let applied = AppliedControls {
                thrust_n: rotors.mean_n(commanded_n(&from.actuation), step_s),
                attitude: [bodies[step - 1].attitude, bodies[step].attitude],
                tension_n,
                air: LoggedAir::new(self.wind, [from, to]),
            };
            let flown = self.replay.advanced(&motion.unwrap_or(bodies[step - 1]), &applied);
            motion = Some(flown);
            let around = [Some(&log.loads[step - 1]), log.loads.get(step + 1)].into_iter().flatten();
            let changes_n = around.map(|load| (tension_n - load.tension_n).abs());
            let change_ns = changes_n.fold(0.0, larger) * step_s;
            allowance_m += 0.5 * step_s * change_ns / self.plant.load_mass_kg;
            let defects_m = [
                self.momentum_m(&flown, &bodies[step], supported_s, allowance_m),
                self.cable_m([&bodies[step - 1], &bodies[step]], tension_n, step_s),
            ];
            let largest_m = if is_larger(defects_m[1], defects_m[0]) { defects_m[1] } else { defects_m[0] };
            let defect = Defect { defect_m: largest_m, t_s: to.t_s };
            worst = Some(worst.map_or(defect, |worst| worst.worse(defect)));
        }
        Ok(worst)
    }

    /// Difference between replay and log, m.
    ///
    /// - `supported_s`: the time during which the ground may have carried up to the load's weight, which the replay lacks, s
    fn momentum_m(&self, flown: &SlungLoadState, logged: &SlungLoadState, supported_s: f64, allowance_m: f64) -> f64 {
        let quadrotor = difference_m(
            &(flown.position_m - logged.position_m),
            &((flown.velocity_mps - logged.velocity_mps) * WINDOW_S),
        );
        let support_mps = GRAVITY_MPS2 * supported_s;
        let load = difference_m(
            &without_support(flown.load_position_m - logged.load_position_m, support_mps * supported_s / 2.0),
            &(without_support(flown.load_velocity_mps - logged.load_velocity_mps, support_mps) * WINDOW_S),
        );
        let load = if self.is_near_ground(logged) { 0.0 } else { load };
        let larger_m = if is_larger(load, quadrotor) { load } else { quadrotor };
        if larger_m <= allowance_m { 0.0 } else { larger_m - allowance_m }
    }

    /// Violation of the cable's complementarity, m. A push counts by the distance that it moves the load in a window.
    fn cable_m(&self, ends: [&SlungLoadState; 2], tension_n: f64, step_s: f64) -> f64 {
        let lengths_m = ends.map(|body| body.cable_m().norm());
        let stretch_m = lengths_m[1] - self.plant.cable_length_m;
        let push_m = -tension_n / self.plant.load_mass_kg * WINDOW_S * WINDOW_S / 2.0;
        // A cable that pulled during a step was taut at some instant of it.
        let moved_m = (ends[0].load_relative_mps().norm().max(ends[1].load_relative_mps().norm())) * step_s;
        let short_m = self.plant.cable_length_m - lengths_m[0].max(lengths_m[1]) - moved_m;
        let slack_pull_m = if tension_n > MIN_PULL_N { short_m } else { 0.0 };
        let violations_m = [stretch_m, push_m, slack_pull_m].into_iter();
        violations_m.fold(0.0, |worst, value| if is_larger(value, worst) { value } else { worst })
    }

    fn is_near_ground(&self, body: &SlungLoadState) -> bool {
        body.load_position_m.z <= self.plant.resting_height_m + NEAR_GROUND_M
    }
}

/// What remains of a difference between replay and log if the ground may have raised the load by up to `most`.
fn without_support(difference: Vector3<f64>, most: f64) -> Vector3<f64> {
    // clamp() panics where a damaged log makes `most` NaN or negative.
    let raised = (-difference.z).max(0.0).min(most.max(0.0));
    difference + Vector3::z() * raised
}

/// Commanded total thrust, N.
fn commanded_n(actuation: &Actuation) -> f64 {
    match actuation {
        Actuation::Thrusts(thrusts) => thrusts.control.thrust_n.iter().sum(),
        Actuation::LoadFactors(_) | Actuation::Acceleration(_) => f64::NAN,
    }
}

#[cfg(test)]
mod tests {
    use nalgebra::UnitQuaternion;
    use scenarios::Interpolation;

    use super::*;

    /// Replay in a shipped scenario.
    fn with_replay(assertions: impl Fn(&LogReplay<'_>)) {
        let scenario = scenarios::load("shipped:drop-and-catch".as_ref()).expect("a shipped scenario");
        let trajectory = Trajectory {
            vehicle: scenario.vehicles[0].name.clone(),
            interpolation: Interpolation::FirstOrderHold,
            times_s: Vec::new(),
            states: Vec::new(),
            controls: Vec::new(),
            cable: Vec::new(),
            planner_nodes: Vec::new(),
        };
        assertions(&LogReplay::new(&scenario, &scenario.vehicles[0], &trajectory));
    }

    /// Quadrotor at rest `cable_m` above its load, which moves at `load_mps` downwards.
    fn above(load_z_m: f64, cable_m: f64, load_mps: f64) -> SlungLoadState {
        SlungLoadState {
            position_m: Vector3::new(1.0, 2.0, load_z_m + cable_m),
            velocity_mps: Vector3::zeros(),
            attitude: UnitQuaternion::identity(),
            body_rate_radps: Vector3::zeros(),
            load_position_m: Vector3::new(1.0, 2.0, load_z_m),
            load_velocity_mps: Vector3::new(0.0, 0.0, -load_mps),
        }
    }

    #[test]
    fn a_load_off_its_momentum_is_a_defect_in_the_air_and_not_on_the_ground() {
        with_replay(|replay| {
            let rest_m = replay.plant.resting_height_m;
            let off = |height_m: f64| {
                let logged = above(rest_m + height_m, 0.5, 0.0);
                let mut flown = logged;
                flown.load_position_m.x += 0.25;
                replay.momentum_m(&flown, &logged, 0.0, 0.05)
            };
            assert!((off(1.0) - 0.2).abs() < 1e-12, "{}", off(1.0));
            assert!((off(2.0 * NEAR_GROUND_M) - 0.2).abs() < 1e-12, "{}", off(2.0 * NEAR_GROUND_M));
            assert_eq!(off(0.5 * NEAR_GROUND_M).to_bits(), 0.0_f64.to_bits());
            // A velocity counts by what it does in a window.
            let logged = above(rest_m + 1.0, 0.5, 0.0);
            let flown = above(rest_m + 1.0, 0.5, 2.0);
            assert!((replay.momentum_m(&flown, &logged, 0.0, 0.0) - 2.0 * WINDOW_S).abs() < 1e-12);
        });
    }

    /// A cable lifts the load off the ground within a step of 10 ms, at up to 0.0981 m/s faster than without the ground.
    #[test]
    fn the_ground_carries_a_load_until_it_is_lifted_off_and_pushes_it_no_further() {
        with_replay(|replay| {
            let lifted = above(replay.plant.resting_height_m + 0.02, 0.5, -1.0);
            let defect_m = |raised_mps: f64, sideways_mps: f64, supported_s: f64| {
                let mut logged = lifted;
                logged.load_velocity_mps += Vector3::new(sideways_mps, 0.0, raised_mps);
                replay.momentum_m(&lifted, &logged, supported_s, 0.0)
            };
            let is = |found: f64, expected: f64| (found - expected).abs() < 1e-12;
            assert!(is(defect_m(0.05, 0.0, 0.01), 0.0));
            assert!(is(defect_m(0.05, 0.0, 0.0), 0.05 * WINDOW_S));
            assert!(is(defect_m(0.1981, 0.0, 0.01), 0.1 * WINDOW_S));
            assert!(is(defect_m(-0.05, 0.0, 0.01), 0.05 * WINDOW_S));
            assert!(is(defect_m(0.05, 0.1, 0.01), 0.1 * WINDOW_S));
            assert!(defect_m(f64::NAN, 0.0, 0.01).is_nan());
            // Times of a damaged log.
            for supported_s in [f64::NAN, -0.01] {
                assert!(is(defect_m(0.05, 0.0, supported_s), 0.05 * WINDOW_S));
            }
        });
    }

    #[test]
    fn a_cable_neither_stretches_nor_pushes_nor_pulls_while_it_is_slack() {
        with_replay(|replay| {
            let length_m = replay.plant.cable_length_m;
            let defect_m = |lengths_m: [f64; 2], tension_n: f64, load_mps: f64| {
                let ends = lengths_m.map(|cable_m| above(5.0, cable_m, load_mps));
                replay.cable_m([&ends[0], &ends[1]], tension_n, 0.01)
            };
            let is = |found: f64, expected: f64| (found - expected).abs() < 1e-12;
            assert!(is(defect_m([length_m, length_m + 0.03], 1.0, 0.0), 0.03));
            assert!(is(defect_m([length_m, length_m], 1.0, 0.0), 0.0));
            let push_m = 2.0 / replay.plant.load_mass_kg * WINDOW_S * WINDOW_S / 2.0;
            assert!(is(defect_m([length_m, length_m], -2.0, 0.0), push_m));
            // Slack by 0.2 m at best; the load may take up 0.01 m in the step.
            let slack = [length_m - 0.3, length_m - 0.2];
            assert!(is(defect_m(slack, 1.0, 0.0), 0.2));
            assert!(is(defect_m(slack, 1.0, 1.0), 0.19));
            assert!(is(defect_m(slack, 0.0, 0.0), 0.0));
            // Whichever end of the step is faster.
            for speeds_mps in [[0.0, 2.0], [2.0, 0.0]] {
                let ends = [0, 1].map(|end| above(5.0, slack[end], speeds_mps[end]));
                assert!(is(replay.cable_m([&ends[0], &ends[1]], 1.0, 0.01), 0.18));
            }
            // Taut at one end of the step is enough.
            assert!(is(defect_m([length_m, length_m - 0.2], 1.0, 0.0), 0.0));
        });
    }
}
