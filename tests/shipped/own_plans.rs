//! The plan files of a passing run pass again.

use harness::plan_source::{PlanSource, plan_import};
use harness::verdict::{Check, Provenance, Status, judge_imported};
use scenarios::plan_input::{self, ImportedTrajectory, PlanError, PlanHeader};
use scenarios::{Plan, Scenario};

use crate::shipped_in;

type Read = Result<(PlanHeader, Vec<ImportedTrajectory>), PlanError>;

/// The plan as it is read from its own files.
fn files(scenario: &Scenario, plan: &Plan) -> [(&'static str, Read); 2] {
    let (mut json, mut csv) = (Vec::new(), Vec::new());
    plan.write_json(&mut json).unwrap();
    plan.write_csv(&mut csv).unwrap();
    let [json, csv] = [json, csv].map(|bytes| String::from_utf8(bytes).unwrap());
    [
        ("plan.json", plan_input::parse_json("plan.json", &json, scenario)),
        ("plan.csv", plan_input::parse_csv("plan.csv", &csv, scenario)),
    ]
}

/// The verdict on a plan.
fn checks(scenario: &Scenario, plan: &Plan, provenance: &Provenance) -> Vec<Check> {
    let checks = judge_imported(scenario, plan, provenance, None).checks;
    checks.into_iter().filter(|check| !check.name.starts_with("flight.")).collect()
}

/// The same plan after writing and reading, of each of its files.
fn read_again(scenario: &Scenario, plan: &Plan) -> Vec<(&'static str, Vec<Check>)> {
    let of_file = |(file, read): (&'static str, Read)| {
        let (header, tracks) = read.unwrap_or_else(|error| panic!("{}: {error}", scenario.name));
        let completed = plan_import::complete(scenario, header, tracks, &plan.planner, 0);
        (file, checks(scenario, &completed.plan, &completed.provenance))
    };
    files(scenario, plan).into_iter().map(of_file).collect()
}

fn source(scenario: &Scenario) -> PlanSource {
    PlanSource::Registered(planners::find(&scenario.planner.name).expect("a planner that exists"))
}

#[test]
fn a_plan_file_has_the_verdict_of_its_plan() {
    for (_, scenario) in ["scenarios/fixed-wing", "scenarios/slung"].into_iter().flat_map(shipped_in) {
        let guidance = source(&scenario).prepare(&scenario, 0, &mut |_| {}).guidance;
        let plan = guidance.into_plan().expect("it plans before the flight").plan;
        let judged = checks(&scenario, &plan, &Provenance::whole());
        for (file, again) in read_again(&scenario, &plan) {
            assert_eq!(again, judged, "{} of {}", file, scenario.name);
        }
    }
}

/// The references followed in the loop are not a plan for a flight without it: where they do not pass, the report says so.
#[test]
fn the_record_of_an_in_loop_flight_passes_or_says_that_it_is_a_record() {
    for (_, scenario) in shipped_in("scenarios/multirotor") {
        let plan = source(&scenario).fly(&scenario, scenario.simulation.seed).answer.plan;
        for (file, checks) in read_again(&scenario, &plan) {
            for check in checks.iter().filter(|check| !matches!(check.status, Status::Pass | Status::Skip)) {
                let is_told = check.reason.as_ref().is_some_and(|reason| reason.contains("record of the references"));
                assert!(is_told, "{} of {}: {check:#?}", file, scenario.name);
            }
        }
    }
}
