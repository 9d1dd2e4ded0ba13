use nalgebra::{Vector3, Vector4};
use scenarios::slung_load::{Control, Model, Trajectory};
use scenarios::{Plan, Prism, Scenario, Vehicle};

use super::cable_detector::CableDetector;
use super::dynamics::Plant;
use super::reference::{Reference, ReferencePoint};
use super::shapes::{GROUND, Part, Parts};
use super::state::SlungLoadState;
use super::tracker::{Thrusts, Tracker};
use crate::air::{Air, drag_n};
use crate::rapier_world::{AppliedForces, TetheredPair};
use crate::saturation::SaturationWatch;
use crate::sensors::{Delay, Sensors};
use crate::{
    Actuation, Commanded, ControlMode, Event, EventKind, FlightOptions, LoadSample, Sample, VehicleLog, start,
};

/// Longest step of the plant, s: an ordinary step of the simulator, for which a command is held, is divided into such.
const LONGEST_PLANT_STEP_S: f64 = 5e-4;

/// Flies a plan of quadrotors with loads for so many steps, each by itself, and returns their logs and what happened.
pub(crate) fn fly(
    scenario: &Scenario,
    plan: &Plan,
    seed: u64,
    setup: &FlightOptions,
    steps: usize,
    progress: &mut dyn FnMut(f64),
) -> (Vec<VehicleLog>, Vec<Event>) {
    let mut events = Vec::new();
    let mut logs = Vec::new();
    for (vehicle, trajectory) in scenario.vehicles.iter().zip(&plan.trajectories) {
        let sortie = SlungLoadSim::new(scenario, vehicle, trajectory.slung_load(), setup, seed);
        let (log, happened) = sortie.fly(steps, progress);
        events.extend(happened.into_iter().map(|(t_s, kind)| Event {
            t_s,
            kind,
            vehicles: vec![vehicle.name.clone()],
        }));
        logs.push(log);
    }
    (logs, events)
}

/// One quadrotor with its load.
struct SlungLoadSim {
    model: Model,
    plant: Plant,
    hoist: TetheredPair,
    reference: Reference,
    control_mode: ControlMode,
    tracker: Tracker,
    sensors: Sensors,
    delay: Delay<SlungLoadState>,
    air: Air,
    obstacles: Vec<Prism>,
    parts: Parts,
    ground_m: Option<f64>,
    step_s: f64,
    plant_steps: usize,
    /// Thrusts that the rotors give, N.
    rotors_n: Vector4<f64>,
    saturation: SaturationWatch,
    cable: CableDetector,
    /// Tension over the last step, N.
    tension_n: f64,
    log: VehicleLog,
    events: Vec<(f64, EventKind)>,
}

impl SlungLoadSim {
    fn new(scenario: &Scenario, vehicle: &Vehicle, trajectory: &Trajectory, setup: &FlightOptions, seed: u64) -> Self {
        let settings = &scenario.simulation;
        let model = scenario.slung_load_model(vehicle).clone();
        let nominal = Plant::nominal(&model, scenario.world.ground_m);
        let plant = Plant {
            mass_kg: nominal.mass_kg * settings.mismatch.mass_ratio,
            load_mass_kg: nominal.load_mass_kg * settings.mismatch.load_mass_ratio,
            ..nominal
        };
        let reference = Reference::new(trajectory, &nominal);
        let first = reference.at(0.0);
        let offset_m = start::offset_m(scenario, vehicle, setup, seed);
        let offset_mps = Vector3::from(setup.start_velocity_offset_mps);
        let start = SlungLoadState {
            position_m: first.body.position_m + offset_m,
            velocity_mps: first.body.velocity_mps + offset_mps,
            load_position_m: first.body.load_position_m + offset_m,
            load_velocity_mps: first.body.load_velocity_mps + offset_mps,
            ..first.body
        };
        let plant_steps = (settings.step_s / LONGEST_PLANT_STEP_S).ceil().max(1.0) as usize * setup.substeps();
        let stream = |kind: &str| scenarios::stream(seed, &format!("{kind}/{}", vehicle.name));
        Self {
            hoist: TetheredPair::new(&plant, model.load_radius_m, &start, settings.step_s / plant_steps as f64),
            tracker: Tracker::new(&reference, &nominal, model.limits.thrust_n, settings.step_s),
            sensors: Sensors::new(&settings.sensors, stream("sensors")),
            delay: Delay::new(settings.sensors.delay_s, settings.step_s),
            air: Air::new(settings.wind.as_ref(), stream("gusts")),
            obstacles: scenario.world.prism_obstacles(),
            parts: Parts::new(&model),
            ground_m: scenario.world.ground_m,
            step_s: settings.step_s,
            plant_steps,
            rotors_n: first.thrust_n,
            saturation: SaturationWatch::default(),
            cable: CableDetector::new(first.cable),
            tension_n: match first.cable {
                scenarios::slung_load::Cable::Taut => plant.tension_n(&start, first.thrust_n.sum()),
                scenarios::slung_load::Cable::Slack => 0.0,
            },
            log: VehicleLog { vehicle: vehicle.name.clone(), samples: Vec::new(), loads: Vec::new() },
            events: Vec::new(),
            control_mode: setup.control_mode,
            model,
            plant,
            reference,
        }
    }

    fn fly(mut self, steps: usize, progress: &mut dyn FnMut(f64)) -> (VehicleLog, Vec<(f64, EventKind)>) {
        for step in 0..=steps {
            let t_s = step as f64 * self.step_s;
            let command = self.decide(t_s);
            if let Some(obstacle) = self.touched() {
                self.events.push((t_s, EventKind::Crash { obstacle: Some(obstacle) }));
                break;
            }
            if step < steps {
                self.advance(t_s, &command);
            }
            if t_s.floor() > (t_s - self.step_s).floor() {
                progress(t_s);
            }
        }
        self.events.extend(self.saturation.finish());
        (self.log, self.events)
    }

    /// Measures, decides on the thrusts of the coming step, and logs.
    fn decide(&mut self, t_s: f64) -> Vector4<f64> {
        let truth = self.hoist.body();
        let measured = self.delay.pass(self.sensors.measure_slung_load(&truth));
        let reference = self.reference.at(t_s);
        let ahead = self.reference.at(t_s + self.step_s / 2.0);
        let thrusts = match self.control_mode {
            ControlMode::Tracker => self.tracker.command(&measured, &reference, &ahead),
            ControlMode::OpenLoop => Thrusts { command_n: ahead.thrust_n, limited_n: ahead.thrust_n },
        };
        self.record(t_s, &truth, &measured, &reference, &thrusts);
        let is_saturated = thrusts.command_n != thrusts.limited_n;
        self.events.extend(self.saturation.observe(t_s, is_saturated));
        thrusts.limited_n
    }

    fn record(
        &mut self,
        t_s: f64,
        truth: &SlungLoadState,
        measured: &SlungLoadState,
        reference: &ReferencePoint,
        thrusts: &Thrusts,
    ) {
        let wanted = &reference.body;
        let control = |thrust_n: &Vector4<f64>| Control { thrust_n: (*thrust_n).into() };
        self.log.samples.push(Sample {
            t_s,
            position_m: truth.position_m.into(),
            velocity_mps: truth.velocity_mps.into(),
            wind_mps: self.air.velocity_mps(truth.position_m.z, &truth.velocity_mps).into(),
            world_from_body: truth.attitude.coords.into(),
            measured_position_m: measured.position_m.into(),
            measured_velocity_mps: measured.velocity_mps.into(),
            reference_position_m: wanted.position_m.into(),
            reference_velocity_mps: wanted.velocity_mps.into(),
            actuation: Actuation::Thrusts(Commanded {
                command: control(&thrusts.command_n),
                control: control(&thrusts.limited_n),
            }),
        });
        self.log.loads.push(LoadSample {
            position_m: truth.load_position_m.into(),
            velocity_mps: truth.load_velocity_mps.into(),
            measured_position_m: measured.load_position_m.into(),
            measured_velocity_mps: measured.load_velocity_mps.into(),
            reference_position_m: wanted.load_position_m.into(),
            tension_n: self.tension_n,
            cable: self.cable.cable(),
        });
    }

    /// Name of an obstacle that body, cable or load touches; of the ground if the body does.
    fn touched(&self) -> Option<String> {
        let body = self.hoist.body();
        let touches = |obstacle: &&Prism| {
            // What is not a number touches.
            let is_clear = |part: &Part| {
                self.parts.distance_lower_bound_m(*part, &body, obstacle) > 0.0
                    || self.parts.distance_m(*part, &body, obstacle) > 0.0
            };
            !Part::ALL.iter().all(is_clear)
        };
        let ground =
            self.ground_m.filter(|ground_m| self.parts.height_m(&body) <= *ground_m).map(|_| GROUND.to_owned());
        ground.or_else(|| self.obstacles.iter().find(touches).map(|obstacle| obstacle.name.clone()))
    }

    /// One step under commanded thrusts, N, in small steps of the plant.
    fn advance(&mut self, t_s: f64, command_n: &Vector4<f64>) {
        let plant_step_s = self.step_s / self.plant_steps as f64;
        let mut impulse_ns = 0.0;
        for plant_step in 0..self.plant_steps {
            let loads = self.loads(command_n, plant_step_s);
            self.hoist.step(&loads);
            impulse_ns += self.hoist.impulse_ns();
            let began_s = t_s + plant_step as f64 * plant_step_s;
            let (cable, step_ns) = (self.hoist.cable(), self.hoist.impulse_ns());
            self.events.extend(self.cable.observe(began_s, plant_step_s, cable, step_ns));
        }
        self.tension_n = impulse_ns / self.step_s;
    }

    /// What acts in the middle of the coming step of the plant. Rotors and air move on.
    fn loads(&mut self, command_n: &Vector4<f64>, plant_step_s: f64) -> AppliedForces {
        let body = self.hoist.body();
        let lag = self.model.rotor_time_constant_s.map_or(0.0, |time_s| (-plant_step_s / time_s).exp());
        let next_n = command_n + (self.rotors_n - command_n) * lag;
        let thrust_n = if self.model.rotor_time_constant_s.is_some() { (self.rotors_n + next_n) / 2.0 } else { next_n };
        self.rotors_n = next_n;
        let (total_n, torque_nm) = self.plant.wrench(&thrust_n);
        let attitude =
            body.attitude * nalgebra::UnitQuaternion::from_scaled_axis(body.body_rate_radps * (plant_step_s / 2.0));
        let wind_mps = self.air.velocity_mps(body.position_m.z, &body.velocity_mps);
        self.air.advance(plant_step_s, body.position_m.z, (body.velocity_mps - wind_mps).norm());
        AppliedForces {
            force_n: attitude * Vector3::z() * total_n
                + drag_n(&(wind_mps - body.velocity_mps), self.model.drag_area_m2),
            torque_nm: attitude * torque_nm,
            load_force_n: drag_n(&(wind_mps - body.load_velocity_mps), self.model.load_drag_area_m2),
        }
    }
}
