//! Replay of a multirotor's log: its thrust or acceleration, and the air, determine its motion.

use nalgebra::{Quaternion, UnitQuaternion};
use scenarios::multirotor::Model;
use scenarios::{CheckSpec, GRAVITY_MPS2, Scenario, Simulation};
use sim::multirotor::{AppliedControls, Replay};
use sim::{Actuation, Flight, LoggedAir, Sample, VehicleLog};

use crate::verdict::evidence::CheckResult;
use crate::verdict::physics::{Defect, check_largest, difference_m};
use crate::verdict::rotors::Rotors;

/// Length of the windows at whose beginning the replay is restarted, s: about the time constant of the feedback.
const WINDOW_S: f64 = 0.2;

/// Largest distance between a log and the motion that results from its forces, restarted at the beginning of every window.
pub fn check(spec: &CheckSpec, scenario: &Scenario, flight: &Flight) -> CheckResult {
    check_largest(spec, scenario, flight, |vehicle, log| {
        Ok(largest_defect(scenario.multirotor_model(vehicle), &scenario.simulation, log))
    })
}

/// Of one vehicle. `None` if its log has no step.
fn largest_defect(model: &Model, simulation: &Simulation, log: &VehicleLog) -> Option<Defect> {
    let replay = Replay::new(model, simulation.mismatch.mass_ratio);
    let mut rotors = hovering(model);
    let (mut motion, mut began_s) = (motion(log.samples.first()?), f64::NEG_INFINITY);
    let mut worst: Option<Defect> = None;
    for pair in log.samples.windows(2) {
        let (from, to) = (&pair[0], &pair[1]);
        if from.t_s - began_s >= WINDOW_S {
            (motion, began_s) = (self::motion(from), from.t_s);
        }
        let air = LoggedAir::new(simulation.wind.as_ref(), [from, to]);
        motion = replay.advanced(motion, &lift(&mut rotors, [from, to], air.step_s()), &air);
        let logged = self::motion(to);
        let defect_m = difference_m(&(motion[0] - logged[0]), &((motion[1] - logged[1]) * WINDOW_S));
        let defect = Defect { defect_m, t_s: to.t_s };
        worst = Some(worst.map_or(defect, |worst| worst.worse(defect)));
    }
    worst
}

/// The rotors in hover.
fn hovering(model: &Model) -> Rotors {
    let time_constant_s = model.airframe.as_ref().and_then(|airframe| airframe.rotor_time_constant_s);
    Rotors::new(model.mass_kg * GRAVITY_MPS2, time_constant_s)
}

/// The lift over the step between two samples.
fn lift(rotors: &mut Rotors, [from, to]: [&Sample; 2], step_s: f64) -> AppliedControls {
    match &from.actuation {
        Actuation::Acceleration(told) => AppliedControls::Acceleration(told.control.into()),
        Actuation::Thrusts(thrusts) => AppliedControls::Thrust {
            mean_n: rotors.mean_n(thrusts.control.thrust_n.iter().sum(), step_s),
            attitude: [from, to].map(attitude),
        },
        Actuation::LoadFactors(_) => AppliedControls::Acceleration([f64::NAN; 3].into()),
    }
}

fn motion(sample: &Sample) -> [nalgebra::Vector3<f64>; 2] {
    [sample.position_m.into(), sample.velocity_mps.into()]
}

fn attitude(sample: &Sample) -> UnitQuaternion<f64> {
    let [x, y, z, w] = sample.world_from_body;
    UnitQuaternion::new_normalize(Quaternion::new(w, x, y, z))
}
