//! What can be wrong with multirotors, reference by reference: each shows what the others cannot.

mod flights;
mod in_loop;
mod moving;
mod plans;
mod rotors;

use scenarios::multirotor::Plant;

use super::super::family::FamilySelftest;
use super::super::{Fault, ReferenceCase};
use super::{log, plan, tightened_limits};

/// The faults for a reference of multirotors in still air.
pub fn faults(reference: &ReferenceCase, family: &'static FamilySelftest) -> Vec<Fault> {
    let has_rotors = reference.scenario.models.multirotor.values().any(|model| model.plant == Plant::Quadrotor);
    if has_rotors {
        rotors::faults()
    } else if !reference.scenario.world.moving.is_empty() {
        moving::faults()
    } else if reference.is_planned_in_the_loop() {
        [log::faults(), in_loop::faults()].into_iter().flatten().collect()
    } else {
        // Positions and velocities name the accelerations that lead from one to the next: there is no defect.
        let on_plans = plan::faults().into_iter().filter(|fault| fault.aims_at != "plan.dynamics");
        let all = [log::faults(), plans::faults(), flights::faults(), tightened_limits::faults(family)];
        on_plans.chain(all.into_iter().flatten()).collect()
    }
}
