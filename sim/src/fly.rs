use std::time::Instant;

use nalgebra::Vector3;
use scenarios::{Plan, Scenario};

use crate::aircraft::Aircraft;
use crate::rapier_world::{RapierWorld, Touch, Touched};
use crate::{Event, EventKind, Flight};

/// Who decides on the load factors.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub enum Pilot {
    /// The tracker follows the plan from the measured state.
    #[default]
    Tracker,
    /// Nobody: the planned load factors act as a function of time, whatever happens, inside the vehicle's limits.
    OpenLoop,
}

/// How a flight differs from an ordinary one, to look at plant and tracker apart: the tests hold open-loop flights
/// against an independent integrator, and let the tracker catch up from a wrong start.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct Setup {
    /// Who decides on the load factors.
    pub pilot: Pilot,
    /// Where every vehicle starts, relative to its plan's first state, world frame, m.
    pub start_offset_m: [f64; 3],
    /// Velocity over ground with which every vehicle starts, relative to its plan's first state, world frame, m/s.
    pub start_velocity_offset_mps: [f64; 3],
}

/// Flies a plan: every vehicle starts in its plan's first state and follows its trajectory by the tracker, in the wind
/// and with the sensors and the mass of the scenario, until `coast_s` after the plan's end or `max_duration_s`.
///
/// - `plan`: complete and checked: one trajectory per vehicle, in the scenario's order, with at least two nodes
/// - `seed`: of gusts and sensors; the same seed gives the same flight
/// - `progress`: is called about once per simulated second with the simulated time, s
///
/// Panics if the plan is not what it should be: whoever loaded it should have seen.
pub fn fly(scenario: &Scenario, plan: &Plan, seed: u64, progress: &mut dyn FnMut(f64)) -> Flight {
    fly_with(scenario, plan, seed, &Setup::default(), progress)
}

/// [`fly`] with another pilot or another start.
pub fn fly_with(scenario: &Scenario, plan: &Plan, seed: u64, setup: &Setup, progress: &mut dyn FnMut(f64)) -> Flight {
    let began = Instant::now();
    assert_flyable(scenario, plan);
    let step_s = scenario.simulation.step_s;
    let steps = number_of_steps(scenario, plan);
    let mut fleet = Fleet::new(scenario, plan, seed, setup, steps);
    fleet.decide(0.0);
    for step in 1..=steps {
        let t_s = step as f64 * step_s;
        let touches = fleet.advance();
        fleet.decide(t_s);
        fleet.crash(&touches, t_s - step_s, step_s, scenario);
        if t_s.floor() > (t_s - step_s).floor() {
            progress(t_s);
        }
    }
    fleet.land(step_s, plan, began)
}

/// Number of steps to the end of the coast, but not beyond the longest duration.
fn number_of_steps(scenario: &Scenario, plan: &Plan) -> usize {
    let simulation = &scenario.simulation;
    let plan_end_s = plan.flight_time_s().expect("a plan that is flown has trajectories");
    let end_s = (plan_end_s + simulation.coast_s).min(simulation.max_duration_s);
    // A thousandth of a step is rounding, not time.
    (end_s / simulation.step_s - 1e-3).ceil().max(0.0) as usize
}

/// The fleet in the air.
struct Fleet {
    world: RapierWorld,
    aircraft: Vec<Aircraft>,
    is_flying: Vec<bool>,
    events: Vec<Event>,
}

impl Fleet {
    fn new(scenario: &Scenario, plan: &Plan, seed: u64, setup: &Setup, steps: usize) -> Self {
        let mut world = RapierWorld::new(scenario.simulation.step_s);
        for cylinder in &scenario.world.cylinders {
            world.add_pillar(cylinder, &scenario.world.map);
        }
        let mut aircraft = Vec::with_capacity(scenario.vehicles.len());
        for (vehicle, trajectory) in scenario.vehicles.iter().zip(&plan.trajectories) {
            let model = scenario.fixed_wing_model(vehicle);
            let start = &trajectory.states[0];
            world.add_body(
                model.mass_kg * scenario.simulation.mismatch.mass_ratio,
                model.body_radius_m,
                Vector3::from(start.position_m()) + Vector3::from(setup.start_offset_m),
                Vector3::from(start.velocity_mps()) + Vector3::from(setup.start_velocity_offset_mps),
            );
            aircraft.push(Aircraft::new(scenario, vehicle, trajectory, setup.pilot, seed, steps));
        }
        Self { world, is_flying: vec![true; aircraft.len()], aircraft, events: Vec::new() }
    }

    /// Everybody measures, decides and logs.
    fn decide(&mut self, t_s: f64) {
        for index in 0..self.aircraft.len() {
            if !self.is_flying[index] {
                continue;
            }
            let (position_m, velocity_mps) = (self.world.position_m(index), self.world.velocity_mps(index));
            let aircraft = &mut self.aircraft[index];
            if let Some((t_s, kind)) = aircraft.decide(t_s, position_m, velocity_mps) {
                self.events.push(Event { t_s, kind, vehicles: vec![aircraft.name().to_owned()] });
            }
        }
    }

    /// One step of the world under everybody's forces.
    fn advance(&mut self) -> Vec<Touch> {
        for index in 0..self.aircraft.len() {
            if !self.is_flying[index] {
                continue;
            }
            let (position_m, velocity_mps) = (self.world.position_m(index), self.world.velocity_mps(index));
            let mass_kg = self.world.mass_kg(index);
            self.world.set_force_n(index, self.aircraft[index].force_n(position_m, velocity_mps, mass_kg));
        }
        self.world.step()
    }

    /// Takes those out that touched something during the step that began at `start_s`. Whoever is out already touches
    /// nobody any more.
    fn crash(&mut self, touches: &[Touch], start_s: f64, step_s: f64, scenario: &Scenario) {
        for touch in touches {
            let (bodies, obstacle) = match touch.with {
                Touched::Body(other) => (vec![touch.body, other], None),
                Touched::Pillar(pillar) => (vec![touch.body], Some(scenario.world.cylinders[pillar].name.clone())),
            };
            if !bodies.iter().all(|body| self.is_flying[*body]) {
                continue;
            }
            let vehicles = bodies.iter().map(|body| self.aircraft[*body].name().to_owned()).collect();
            let t_s = start_s + touch.share * step_s;
            self.events.push(Event { t_s, kind: EventKind::Crash { obstacle }, vehicles });
            for body in bodies {
                self.is_flying[body] = false;
                self.world.remove_body(body);
            }
        }
    }

    fn land(mut self, step_s: f64, plan: &Plan, began: Instant) -> Flight {
        let mut vehicles = Vec::with_capacity(self.aircraft.len());
        for aircraft in self.aircraft {
            let (log, last_event) = aircraft.land();
            let vehicle = log.vehicle.clone();
            self.events.extend(last_event.map(|(t_s, kind)| Event { t_s, kind, vehicles: vec![vehicle] }));
            vehicles.push(log);
        }
        self.events.sort_by(|a, b| a.t_s.total_cmp(&b.t_s));
        Flight {
            step_s,
            plan_end_s: plan.flight_time_s().unwrap_or(0.0),
            vehicles,
            events: self.events,
            wall_s: began.elapsed().as_secs_f64(),
        }
    }
}

/// Panics with the reason if a plan cannot be flown for reasons of form.
fn assert_flyable(scenario: &Scenario, plan: &Plan) {
    assert!(scenario.simulation.step_s > 0.0, "the step must be positive, not {}", scenario.simulation.step_s);
    assert_eq!(plan.trajectories.len(), scenario.vehicles.len(), "a plan has one trajectory per vehicle");
    for (vehicle, trajectory) in scenario.vehicles.iter().zip(&plan.trajectories) {
        let (name, times_s) = (&vehicle.name, &trajectory.times_s);
        assert_eq!(name, &trajectory.vehicle, "trajectories stand in the order of the vehicles");
        assert!(times_s.len() >= 2, "the trajectory of {name} has fewer than two nodes");
        assert_eq!(times_s.len(), trajectory.states.len(), "the trajectory of {name} has one state per node");
        assert_eq!(times_s.len(), trajectory.controls.len(), "the trajectory of {name} has one control per node");
        assert_eq!(times_s[0], 0.0, "the trajectory of {name} begins at time 0");
        assert!(times_s.windows(2).all(|pair| pair[0] < pair[1]), "the times of {name} increase");
        let states = trajectory.states.iter().flat_map(|state| state.to_array());
        let controls = trajectory.controls.iter().flat_map(|control| control.to_array());
        let mut numbers = states.chain(controls).chain(times_s.iter().copied());
        assert!(numbers.all(f64::is_finite), "the trajectory of {name} holds finite numbers only");
    }
}
