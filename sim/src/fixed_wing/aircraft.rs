use nalgebra::Vector3;
use scenarios::Vehicle;
use scenarios::fixed_wing::{Control, Model, Trajectory};

use super::attitude::world_from_body;
use super::plant::mid_step_force_n;
use super::reference::{Reference, ReferencePoint};
use super::tracker::{Tracker, saturated};
use crate::actuation::{Actuation, Commanded};
use crate::air::Air;
use crate::flight::{EventKind, Sample, VehicleLog};
use crate::kinematics::PointState;
use crate::request::{ControlMode, FlightRequest};
use crate::saturation::SaturationDetector;
use crate::sensors::{Delay, Measurement, Sensors};

/// One aircraft of the fleet, except for its body, which is in a world.
pub(super) struct Aircraft {
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
    saturation: SaturationDetector,
    is_flying: bool,
    log: VehicleLog,
}

impl Aircraft {
    /// `start`: true state at time 0.
    pub fn new(request: &FlightRequest<'_>, vehicle: &Vehicle, trajectory: &Trajectory, start: &PointState) -> Self {
        let settings = &request.scenario.simulation;
        Self {
            model: request.scenario.fixed_wing_model(vehicle).clone(),
            reference: Reference::new(trajectory),
            control_mode: request.options.control_mode,
            tracker: Tracker::new(&settings.tracker, settings.step_s),
            sensors: Sensors::new(&settings.sensors, request.stream("sensors", vehicle)),
            delay: Delay::new(settings.sensors.delay_s, settings.step_s),
            air: Air::new(request, vehicle, start),
            step_s: settings.step_s,
            control: Control::CRUISE,
            saturation: SaturationDetector::default(),
            is_flying: true,
            log: VehicleLog {
                vehicle: vehicle.name.clone(),
                samples: Vec::with_capacity(request.steps + 1),
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

    /// The mass with which load factors become forces, kg.
    pub fn nominal_mass_kg(&self) -> f64 {
        self.model.mass_kg
    }

    /// Is it still in the air?
    pub fn is_flying(&self) -> bool {
        self.is_flying
    }

    /// The log so far: one sample at time 0 and one after every step.
    pub fn samples(&self) -> &[Sample] {
        &self.log.samples
    }

    /// Removes it from the flight after a crash, and truncates its log to this number of steps.
    pub fn remove(&mut self, steps: usize) {
        self.is_flying = false;
        self.log.samples.truncate(steps + 1);
    }

    /// Beginnings and ends of saturations from step `first` on, with their times, s. Every sample is observed once,
    /// when it is certain that it will not be truncated.
    pub fn observe_saturation(&mut self, first: usize) -> Vec<(f64, EventKind)> {
        let new = if first == 0 { 0 } else { first + 1 };
        let Self { log, saturation, .. } = self;
        let samples = log.samples.iter().skip(new);
        samples.filter_map(|sample| saturation.observe(sample.t_s, sample.is_saturated())).collect()
    }

    /// Measures, computes the control of the coming step, and logs. `truth`: at `t_s`.
    pub fn decide(&mut self, t_s: f64, truth: PointState) {
        let PointState { position_m, velocity_mps } = truth;
        let measured = self.delay.pass(self.sensors.measure(position_m, velocity_mps));
        let reference = self.reference.at(t_s);
        let command = self.command(t_s, &measured, &reference);
        self.control = saturated(command, &self.model.limits);
        let wind_mps = self.air.velocity_mps(t_s);
        let sample = Sample {
            t_s,
            position_m: position_m.into(),
            velocity_mps: velocity_mps.into(),
            wind_mps: wind_mps.into(),
            world_from_body: world_from_body(&(velocity_mps - wind_mps), self.control),
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

    /// Continues the air over the step that begins at `t_s`. `truth`: as for [`decide`](Self::decide).
    pub fn begin_step(&mut self, t_s: f64, truth: &PointState) {
        self.air.begin_step(t_s, self.step_s, truth);
    }

    /// Force in the middle of a step of the plant, N.
    ///
    /// - `velocity_mps`, `mass_kg`: true velocity at its beginning, and true mass
    /// - `began_s`, `plant_step_s`: its beginning and its length
    pub fn force_n(&self, velocity_mps: Vector3<f64>, mass_kg: f64, began_s: f64, plant_step_s: f64) -> Vector3<f64> {
        let wind_mps = self.air.velocity_mps(began_s + plant_step_s / 2.0);
        mid_step_force_n(&velocity_mps, &wind_mps, self.control, self.model.mass_kg, mass_kg, plant_step_s)
    }

    /// Ends the flight. Returns the log, and an event with its time, s, if one was still pending.
    pub fn finish(mut self) -> (VehicleLog, Option<(f64, EventKind)>) {
        (self.log, self.saturation.finish())
    }
}
