//! Selftest of multirotors. Each reference case shows what the others cannot.

mod flights;
mod in_loop;
mod moving;
mod near_misses;
mod plans;
mod rotors;

use scenarios::multirotor::{self, Plant};
use scenarios::{Family, Sensors, Trajectory};

use super::edit_trajectory::EditTrajectory;
use super::family::FamilySelftest;
use super::faults::tightened_limits::{self, FamilyLimits, SEPARATION_CHECKS, limit};
use super::faults::{log, places, plan, requirements};
use super::reference_case::UnflownCase;
use super::{Fault, ReferenceCase};

/// The entry in the selftest's table of families.
pub static SELFTEST: FamilySelftest = FamilySelftest {
    family: Family::Multirotor,
    reference_cases,
    faults,
    near_misses: near_misses::all,
    // A multirotor's plan ends exactly in its goal: no limit is below that.
    limits: FamilyLimits {
        upper: &[
            limit("the limit of the distance from the goal", &["flight.goal"], |it, limit| {
                it.scenario.verdict.goal_m = Some(limit);
            }),
            limit("the limit of the speed at the end", &["flight.rest"], |it, limit| {
                it.scenario.verdict.rest_mps = Some(limit);
            }),
        ],
        distance_checks: SEPARATION_CHECKS,
        set_distance: tightened_limits::set_separation,
    },
    edit,
};

fn reference_cases() -> Vec<UnflownCase> {
    vec![
        head_on(),
        crossing(),
        UnflownCase::shipped("corridor-moving", include_str!("../../../scenarios/multirotor/corridor-moving.toml")),
        tilting(),
        windy(),
    ]
}

/// With drag, which planners do not know: without it the tracking would be perfect, and a flattering log would be true.
fn crossing() -> UnflownCase {
    let text = include_str!("../../../scenarios/multirotor/crossing-4.toml");
    UnflownCase::shipped("crossing-4", text).with(|scenario| {
        scenario.models.multirotor.values_mut().for_each(|model| model.drag_area_m2 = 0.03);
    })
}

/// The two of the four that fly towards each other, a metre apart, planned before the flight and arriving together.
fn head_on() -> UnflownCase {
    crossing().planned_by("sparse-astar").with(|scenario| {
        "head-on".clone_into(&mut scenario.name);
        scenario.vehicles.truncate(2);
        scenario.fleet.simultaneous_arrival = true;
    })
}

/// A quadrotor that has to tilt, with exact sensors, so that noise does not hide what is wrong with its log.
fn tilting() -> UnflownCase {
    let text = include_str!("../../../scenarios/multirotor/paper-map-quadrotor.toml");
    UnflownCase::shipped("paper-map-quadrotor", text).with(|scenario| scenario.simulation.sensors = Sensors::default())
}

/// In a wind whose gusts are smaller than its mean: gusts of its size would hide a wrong mean.
fn windy() -> UnflownCase {
    let text = include_str!("../../../scenarios/multirotor/paper-map-gusts.toml");
    UnflownCase::shipped("paper-map-gusts", text).with(|scenario| {
        let gusts = scenario.simulation.wind.as_mut().and_then(|wind| wind.gusts.as_mut());
        if let Some(gusts) = gusts {
            (gusts.wind_at_20ft_mps, gusts.sigma_aloft_mps) = (2.0, 0.4);
        }
        scenario.simulation.sensors.delay_s = 0.02;
    })
}

fn faults(reference: &ReferenceCase) -> Vec<Fault> {
    if has_rotors(reference) {
        rotors::faults().into_iter().chain(places::flown_faults()).collect()
    } else if !reference.scenario.world.moving.is_empty() {
        moving::faults().into_iter().chain(places::flown_faults()).collect()
    } else if reference.is_planned_in_the_loop() {
        [log::faults(), in_loop::faults(), places::flown_faults(), requirements::flown_faults()]
            .into_iter()
            .flatten()
            .collect()
    } else {
        // Positions and velocities determine the accelerations between two nodes: there is no defect.
        let on_plans = plan::faults().into_iter().filter(|fault| fault.aims_at != "plan.dynamics");
        let limits = tightened_limits::faults(&SELFTEST.limits);
        let all = [log::faults(), plans::faults(), flights::faults(), places::faults(), requirements::faults(), limits];
        on_plans.chain(all.into_iter().flatten()).collect()
    }
}

/// Whether the plant has rotors, and so an attitude.
fn has_rotors(reference: &ReferenceCase) -> bool {
    reference.scenario.models.multirotor.values().any(|model| model.plant == Plant::Quadrotor)
}

fn edit(trajectory: &mut Trajectory) -> &mut dyn EditTrajectory {
    trajectory_of(trajectory)
}

fn trajectory_of(trajectory: &mut Trajectory) -> &mut multirotor::Trajectory {
    match trajectory {
        Trajectory::Multirotor(trajectory) => trajectory,
        _ => panic!("not a multirotor"),
    }
}

impl EditTrajectory for multirotor::Trajectory {
    fn vehicle(&mut self) -> &mut String {
        &mut self.vehicle
    }

    fn times_s(&mut self) -> &mut Vec<f64> {
        &mut self.times_s
    }

    fn truncate(&mut self, nodes: usize) {
        self.times_s.truncate(nodes);
        self.states.truncate(nodes);
    }

    fn move_north(&mut self, by_m: f64) {
        self.states.iter_mut().for_each(|state| state.position_m[1] += by_m);
    }
}

impl ReferenceCase {
    /// The planned trajectory of a multirotor. Panics for others.
    fn multirotor(&mut self, vehicle: usize) -> &mut multirotor::Trajectory {
        trajectory_of(&mut self.plan.trajectories[vehicle])
    }

    /// The only model of multirotors.
    fn multirotor_model(&mut self) -> &mut multirotor::Model {
        self.scenario.models.multirotor.values_mut().next().expect("the reference has a model")
    }
}
