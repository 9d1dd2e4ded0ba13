//! Controller settings from a scenario.

use scenarios::{
    AttractionAlong, CostMap, Horizon, PotentialField, PotentialFieldForm, RepelledBy, RepulsionForm, Sampler, Scenario,
};

use super::controller::{ControllerSettings, CostModel};
use super::optimiser::Budget;
use super::problem::{Attraction, ControlGrid, Repulsion, VIOLATION_WEIGHTS};
use super::sampler::{Inertia, SamplerKind, SwarmSettings};
use crate::multirotor::{self, PlanningLimits};
use crate::roadmap::RoadmapKind;

/// Number of node altitudes of cost maps in space, in addition to those of start and goal.
const NODE_ALTITUDES: usize = 4;

/// Variant of the receding-horizon planner.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Variant {
    /// RHC with the additions to the paper.
    Default,
    /// RHC-PSO.
    Pso,
    /// RHC-FPSO.
    Fpso,
    /// RHC-FPSO with the paper's update alone.
    PlainFpso,
    /// RHC-APF: FPSO with a potential field.
    Apf,
}

/// Altitudes at which cost maps have their nodes, m: in the plane only that of the vehicle.
pub fn node_altitudes_m(scenario: &Scenario, vehicle: usize) -> Vec<f64> {
    let vehicle = &scenario.vehicles[vehicle];
    let mut altitudes_m = vec![vehicle.start.z_m];
    if !scenario.is_planar() {
        let range = scenario.world.map.z_m;
        let fraction = |level: usize| (level + 1) as f64 / (NODE_ALTITUDES + 1) as f64;
        altitudes_m.push(vehicle.goal.z_m);
        altitudes_m.extend(vehicle.via.iter().map(|via| via.z_m));
        altitudes_m.extend((0..NODE_ALTITUDES).map(|level| range.min + fraction(level) * (range.max - range.min)));
    }
    altitudes_m.sort_by(f64::total_cmp);
    altitudes_m.dedup();
    altitudes_m
}

/// Settings of a vehicle's controller.
pub fn controller_settings(scenario: &Scenario, vehicle: usize, variant: Variant) -> ControllerSettings {
    let horizon = scenario.planner.horizon.clone().unwrap_or_default();
    let is_default = variant == Variant::Default;
    ControllerSettings {
        sampler: sampler(&horizon, variant),
        budget: Budget {
            particles: horizon.particles.unwrap_or(40),
            max_iterations: horizon.iterations.unwrap_or(60),
            stall_iterations: horizon.stall_iterations,
        },
        cost_model: cost_model(&horizon, variant),
        grid: ControlGrid { steps: horizon.steps.unwrap_or(12), axes: if scenario.is_planar() { 2 } else { 3 } },
        step_s: horizon.step_s.unwrap_or(0.25),
        limits: PlanningLimits::of_vehicle(scenario, vehicle),
        clearance_m: multirotor::clearance_m(scenario, vehicle),
        violation_weights: violation_weights(&horizon),
        smoothness_weight: if is_default { 1e-2 } else { 0.0 },
        stage_weight: horizon.stage_weight.unwrap_or(1.0),
        starts_warm: is_default,
        projects_controls: is_default,
        requires_stop: is_default,
        brakes_at_goal: horizon.brakes_at_goal.unwrap_or(variant != Variant::PlainFpso),
        costs_infeasible: horizon.costs_infeasible.unwrap_or(false),
        known_radius_m: known_radius_m(scenario, vehicle),
    }
}

/// Distance from the state at which an answer takes effect within which all static obstacles are known, m.
fn known_radius_m(scenario: &Scenario, vehicle: usize) -> f64 {
    let model = scenario.multirotor_model(&scenario.vehicles[vehicle]);
    model.sensor_range_m - model.planning_limits.speed_mps * scenario.simulation.planning.deadline_s
}

fn sampler(horizon: &Horizon, variant: Variant) -> SamplerKind {
    let sampler = match variant {
        Variant::Default => horizon.sampler.unwrap_or(Sampler::Fpso),
        Variant::Pso => Sampler::Pso,
        Variant::Fpso | Variant::PlainFpso | Variant::Apf => Sampler::Fpso,
    };
    match sampler {
        Sampler::Pso => SamplerKind::ParticleSwarm(swarm(horizon, SwarmSettings::STANDARD)),
        Sampler::Fpso => {
            let keeps_best = variant != Variant::PlainFpso;
            let defaults = SwarmSettings { keeps_best, ..SwarmSettings::FEASIBILITY_DRIVEN };
            SamplerKind::ParticleSwarm(swarm(horizon, defaults))
        }
        Sampler::Cem => SamplerKind::CrossEntropy,
        Sampler::Mppi => SamplerKind::PathIntegral,
        Sampler::CmaEs => SamplerKind::CmaEs,
    }
}

/// The swarm of the scenario, by default that of `defaults`.
fn swarm(horizon: &Horizon, defaults: SwarmSettings) -> SwarmSettings {
    let own = horizon.swarm.clone().unwrap_or_default();
    SwarmSettings {
        cognitive: own.cognitive.unwrap_or(defaults.cognitive),
        social: own.social.unwrap_or(defaults.social),
        inertia: Inertia {
            first: own.inertia_max.unwrap_or(defaults.inertia.first),
            last: own.inertia_min.unwrap_or(defaults.inertia.last),
            ..defaults.inertia
        },
        velocity_fraction: own.velocity_fraction.unwrap_or(defaults.velocity_fraction),
        moves_as_printed: horizon.moves_as_printed.unwrap_or(defaults.moves_as_printed),
        keeps_best: own.keeps_best.unwrap_or(defaults.keeps_best),
    }
}

fn violation_weights(horizon: &Horizon) -> [f64; 3] {
    let own = horizon.violation_weights.clone().unwrap_or_default();
    let [distance, speed, acceleration] = VIOLATION_WEIGHTS;
    [own.distance.unwrap_or(distance), own.speed.unwrap_or(speed), own.acceleration.unwrap_or(acceleration)]
}

fn cost_model(horizon: &Horizon, variant: Variant) -> CostModel {
    let roadmap = match horizon.cost_map {
        Some(CostMap::Voronoi) => RoadmapKind::Voronoi,
        Some(CostMap::VoronoiVertices) => RoadmapKind::VoronoiVertices,
        Some(CostMap::Visibility) | None => RoadmapKind::Visibility,
    };
    let field = horizon.field.clone().unwrap_or_default();
    match (variant, field.form) {
        (Variant::Apf, Some(PotentialFieldForm::Alone)) => {
            let attraction = Attraction {
                gain: field.attraction.unwrap_or(0.1),
                is_along_horizon: field.attraction_along == Some(AttractionAlong::Horizon),
            };
            CostModel::PotentialField { attraction, repulsion: repulsion(&field) }
        }
        (Variant::Apf, _) => CostModel::CostMap { roadmap, repulsion: Some(repulsion(&field)) },
        _ => CostModel::CostMap { roadmap, repulsion: None },
    }
}

fn repulsion(field: &PotentialField) -> Repulsion {
    Repulsion {
        gain: field.gain.unwrap_or(0.05),
        reach_m: field.reach_m.unwrap_or(1.0),
        is_squared: field.repulsion != Some(RepulsionForm::Printed),
        is_by_all: field.repelled_by == Some(RepelledBy::All),
    }
}
