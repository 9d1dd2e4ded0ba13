use nalgebra::Vector3;
use rayon::prelude::*;
use scenarios::{Plan, Scenario};

use super::aircraft::Aircraft;
use crate::rapier_world::{RapierWorld, Touch, Touched};
use crate::{Event, EventKind, Setup, VehicleLog};

/// Number of aircraft from which on sharing them out to threads is worth what it costs, some 10 µs per step.
const LARGE_FLEET: usize = 64;

/// Flies a plan of fixed wings for so many steps, and returns their logs and what happened.
pub(crate) fn fly(
    scenario: &Scenario,
    plan: &Plan,
    seed: u64,
    setup: &Setup,
    steps: usize,
    progress: &mut dyn FnMut(f64),
) -> (Vec<VehicleLog>, Vec<Event>) {
    let step_s = scenario.simulation.step_s;
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
    fleet.land()
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
            let trajectory = trajectory.fixed_wing();
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
        let Self { world, aircraft, is_flying, events } = self;
        let states: Vec<_> =
            (0..aircraft.len()).map(|i| is_flying[i].then(|| (world.position_m(i), world.velocity_mps(i)))).collect();
        let decided = each_alone(aircraft, |index, aircraft| {
            let (position_m, velocity_mps) = states[index]?;
            aircraft.decide(t_s, position_m, velocity_mps)
        });
        for (index, event) in decided.into_iter().enumerate() {
            if let Some((t_s, kind)) = event {
                events.push(Event { t_s, kind, vehicles: vec![aircraft[index].name().to_owned()] });
            }
        }
    }

    /// One step of the world under everybody's forces.
    fn advance(&mut self) -> Vec<Touch> {
        let Self { world, aircraft, is_flying, .. } = self;
        let state = |i: usize| (world.position_m(i), world.velocity_mps(i), world.mass_kg(i));
        let states: Vec<_> = (0..aircraft.len()).map(|i| is_flying[i].then(|| state(i))).collect();
        let forces_n = each_alone(aircraft, |index, aircraft| {
            let (position_m, velocity_mps, mass_kg) = states[index]?;
            Some(aircraft.force_n(position_m, velocity_mps, mass_kg))
        });
        for (index, force_n) in forces_n.into_iter().enumerate() {
            if let Some(force_n) = force_n {
                world.set_force_n(index, force_n);
            }
        }
        world.step()
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

    fn land(mut self) -> (Vec<VehicleLog>, Vec<Event>) {
        let mut vehicles = Vec::with_capacity(self.aircraft.len());
        for aircraft in self.aircraft {
            let (log, last_event) = aircraft.land();
            let vehicle = log.vehicle.clone();
            self.events.extend(last_event.map(|(t_s, kind)| Event { t_s, kind, vehicles: vec![vehicle] }));
            vehicles.push(log);
        }
        (vehicles, self.events)
    }
}

/// Calls `act` for every aircraft; from a certain size on for several at a time, since none knows of the others.
fn each_alone<T: Send>(fleet: &mut [Aircraft], act: impl Fn(usize, &mut Aircraft) -> T + Sync) -> Vec<T> {
    if fleet.len() < LARGE_FLEET {
        return fleet.iter_mut().enumerate().map(|(index, aircraft)| act(index, aircraft)).collect();
    }
    let chunks = fleet.par_iter_mut().enumerate().with_min_len(LARGE_FLEET / 2);
    chunks.map(|(index, aircraft)| act(index, aircraft)).collect()
}
