//! The cases of every experiment.

use planners::Planner;
use scenarios::{CostMap, Horizon, PotentialField, PotentialFieldForm, RepulsionForm, Sampler, Scenario};
use serde::Serialize;

use super::Plan;

/// Iterations without improvement after which a search ends, in the experiment that compares search times: with a fixed
/// number of iterations, an earlier end could not show.
const STALL: usize = 10;

/// The experiments of section 5 of the paper, and a comparison of samplers.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Serialize)]
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

/// Every case.
pub fn all(plan: &Plan) -> Vec<Case> {
    let mut cases = Vec::new();
    let mut add = |experiment, scenario: &Scenario, name, planner: &str, options: Horizon| {
        let planner = planners::find(planner).expect("a planner of the registry");
        let mut scenario = scenario.clone();
        // Grid and swarm of the scenario, options of the case.
        let own = scenario.planner.horizon.take().unwrap_or_default();
        scenario.planner.horizon = Some(Horizon {
            step_s: own.step_s,
            steps: own.steps,
            particles: own.particles,
            iterations: own.iterations,
            ..options
        });
        cases.push(Case { experiment, name, scenario, planner });
    };
    let usual = Horizon::default;
    let map = &plan.paper_map;
    add(Experiment::CostMaps, map, "rhc-fpso, visibility", "rhc-fpso", with_cost_map(CostMap::Visibility));
    add(Experiment::CostMaps, map, "rhc-fpso, voronoi", "rhc-fpso", with_cost_map(CostMap::Voronoi));
    add(Experiment::CostMaps, map, "rhc, visibility", "rhc", with_cost_map(CostMap::Visibility));
    add(Experiment::CostMaps, map, "rhc, voronoi", "rhc", with_cost_map(CostMap::Voronoi));
    for planner in ["sparse-astar", "rrt", "rrt-star", "rhc-fpso", "rhc"] {
        add(Experiment::Baselines, map, planner, planner, usual());
    }
    for scenario in [map, &plan.trap] {
        for (name, planner, costs_infeasible) in [
            (PSO_ALL, "rhc-pso", true),
            (PSO_SKIP, "rhc-pso", false),
            (FPSO_ALL, "rhc-fpso", true),
            (FPSO_SKIP, "rhc-fpso", false),
        ] {
            let options = Horizon {
                costs_infeasible: Some(costs_infeasible),
                stall_iterations: Some(STALL),
                ..Horizon::default()
            };
            add(Experiment::Swarms, scenario, name, planner, options);
        }
    }
    add(Experiment::Fields, map, "with cost map, squared", "rhc-apf", field(PotentialFieldForm::WithCostMap, true));
    add(Experiment::Fields, map, "with cost map, printed", "rhc-apf", field(PotentialFieldForm::WithCostMap, false));
    add(Experiment::Fields, map, "alone, squared", "rhc-apf", field(PotentialFieldForm::Alone, true));
    add(Experiment::Fields, map, "alone, printed", "rhc-apf", field(PotentialFieldForm::Alone, false));
    add(Experiment::DynamicMap, &plan.pop_up, "rhc-fpso", "rhc-fpso", usual());
    add(Experiment::DynamicMap, &plan.pop_up, "rhc-apf, alone", "rhc-apf", field(PotentialFieldForm::Alone, true));
    add(Experiment::DynamicMap, &plan.pop_up, "rhc", "rhc", usual());
    for scenario in [map, &plan.trap] {
        for (name, sampler) in [
            ("PSO", Sampler::Pso),
            ("FPSO", Sampler::Fpso),
            ("CEM", Sampler::Cem),
            ("MPPI", Sampler::Mppi),
            ("CMA-ES", Sampler::CmaEs),
        ] {
            add(Experiment::Samplers, scenario, name, "rhc", Horizon { sampler: Some(sampler), ..Horizon::default() });
        }
    }
    cases
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
