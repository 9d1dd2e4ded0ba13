use std::ops::Range;

use nalgebra::Vector3;

use super::aircraft::Aircraft;
use crate::rapier_world::RapierWorld;

/// Aircraft that share a rapier world: enough of them to share what a step of it costs however few they are, few enough
/// to give every thread some squadrons.
pub(super) struct AircraftBatch {
    world: RapierWorld,
    aircraft: Vec<Aircraft>,
    step_s: f64,
    substeps: usize,
}

impl AircraftBatch {
    /// Most aircraft in one.
    pub const SIZE: usize = 10;

    /// An empty one. Decisions are held for `step_s` > 0, in which the world makes so many steps.
    pub fn new(step_s: f64, substeps: usize) -> Self {
        let world = RapierWorld::new(step_s / substeps as f64);
        Self { world, aircraft: Vec::with_capacity(Self::SIZE), step_s, substeps }
    }

    pub fn is_full(&self) -> bool {
        self.aircraft.len() == Self::SIZE
    }

    /// Adds an aircraft in the air.
    ///
    /// - `mass_ratio`: true mass over the nominal one
    /// - `position_m`, `velocity_mps`: at time 0, world frame
    pub fn add(&mut self, aircraft: Aircraft, mass_ratio: f64, position_m: Vector3<f64>, velocity_mps: Vector3<f64>) {
        self.world.add_body(aircraft.nominal_mass_kg() * mass_ratio, position_m, velocity_mps);
        self.aircraft.push(aircraft);
    }

    pub fn aircraft(&self) -> &[Aircraft] {
        &self.aircraft
    }

    pub fn aircraft_mut(&mut self) -> &mut [Aircraft] {
        &mut self.aircraft
    }

    /// Everybody decides for the first time, at time 0.
    pub fn begin(&mut self) {
        self.decide(0.0);
    }

    /// Lets these steps pass, counted from 0.
    pub fn fly(&mut self, steps: Range<usize>) {
        for step in steps {
            for substep in 0..self.substeps {
                self.advance(substep);
            }
            self.decide((step + 1) as f64 * self.step_s);
        }
    }

    /// Takes an aircraft out that should have flown `steps` only.
    pub fn remove(&mut self, index: usize, steps: usize) {
        self.aircraft[index].remove(steps);
        self.world.remove_body(index);
    }

    pub fn finish(self) -> Vec<Aircraft> {
        self.aircraft
    }

    /// One step of the world under everybody's forces.
    fn advance(&mut self, substep: usize) {
        let Self { world, aircraft, substeps, .. } = self;
        let (middle, share) = ((substep as f64 + 0.5) / *substeps as f64, 1.0 / *substeps as f64);
        for (index, aircraft) in flying(aircraft) {
            let (position_m, velocity_mps) = (world.position_m(index), world.velocity_mps(index));
            if substep == 0 {
                aircraft.advance_wind(position_m, velocity_mps);
            }
            let force_n = aircraft.force_n(velocity_mps, world.mass_kg(index), middle, share);
            world.set_force_n(index, force_n);
        }
        world.step();
    }

    /// Everybody measures, decides and logs.
    fn decide(&mut self, t_s: f64) {
        let Self { world, aircraft, .. } = self;
        for (index, aircraft) in flying(aircraft) {
            aircraft.decide(t_s, world.position_m(index), world.velocity_mps(index));
        }
    }
}

fn flying(aircraft: &mut [Aircraft]) -> impl Iterator<Item = (usize, &mut Aircraft)> {
    aircraft.iter_mut().enumerate().filter(|(_, aircraft)| aircraft.is_flying())
}
