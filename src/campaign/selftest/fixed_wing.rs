//! Selftest of fixed wings.

mod faults;
mod goals;

use scenarios::{Cylinder, Family, Trajectory, fixed_wing};
use sim::{Actuation, Commanded, Sample};

use super::edit_trajectory::EditTrajectory;
use super::family::FamilySelftest;
use super::faults::tightened_limits::{self, DEFECTS, FamilyLimits, SEPARATION_CHECKS, limit};
use super::faults::{places, requirements};
use super::near_misses::{self, NEAR_M};
use super::reference_case::UnflownCase;
use super::{Fault, NearMiss, ReferenceCase};

/// The entry in the selftest's table of families.
pub static SELFTEST: FamilySelftest = FamilySelftest {
    family: Family::FixedWing,
    reference_cases,
    faults,
    near_misses,
    limits: FamilyLimits {
        upper: &[
            DEFECTS,
            limit("the limit of the open-loop error", &["plan.rollout"], |it, limit| {
                it.scenario.verdict.rollout_m = Some(limit);
            }),
            limit("the limit of the spread of arrivals", &["flight.arrival"], |it, limit| {
                it.scenario.verdict.arrival_spread_s = Some(limit);
            }),
        ],
        distance_checks: SEPARATION_CHECKS,
        set_distance: tightened_limits::set_separation,
    },
    edit,
};

fn reference_cases() -> Vec<UnflownCase> {
    vec![
        UnflownCase::shipped("rendezvous-2", include_str!("../../../scenarios/fixed-wing/rendezvous-2.toml")),
        UnflownCase::shipped("rendezvous-7-wind", include_str!("../../../scenarios/fixed-wing/rendezvous-7-wind.toml")),
    ]
}

fn faults(_: &ReferenceCase) -> Vec<Fault> {
    super::faults::with_common(faults::all().into_iter().chain(goals::faults()).collect(), &SELFTEST.limits)
}

fn near_misses(_: &ReferenceCase) -> Vec<NearMiss> {
    let own = [places::near_misses(), requirements::near_misses(), vec![near_misses::separation()]];
    let common = [near_misses::limits(&SELFTEST.limits), near_misses::whole()].into_iter().chain(own);
    common.flatten().chain(own_near_misses()).chain(goals::near_misses()).collect()
}

fn own_near_misses() -> [NearMiss; 2] {
    [
        NearMiss::new("a pole that a wing just clears", |it| {
            let (middle, wing_m) = (it.steps() / 2, it.fixed_wing_model().body_radius_m);
            let from = it.samples(0)[middle];
            let [vx, vy, _] = from.velocity_mps;
            let (speed_mps, left_m) = (vx.hypot(vy), wing_m + 1.0);
            let [x_m, y_m, _] = from.position_m;
            let center_m = [x_m - left_m * vy / speed_mps, y_m + left_m * vx / speed_mps];
            it.scenario.world.cylinders.push(Cylinder { name: "planted".to_owned(), center_m, radius_m: 0.9 });
        }),
        NearMiss::new("a flight just below the largest airspeed", |it| {
            let airspeed = |sample: &Sample| sample.air_velocity_mps().iter().map(|v| v * v).sum::<f64>().sqrt();
            let fastest = |samples: &[Sample]| samples.iter().map(airspeed).fold(0.0, f64::max);
            let logs = &it.flight().vehicles;
            let fastest_mps = logs.iter().map(|log| fastest(&log.samples)).fold(0.0, f64::max);
            let planned_mps = it.fixed_wing_model().planning_limits.speed_mps.max + 1e-4;
            it.fixed_wing_model().limits.speed_mps.max = fastest_mps.max(planned_mps) + NEAR_M;
        }),
    ]
}

fn edit(trajectory: &mut Trajectory) -> &mut dyn EditTrajectory {
    trajectory_of(trajectory)
}

fn trajectory_of(trajectory: &mut Trajectory) -> &mut fixed_wing::Trajectory {
    match trajectory {
        Trajectory::FixedWing(trajectory) => trajectory,
        _ => panic!("not a fixed wing"),
    }
}

impl EditTrajectory for fixed_wing::Trajectory {
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
    }

    fn move_north(&mut self, by_m: f64) {
        self.states.iter_mut().for_each(|state| state.y_m += by_m);
    }
}

impl ReferenceCase {
    /// The planned trajectory of a fixed wing. Panics for others.
    fn fixed_wing(&mut self, vehicle: usize) -> &mut fixed_wing::Trajectory {
        trajectory_of(&mut self.plan.trajectories[vehicle])
    }

    /// The only model of fixed wings.
    fn fixed_wing_model(&mut self) -> &mut fixed_wing::Model {
        self.scenario.models.fixed_wing.values_mut().next().expect("the reference has a model")
    }
}

/// Load factors of a sample. Panics for a quadrotor's.
fn load_factors(sample: &mut Sample) -> &mut Commanded<fixed_wing::Control> {
    match &mut sample.actuation {
        Actuation::LoadFactors(factors) => factors,
        _ => panic!("not a fixed wing"),
    }
}
