use nalgebra::Vector3;
use rayon::prelude::*;
use scenarios::Plan;

use super::aircraft::Aircraft;
use super::aircraft_batch::AircraftBatch;
use super::collisions::{Collision, Obstacle, Obstacles, SweptPath, collisions};
use crate::collision::GROUND;
use crate::flight::{Event, EventKind, FleetLog};
use crate::kinematics::PointState;
use crate::obstacles::Obstacles as OtherObstacles;
use crate::request::FlightRequest;
use crate::start;

/// Length of a time chunk, s. Collisions are detected after each chunk.
const TIME_CHUNK_S: f64 = 1.0;

/// Simulates fixed wings that fly a plan.
///
/// Aircraft do not interact, so that batches of them are simulated in parallel, one time chunk after the other. The log
/// of an aircraft that collided within the chunk is truncated; no other aircraft is affected by it.
pub(crate) fn simulate(request: &FlightRequest<'_>, plan: &Plan, progress: &mut dyn FnMut(f64)) -> FleetLog {
    let chunk_steps = (TIME_CHUNK_S / request.step_s()).ceil().max(1.0) as usize;
    let mut fleet = Fleet::new(request, plan);
    for first in (0..request.steps).step_by(chunk_steps) {
        let end = (first + chunk_steps).min(request.steps);
        fleet.fly(first, end);
        progress(request.time_s(end));
    }
    fleet.finish()
}

/// Fixed wings in flight.
struct Fleet<'a> {
    batches: Vec<AircraftBatch>,
    obstacles: Obstacles<'a>,
    step_s: f64,
    events: Vec<Event>,
}

impl<'a> Fleet<'a> {
    fn new(request: &FlightRequest<'a>, plan: &Plan) -> Self {
        let (scenario, step_s) = (request.scenario, request.step_s());
        let mut batches: Vec<AircraftBatch> = Vec::new();
        for (vehicle, trajectory) in scenario.vehicles.iter().zip(&plan.trajectories) {
            if batches.last().is_none_or(AircraftBatch::is_full) {
                batches.push(AircraftBatch::new(request));
            }
            let trajectory = trajectory.fixed_wing();
            let (first, offset) = (&trajectory.states[0], start::offset(request, vehicle));
            let start = PointState {
                position_m: Vector3::from(first.position_m()) + offset.position_m,
                velocity_mps: Vector3::from(first.velocity_mps()) + offset.velocity_mps,
            };
            let aircraft = Aircraft::new(request, vehicle, trajectory, &start);
            let batch = batches.last_mut().expect("one was added");
            batch.add(aircraft, scenario.simulation.mismatch.mass_ratio, &start);
        }
        batches.par_iter_mut().for_each(AircraftBatch::begin);
        let world = &scenario.world;
        let others = OtherObstacles::beyond_cylinders(world);
        let obstacles = Obstacles { cylinders: &world.cylinders, others, ground_m: world.ground_m };
        Self { batches, obstacles, step_s, events: Vec::new() }
    }

    /// Simulates steps `first`..`end`, counted from 0.
    fn fly(&mut self, first: usize, end: usize) {
        self.batches.par_iter_mut().for_each(|batch| batch.fly(first..end));
        for collision in self.collisions(first) {
            self.crash(first, &collision);
        }
        for aircraft in self.batches.iter_mut().flat_map(AircraftBatch::aircraft_mut) {
            let events = aircraft.observe_saturation(first).into_iter();
            self.events.extend(events.map(|event| Event::of_vehicle(aircraft.name(), event)));
        }
    }

    /// All collisions within the time chunk that began with step `first`.
    fn collisions(&self, first: usize) -> Vec<Collision> {
        let all = self.batches.iter().flat_map(AircraftBatch::aircraft).enumerate();
        let flying = all.filter(|(_, aircraft)| aircraft.is_flying());
        let paths: Vec<SweptPath<'_>> = flying
            .map(|(index, aircraft)| SweptPath {
                aircraft: index,
                radius_m: aircraft.body_radius_m(),
                samples: &aircraft.samples()[first..],
            })
            .collect();
        collisions(&paths, &self.obstacles)
    }

    /// Removes the aircraft that collided, unless one of them had been removed before.
    fn crash(&mut self, first: usize, collision: &Collision) {
        let (crashed, obstacle) = match collision.with {
            Obstacle::Aircraft(other) => (vec![collision.aircraft, other], None),
            Obstacle::Cylinder(index) => (vec![collision.aircraft], Some(self.obstacles.cylinders[index].name.clone())),
            Obstacle::Other(index) => (vec![collision.aircraft], Some(self.obstacles.others.name(index).to_owned())),
            Obstacle::Ground => (vec![collision.aircraft], Some(GROUND.to_owned())),
        };
        if !crashed.iter().all(|index| self.aircraft(*index).is_flying()) {
            return;
        }
        let step = first + collision.step;
        let t_s = (step as f64 + collision.fraction) * self.step_s;
        let vehicles = crashed.iter().map(|index| self.aircraft(*index).name().to_owned()).collect();
        self.events.push(Event { t_s, kind: EventKind::Crash { obstacle }, vehicles });
        for index in crashed {
            self.batches[index / AircraftBatch::SIZE].remove(index % AircraftBatch::SIZE, step + 1);
        }
    }

    fn aircraft(&self, index: usize) -> &Aircraft {
        &self.batches[index / AircraftBatch::SIZE].aircraft()[index % AircraftBatch::SIZE]
    }

    fn finish(mut self) -> FleetLog {
        let mut vehicles = Vec::new();
        for aircraft in self.batches.into_iter().flat_map(AircraftBatch::finish) {
            let (log, event) = aircraft.finish();
            self.events.extend(event.map(|event| Event::of_vehicle(&log.vehicle, event)));
            vehicles.push(log);
        }
        FleetLog { vehicles, events: self.events, in_loop: None }
    }
}
