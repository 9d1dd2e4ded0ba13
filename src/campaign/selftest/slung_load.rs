//! Selftest of quadrotors with a slung load.

mod faults;

use scenarios::{Family, Trajectory, slung_load};
use sim::LoadSample;

use super::edit_trajectory::EditTrajectory;
use super::family::FamilySelftest;
use super::faults::tightened_limits::{self, DEFECTS, FamilyLimits, GOALS, limit};
use super::faults::{places, requirements};
use super::near_misses::{self, NEAR_M};
use super::reference_case::{UnflownCase, thrusts};
use super::{Fault, NearMiss, ReferenceCase};

/// The entry in the selftest's table of families.
pub static SELFTEST: FamilySelftest = FamilySelftest {
    family: Family::SlungLoad,
    reference_cases,
    faults,
    near_misses,
    limits: FamilyLimits {
        upper: &[
            DEFECTS,
            GOALS,
            limit("the limit of the speed at the end", &["plan.rest", "flight.rest"], |it, limit| {
                it.scenario.verdict.rest_mps = Some(limit);
            }),
            limit("the strength of the cable", &["plan.tension", "flight.tension"], |it, limit| {
                it.slung_load_model().limits.tension_n = limit;
            }),
            limit("the limit of the time between planned and flown switches", &["flight.slack"], |it, limit| {
                it.scenario.verdict.switch_s = Some(limit);
            }),
        ],
        distance_checks: &["nodes.envelope", "plan.envelope"],
        set_distance: tightened_limits::set_envelope,
    },
    edit,
};

fn reference_cases() -> Vec<UnflownCase> {
    vec![
        UnflownCase::shipped("drop-and-catch", include_str!("../../../scenarios/slung/drop-and-catch.toml")),
        UnflownCase::shipped("drop-and-catch-wind", include_str!("../../../scenarios/slung/drop-and-catch-wind.toml")),
    ]
}

fn faults(_: &ReferenceCase) -> Vec<Fault> {
    let own = faults::all().into_iter().chain(places::load_faults());
    super::faults::with_common(own.collect(), &SELFTEST.limits)
}

fn near_misses(_: &ReferenceCase) -> Vec<NearMiss> {
    let bounds = [near_misses::limits(&SELFTEST.limits), near_misses::whole()];
    let common = bounds.into_iter().chain([places::near_misses(), requirements::near_misses()]);
    common.flatten().chain(own_near_misses()).collect()
}

fn own_near_misses() -> [NearMiss; 2] {
    [
        NearMiss::new("an envelope just outside the obstacle", |it| {
            let nearest_m = it.value("nodes.envelope").min(it.value("plan.envelope"));
            tightened_limits::set_envelope(it, nearest_m - NEAR_M);
        }),
        NearMiss::new("thrusts just below the largest of the rotors", |it| {
            let flown = it.samples(0).iter_mut().flat_map(|it| thrusts(it).control.thrust_n);
            let largest_n = flown.fold(0.0, f64::max);
            let promised_n = it.slung_load_model().planning_limits.thrust_n.max + 1e-4;
            let planned = it.slung_load().controls.iter().flat_map(|control| control.thrust_n);
            let planned_n = planned.fold(promised_n, f64::max);
            it.slung_load_model().limits.thrust_n.max = largest_n.max(planned_n) + NEAR_M;
        }),
    ]
}

fn edit(trajectory: &mut Trajectory) -> &mut dyn EditTrajectory {
    trajectory_of(trajectory)
}

fn trajectory_of(trajectory: &mut Trajectory) -> &mut slung_load::Trajectory {
    match trajectory {
        Trajectory::SlungLoad(trajectory) => trajectory,
        _ => panic!("not a slung load"),
    }
}

impl EditTrajectory for slung_load::Trajectory {
    fn vehicle(&mut self) -> &mut String {
        &mut self.vehicle
    }

    fn times_s(&mut self) -> &mut Vec<f64> {
        &mut self.times_s
    }

    fn truncate(&mut self, nodes: usize) {
        self.times_s.truncate(nodes);
        self.states.truncate(nodes);
        self.controls.truncate(nodes);
        self.cable.truncate(nodes);
        self.planner_nodes.retain(|node| *node < nodes);
    }

    fn move_north(&mut self, by_m: f64) {
        self.states.iter_mut().for_each(|state| {
            state.position_m[1] += by_m;
            state.load_position_m[1] += by_m;
        });
    }
}

impl ReferenceCase {
    /// The planned trajectory of a slung load. Panics for others.
    fn slung_load(&mut self) -> &mut slung_load::Trajectory {
        trajectory_of(&mut self.plan.trajectories[0])
    }

    /// The only model of slung loads.
    fn slung_load_model(&mut self) -> &mut slung_load::Model {
        self.scenario.models.slung_load.values_mut().next().expect("the reference has a model")
    }

    /// The samples of the load of the first vehicle.
    pub fn loads(&mut self) -> &mut Vec<LoadSample> {
        &mut self.flight().vehicles[0].loads
    }
}
