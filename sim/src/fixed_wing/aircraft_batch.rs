use std::ops::Range;

use super::aircraft::Aircraft;
use crate::kinematics::PointState;
use crate::plant_steps::PlantSteps;
use crate::rapier_world::RapierWorld;
use crate::request::FlightRequest;

/// Maximum step of the plant, s.
const MAX_PLANT_STEP_S: f64 = 0.01;

/// Rapier clips faster bodies.
const MAX_SPEED_MPS: f64 = 1000.0;

/// Aircraft that share a rapier world: enough of them to distribute the fixed cost of a world's step, few enough that
/// every thread has several batches.
pub(super) struct AircraftBatch {
    world: RapierWorld,
    aircraft: Vec<Aircraft>,
    step_s: f64,
    plant_steps: PlantSteps,
}

impl AircraftBatch {
    /// Maximum number of aircraft in a batch.
    pub const SIZE: usize = 10;

    /// An empty batch.
    pub fn new(request: &FlightRequest<'_>) -> Self {
        Self {
            world: RapierWorld::new(MAX_SPEED_MPS),
            aircraft: Vec::with_capacity(Self::SIZE),
            step_s: request.step_s(),
            plant_steps: PlantSteps::new(request, MAX_PLANT_STEP_S),
        }
    }

    pub fn is_full(&self) -> bool {
        self.aircraft.len() == Self::SIZE
    }

    /// Adds an aircraft.
    ///
    /// - `mass_ratio`: true mass over the nominal one
    /// - `start`: true state at time 0
    pub fn add(&mut self, aircraft: Aircraft, mass_ratio: f64, start: &PointState) {
        self.world.add_point_mass(aircraft.nominal_mass_kg() * mass_ratio, start);
        self.aircraft.push(aircraft);
    }

    pub fn aircraft(&self) -> &[Aircraft] {
        &self.aircraft
    }

    pub fn aircraft_mut(&mut self) -> &mut [Aircraft] {
        &mut self.aircraft
    }

    /// Computes the first controls, at time 0.
    pub fn begin(&mut self) {
        self.decide(0.0);
    }

    /// Simulates these steps, counted from 0.
    pub fn fly(&mut self, steps: Range<usize>) {
        for step in steps {
            let t_s = step as f64 * self.step_s;
            self.begin_step(t_s);
            let (plant_steps_s, plant_step_s) = self.plant_steps.within(t_s);
            for began_s in plant_steps_s {
                self.advance(began_s, plant_step_s);
            }
            self.decide((step + 1) as f64 * self.step_s);
        }
    }

    /// Removes an aircraft that crashed in the last one of `steps` steps.
    pub fn remove(&mut self, index: usize, steps: usize) {
        self.aircraft[index].remove(steps);
        self.world.remove_body(index);
    }

    pub fn finish(self) -> Vec<Aircraft> {
        self.aircraft
    }

    /// Continues the air of all aircraft over the simulator's step that begins at `t_s`.
    fn begin_step(&mut self, t_s: f64) {
        let Self { world, aircraft, .. } = self;
        for (index, aircraft) in flying(aircraft) {
            aircraft.begin_step(t_s, &world.point_state(index));
        }
    }

    /// One step of the world under the forces of all aircraft.
    fn advance(&mut self, began_s: f64, plant_step_s: f64) {
        let Self { world, aircraft, .. } = self;
        for (index, aircraft) in flying(aircraft) {
            let velocity_mps = world.point_state(index).velocity_mps;
            let force_n = aircraft.force_n(velocity_mps, world.mass_kg(index), began_s, plant_step_s);
            world.set_force_n(index, force_n);
        }
        world.step(plant_step_s);
    }

    /// Measures, computes the controls of the coming step, and logs.
    fn decide(&mut self, t_s: f64) {
        let Self { world, aircraft, .. } = self;
        for (index, aircraft) in flying(aircraft) {
            aircraft.decide(t_s, world.point_state(index));
        }
    }
}

fn flying(aircraft: &mut [Aircraft]) -> impl Iterator<Item = (usize, &mut Aircraft)> {
    aircraft.iter_mut().enumerate().filter(|(_, aircraft)| aircraft.is_flying())
}
