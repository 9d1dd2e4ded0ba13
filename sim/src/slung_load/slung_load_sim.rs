use nalgebra::Vector4;
use scenarios::slung_load::{Cable, Control, Model, Trajectory};
use scenarios::{Plan, Prism, Vehicle};

use super::cable_detector::CableDetector;
use super::dynamics::Plant;
use super::reference::{Reference, ReferencePoint};
use super::shapes::{Part, Parts};
use super::state::SlungLoadState;
use super::tethered_pair::{AppliedForces, TetheredPair};
use super::tracker::{Thrusts, Tracker};
use crate::actuation::{Actuation, Commanded};
use crate::air::{Air, drag_n};
use crate::collision::GROUND;
use crate::flight::{Event, EventKind, FleetLog, LoadSample, Sample, VehicleLog};
use crate::kinematics::PointState;
use crate::quadrotor::{LaggedRotors, mid_step_wrench};
use crate::request::{ControlMode, FlightRequest};
use crate::saturation::SaturationDetector;
use crate::sensors::{Delay, Sensors};
use crate::start;

/// Maximum step of the plant, s. A step of the simulator, for which a command is held, is divided into plant steps.
const MAX_PLANT_STEP_S: f64 = 5e-4;

/// Simulates quadrotors with slung loads that fly a plan, one after the other.
pub(crate) fn simulate(request: &FlightRequest<'_>, plan: &Plan, progress: &mut dyn FnMut(f64)) -> FleetLog {
    let (mut vehicles, mut events) = (Vec::new(), Vec::new());
    for (vehicle, trajectory) in request.scenario.vehicles.iter().zip(&plan.trajectories) {
        let sim = SlungLoadSim::new(request, vehicle, trajectory.slung_load());
        let (log, of_vehicle) = sim.fly(request, progress);
        events.extend(of_vehicle.into_iter().map(|event| Event::of_vehicle(&vehicle.name, event)));
        vehicles.push(log);
    }
    FleetLog { vehicles, events, in_loop: None }
}

/// One quadrotor with its load.
struct SlungLoadSim {
    model: Model,
    plant: Plant,
    pair: TetheredPair,
    rotors: LaggedRotors,
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
    saturation: SaturationDetector,
    cable: CableDetector,
    /// Mean tension over the last step, N.
    tension_n: f64,
    log: VehicleLog,
    events: Vec<(f64, EventKind)>,
}

impl SlungLoadSim {
    fn new(request: &FlightRequest<'_>, vehicle: &Vehicle, trajectory: &Trajectory) -> Self {
        let (scenario, settings) = (request.scenario, &request.scenario.simulation);
        let model = scenario.slung_load_model(vehicle).clone();
        let nominal = Plant::nominal(&model, scenario.world.ground_m);
        let plant = Plant {
            mass_kg: nominal.mass_kg * settings.mismatch.mass_ratio,
            load_mass_kg: nominal.load_mass_kg * settings.mismatch.load_mass_ratio,
            ..nominal
        };
        let reference = Reference::new(trajectory, &nominal);
        let first = reference.at(0.0);
        let start = start_state(request, vehicle, &first.state);
        let plant_steps = (settings.step_s / MAX_PLANT_STEP_S).ceil().max(1.0) as usize * request.options.substeps();
        Self {
            pair: TetheredPair::new(&plant, model.load_radius_m, &start, settings.step_s / plant_steps as f64),
            rotors: LaggedRotors::new(first.thrust_n, model.rotor_time_constant_s),
            tracker: Tracker::new(&reference, &nominal, model.limits.thrust_n, settings.step_s),
            sensors: Sensors::new(&settings.sensors, request.stream("sensors", vehicle)),
            delay: Delay::new(settings.sensors.delay_s, settings.step_s),
            air: Air::new(settings.wind.as_ref(), request.stream("gusts", vehicle)),
            obstacles: scenario.world.prism_obstacles(),
            parts: Parts::new(&model),
            ground_m: scenario.world.ground_m,
            step_s: settings.step_s,
            plant_steps,
            saturation: SaturationDetector::default(),
            cable: CableDetector::new(first.cable),
            tension_n: match first.cable {
                Cable::Taut => plant.tension_n(&start, first.thrust_n.sum()),
                Cable::Slack => 0.0,
            },
            log: VehicleLog { vehicle: vehicle.name.clone(), samples: Vec::new(), loads: Vec::new() },
            events: Vec::new(),
            control_mode: request.options.control_mode,
            model,
            plant,
            reference,
        }
    }

    /// Simulates the flight. Returns the log, and the events with their times, s.
    fn fly(
        mut self,
        request: &FlightRequest<'_>,
        progress: &mut dyn FnMut(f64),
    ) -> (VehicleLog, Vec<(f64, EventKind)>) {
        for step in 0..=request.steps {
            let t_s = request.time_s(step);
            let command_n = self.decide(t_s);
            if let Some(obstacle) = self.collision() {
                self.events.push((t_s, EventKind::Crash { obstacle: Some(obstacle) }));
                break;
            }
            if step < request.steps {
                self.advance(t_s, &command_n);
            }
            request.report_second(t_s, progress);
        }
        self.events.extend(self.saturation.finish());
        (self.log, self.events)
    }

    /// Measures, computes the thrusts of the coming step, N, and logs.
    fn decide(&mut self, t_s: f64) -> Vector4<f64> {
        let truth = self.pair.state();
        let measured = self.delay.pass(truth.measured_by(&mut self.sensors));
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
        let desired = &reference.state;
        let control = |thrust_n: &Vector4<f64>| Control { thrust_n: (*thrust_n).into() };
        self.log.samples.push(Sample {
            t_s,
            position_m: truth.position_m.into(),
            velocity_mps: truth.velocity_mps.into(),
            wind_mps: self.air.velocity_mps(truth.position_m.z, &truth.velocity_mps).into(),
            world_from_body: truth.attitude.coords.into(),
            measured_position_m: measured.position_m.into(),
            measured_velocity_mps: measured.velocity_mps.into(),
            reference_position_m: desired.position_m.into(),
            reference_velocity_mps: desired.velocity_mps.into(),
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
            reference_position_m: desired.load_position_m.into(),
            tension_n: self.tension_n,
            cable: self.cable.cable(),
        });
    }

    /// Name of an obstacle that body, cable or load touches; of the ground if the body does.
    fn collision(&self) -> Option<String> {
        let state = self.pair.state();
        let touches = |obstacle: &&Prism| {
            // NaN counts as a collision.
            let is_clear = |part: &Part| {
                self.parts.distance_lower_bound_m(*part, &state, obstacle) > 0.0
                    || self.parts.distance_m(*part, &state, obstacle) > 0.0
            };
            !Part::ALL.iter().all(is_clear)
        };
        let ground =
            self.ground_m.filter(|ground_m| self.parts.height_m(&state) <= *ground_m).map(|_| GROUND.to_owned());
        ground.or_else(|| self.obstacles.iter().find(touches).map(|obstacle| obstacle.name.clone()))
    }

    /// Advances the plant by one step under commanded thrusts, N.
    fn advance(&mut self, t_s: f64, command_n: &Vector4<f64>) {
        let plant_step_s = self.step_s / self.plant_steps as f64;
        let mut impulse_ns = 0.0;
        for plant_step in 0..self.plant_steps {
            let forces = self.mid_step_forces(command_n, plant_step_s);
            self.pair.step(&forces);
            impulse_ns += self.pair.impulse_ns();
            let began_s = t_s + plant_step as f64 * plant_step_s;
            let (cable, step_ns) = (self.pair.cable(), self.pair.impulse_ns());
            self.events.extend(self.cable.observe(began_s, plant_step_s, cable, step_ns));
        }
        self.tension_n = impulse_ns / self.step_s;
    }

    /// Forces in the middle of the coming step of the plant, over which rotors and air are advanced.
    fn mid_step_forces(&mut self, command_n: &Vector4<f64>, plant_step_s: f64) -> AppliedForces {
        let state = self.pair.state();
        let thrust_n = self.rotors.advance(command_n, plant_step_s);
        let [lift_n, torque_nm] =
            mid_step_wrench(&self.plant.rotors(), &thrust_n, &state.attitude_state(), plant_step_s);
        let wind_mps = self.air.velocity_mps(state.position_m.z, &state.velocity_mps);
        self.air.advance(plant_step_s, state.position_m.z, (state.velocity_mps - wind_mps).norm());
        AppliedForces {
            force_n: lift_n + drag_n(&(wind_mps - state.velocity_mps), self.model.drag_area_m2),
            torque_nm,
            load_force_n: drag_n(&(wind_mps - state.load_velocity_mps), self.model.load_drag_area_m2),
        }
    }
}

/// The true start: quadrotor and load are offset together, so that the cable keeps its length.
fn start_state(request: &FlightRequest<'_>, vehicle: &Vehicle, nominal: &SlungLoadState) -> SlungLoadState {
    let PointState { position_m, velocity_mps } = start::offset(request, vehicle);
    SlungLoadState {
        position_m: nominal.position_m + position_m,
        velocity_mps: nominal.velocity_mps + velocity_mps,
        load_position_m: nominal.load_position_m + position_m,
        load_velocity_mps: nominal.load_velocity_mps + velocity_mps,
        ..*nominal
    }
}
