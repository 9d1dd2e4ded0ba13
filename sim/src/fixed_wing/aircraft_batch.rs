use std::ops::Range;

use super::aircraft::Aircraft;
use crate::kinematics::PointState;
use crate::rapier_world::RapierWorld;

/// Rapier clips faster bodies.
const MAX_SPEED_MPS: f64 = 1000.0;

/// Aircraft that share a rapier world: enough of them to distribute the fixed cost of a world's step, few enough that
/// every thread has several batches.
pub(super) struct AircraftBatch {
    world: RapierWorld,
    aircraft: Vec<Aircraft>,
    step_s: f64,
    substeps: usize,
}

impl AircraftBatch {
    /// Maximum number of aircraft in a batch.
    pub const SIZE: usize = 10;

    /// An empty batch. Controls are held for `step_s` > 0, which the world divides into `substeps` steps.
    pub fn new(step_s: f64, substeps: usize) -> Self {
        let world = RapierWorld::new(step_s / substeps as f64, MAX_SPEED_MPS);
        Self { world, aircraft: Vec::with_capacity(Self::SIZE), step_s, substeps }
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
            for substep in 0..self.substeps {
                self.advance(substep);
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

    /// One step of the world under the forces of all aircraft.
    fn advance(&mut self, substep: usize) {
        let Self { world, aircraft, substeps, .. } = self;
        let (middle, length) = ((substep as f64 + 0.5) / *substeps as f64, 1.0 / *substeps as f64);
        for (index, aircraft) in flying(aircraft) {
            let truth = world.point_state(index);
            if substep == 0 {
                aircraft.advance_wind(truth);
            }
            let force_n = aircraft.force_n(truth.velocity_mps, world.mass_kg(index), middle, length);
            world.set_force_n(index, force_n);
        }
        world.step();
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
