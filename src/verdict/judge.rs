use rayon::prelude::*;
use scenarios::{Family, Plan, PlanStatus, Scenario};
use sim::Flight;

use crate::verdict::flown::Flown;
use crate::verdict::planned::Planned;
use crate::verdict::question::{Evidence, Group, Question};
use crate::verdict::{
    Check, Integration, Outcome, Provenance, Status, Verdict, arrival, clearance, conditions, dynamics,
    flight_integrity, integrity, limits, multirotor, physics, separation, slung_load, tracking,
};

/// Judges a plan and its flight.
///
/// - `flight`: `None` when the plan was not flown
///
/// Every check of [`scenarios::check_names`] is answered, in that order. What does not apply to the scenario is skipped
/// with the reason; what applies and cannot be measured, because something is missing, empty or not a number, fails
/// with the reason. Nothing that a plan or a flight may hold makes it panic.
pub fn judge(scenario: &Scenario, plan: &Plan, flight: Option<&Flight>) -> Verdict {
    judge_imported(scenario, plan, &Provenance::whole(), flight)
}

/// [`judge`], of a plan that was not whole: what was reconstructed decides nothing that it cannot tell.
pub fn judge_imported(scenario: &Scenario, plan: &Plan, provenance: &Provenance, flight: Option<&Flight>) -> Verdict {
    judge_with(scenario, plan, provenance, flight, None)
}

/// [`judge_imported`], with what a second integrator made of the flight; without it the disagreement is estimated.
pub fn judge_with(
    scenario: &Scenario,
    plan: &Plan,
    provenance: &Provenance,
    flight: Option<&Flight>,
    integration: Option<Integration>,
) -> Verdict {
    let flyable = integrity::is_flyable(scenario, plan);
    let logged = flyable.clone().and_then(|()| flight.ok_or_else(|| "the plan was not flown".to_owned()));
    let logged = logged.as_ref().map(|flight| *flight).map_err(String::as_str);
    let mut checks = match scenario.family() {
        Family::FixedWing => of_fixed_wings(scenario, plan, &flyable, logged),
        Family::SlungLoad => of_a_slung_load(scenario, plan, &flyable, logged),
        Family::Multirotor => of_multirotors(scenario, plan, &flyable, logged),
    };

    provenance.qualify(&mut checks);
    let integration = integration.or_else(|| Integration::by_replay(&checks));
    if let Some(integration) = &integration {
        integration.doubt(&mut checks);
    }
    let overclaimed = plan.status == PlanStatus::Solved && checks.iter().any(|check| check.is_bad_in(Group::Plan));
    settle(scenario, &mut checks);
    let outcome = if plan.status == PlanStatus::NoPlan || plan.trajectories.is_empty() {
        Outcome::NoPlan
    } else if checks.iter().any(|check| check.is_bad() && !check.advisory) {
        Outcome::Fail
    } else {
        Outcome::Pass
    };
    Verdict { outcome, overclaimed, checks, integration }
}

fn of_fixed_wings(
    scenario: &Scenario,
    plan: &Plan,
    flyable: &Result<(), String>,
    logged: Evidence<'_, Flight>,
) -> Vec<Check> {
    let planned = flyable.clone().and_then(|()| Planned::new(scenario, plan));
    let flown = logged.map_err(str::to_owned).and_then(|flight| Flown::new(scenario, plan, flight));
    let mut checks = nodes_checks(scenario, flyable.as_ref().map(|()| plan).map_err(String::as_str));
    checks.extend(plan_checks(scenario, plan, flyable.as_ref().map_err(String::as_str), planned.as_ref()));
    checks.extend(log_checks(scenario, plan, logged, flown.as_ref().map_err(String::as_str)));
    checks.extend(flight_checks(scenario, logged, flown.as_ref().map_err(String::as_str)));
    checks
}

fn of_a_slung_load(
    scenario: &Scenario,
    plan: &Plan,
    flyable: &Result<(), String>,
    logged: Evidence<'_, Flight>,
) -> Vec<Check> {
    let judge = slung_load::Judge::new(scenario, plan, flyable.clone());
    let mut checks = judge.nodes_checks();
    checks.extend(judge.plan_checks());
    // Body, cable and load are judged by their true shapes: what touches has no clearance.
    checks.extend(log_checks(scenario, plan, logged, Err("")));
    checks.extend(judge.flight_checks(logged));
    checks
}

fn of_multirotors(
    scenario: &Scenario,
    plan: &Plan,
    flyable: &Result<(), String>,
    logged: Evidence<'_, Flight>,
) -> Vec<Check> {
    let in_the_loop = logged.is_ok_and(|flight| flight.planning.is_some());
    let flyable = flyable.as_ref().map_err(String::as_str);
    let flown = logged.map_err(str::to_owned).and_then(|flight| Flown::new(scenario, plan, flight));
    let flown = flown.as_ref().map_err(String::as_str);
    let mut checks = multirotor::plan_checks(scenario, plan, flyable, in_the_loop);
    checks.extend(log_checks(scenario, plan, logged, flown));
    checks.extend(multirotor::flight_checks(scenario, plan, logged, flown));
    checks
}

fn nodes_checks(scenario: &Scenario, plan: Evidence<'_, Plan>) -> Vec<Check> {
    vec![
        separation::check_nodes(scenario, plan),
        clearance::check_nodes(scenario, plan),
        limits::check_node_states(scenario, plan),
        limits::check_planned_controls(Group::Nodes, scenario, plan),
        arrival::check_node_goals(scenario, plan),
    ]
}

fn plan_checks(
    scenario: &Scenario,
    plan: &Plan,
    flyable: Evidence<'_, ()>,
    planned: Result<&Planned, &String>,
) -> Vec<Check> {
    let nodes = flyable.map(|()| plan);
    let planned = planned.map_err(String::as_str);
    let motions = planned.map(|planned| planned.motions.as_slice());
    vec![
        integrity::check_plan_finite(plan),
        integrity::check_plan_complete(scenario, plan),
        separation::check(Group::Plan, scenario, motions),
        clearance::check(Group::Plan, scenario, motions),
        limits::check_planned_states(scenario, motions),
        limits::check_planned_controls(Group::Plan, scenario, nodes),
        dynamics::check_defects(scenario, plan, planned),
        dynamics::check_rollout(scenario, plan, planned),
        arrival::check_planned_goals(scenario, motions),
        arrival::check_planned_arrival(scenario, nodes),
        arrival::check_planned_duration(scenario, nodes),
    ]
}

fn log_checks(
    scenario: &Scenario,
    plan: &Plan,
    flight: Evidence<'_, Flight>,
    flown: Evidence<'_, Flown<'_>>,
) -> Vec<Check> {
    match flight {
        Ok(flight) => answers(&[
            &|| flight_integrity::check_finite(flight),
            &|| flight_integrity::check_complete(scenario, plan, flight),
            &|| flight_integrity::check_crash(scenario, flight, flown),
            &|| conditions::check(scenario, plan, flight),
        ]),
        Err(reason) => {
            [("finite", "numbers"), ("complete", "vehicles"), ("crash", "crashes"), ("conditions", "vehicles")]
                .map(|(name, unit)| Question::new(Group::Flight, name, unit).fail(reason))
                .into()
        }
    }
}

fn flight_checks(scenario: &Scenario, logged: Evidence<'_, Flight>, flown: Evidence<'_, Flown<'_>>) -> Vec<Check> {
    let motions = flown.map(|flown| flown.motions.as_slice());
    let no_load = |name, unit| Question::new(Group::Flight, name, unit).skip("no vehicle carries a load");
    answers(&[
        &|| separation::check(Group::Flight, scenario, motions),
        &|| clearance::check(Group::Flight, scenario, motions),
        &|| limits::check_flown_states(scenario, flown),
        &|| limits::check_flown_controls(scenario, flown),
        &|| physics::check(scenario, logged),
        &|| arrival::check_flown_goals(scenario, flown),
        &|| arrival::check_flown_arrival(scenario, flown),
        &|| arrival::check_flown_duration(scenario, flown),
        &|| tracking::check_root_mean_square(scenario, flown),
        &|| tracking::check_largest(scenario, flown),
        &|| tracking::check_saturation(scenario, flown),
        &|| no_load("tension", "N"),
        &|| no_load("slack", "s"),
        &|| no_load("swing", "deg"),
    ])
}

/// The answers in the order of the questions, which go through the same long log on all threads.
fn answers(questions: &[&(dyn Fn() -> Check + Sync)]) -> Vec<Check> {
    questions.par_iter().map(|question| question()).collect()
}

/// Applies what the scenario says of single checks: advisory ones do not decide, required ones must have been made.
fn settle(scenario: &Scenario, checks: &mut Vec<Check>) {
    for name in &scenario.verdict.required {
        match checks.iter_mut().find(|check| check.name == *name) {
            Some(check) if check.status == Status::Skip => {
                check.status = Status::Fail;
                let why = check.reason.take().unwrap_or_default();
                check.reason = Some(format!("required, but it could not be asked: {why}"));
            }
            Some(_) => {}
            None => checks.push(Check::unknown(name)),
        }
    }
    for check in checks {
        check.advisory = scenario.verdict.advisory.contains(&check.name);
    }
}

impl Check {
    fn is_bad_in(&self, group: Group) -> bool {
        self.is_bad() && self.name.starts_with(&format!("{group}."))
    }

    /// A required check that does not exist: nobody has made it, so it has failed.
    fn unknown(name: &str) -> Self {
        let reason = "required, but there is no check of this name".to_owned();
        Self { name: name.to_owned(), ..Question::new(Group::Flight, "", "-").fail(reason) }
    }
}
