//! Does the flight obey the equations of motion? What carries the vehicle stands in its log, and so does the air: they must
//! explain where it goes.

use nalgebra::{Quaternion, UnitQuaternion};
use scenarios::Scenario;
use scenarios::multirotor::Model;
use sim::multirotor::{Lift, Replay};
use sim::{Actuation, Flight, Sample, VehicleLog};

use crate::verdict::Check;
use crate::verdict::physics::{self, Defect, difference_m};
use crate::verdict::question::Evidence;

/// Length of the windows at whose beginning the replay starts anew, s: about the time in which the feedback acts.
const WINDOW_S: f64 = 0.2;

/// Largest distance between a log and where its forces lead, restarted at the beginning of every window.
pub fn check(scenario: &Scenario, flight: Evidence<'_, Flight>) -> Check {
    physics::answer(scenario, flight, physics::LIMIT_M, |vehicle, log| {
        Ok(largest_defect(scenario.multirotor_model(vehicle), scenario.simulation.mismatch.mass_ratio, log))
    })
}

/// Of one vehicle. `None` if its log holds no step.
fn largest_defect(model: &Model, mass_ratio: f64, log: &VehicleLog) -> Option<Defect> {
    let replay = Replay::new(model, mass_ratio);
    let mut rotors = Rotors::of(model);
    let (mut motion, mut began_s) = (motion(log.samples.first()?), f64::NEG_INFINITY);
    let mut worst: Option<Defect> = None;
    for pair in log.samples.windows(2) {
        let (from, to) = (&pair[0], &pair[1]);
        if from.t_s - began_s >= WINDOW_S {
            (motion, began_s) = (self::motion(from), from.t_s);
        }
        let step_s = to.t_s - from.t_s;
        let wind_mps = [from.wind_mps.into(), to.wind_mps.into()];
        motion = replay.advanced(motion, &rotors.lift([from, to], step_s), wind_mps, step_s);
        let logged = self::motion(to);
        let defect_m = difference_m(&(motion[0] - logged[0]), &((motion[1] - logged[1]) * WINDOW_S));
        let defect = Defect { defect_m, t_s: to.t_s };
        worst = Some(worst.map_or(defect, |worst| worst.worse(defect)));
    }
    worst
}

/// The rotors of a quadrotor, which follow their command with a lag, if they have one.
struct Rotors {
    total_n: f64,
    time_constant_s: Option<f64>,
}

impl Rotors {
    /// As they hover.
    fn of(model: &Model) -> Self {
        let time_constant_s = model.airframe.as_ref().and_then(|airframe| airframe.rotor_time_constant_s);
        Self { total_n: model.mass_kg * scenarios::multirotor::GRAVITY_MPS2, time_constant_s }
    }

    /// What carries the vehicle over the step between two samples.
    fn lift(&mut self, [from, to]: [&Sample; 2], step_s: f64) -> Lift {
        match &from.actuation {
            Actuation::Acceleration(told) => Lift::Acceleration(told.control.into()),
            Actuation::Thrusts(thrusts) => Lift::Thrust {
                mean_n: self.mean_n(thrusts.control.thrust_n.iter().sum(), step_s),
                attitude: [from, to].map(attitude),
            },
            Actuation::LoadFactors(_) => Lift::Acceleration([f64::NAN; 3].into()),
        }
    }

    /// Mean total thrust over a step under a command, N.
    fn mean_n(&mut self, command_n: f64, step_s: f64) -> f64 {
        let Some(time_s) = self.time_constant_s else { return command_n };
        let ahead_n = self.total_n - command_n;
        let lag = (-step_s / time_s).exp();
        self.total_n = command_n + ahead_n * lag;
        command_n + ahead_n * (1.0 - lag) * time_s / step_s
    }
}

fn motion(sample: &Sample) -> [nalgebra::Vector3<f64>; 2] {
    [sample.position_m.into(), sample.velocity_mps.into()]
}

fn attitude(sample: &Sample) -> UnitQuaternion<f64> {
    let [x, y, z, w] = sample.world_from_body;
    UnitQuaternion::new_normalize(Quaternion::new(w, x, y, z))
}
