mod flying;

use scenarios::{Family, Plan, Scenario, fixed_wing, multirotor, slung_load};
use sim::{Actuation, Commanded, Flight, LoadSample, Sample};

use crate::plan_source::PlanSource;
use crate::verdict::{self, Check, Verdict};

pub use flying::{UnflownCase, by, shipped};

/// A scenario with a plan and a flight that pass: what faults are injected into.
#[derive(Clone)]
pub struct ReferenceCase {
    /// The question.
    pub scenario: Scenario,
    /// The planner's answer; of one who plans in the loop, what was followed.
    pub plan: Plan,
    /// What was flown.
    pub flight: Option<Flight>,
    /// Who planned it.
    plan_source: PlanSource,
}

impl ReferenceCase {
    /// By the same judge as every run.
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

    /// What a check measures now. Panics if it measures nothing.
    pub fn value(&self, name: &str) -> f64 {
        self.check(name).value.unwrap_or_else(|| panic!("{name} has no value"))
    }

    /// The flight. Panics if it was taken away.
    pub fn flight(&mut self) -> &mut Flight {
        self.flight.as_mut().expect("a reference has a flight")
    }

    /// The samples of a vehicle.
    pub fn samples(&mut self, vehicle: usize) -> &mut Vec<Sample> {
        &mut self.flight().vehicles[vehicle].samples
    }

    /// The samples of the load of the first vehicle.
    pub fn loads(&mut self) -> &mut Vec<LoadSample> {
        &mut self.flight().vehicles[0].loads
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
        match &mut self.plan.trajectories[vehicle] {
            scenarios::Trajectory::FixedWing(trajectory) => &mut trajectory.times_s,
            scenarios::Trajectory::SlungLoad(trajectory) => &mut trajectory.times_s,
            scenarios::Trajectory::Multirotor(trajectory) => &mut trajectory.times_s,
        }
    }

    /// The nodes of a multirotor's plan. Panics for others.
    pub fn multirotor(&mut self, vehicle: usize) -> &mut multirotor::Trajectory {
        match &mut self.plan.trajectories[vehicle] {
            scenarios::Trajectory::Multirotor(trajectory) => trajectory,
            _ => panic!("not a multirotor"),
        }
    }

    /// The plan of a fixed wing. Panics for others.
    pub fn fixed_wing(&mut self, vehicle: usize) -> &mut fixed_wing::Trajectory {
        match &mut self.plan.trajectories[vehicle] {
            scenarios::Trajectory::FixedWing(trajectory) => trajectory,
            _ => panic!("not a fixed wing"),
        }
    }

    /// The plan of a slung load. Panics for others.
    pub fn slung_load(&mut self) -> &mut slung_load::Trajectory {
        match &mut self.plan.trajectories[0] {
            scenarios::Trajectory::SlungLoad(trajectory) => trajectory,
            _ => panic!("not a slung load"),
        }
    }

    /// The only model of fixed wings.
    pub fn fixed_wing_model(&mut self) -> &mut fixed_wing::Model {
        self.scenario.models.fixed_wing.values_mut().next().expect("the reference has a model")
    }

    /// The only model of multirotors.
    pub fn multirotor_model(&mut self) -> &mut multirotor::Model {
        self.scenario.models.multirotor.values_mut().next().expect("the reference has a model")
    }

    /// The only model of slung loads.
    pub fn slung_load_model(&mut self) -> &mut slung_load::Model {
        self.scenario.models.slung_load.values_mut().next().expect("the reference has a model")
    }
}

/// Load factors of a sample. Panics for a quadrotor's.
pub fn load_factors(sample: &mut Sample) -> &mut Commanded<fixed_wing::Control> {
    match &mut sample.actuation {
        Actuation::LoadFactors(factors) => factors,
        _ => panic!("not a fixed wing"),
    }
}

/// Thrusts of a sample. Panics for a fixed wing's.
pub fn thrusts(sample: &mut Sample) -> &mut Commanded<slung_load::Control> {
    match &mut sample.actuation {
        Actuation::Thrusts(thrusts) => thrusts,
        _ => panic!("not a quadrotor"),
    }
}

/// Acceleration of a sample. Panics for one that does not stand for a point mass.
pub fn acceleration(sample: &mut Sample) -> &mut Commanded<[f64; 3]> {
    match &mut sample.actuation {
        Actuation::Acceleration(acceleration) => acceleration,
        _ => panic!("not a point mass"),
    }
}
