use nalgebra::{UnitQuaternion, Vector3, Vector4};
use scenarios::multirotor::{GRAVITY_MPS2, Model, Plant};
use scenarios::{Vehicle, slung_load};

use super::reference::{Reference, ReferencePoint};
use super::state::{MultirotorState, NavigationState};
use super::tracker::{Autopilot, Tracker, jerk_limited_mps2, limited_mps2, upright_towards};
use crate::actuation::{Actuation, Commanded};
use crate::air::{Air, DragBody};
use crate::flight::{EventKind, Sample, VehicleLog};
use crate::kinematics::{AttitudeState, PointState};
use crate::quadrotor::{LaggedRotors, mid_step_wrench};
use crate::rapier_world::RapierWorld;
use crate::request::{ControlMode, FlightRequest};
use crate::saturation::SaturationDetector;
use crate::sensors::{Delay, Measurement, Sensors};
use crate::start;

/// One multirotor, except for its body, which is in the world.
pub(super) struct MultirotorSim {
    body: usize,
    model: Model,
    control_mode: ControlMode,
    tracker: Tracker,
    quadrotor: Option<QuadrotorSim>,
    sensors: Sensors,
    delay: Delay<Measurement>,
    air: Air,
    step_s: f64,
    /// Acceleration that was decided on, m/s²: that of a point mass acts during the coming step.
    acceleration_mps2: Vector3<f64>,
    saturation: SaturationDetector,
    log: VehicleLog,
}

/// What a quadrotor has beyond a point mass.
struct QuadrotorSim {
    autopilot: Autopilot,
    delay: Delay<AttitudeState>,
    /// Attitude as measured last.
    measured: UnitQuaternion<f64>,
    /// Commanded thrusts, inside their limits, N.
    command_n: Vector4<f64>,
    rotors: LaggedRotors,
}

impl QuadrotorSim {
    fn new(model: &Model, delay: Delay<AttitudeState>) -> Self {
        let autopilot = Autopilot::new(model);
        let command_n = autopilot.hover_n();
        let rotors = LaggedRotors::new(command_n, autopilot.airframe().rotor_time_constant_s);
        Self { autopilot, delay, measured: AttitudeState::level().attitude, command_n, rotors }
    }
}

impl MultirotorSim {
    /// Adds its body to the world.
    pub fn new(request: &FlightRequest<'_>, vehicle: &Vehicle, world: &mut RapierWorld) -> Self {
        let settings = &request.scenario.simulation;
        let model = request.scenario.multirotor_model(vehicle).clone();
        let delay_s = settings.sensors.delay_s;
        let quadrotor =
            (model.plant == Plant::Quadrotor).then(|| QuadrotorSim::new(&model, Delay::new(delay_s, settings.step_s)));
        let start = start_state(request, vehicle);
        Self {
            body: add_body(request, vehicle, quadrotor.as_ref(), &start, world),
            control_mode: request.options.control_mode,
            tracker: Tracker::new(&settings.tracker),
            quadrotor,
            sensors: Sensors::new(&settings.sensors, request.stream("sensors", vehicle)),
            delay: Delay::new(delay_s, settings.step_s),
            air: Air::new(request, vehicle, &start),
            step_s: settings.step_s,
            acceleration_mps2: Vector3::zeros(),
            saturation: SaturationDetector::default(),
            log: VehicleLog { vehicle: vehicle.name.clone(), samples: Vec::new(), loads: Vec::new() },
            model,
        }
    }

    pub fn name(&self) -> &str {
        &self.log.vehicle
    }

    /// Index of its body in the world.
    pub fn body(&self) -> usize {
        self.body
    }

    /// Radius of the ball about its body, m.
    pub fn body_radius_m(&self) -> f64 {
        self.model.body_radius_m
    }

    /// The true state.
    pub fn state(&self, world: &RapierWorld) -> MultirotorState {
        let PointState { position_m, velocity_mps } = world.point_state(self.body);
        MultirotorState { position_m, velocity_mps, attitude_state: world.attitude_state(self.body) }
    }

    /// Measures position and velocity, once per step.
    pub fn measure(&mut self, truth: &MultirotorState) -> Measurement {
        self.delay.pass(self.sensors.measure(truth.position_m, truth.velocity_mps))
    }

    /// What its controller knows of its motion.
    pub fn navigation(&self, measured: Measurement) -> NavigationState {
        let world_from_body = match &self.quadrotor {
            None => self.thrust_attitude(),
            Some(quadrotor) => quadrotor.measured,
        };
        NavigationState { measured, acceleration_mps2: self.acceleration_mps2, world_from_body }
    }

    /// A point mass is drawn, and navigates, as if it tilted.
    fn thrust_attitude(&self) -> UnitQuaternion<f64> {
        upright_towards(&(self.acceleration_mps2 + Vector3::z() * GRAVITY_MPS2))
    }

    /// Computes the control of the coming step, and logs. Returns an event with its time, s, if there is one.
    pub fn decide(
        &mut self,
        t_s: f64,
        truth: &MultirotorState,
        measured: &Measurement,
        reference: &Reference,
    ) -> Option<(f64, EventKind)> {
        let (here, ahead) = (reference.at(t_s), reference.at(t_s + self.step_s / 2.0));
        let desired_mps2 = match self.control_mode {
            ControlMode::Tracker => self.tracker.acceleration_mps2(measured, &here, &ahead),
            ControlMode::OpenLoop => ahead.acceleration_mps2,
        };
        let desired_mps2 = match &self.quadrotor {
            None => desired_mps2,
            Some(_) => jerk_limited_mps2(&self.acceleration_mps2, &desired_mps2, self.step_s),
        };
        let limited_mps2 = limited_mps2(&desired_mps2, &measured.velocity_mps, &self.model.limits, self.step_s);
        self.acceleration_mps2 = limited_mps2;
        let actuation = self.actuate(truth, &desired_mps2, &limited_mps2);
        let sample = self.sample(t_s, truth, measured, &here, actuation);
        self.log.samples.push(sample);
        self.saturation.observe(t_s, sample.is_saturated())
    }

    /// Turns an acceleration into the controls of the plant.
    fn actuate(
        &mut self,
        truth: &MultirotorState,
        desired_mps2: &Vector3<f64>,
        limited_mps2: &Vector3<f64>,
    ) -> Actuation {
        let Some(QuadrotorSim { autopilot, delay, measured, command_n, .. }) = &mut self.quadrotor else {
            return Actuation::Acceleration(Commanded {
                command: (*desired_mps2).into(),
                control: (*limited_mps2).into(),
            });
        };
        let attitude = delay.pass(self.sensors.measure_attitude(&truth.attitude_state));
        *measured = attitude.attitude;
        let [desired_n, limited_n] = autopilot.thrusts_n(&attitude, desired_mps2, limited_mps2);
        *command_n = limited_n;
        let control = |thrust_n: Vector4<f64>| slung_load::Control { thrust_n: thrust_n.into() };
        Actuation::Thrusts(Commanded { command: control(desired_n), control: control(limited_n) })
    }

    /// Continues the air over the simulator's step that begins at `t_s`.
    pub fn begin_step(&mut self, t_s: f64, world: &RapierWorld) {
        self.air.begin_step(t_s, self.step_s, &world.point_state(self.body));
    }

    /// Applies force and torque in the middle of a step of the plant, over which the rotors are advanced.
    ///
    /// - `began_s`, `plant_step_s`: its beginning and its length
    pub fn apply_forces(&mut self, world: &mut RapierWorld, began_s: f64, plant_step_s: f64) {
        let state = self.state(world);
        let Some(QuadrotorSim { autopilot, command_n, rotors, .. }) = &mut self.quadrotor else {
            let lift_n = (self.acceleration_mps2 + Vector3::z() * GRAVITY_MPS2) * self.model.mass_kg;
            let force_n = self.with_drag_n(lift_n, world, began_s, plant_step_s);
            world.set_force_n(self.body, force_n);
            return;
        };
        let thrust_n = rotors.advance(command_n, plant_step_s);
        let [lift_n, torque_nm] = mid_step_wrench(&autopilot.rotors(), &thrust_n, &state.attitude_state, plant_step_s);
        let force_n = self.with_drag_n(lift_n, world, began_s, plant_step_s);
        world.set_force_n(self.body, force_n);
        world.set_torque_nm(self.body, torque_nm);
    }

    /// Lift and drag in the middle of a step of the plant, N.
    fn with_drag_n(&self, lift_n: Vector3<f64>, world: &RapierWorld, began_s: f64, plant_step_s: f64) -> Vector3<f64> {
        let body = DragBody {
            drag_area_m2: self.model.drag_area_m2,
            mass_kg: world.mass_kg(self.body),
            velocity_mps: world.point_state(self.body).velocity_mps,
        };
        let wind_mps = self.air.velocity_mps(began_s + plant_step_s / 2.0);
        let weight_n = Vector3::z() * (-GRAVITY_MPS2 * body.mass_kg);
        lift_n + body.mid_step_drag_n(&wind_mps, &(lift_n + weight_n), plant_step_s)
    }

    /// Ends the flight. Returns the log, and an event with its time, s, if one was still pending.
    pub fn finish(mut self) -> (VehicleLog, Option<(f64, EventKind)>) {
        (self.log, self.saturation.finish())
    }

    fn sample(
        &self,
        t_s: f64,
        truth: &MultirotorState,
        measured: &Measurement,
        reference: &ReferencePoint,
        actuation: Actuation,
    ) -> Sample {
        let attitude = match self.quadrotor {
            None => self.thrust_attitude(),
            Some(_) => truth.attitude_state.attitude,
        };
        Sample {
            t_s,
            position_m: truth.position_m.into(),
            velocity_mps: truth.velocity_mps.into(),
            wind_mps: self.air.velocity_mps(t_s).into(),
            world_from_body: attitude.coords.into(),
            measured_position_m: measured.position_m.into(),
            measured_velocity_mps: measured.velocity_mps.into(),
            reference_position_m: reference.position_m.into(),
            reference_velocity_mps: reference.velocity_mps.into(),
            actuation,
        }
    }
}

/// The true start of a vehicle.
fn start_state(request: &FlightRequest<'_>, vehicle: &Vehicle) -> PointState {
    let offset = start::offset(request, vehicle);
    PointState {
        position_m: Vector3::from(vehicle.start.position_m()) + offset.position_m,
        velocity_mps: Vector3::from(vehicle.start.velocity_mps()) + offset.velocity_mps,
    }
}

/// Adds the body of a vehicle: level, and at rest about its axes. Returns its index.
fn add_body(
    request: &FlightRequest<'_>,
    vehicle: &Vehicle,
    quadrotor: Option<&QuadrotorSim>,
    start: &PointState,
    world: &mut RapierWorld,
) -> usize {
    let mass_kg = request.scenario.multirotor_model(vehicle).mass_kg * request.scenario.simulation.mismatch.mass_ratio;
    match quadrotor {
        None => world.add_point_mass(mass_kg, start),
        Some(QuadrotorSim { autopilot, .. }) => {
            let inertia_kgm2 = autopilot.airframe().inertia_kgm2.into();
            world.add_rigid_body(mass_kg, &inertia_kgm2, start, &AttitudeState::level())
        }
    }
}
