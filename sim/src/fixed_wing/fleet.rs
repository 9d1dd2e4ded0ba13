use nalgebra::Vector3;
use rayon::prelude::*;
use scenarios::{Cylinder, Plan, Scenario};

use super::aircraft::Aircraft;
use super::aircraft_batch::AircraftBatch;
use super::collisions::{Collision, Obstacle, SweptPath, collisions};
use crate::{Event, EventKind, FlightOptions, VehicleLog, start};

/// Length of a time_chunk, s: after each it is seen who touched what.
const STRETCH_S: f64 = 1.0;

/// Flies a plan of fixed wings for so many steps, and returns their logs and what happened.
///
/// Aircraft do not feel each other, so squadrons of them fly side by side, a time_chunk at a time. Whoever touched something
/// on it should not have flown on: the log is cut, and the others never noticed.
pub(crate) fn fly(
    scenario: &Scenario,
    plan: &Plan,
    seed: u64,
    setup: &FlightOptions,
    steps: usize,
    progress: &mut dyn FnMut(f64),
) -> (Vec<VehicleLog>, Vec<Event>) {
    let step_s = scenario.simulation.step_s;
    let steps_per_stretch = (STRETCH_S / step_s).ceil().max(1.0) as usize;
    let mut fleet = Fleet::new(scenario, plan, seed, setup, steps);
    for first in (0..steps).step_by(steps_per_stretch) {
        let last = (first + steps_per_stretch).min(steps);
        fleet.fly(first, last);
        progress(last as f64 * step_s);
    }
    fleet.finish()
}

/// The fleet in the air.
struct Fleet<'a> {
    squadrons: Vec<AircraftBatch>,
    pillars: &'a [Cylinder],
    step_s: f64,
    events: Vec<Event>,
}

impl<'a> Fleet<'a> {
    fn new(scenario: &'a Scenario, plan: &Plan, seed: u64, setup: &FlightOptions, steps: usize) -> Self {
        let step_s = scenario.simulation.step_s;
        let mut squadrons: Vec<AircraftBatch> = Vec::new();
        for (vehicle, trajectory) in scenario.vehicles.iter().zip(&plan.trajectories) {
            if squadrons.last().is_none_or(AircraftBatch::is_full) {
                squadrons.push(AircraftBatch::new(step_s, setup.substeps()));
            }
            let trajectory = trajectory.fixed_wing();
            let first = &trajectory.states[0];
            let offset_m = start::offset_m(scenario, vehicle, setup, seed);
            squadrons.last_mut().expect("one was added").add(
                Aircraft::new(scenario, vehicle, trajectory, setup.control_mode, seed, steps),
                scenario.simulation.mismatch.mass_ratio,
                Vector3::from(first.position_m()) + offset_m,
                Vector3::from(first.velocity_mps()) + Vector3::from(setup.start_velocity_offset_mps),
            );
        }
        let mut fleet = Self { squadrons, pillars: &scenario.world.cylinders, step_s, events: Vec::new() };
        fleet.squadrons.par_iter_mut().for_each(AircraftBatch::begin);
        fleet
    }

    /// Steps `first`..`last`, counted from 0.
    fn fly(&mut self, first: usize, last: usize) {
        self.squadrons.par_iter_mut().for_each(|squadron| squadron.fly(first..last));
        for collision in self.collisions(first) {
            self.crash(first, &collision);
        }
        for aircraft in self.squadrons.iter_mut().flat_map(AircraftBatch::aircraft_mut) {
            let happened = aircraft.saturations(first);
            let vehicle = aircraft.name();
            self.events.extend(happened.into_iter().map(|(t_s, kind)| event(t_s, kind, vehicle)));
        }
    }

    /// Who touches what on the time_chunk that began with step `first`.
    fn collisions(&self, first: usize) -> Vec<Collision> {
        let everybody = self.squadrons.iter().flat_map(AircraftBatch::aircraft).enumerate();
        let flying = everybody.filter(|(_, aircraft)| aircraft.is_flying());
        let ways: Vec<SweptPath<'_>> = flying
            .map(|(index, aircraft)| SweptPath {
                aircraft: index,
                radius_m: aircraft.body_radius_m(),
                samples: &aircraft.samples()[first..],
            })
            .collect();
        collisions(&ways, self.pillars)
    }

    /// Takes those out that touched something, unless one of them was out before.
    fn crash(&mut self, first: usize, collision: &Collision) {
        let (out, obstacle) = match collision.with {
            Obstacle::Aircraft(other) => (vec![collision.aircraft, other], None),
            Obstacle::Pillar(pillar) => (vec![collision.aircraft], Some(self.pillars[pillar].name.clone())),
        };
        if !out.iter().all(|index| self.aircraft(*index).is_flying()) {
            return;
        }
        let step = first + collision.step;
        let t_s = (step as f64 + collision.share) * self.step_s;
        let vehicles = out.iter().map(|index| self.aircraft(*index).name().to_owned()).collect();
        self.events.push(Event { t_s, kind: EventKind::Crash { obstacle }, vehicles });
        for index in out {
            self.squadrons[index / AircraftBatch::SIZE].remove(index % AircraftBatch::SIZE, step + 1);
        }
    }

    fn aircraft(&self, index: usize) -> &Aircraft {
        &self.squadrons[index / AircraftBatch::SIZE].aircraft()[index % AircraftBatch::SIZE]
    }

    fn finish(mut self) -> (Vec<VehicleLog>, Vec<Event>) {
        let mut vehicles = Vec::new();
        for aircraft in self.squadrons.into_iter().flat_map(AircraftBatch::finish) {
            let (log, last_event) = aircraft.finish();
            self.events.extend(last_event.map(|(t_s, kind)| event(t_s, kind, &log.vehicle)));
            vehicles.push(log);
        }
        (vehicles, self.events)
    }
}

fn event(t_s: f64, kind: EventKind, vehicle: &str) -> Event {
    Event { t_s, kind, vehicles: vec![vehicle.to_owned()] }
}
