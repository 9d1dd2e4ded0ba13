//! Where specimens come from: shipped scenarios, planned and flown.

use scenarios::{Family, Plan, Scenario};
use sim::Flight;

use super::ReferenceCase;
use crate::plan_source::PlanSource;
use crate::verdict;

/// A scenario that is still to be planned and flown.
pub struct UnflownCase {
    /// The scenario: one of those that are shipped, or a part of one.
    pub scenario: Scenario,
    plan_source: PlanSource,
}

/// The specimens of a family: in still air, and with everything that disturbs.
///
/// Panics if a file in the program is no scenario: a bug.
pub fn all(family: Family) -> Vec<UnflownCase> {
    match family {
        Family::FixedWing => vec![
            shipped("rendezvous-2", include_str!("../../../../scenarios/fixed-wing/rendezvous-2.toml")),
            shipped("rendezvous-7-wind", include_str!("../../../../scenarios/fixed-wing/rendezvous-7-wind.toml")),
        ],
        Family::SlungLoad => vec![
            shipped("drop-and-catch", include_str!("../../../../scenarios/slung/drop-and-catch.toml")),
            shipped("drop-and-catch-wind", include_str!("../../../../scenarios/slung/drop-and-catch-wind.toml")),
        ],
        Family::Multirotor => vec![
            head_on(),
            crossing(),
            shipped("corridor-moving", include_str!("../../../../scenarios/multirotor/corridor-moving.toml")),
            tilting(),
            windy(),
        ],
    }
}

fn shipped(name: &str, text: &str) -> UnflownCase {
    let scenario = scenarios::parse(name, text).unwrap_or_else(|error| panic!("{name}: {error}"));
    by(scenario.planner.name.clone().as_str(), scenario)
}

fn by(planner: &str, mut scenario: Scenario) -> UnflownCase {
    let planner = planners::find(planner).unwrap_or_else(|| panic!("{}: unknown planner {planner}", scenario.name));
    planner.name.clone_into(&mut scenario.planner.name);
    UnflownCase { scenario, plan_source: PlanSource::Registered(planner) }
}

/// With drag, of which planners know nothing: without it the tracking would be perfect, and a log that flatters it true.
fn crossing() -> UnflownCase {
    let UnflownCase { mut scenario, plan_source } =
        shipped("crossing-4", include_str!("../../../../scenarios/multirotor/crossing-4.toml"));
    scenario.models.multirotor.values_mut().for_each(|model| model.drag_area_m2 = 0.03);
    UnflownCase { scenario, plan_source }
}

/// The two of the four that fly towards each other, a metre apart, planned ahead and arriving together.
fn head_on() -> UnflownCase {
    let UnflownCase { mut scenario, .. } = crossing();
    "head-on".clone_into(&mut scenario.name);
    scenario.vehicles.truncate(2);
    scenario.fleet.simultaneous_arrival = true;
    by("sparse-astar", scenario)
}

/// A quadrotor that has to tilt, with exact sensors: what is wrong with its log is not hidden by noise.
fn tilting() -> UnflownCase {
    let UnflownCase { mut scenario, plan_source } =
        shipped("paper-map-quadrotor", include_str!("../../../../scenarios/multirotor/paper-map-quadrotor.toml"));
    scenario.simulation.sensors = scenarios::Sensors::default();
    UnflownCase { scenario, plan_source }
}

/// In a wind whose gusts are smaller than its mean: what blows within gusts of its own size cannot be told from them.
fn windy() -> UnflownCase {
    let UnflownCase { mut scenario, plan_source } =
        shipped("paper-map-gusts", include_str!("../../../../scenarios/multirotor/paper-map-gusts.toml"));
    let gusts = scenario.simulation.wind.as_mut().and_then(|wind| wind.gusts.as_mut());
    if let Some(gusts) = gusts {
        (gusts.wind_at_20ft_mps, gusts.sigma_aloft_mps) = (2.0, 0.4);
    }
    scenario.simulation.sensors.delay_s = 0.02;
    UnflownCase { scenario, plan_source }
}

impl UnflownCase {
    /// Plans and flies it.
    pub fn flown(self) -> ReferenceCase {
        let Self { scenario, plan_source } = self;
        let seed = scenario.simulation.seed;
        let (plan, flight) = plan_source.fly_in_loop(&scenario, seed).map_or_else(
            || {
                let plan = ahead(&scenario, &plan_source);
                let flight = flown_ahead(&scenario, &plan);
                (plan, flight)
            },
            |(plan, flight)| (plan, Some(flight)),
        );
        ReferenceCase { scenario, plan, flight, plan_source }
    }
}

fn flown_ahead(scenario: &Scenario, plan: &Plan) -> Option<Flight> {
    let is_flyable = verdict::is_flyable(scenario, plan).is_ok();
    is_flyable.then(|| sim::fly(scenario, plan, scenario.simulation.seed, &mut |_| {}))
}

/// A plan for every vehicle. A planner that handles one at a time plans for one after the other.
fn ahead(scenario: &Scenario, plan_source: &PlanSource) -> Plan {
    let seed = scenario.simulation.seed;
    let plan = |scenario: &Scenario| plan_source.plan(scenario, seed, &mut |_| {}).answer.plan;
    let PlanSource::Registered(planner) = plan_source else { return plan(scenario) };
    if (planner.unsupported_reason)(scenario).is_none() {
        return plan(scenario);
    }
    let alone = |vehicle: &scenarios::Vehicle| {
        let mut alone = scenario.clone();
        alone.vehicles = vec![vehicle.clone()];
        plan(&alone)
    };
    let plans: Vec<Plan> = scenario.vehicles.iter().map(alone).collect();
    let trajectories = plans.iter().flat_map(|plan| plan.trajectories.clone()).collect();
    Plan { trajectories, ..plans[0].clone() }
}

impl ReferenceCase {
    /// Flies it again, for instance in another scenario than it will be judged by: the plan, or by who plans in the loop.
    pub fn fly_in(&mut self, scenario: &Scenario) {
        match self.plan_source.fly_in_loop(scenario, scenario.simulation.seed) {
            Some((plan, flight)) => (self.plan, self.flight) = (plan, Some(flight)),
            None => self.flight = flown_ahead(scenario, &self.plan),
        }
    }

    /// Flies another plan, and says that it was planned as before.
    pub fn fly_instead(&mut self, plan: &Plan) {
        let planning = self.flight().planning.take();
        let flight = sim::fly(&self.scenario, plan, self.scenario.simulation.seed, &mut |_| {});
        self.flight = Some(Flight { planning, ..flight });
    }

    /// Was it planned during the flight?
    pub fn is_planned_in_the_loop(&self) -> bool {
        self.plan_source.plans_in_the_loop()
    }
}
