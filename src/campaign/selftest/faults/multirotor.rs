//! What can be wrong with multirotors, specimen by specimen: each shows what the others cannot.

mod flights;
mod in_loop;
mod moving;
mod plans;
mod rotors;

use scenarios::multirotor::Plant;

use super::super::{Fault, Specimen};
use super::{cuts, log, plan};

/// The faults for a specimen of multirotors in still air.
pub fn faults(specimen: &Specimen) -> Vec<Fault> {
    let has_rotors = specimen.scenario.models.multirotor.values().any(|model| model.plant == Plant::Quadrotor);
    if has_rotors {
        rotors::faults()
    } else if !specimen.scenario.world.moving.is_empty() {
        moving::faults()
    } else if specimen.is_planned_in_the_loop() {
        [log::faults(), in_loop::faults()].into_iter().flatten().collect()
    } else {
        // Positions and velocities name the accelerations that lead from one to the next: there is no defect.
        let on_plans = plan::faults().into_iter().filter(|fault| fault.aims_at != "plan.dynamics");
        let all = [log::faults(), plans::faults(), flights::faults(), cuts::faults(specimen.family())];
        on_plans.chain(all.into_iter().flatten()).collect()
    }
}
