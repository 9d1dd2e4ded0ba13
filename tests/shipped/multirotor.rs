//! Every shipped scenario of multirotors passes with its planner, and flies the same on any number of threads.

use harness::plan_source::in_loop::as_plan;
use harness::verdict::{self, Outcome};
use scenarios::in_loop::InLoopPlanner;
use scenarios::{Plan, Scenario};
use sim::Flight;

/// Long enough for a few replans of every planner, s.
const FIRST_SECONDS_S: f64 = 3.0;

fn flown(scenario: &Scenario, planner: &str) -> Flight {
    let entry = planners::find(planner).expect("a planner that exists");
    let planner_view = scenario.planner_view();
    let seed = scenario.simulation.seed;
    let vehicles = 0..scenario.vehicles.len();
    let planners: Vec<Box<dyn InLoopPlanner>> =
        vehicles.map(|index| entry.in_loop(&planner_view, index, seed)).collect();
    sim::fly(scenario, planners, seed, &mut |_| {})
}

/// The references that were followed in the first seconds of a flight.
pub fn followed(scenario: &Scenario, planner: &planners::Planner) -> Plan {
    let mut short = scenario.clone();
    short.simulation.max_duration_s = FIRST_SECONDS_S.min(scenario.simulation.max_duration_s);
    let flight = flown(&short, planner.name);
    as_plan(scenario, planner.name, 0, flight.planning.as_ref().expect("a log of the planning"))
}

#[test]
fn every_shipped_scenario_passes() {
    let shipped = super::shipped_in("scenarios/multirotor");
    assert!(shipped.len() >= 11);
    for (_, scenario) in shipped {
        let flight = flown(&scenario, &scenario.planner.name);
        let log = flight.planning.as_ref().expect("a log of the planning");
        let plan = as_plan(&scenario, &scenario.planner.name, 0, log);
        let verdict = verdict::judge(&scenario, &plan, Some(&flight));
        let bad: Vec<_> = verdict.checks.iter().filter(|check| check.is_bad()).collect();
        assert_eq!(verdict.outcome, Outcome::Pass, "{}: {bad:#?}", scenario.name);
    }
}

#[test]
fn the_pocket_is_entered_and_left_again() {
    let shipped = super::shipped_in("scenarios/multirotor").into_iter();
    let (_, scenario) = shipped.into_iter().find(|(_, it)| it.name == "pop-up").expect("a shipped scenario");
    let flight = flown(&scenario, "rhc");
    let found: Vec<_> = flight
        .events
        .iter()
        .filter_map(|event| match &event.kind {
            sim::EventKind::Discovered { obstacle } => Some(obstacle.as_str()),
            _ => None,
        })
        .collect();
    assert_eq!(found, ["popup-lower", "popup-upper"]);
}

#[test]
fn the_same_seed_gives_the_same_flight_on_any_number_of_threads() {
    let shipped = super::shipped_in("scenarios/multirotor");
    let (_, scenario) = shipped.into_iter().find(|(_, it)| it.name == "forest-noise").expect("a shipped scenario");
    let in_loop = planners::registry().iter().filter(|entry| entry.plans_in_the_loop());
    for entry in in_loop.filter(|entry| (entry.unsupported_reason)(&scenario).is_none()) {
        let on = |threads: usize| {
            let pool = rayon::ThreadPoolBuilder::new().num_threads(threads).build().expect("a thread pool");
            pool.install(|| flown(&scenario, entry.name)).vehicles
        };
        assert!(on(1) == on(2), "{}", entry.name);
    }
}
