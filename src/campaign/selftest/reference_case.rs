mod unflown;

use scenarios::{Family, Plan, Scenario, slung_load};
use sim::{Actuation, Commanded, Flight, Sample};

use super::edit_trajectory::{AsEditable, EditTrajectory};
use crate::plan_source::PlanSource;
use crate::verdict::{self, Check, Verdict};

pub use unflown::UnflownCase;

/// A scenario with a plan and a flight that pass, into which faults are injected.
#[derive(Clone)]
pub struct ReferenceCase {
    /// The scenario.
    pub scenario: Scenario,
    /// The plan; of in-loop planners, the references that were followed.
    pub plan: Plan,
    /// The flight.
    pub flight: Option<Flight>,
    /// Access to the trajectories of its family.
    edit: AsEditable,
    /// Where the plan comes from.
    plan_source: PlanSource,
}

impl ReferenceCase {
    /// The verdict of the same judge as in every run.
    pub fn judge(&self) -> Verdict {
        verdict::judge(&self.scenario, &self.plan, self.flight.as_ref())
    }

    /// Family of its vehicles.
    pub fn family(&self) -> Family {
        self.scenario.family()
    }

    /// The check of this name. Panics if there is none.
    pub fn check(&self, name: &str) -> Check {
        let checks = self.judge().checks;
        checks.into_iter().find(|check| check.name == name).unwrap_or_else(|| panic!("there is no check {name}"))
    }

    /// The value of a check. Panics if it has none.
    pub fn value(&self, name: &str) -> f64 {
        self.check(name).value.unwrap_or_else(|| panic!("{name} has no value"))
    }

    /// The flight. Panics if there is none.
    pub fn flight(&mut self) -> &mut Flight {
        self.flight.as_mut().expect("a reference has a flight")
    }

    /// The samples of a vehicle.
    pub fn samples(&mut self, vehicle: usize) -> &mut Vec<Sample> {
        &mut self.flight().vehicles[vehicle].samples
    }

    /// The number of samples of the first vehicle.
    pub fn steps(&mut self) -> usize {
        self.samples(0).len()
    }

    /// The number of the first vehicle's samples within its plan.
    pub fn planned_steps(&mut self) -> usize {
        let end_s = self.plan.flight_time_s().unwrap_or(0.0);
        self.samples(0).partition_point(|sample| sample.t_s <= end_s)
    }

    /// Moves vehicle and load in some samples.
    pub fn shift(&mut self, vehicle: usize, samples: std::ops::Range<usize>, by_m: [f64; 3]) {
        let log = &mut self.flight().vehicles[vehicle];
        let moved = |position_m: &mut [f64; 3]| (0..3).for_each(|axis| position_m[axis] += by_m[axis]);
        log.samples[samples.clone()].iter_mut().for_each(|sample| {
            moved(&mut sample.position_m);
            moved(&mut sample.measured_position_m);
        });
        log.loads.get_mut(samples).into_iter().flatten().for_each(|load| {
            moved(&mut load.position_m);
            moved(&mut load.measured_position_m);
        });
    }

    /// The planned times of a vehicle.
    pub fn times_s(&mut self, vehicle: usize) -> &mut Vec<f64> {
        self.edit(vehicle).times_s()
    }

    /// The planned trajectory of a vehicle, whatever its family.
    pub fn edit(&mut self, vehicle: usize) -> &mut dyn EditTrajectory {
        (self.edit)(&mut self.plan.trajectories[vehicle])
    }
}

/// Thrusts of a sample. Panics for a fixed wing's.
pub fn thrusts(sample: &mut Sample) -> &mut Commanded<slung_load::Control> {
    match &mut sample.actuation {
        Actuation::Thrusts(thrusts) => thrusts,
        _ => panic!("not a quadrotor"),
    }
}
