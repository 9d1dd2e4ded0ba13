use nalgebra::{Vector3, Vector4};
use scenarios::multirotor::{GRAVITY_MPS2, Model, Plant};
use scenarios::{Scenario, Vehicle, slung_load};

use super::reference::{Reference, ReferencePoint};
use super::tracker::{Autopilot, Tracker, limited_mps2, turned_towards, upright_towards};
use crate::air::{Air, drag_n};
use crate::quadrotor::AttitudeState;
use crate::rapier_world::RapierWorld;
use crate::saturation::SaturationWatch;
use crate::sensors::{Delay, Measurement, Sensors};
use crate::{Actuation, Commanded, EventKind, Sample, VehicleLog};

/// One multirotor: everything about it but its body.
pub(super) struct MultirotorSim {
    index: usize,
    pub model: Model,
    tracker: Tracker,
    /// Of a quadrotor.
    autopilot: Option<Autopilot>,
    sensors: Sensors,
    delay: Delay<Measurement>,
    turning_delay: Delay<AttitudeState>,
    air: Air,
    step_s: f64,
    /// Acceleration that was decided on, m/s²: that of a point mass acts during the coming step.
    acceleration_mps2: Vector3<f64>,
    /// Thrusts that are asked for, and that the rotors give, N, of a quadrotor.
    command_n: Vector4<f64>,
    rotors_n: Vector4<f64>,
    saturation: SaturationWatch,
    pub log: VehicleLog,
}

/// A body as it is.
#[derive(Clone, Copy, Debug)]
pub(super) struct Truth {
    pub position_m: Vector3<f64>,
    pub velocity_mps: Vector3<f64>,
    pub turning: AttitudeState,
}

impl MultirotorSim {
    /// Adds its body to the world. `start`: position, m, and velocity, m/s.
    pub fn new(
        scenario: &Scenario,
        (index, vehicle): (usize, &Vehicle),
        seed: u64,
        world: &mut RapierWorld,
        start: [Vector3<f64>; 2],
    ) -> Self {
        let settings = &scenario.simulation;
        let model = scenario.multirotor_model(vehicle).clone();
        let stream = |kind: &str| scenarios::stream(seed, &format!("{kind}/{}", vehicle.name));
        let autopilot = (model.plant == Plant::Quadrotor).then(|| Autopilot::new(&model));
        let mass_kg = model.mass_kg * settings.mismatch.mass_ratio;
        let [position_m, velocity_mps] = start;
        match &autopilot {
            None => world.add_body(mass_kg, position_m, velocity_mps),
            Some(autopilot) => {
                let inertia_kgm2 = autopilot.airframe().inertia_kgm2.into();
                world.add_turning_body(mass_kg, inertia_kgm2, position_m, velocity_mps);
            }
        }
        let hover_n = autopilot.as_ref().map_or_else(Vector4::zeros, Autopilot::hover_n);
        Self {
            index,
            tracker: Tracker::new(&settings.tracker),
            autopilot,
            sensors: Sensors::new(&settings.sensors, stream("sensors")),
            delay: Delay::new(settings.sensors.delay_s, settings.step_s),
            turning_delay: Delay::new(settings.sensors.delay_s, settings.step_s),
            air: Air::new(settings.wind.as_ref(), stream("gusts")),
            step_s: settings.step_s,
            acceleration_mps2: Vector3::zeros(),
            command_n: hover_n,
            rotors_n: hover_n,
            saturation: SaturationWatch::default(),
            log: VehicleLog { vehicle: vehicle.name.clone(), samples: Vec::new(), loads: Vec::new() },
            model,
        }
    }

    pub fn name(&self) -> &str {
        &self.log.vehicle
    }

    /// The body as it is.
    pub fn truth(&self, world: &RapierWorld) -> Truth {
        let turning =
            AttitudeState { attitude: world.attitude(self.index), rate_radps: world.body_rate_radps(self.index) };
        Truth { position_m: world.position_m(self.index), velocity_mps: world.velocity_mps(self.index), turning }
    }

    /// The body as its sensors have it, once per step.
    pub fn measure(&mut self, truth: &Truth) -> Measurement {
        self.delay.pass(self.sensors.measure(truth.position_m, truth.velocity_mps))
    }

    /// Decides on the control of the coming step, and logs. Returns an event with its time, s, if there is one.
    pub fn decide(
        &mut self,
        t_s: f64,
        truth: &Truth,
        measured: &Measurement,
        reference: &Reference,
        open_loop: bool,
    ) -> Option<(f64, EventKind)> {
        let (here, ahead) = (reference.at(t_s), reference.at(t_s + self.step_s / 2.0));
        let wanted_mps2 =
            if open_loop { ahead.acceleration_mps2 } else { self.tracker.acceleration_mps2(measured, &here, &ahead) };
        let wanted_mps2 = match &self.autopilot {
            None => wanted_mps2,
            Some(_) => turned_towards(&self.acceleration_mps2, &wanted_mps2, self.step_s),
        };
        let limited = limited_mps2(&wanted_mps2, &measured.velocity_mps, &self.model.limits, self.step_s);
        self.acceleration_mps2 = limited;
        let actuation = match &self.autopilot {
            None => Actuation::Acceleration(Commanded { command: wanted_mps2.into(), control: limited.into() }),
            Some(autopilot) => {
                let turning = self.turning_delay.pass(self.sensors.measure_turning(&truth.turning));
                let [command_n, limited_n] = autopilot.thrusts_n(&turning, &wanted_mps2, &limited);
                self.command_n = limited_n;
                let control = |thrust_n: Vector4<f64>| slung_load::Control { thrust_n: thrust_n.into() };
                Actuation::Thrusts(Commanded { command: control(command_n), control: control(limited_n) })
            }
        };
        let sample = self.sample(t_s, truth, measured, &here, actuation);
        self.log.samples.push(sample);
        self.saturation.observe(t_s, sample.is_saturated())
    }

    /// Sets force and torque for the middle of the coming step of the plant. Rotors and air move on.
    pub fn push(&mut self, world: &mut RapierWorld, plant_step_s: f64) {
        let truth = self.truth(world);
        let wind_mps = self.air.velocity_mps(truth.position_m.z, &truth.velocity_mps);
        self.air.advance(plant_step_s, truth.position_m.z, (truth.velocity_mps - wind_mps).norm());
        let drag_n = drag_n(&(wind_mps - truth.velocity_mps), self.model.drag_area_m2);
        if self.autopilot.is_none() {
            let lift_n = (self.acceleration_mps2 + Vector3::z() * GRAVITY_MPS2) * self.model.mass_kg;
            world.set_force_n(self.index, lift_n + drag_n);
            return;
        }
        let thrust_n = self.update_rotors(plant_step_s);
        let Some(autopilot) = &self.autopilot else { return };
        let (total_n, torque_nm) = autopilot.rotors().wrench(&thrust_n);
        let middle = truth.turning.rate_radps * (plant_step_s / 2.0);
        let attitude = truth.turning.attitude * nalgebra::UnitQuaternion::from_scaled_axis(middle);
        world.set_force_n(self.index, attitude * Vector3::z() * total_n + drag_n);
        world.set_torque_nm(self.index, attitude * torque_nm);
    }

    /// The flight is over. Returns an event with its time, s, if one was still to come.
    pub fn finish(&mut self) -> Option<(f64, EventKind)> {
        self.saturation.finish()
    }

    /// Lets the rotors follow their command for a step of the plant; returns the thrusts in its middle, N.
    fn update_rotors(&mut self, plant_step_s: f64) -> Vector4<f64> {
        let time_constant_s = self.autopilot.as_ref().and_then(|autopilot| autopilot.airframe().rotor_time_constant_s);
        let Some(time_constant_s) = time_constant_s else {
            self.rotors_n = self.command_n;
            return self.rotors_n;
        };
        let next_n = self.command_n + (self.rotors_n - self.command_n) * (-plant_step_s / time_constant_s).exp();
        let middle_n = (self.rotors_n + next_n) / 2.0;
        self.rotors_n = next_n;
        middle_n
    }

    fn sample(
        &self,
        t_s: f64,
        truth: &Truth,
        measured: &Measurement,
        reference: &ReferencePoint,
        actuation: Actuation,
    ) -> Sample {
        // A point mass is drawn as if it tilted.
        let attitude = match self.autopilot {
            None => upright_towards(&(self.acceleration_mps2 + Vector3::z() * GRAVITY_MPS2)),
            Some(_) => truth.turning.attitude,
        };
        Sample {
            t_s,
            position_m: truth.position_m.into(),
            velocity_mps: truth.velocity_mps.into(),
            wind_mps: self.air.velocity_mps(truth.position_m.z, &truth.velocity_mps).into(),
            world_from_body: attitude.coords.into(),
            measured_position_m: measured.position_m.into(),
            measured_velocity_mps: measured.velocity_mps.into(),
            reference_position_m: reference.position_m.into(),
            reference_velocity_mps: reference.velocity_mps.into(),
            actuation,
        }
    }
}
