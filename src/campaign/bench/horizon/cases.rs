//! The cases of every experiment.

use clap::ValueEnum;
use planners::Planner;
use scenarios::{
    AttractionAlong, CostMap, Horizon, PathTiming, PotentialField, PotentialFieldForm, RepelledBy, RepulsionForm,
    Sampler, Scenario, Search,
};
use serde::Serialize;

use super::Plan;

/// Iterations without improvement after which a search ends, in the experiment that compares search times: with a fixed
/// number of iterations, an earlier end could not show.
const STALL: usize = 10;

/// The experiments of section 5 of the paper, and a comparison of samplers.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Serialize, ValueEnum)]
#[serde(rename_all = "kebab-case")]
pub enum Experiment {
    /// Voronoi against visibility.
    CostMaps,
    /// Against sparse A* and rapidly exploring random trees.
    Baselines,
    /// FPSO against PSO, the two savings apart.
    Swarms,
    /// Potential fields.
    Fields,
    /// Obstacles that appear.
    DynamicMap,
    /// Samplers at equal budget.
    Samplers,
}

impl Experiment {
    /// Its name in a table.
    pub fn name(self) -> &'static str {
        match self {
            Self::CostMaps => "1 cost maps",
            Self::Baselines => "2 baselines",
            Self::Swarms => "3 swarms",
            Self::Fields => "4 fields",
            Self::DynamicMap => "5 dynamic map",
            Self::Samplers => "6 samplers",
        }
    }
}

/// A planner with its options on a scenario.
#[derive(Clone)]
pub struct Case {
    /// Which experiment it belongs to.
    pub experiment: Experiment,
    /// Name of the case.
    pub name: &'static str,
    /// The scenario with the options of the case.
    pub scenario: Scenario,
    /// The planner.
    pub planner: &'static Planner,
}

/// Names of the cases that the notes compare.
pub const PSO_ALL: &str = "PSO, cost of all";
/// See above.
pub const PSO_SKIP: &str = "PSO, infeasible skipped";
/// See above.
pub const FPSO_ALL: &str = "FPSO, cost of all";
/// See above.
pub const FPSO_SKIP: &str = "FPSO, infeasible skipped";

/// The cases of a plan.
pub fn selected(plan: &Plan) -> Vec<Case> {
    let is_selected = |case: &Case| plan.experiment.is_none_or(|experiment| experiment == case.experiment);
    all(plan).into_iter().filter(is_selected).collect()
}

/// Every case.
fn all(plan: &Plan) -> Vec<Case> {
    let mut cases = Vec::new();
    let mut add = |experiment, scenario: &Scenario, name, planner: &str, options: Horizon| {
        let planner = planners::find(planner).expect("a planner of the registry");
        let scenario = with_options(scenario, options);
        cases.push(Case { experiment, name, scenario, planner });
    };
    let usual = Horizon::default;
    let map = &plan.paper_map;
    add(Experiment::CostMaps, map, "rhc-fpso, visibility", "rhc-fpso", with_cost_map(CostMap::Visibility));
    add(Experiment::CostMaps, map, "rhc-fpso, voronoi", "rhc-fpso", with_cost_map(CostMap::Voronoi));
    let vertices = || with_cost_map(CostMap::VoronoiVertices);
    add(Experiment::CostMaps, map, "rhc-fpso, voronoi-vertices", "rhc-fpso", vertices());
    add(Experiment::CostMaps, map, "rhc, visibility", "rhc", with_cost_map(CostMap::Visibility));
    add(Experiment::CostMaps, map, "rhc, voronoi", "rhc", with_cost_map(CostMap::Voronoi));
    for planner in ["sparse-astar", "rrt", "rrt-star", "rhc-fpso", "rhc"] {
        add(Experiment::Baselines, map, planner, planner, usual());
    }
    let as_planned = as_planned(map);
    for (name, planner) in AS_PLANNED {
        add(Experiment::Baselines, &as_planned, name, planner, usual());
    }
    for scenario in [map, &plan.trap] {
        add(Experiment::Swarms, scenario, "FPSO, the paper's update", "rhc-fpso-plain", stalling(false));
        for (name, planner, costs_infeasible) in [
            (PSO_ALL, "rhc-pso", true),
            (PSO_SKIP, "rhc-pso", false),
            (FPSO_ALL, "rhc-fpso", true),
            (FPSO_SKIP, "rhc-fpso", false),
        ] {
            add(Experiment::Swarms, scenario, name, planner, stalling(costs_infeasible));
        }
    }
    add(Experiment::Fields, map, "with cost map, squared", "rhc-apf", field(PotentialFieldForm::WithCostMap, true));
    add(Experiment::Fields, map, "with cost map, printed", "rhc-apf", field(PotentialFieldForm::WithCostMap, false));
    add(Experiment::Fields, map, "alone, squared", "rhc-apf", field(PotentialFieldForm::Alone, true));
    add(Experiment::Fields, map, "alone, printed", "rhc-apf", field(PotentialFieldForm::Alone, false));
    add(Experiment::Fields, map, "alone, all obstacles", "rhc-apf", variant(None, Some(RepelledBy::All)));
    let along = Some(AttractionAlong::Horizon);
    add(Experiment::Fields, map, "alone, whole horizon", "rhc-apf", variant(along, None));
    add(Experiment::DynamicMap, &plan.pop_up, "rhc-fpso", "rhc-fpso", usual());
    add(Experiment::DynamicMap, &plan.pop_up, "rhc-fpso-plain", "rhc-fpso-plain", usual());
    add(Experiment::DynamicMap, &plan.pop_up, "rhc-apf, alone", "rhc-apf", field(PotentialFieldForm::Alone, true));
    add(Experiment::DynamicMap, &plan.pop_up, "rhc", "rhc", usual());
    for (name, east_m) in SLOTS {
        add(Experiment::DynamicMap, &with_slot(&plan.pop_up, east_m), name, "rhc-fpso", usual());
    }
    let end_alone = Horizon { stage_weight: Some(0.0), ..Horizon::default() };
    add(Experiment::DynamicMap, &plan.pop_up, END_ALONE, "rhc-fpso", end_alone);
    for scenario in [map, &plan.trap] {
        for (name, sampler) in SAMPLERS {
            add(Experiment::Samplers, scenario, name, "rhc", Horizon { sampler: Some(sampler), ..Horizon::default() });
        }
    }
    cases
}

/// A scenario with the options of a case; grid, swarm and weights are its own.
fn with_options(scenario: &Scenario, options: Horizon) -> Scenario {
    let mut scenario = scenario.clone();
    let own = scenario.planner.horizon.take().unwrap_or_default();
    scenario.planner.horizon = Some(Horizon {
        step_s: own.step_s,
        steps: own.steps,
        particles: own.particles,
        iterations: own.iterations,
        swarm: own.swarm,
        violation_weights: own.violation_weights,
        stage_weight: options.stage_weight.or(own.stage_weight),
        ..options
    });
    scenario
}

/// The samplers that are compared.
const SAMPLERS: [(&str, Sampler); 5] = [
    ("PSO", Sampler::Pso),
    ("FPSO", Sampler::Fpso),
    ("CEM", Sampler::Cem),
    ("MPPI", Sampler::Mppi),
    ("CMA-ES", Sampler::CmaEs),
];

/// The paths of the baselines, flown as planned.
const AS_PLANNED: [(&str, &str); 3] =
    [("sparse-astar, as planned", "sparse-astar"), ("rrt, as planned", "rrt"), ("rrt-star, as planned", "rrt-star")];

/// The scenario with paths that are flown as planned, without regard to the acceleration limit.
fn as_planned(scenario: &Scenario) -> Scenario {
    let mut scenario = scenario.clone();
    scenario.planner.search = Some(Search { timing: Some(PathTiming::ConstantSpeed) });
    scenario
}

/// The case without the mean cost-to-go over the horizon.
const END_ALONE: &str = "rhc-fpso, cost-to-go at the end alone";

/// The wall that is sensed first, and its displacements: it leaves a slot of 1.25 m beside block-10, through which the
/// shortest path of the cost map leads. Closed it is 0.85 m wide, which the clearance does not admit; wide 2.25 m.
const LOWER_WALL: &str = "popup-lower";
const SLOTS: [(&str, f64); 2] = [("rhc-fpso, slot closed", -0.4), ("rhc-fpso, slot of 2.25 m", 1.0)];

/// The scenario with its lower wall displaced to the east.
fn with_slot(scenario: &Scenario, east_m: f64) -> Scenario {
    let mut scenario = scenario.clone();
    for wall in scenario.world.boxes.iter_mut().filter(|wall| wall.name == LOWER_WALL) {
        wall.center_m[0] += east_m;
    }
    scenario
}

fn stalling(costs_infeasible: bool) -> Horizon {
    Horizon { costs_infeasible: Some(costs_infeasible), stall_iterations: Some(STALL), ..Horizon::default() }
}

/// A field without a cost map (eq. 17) with variants of eq. 2 and 3.
fn variant(attraction_along: Option<AttractionAlong>, repelled_by: Option<RepelledBy>) -> Horizon {
    let usual = field(PotentialFieldForm::Alone, true);
    let field = usual.field.map(|field| PotentialField { attraction_along, repelled_by, ..field });
    Horizon { field, ..Horizon::default() }
}

fn with_cost_map(cost_map: CostMap) -> Horizon {
    Horizon { cost_map: Some(cost_map), ..Horizon::default() }
}

fn field(form: PotentialFieldForm, is_squared: bool) -> Horizon {
    let repulsion = if is_squared { RepulsionForm::Squared } else { RepulsionForm::Printed };
    Horizon {
        field: Some(PotentialField { form: Some(form), repulsion: Some(repulsion), ..PotentialField::default() }),
        ..Horizon::default()
    }
}
