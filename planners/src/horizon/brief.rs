//! From a scenario to the options of a pilot.

use scenarios::{CostMap, Family, Horizon, PotentialField, PotentialFieldForm, RepulsionForm, Sampler, Scenario};

use super::cost_map::Ways;
use super::optimise::Budget;
use super::pilot::{Charge, Options};
use super::question::{Grid, Limits, Repulsion};
use super::sampler::{Method, Swarm};

/// Distance kept beyond the body, m, where the scenario says nothing: room for the tracker.
const MARGIN_M: f64 = 0.25;

/// Altitudes of the nodes of cost maps in space, beside those of start and goal.
const LEVELS: usize = 4;

/// Which planner.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Variant {
    /// Our own.
    Ours,
    /// RHC-PSO.
    Pso,
    /// RHC-FPSO.
    Fpso,
    /// RHC-APF: FPSO with a potential field.
    Apf,
}

/// Why a planner for multirotors cannot handle a scenario, if it cannot.
pub fn refuses(scenario: &Scenario) -> Option<String> {
    (scenario.family() != Family::Multirotor)
        .then(|| format!("vehicle `{}` is not a multirotor", scenario.vehicles[0].name))
}

/// Distance between a vehicle's centre and everything else that its planner keeps, m.
pub fn clearance_m(scenario: &Scenario, vehicle: usize) -> f64 {
    let model = scenario.multirotor_model(&scenario.vehicles[vehicle]);
    model.body_radius_m + margin_m(scenario)
}

/// Distance kept beyond the body, m.
pub fn margin_m(scenario: &Scenario) -> f64 {
    scenario.planner.margin_m.unwrap_or(MARGIN_M)
}

/// What a vehicle keeps to while it plans.
pub fn limits(scenario: &Scenario, vehicle: usize) -> Limits {
    let limits = scenario.multirotor_model(&scenario.vehicles[vehicle]).planning_limits;
    Limits { speed_mps: limits.speed_mps, acceleration_mps2: limits.acceleration_mps2 }
}

/// Altitudes at which cost maps have their nodes, m: in the plane that of the vehicle.
pub fn levels_m(scenario: &Scenario, vehicle: usize) -> Vec<f64> {
    let vehicle = &scenario.vehicles[vehicle];
    let [start_m, goal_m] = [&vehicle.start, &vehicle.goal].map(|point| point.position_m()[2]);
    let mut levels_m = vec![start_m];
    if !scenario.is_planar() {
        let range = scenario.world.map.z_m;
        let share = |level: usize| (level + 1) as f64 / (LEVELS + 1) as f64;
        levels_m.push(goal_m);
        levels_m.extend((0..LEVELS).map(|level| range.min + share(level) * (range.max - range.min)));
    }
    levels_m.sort_by(f64::total_cmp);
    levels_m.dedup();
    levels_m
}

/// How a vehicle's pilot plans.
pub fn options(scenario: &Scenario, vehicle: usize, variant: Variant) -> Options {
    let horizon = scenario.planner.horizon.clone().unwrap_or_default();
    let limits = limits(scenario, vehicle);
    let is_ours = variant == Variant::Ours;
    Options {
        method: method(&horizon, variant),
        budget: Budget {
            particles: horizon.particles.unwrap_or(40),
            iterations: horizon.iterations.unwrap_or(60),
            stall: horizon.stall_iterations,
        },
        charge: charge(&horizon, variant),
        grid: Grid { steps: horizon.steps.unwrap_or(12), axes: if scenario.is_planar() { 2 } else { 3 } },
        step_s: horizon.step_s.unwrap_or(0.25),
        limits,
        clearance_m: clearance_m(scenario, vehicle),
        smoothness: if is_ours { 1e-2 } else { 0.0 },
        stage_weight: 1.0,
        starts_warm: is_ours,
        is_projected: is_ours,
        stops: is_ours,
        costs_infeasible: horizon.costs_infeasible.unwrap_or(false),
        known_within_m: known_within_m(scenario, vehicle),
    }
}

/// Distance from where an answer takes effect within which everything that stands still is known, m.
fn known_within_m(scenario: &Scenario, vehicle: usize) -> f64 {
    let model = scenario.multirotor_model(&scenario.vehicles[vehicle]);
    model.sensor_range_m - model.planning_limits.speed_mps * scenario.simulation.planning.deadline_s
}

fn method(horizon: &Horizon, variant: Variant) -> Method {
    let sampler = match variant {
        Variant::Ours => horizon.sampler.unwrap_or(Sampler::Fpso),
        Variant::Pso => Sampler::Pso,
        Variant::Fpso | Variant::Apf => Sampler::Fpso,
    };
    let moves_as_printed = horizon.moves_as_printed.unwrap_or(false);
    match sampler {
        Sampler::Pso => Method::Swarm(Swarm { moves_as_printed, ..Swarm::USUAL }),
        Sampler::Fpso => Method::Swarm(Swarm { moves_as_printed, ..Swarm::FEASIBILITY }),
        Sampler::Cem => Method::CrossEntropy,
        Sampler::Mppi => Method::PathIntegral,
        Sampler::CmaEs => Method::CmaEs,
    }
}

fn charge(horizon: &Horizon, variant: Variant) -> Charge {
    let ways = match horizon.cost_map {
        Some(CostMap::Voronoi) => Ways::Voronoi,
        Some(CostMap::Visibility) | None => Ways::Visibility,
    };
    let field = horizon.field.clone().unwrap_or_default();
    match (variant, field.form) {
        (Variant::Apf, Some(PotentialFieldForm::Alone)) => {
            Charge::Field(field.attraction.unwrap_or(0.1), repulsion(&field))
        }
        (Variant::Apf, _) => Charge::Map(ways, Some(repulsion(&field))),
        _ => Charge::Map(ways, None),
    }
}

fn repulsion(field: &PotentialField) -> Repulsion {
    Repulsion {
        gain: field.gain.unwrap_or(0.05),
        reach_m: field.reach_m.unwrap_or(1.0),
        is_squared: field.repulsion != Some(RepulsionForm::Printed),
    }
}
