use nalgebra::{Vector3, Vector4};
use scenarios::geometry::Solid;
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
use crate::plant_steps::PlantSteps;
use crate::quadrotor::{LaggedRotors, mid_step_wrench};
use crate::request::{ControlMode, FlightRequest};
use crate::saturation::SaturationDetector;
use crate::sensors::{Delay, Sensors};
use crate::start;

/// Maximum step of the plant, s.
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
    solids: Vec<Solid>,
    parts: Parts,
    ground_m: Option<f64>,
    step_s: f64,
    plant_steps: PlantSteps,
    /// Length of the last step of the plant, s, and the velocities of quadrotor and load at its beginning, m/s.
    last_plant_step: Option<(f64, [Vector3<f64>; 2])>,
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
        Self {
            pair: TetheredPair::new(&plant, model.load_radius_m, &start),
            rotors: LaggedRotors::new(first.thrust_n, model.rotor_time_constant_s),
            tracker: Tracker::new(&reference, &nominal, model.limits.thrust_n, settings.step_s),
            sensors: Sensors::new(&settings.sensors, request.stream("sensors", vehicle)),
            delay: Delay::new(settings.sensors.delay_s, settings.step_s),
            air: Air::new(request, vehicle, &start.quadrotor()),
            obstacles: scenario.world.prism_obstacles(),
            solids: scenario.world.solids(),
            parts: Parts::new(&model),
            ground_m: scenario.world.ground_m,
            step_s: settings.step_s,
            plant_steps: PlantSteps::new(request, MAX_PLANT_STEP_S),
            last_plant_step: None,
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
        let mut crash = self.collision().map(|obstacle| (0.0, obstacle));
        for step in 0..=request.steps {
            let t_s = request.time_s(step);
            let command_n = self.decide(t_s);
            if step < request.steps && crash.is_none() {
                crash = self.advance(t_s, &command_n);
            }
            if let Some((t_s, obstacle)) = crash {
                self.events.push((t_s, EventKind::Crash { obstacle: Some(obstacle) }));
                break;
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
            wind_mps: self.air.velocity_mps(t_s).into(),
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
        let touches_solid = |solid: &&Solid| {
            let is_clear = |part: &Part| {
                self.parts.distance_to_solid_lower_bound_m(*part, &state, solid) > 0.0
                    || self.parts.distance_to_solid_m(*part, &state, solid) > 0.0
            };
            !Part::ALL.iter().all(is_clear)
        };
        let prism = || self.obstacles.iter().find(touches).map(|obstacle| obstacle.name.clone());
        let solid = || self.solids.iter().find(touches_solid).map(|solid| solid.name().to_owned());
        ground.or_else(prism).or_else(solid)
    }

    /// Advances the plant by one step under commanded thrusts, N, or until it touches something: returns the time, s, and
    /// the name of the obstacle.
    fn advance(&mut self, t_s: f64, command_n: &Vector4<f64>) -> Option<(f64, String)> {
        self.air.begin_step(t_s, self.step_s, &self.pair.state().quadrotor());
        let (plant_steps_s, plant_step_s) = self.plant_steps.within(t_s);
        let mut impulse_ns = 0.0;
        for began_s in plant_steps_s {
            let forces = self.mid_step_forces(command_n, began_s, plant_step_s);
            self.pair.step(&forces, plant_step_s);
            impulse_ns += self.pair.impulse_ns();
            let (cable, step_ns) = (self.pair.cable(), self.pair.impulse_ns());
            self.events.extend(self.cable.observe(began_s, plant_step_s, cable, step_ns));
            if let Some(obstacle) = self.collision() {
                return Some((began_s + plant_step_s, obstacle));
            }
        }
        self.tension_n = impulse_ns / self.step_s;
        None
    }

    /// Forces in the middle of a step of the plant, over which the rotors are advanced.
    fn mid_step_forces(&mut self, command_n: &Vector4<f64>, began_s: f64, plant_step_s: f64) -> AppliedForces {
        let state = self.pair.state();
        let thrust_n = self.rotors.advance(command_n, plant_step_s);
        let [lift_n, torque_nm] =
            mid_step_wrench(&self.plant.rotors(), &thrust_n, &state.attitude_state(), plant_step_s);
        let wind_mps = self.air.velocity_mps(began_s + plant_step_s / 2.0);
        let [velocity_mps, load_velocity_mps] = self.mid_step_velocities_mps(&state, plant_step_s);
        AppliedForces {
            force_n: lift_n + drag_n(&(wind_mps - velocity_mps), self.model.drag_area_m2),
            torque_nm,
            load_force_n: drag_n(&(wind_mps - load_velocity_mps), self.model.load_drag_area_m2),
        }
    }

    /// Velocities of quadrotor and load in the middle of a step of the plant, extrapolated from the step before it.
    fn mid_step_velocities_mps(&mut self, state: &SlungLoadState, plant_step_s: f64) -> [Vector3<f64>; 2] {
        let now_mps = [state.velocity_mps, state.load_velocity_mps];
        let (last_step_s, before_mps) = self.last_plant_step.replace((plant_step_s, now_mps)).unwrap_or((1.0, now_mps));
        let ahead = plant_step_s / (2.0 * last_step_s);
        std::array::from_fn(|body| now_mps[body] + (now_mps[body] - before_mps[body]) * ahead)
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
