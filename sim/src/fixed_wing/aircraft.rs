use nalgebra::Vector3;
use scenarios::fixed_wing::{Control, Model, Trajectory};
use scenarios::{Scenario, Vehicle};

use super::tracker::{Tracker, saturated};
use super::{Reference, ReferencePoint, mid_step_force_n, world_from_body};
use crate::air::Air;
use crate::saturation::SaturationWatch;
use crate::sensors::{Delay, Measurement, Sensors};
use crate::{Actuation, Commanded, ControlMode, EventKind, Sample, VehicleLog};

/// One aircraft of the fleet: everything about it but its body.
pub(crate) struct Aircraft {
    model: Model,
    reference: Reference,
    control_mode: ControlMode,
    tracker: Tracker,
    sensors: Sensors,
    delay: Delay<Measurement>,
    air: Air,
    step_s: f64,
    /// Load factors that act during the coming step.
    control: Control,
    /// Velocity of the air at the coming step's beginning, m/s.
    wind_mps: Vector3<f64>,
    /// The same at its end, m/s.
    wind_ahead_mps: Vector3<f64>,
    saturation: SaturationWatch,
    is_flying: bool,
    log: VehicleLog,
}

impl Aircraft {
    /// `steps`: how many will be flown, for the log's size.
    pub fn new(
        scenario: &Scenario,
        vehicle: &Vehicle,
        trajectory: &Trajectory,
        control_mode: ControlMode,
        seed: u64,
        steps: usize,
    ) -> Self {
        let settings = &scenario.simulation;
        let stream = |kind: &str| scenarios::stream(seed, &format!("{kind}/{}", vehicle.name));
        Self {
            model: scenario.fixed_wing_model(vehicle).clone(),
            reference: Reference::new(trajectory),
            control_mode,
            tracker: Tracker::new(&settings.tracker, settings.step_s),
            sensors: Sensors::new(&settings.sensors, stream("sensors")),
            delay: Delay::new(settings.sensors.delay_s, settings.step_s),
            air: Air::new(settings.wind.as_ref(), stream("gusts")),
            step_s: settings.step_s,
            control: Control::CRUISE,
            wind_mps: Vector3::zeros(),
            wind_ahead_mps: Vector3::zeros(),
            saturation: SaturationWatch::default(),
            is_flying: true,
            log: VehicleLog {
                vehicle: vehicle.name.clone(),
                samples: Vec::with_capacity(steps + 1),
                loads: Vec::new(),
            },
        }
    }

    /// Name of the vehicle.
    pub fn name(&self) -> &str {
        &self.log.vehicle
    }

    /// Radius of its body, m.
    pub fn body_radius_m(&self) -> f64 {
        self.model.body_radius_m
    }

    /// The mass that its load factors are computed with, kg.
    pub fn nominal_mass_kg(&self) -> f64 {
        self.model.mass_kg
    }

    /// Is it still in the air?
    pub fn is_flying(&self) -> bool {
        self.is_flying
    }

    /// Its log so far: one sample at time 0 and one after every step.
    pub fn samples(&self) -> &[Sample] {
        &self.log.samples
    }

    /// It crashed: what it did after so many steps never happened.
    pub fn remove(&mut self, steps: usize) {
        self.is_flying = false;
        self.log.samples.truncate(steps + 1);
    }

    /// Beginnings and ends of saturations, with their times, s, from step `first` on: to be called once for every sample,
    /// when it is certain that it stays.
    pub fn saturations(&mut self, first: usize) -> Vec<(f64, EventKind)> {
        let new = if first == 0 { 0 } else { first + 1 };
        let Self { log, saturation, .. } = self;
        let samples = log.samples.iter().skip(new);
        samples.filter_map(|sample| saturation.observe(sample.t_s, sample.is_saturated())).collect()
    }

    /// Measures, decides on the control of the coming step, and logs. `position_m`, `velocity_mps`: the truth at `t_s`.
    pub fn decide(&mut self, t_s: f64, position_m: Vector3<f64>, velocity_mps: Vector3<f64>) {
        let measured = self.delay.pass(self.sensors.measure(position_m, velocity_mps));
        let reference = self.reference.at(t_s);
        let command = self.command(t_s, &measured, &reference);
        self.control = saturated(command, &self.model.limits);
        self.wind_mps = self.air.velocity_mps(position_m.z, &velocity_mps);
        let sample = Sample {
            t_s,
            position_m: position_m.into(),
            velocity_mps: velocity_mps.into(),
            wind_mps: self.wind_mps.into(),
            world_from_body: world_from_body(&(velocity_mps - self.wind_mps), self.control),
            measured_position_m: measured.position_m.into(),
            measured_velocity_mps: measured.velocity_mps.into(),
            reference_position_m: reference.position_m.into(),
            reference_velocity_mps: reference.velocity_mps.into(),
            actuation: Actuation::LoadFactors(Commanded { command, control: self.control }),
        };
        self.log.samples.push(sample);
    }

    fn command(&self, t_s: f64, measured: &Measurement, reference: &ReferencePoint) -> Control {
        let ahead = self.reference.at(t_s + self.step_s / 2.0);
        match self.control_mode {
            ControlMode::Tracker => self.tracker.command(measured, reference, &ahead),
            ControlMode::OpenLoop => ahead.control,
        }
    }

    /// The air moves on by the coming step. The truth at its beginning, for which [`decide`](Self::decide) was called.
    pub fn advance_wind(&mut self, position_m: Vector3<f64>, velocity_mps: Vector3<f64>) {
        self.air.advance(self.step_s, position_m.z, (velocity_mps - self.wind_mps).norm());
        self.wind_ahead_mps = self.air.velocity_mps(position_m.z, &velocity_mps);
    }

    /// Force in the middle of a step of the plant, N.
    ///
    /// - `velocity_mps`, `mass_kg`: the truth at the plant step's beginning
    /// - `middle`: where its middle is in the coming step, in [0, 1]
    /// - `share`: its length, as a share of that step
    pub fn force_n(&self, velocity_mps: Vector3<f64>, mass_kg: f64, middle: f64, share: f64) -> Vector3<f64> {
        let wind_mps = self.wind_mps * (1.0 - middle) + self.wind_ahead_mps * middle;
        let step_s = self.step_s * share;
        mid_step_force_n(&velocity_mps, &wind_mps, self.control, self.model.mass_kg, mass_kg, step_s)
    }

    /// The flight is over. Returns the log, and an event with its time, s, if one was still to come.
    pub fn finish(mut self) -> (VehicleLog, Option<(f64, EventKind)>) {
        (self.log, self.saturation.finish())
    }
}
