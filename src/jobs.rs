//! From paths and planner names to what has to be run: every scenario with every planner.

use std::path::{Path, PathBuf};

use planners::Planner;
use scenarios::{Issue, Scenario, ScenarioFile, closest_name};

use crate::error::Error;
use crate::plan_source::PlanSource;
use crate::plan_source::external::ExternalPlanner;

/// One scenario for one planner.
#[derive(Clone)]
pub struct Job {
    /// The question.
    pub scenario: Scenario,
    /// The file that it stands in.
    pub source: ScenarioFile,
    /// Who answers.
    pub plan_source: PlanSource,
    /// Seed of everything random in planning and flight.
    pub seed: u64,
}

/// Jobs, and the files (or pairs of file and planner) that gave none.
#[derive(Default)]
pub struct Jobs {
    /// What can be run, in the order of the files and of the planners.
    pub runnable: Vec<Job>,
    /// What cannot, and why.
    pub rejected: Vec<RejectedJob>,
}

/// A file that cannot be run.
#[derive(Debug)]
pub struct RejectedJob {
    /// The file.
    pub file: PathBuf,
    /// Why.
    pub error: Error,
}

/// The planners of these names. An unknown name is an error, since nothing that was asked for can be done then.
pub fn planners_named(names: &[String]) -> Result<Vec<PlanSource>, Error> {
    let named = |name: &String| planners::find(name).map(PlanSource::Registered).ok_or_else(|| unknown_planner(name));
    names.iter().map(named).collect()
}

/// Loads every file and pairs its scenario with `plan_sources`, or with the planner that it names if there are none.
///
/// - `seed`: replaces the scenarios' own
/// - `is_wanted`: scenarios for which it is false are left out; a bad file always shows
pub fn load(
    files: &[PathBuf],
    plan_sources: &[PlanSource],
    seed: Option<u64>,
    is_wanted: impl Fn(&Scenario) -> bool,
) -> Jobs {
    let mut jobs = Jobs::default();
    for file in files {
        match load_file(file, seed) {
            Ok((_, scenario)) if !is_wanted(&scenario) => {}
            Ok((source, scenario)) => {
                pair(file, &source, &scenario, plan_sources).into_iter().for_each(|pair| match pair {
                    Ok(job) => jobs.runnable.push(job),
                    Err(error) => jobs.rejected.push(RejectedJob { file: file.clone(), error }),
                });
            }
            Err(error) => jobs.rejected.push(RejectedJob { file: file.clone(), error }),
        }
    }
    jobs
}

/// Loads one file for one planner.
pub fn load_one(file: &Path, plan_sources: &[PlanSource], seed: Option<u64>) -> Result<Job, Error> {
    let mut jobs = load(&[file.to_owned()], plan_sources, seed, |_| true);
    match (jobs.rejected.pop(), jobs.runnable.pop()) {
        (Some(refusal), _) => Err(refusal.error),
        (None, Some(job)) if jobs.runnable.is_empty() => Ok(job),
        (None, _) => Err(Error::OnePlanner),
    }
}

/// Loads one file.
///
/// - `seed`: replaces the scenario's own
pub fn load_file(file: &Path, seed: Option<u64>) -> Result<(ScenarioFile, Scenario), Error> {
    let source = ScenarioFile::read(file)?;
    let mut scenario = source.scenario()?;
    scenario.simulation.seed = seed.unwrap_or(scenario.simulation.seed);
    Ok((source, scenario))
}

/// One job per plan_source, or that of the planner which the scenario names.
fn pair(
    file: &Path,
    source: &ScenarioFile,
    scenario: &Scenario,
    plan_sources: &[PlanSource],
) -> Vec<Result<Job, Error>> {
    let job = |plan_source: PlanSource| Job {
        seed: scenario.simulation.seed,
        scenario: scenario.clone(),
        source: source.clone(),
        plan_source,
    };
    if plan_sources.is_empty() {
        return vec![named_by_scenario(file, source, scenario).map(job)];
    }
    let fitting = |plan_source: &PlanSource| match plan_source {
        PlanSource::Registered(planner) => match (planner.unsupported_reason)(scenario) {
            Some(reason) => Err(Error::Unfit { file: file.display().to_string(), planner: planner.name, reason }),
            None => Ok(job(plan_source.clone())),
        },
        _ => Ok(job(plan_source.clone())),
    };
    plan_sources.iter().map(fitting).collect()
}

/// The planner that the scenario names; if that cannot be, an error that points to the line.
fn named_by_scenario(file: &Path, source: &ScenarioFile, scenario: &Scenario) -> Result<PlanSource, Error> {
    let name = &scenario.planner.name;
    let problem = |expected: String, remedy: String| {
        source.error(vec![Issue::new("planner.name", format!("\"{name}\""), expected).remedy(remedy)])
    };
    if let Some(command) = &scenario.planner.command {
        if planners::find(name).is_some() {
            let expected = "a name of its own for a planner with a `command`: this is one of the harness's";
            return Err(problem(expected.into(), "rename it, or remove `command`".into()).into());
        }
        let folder = file.parent().filter(|folder| !folder.as_os_str().is_empty()).unwrap_or(Path::new("."));
        let (name, command, folder) = (name.clone(), command.clone(), folder.to_owned());
        return Ok(PlanSource::External(ExternalPlanner {
            name,
            command,
            folder,
            time_limit_s: scenario.planner.time_limit_s,
            in_loop: scenario.planner.in_loop,
        }));
    }
    let Some(planner) = planners::find(name) else {
        return Err(problem(format!("the name of a planner: {}", known_planners()), remedy_for(name)).into());
    };
    refuse_unfit(planner, scenario, problem).map(|()| PlanSource::Registered(planner))
}

fn refuse_unfit(
    planner: &Planner,
    scenario: &Scenario,
    problem: impl Fn(String, String) -> scenarios::LoadError,
) -> Result<(), Error> {
    match (planner.unsupported_reason)(scenario) {
        None => Ok(()),
        Some(reason) => {
            let expected = format!("a planner that can handle this scenario: {reason}");
            Err(problem(expected, "`harness list` shows what each planner handles".into()).into())
        }
    }
}

fn unknown_planner(name: &str) -> Error {
    Error::UnknownPlanner { name: name.to_owned(), known: known_planners(), remedy: remedy_for(name) }
}

fn known_planners() -> String {
    planners::registry().iter().map(|entry| entry.name).collect::<Vec<_>>().join(", ")
}

fn remedy_for(name: &str) -> String {
    match closest_name(name, planners::registry().iter().map(|entry| entry.name)) {
        Some(known) => format!("did you mean `{known}`?"),
        None => "`harness list` shows the planners; one of your own is a `command`, see `harness run --help`".into(),
    }
}
