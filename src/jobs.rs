//! Loads scenario files and pairs every scenario with every planner.

use std::path::{Path, PathBuf};

use planners::Planner;
use scenarios::{Issue, Scenario, ScenarioFile, closest_name};

use crate::error::Error;
use crate::plan_source::PlanSource;
use crate::plan_source::external::ExternalPlanner;

/// One scenario with one planner.
#[derive(Clone)]
pub struct Job {
    /// The scenario.
    pub scenario: Scenario,
    /// The scenario file.
    pub source: ScenarioFile,
    /// Where the plan comes from.
    pub plan_source: PlanSource,
    /// Seed of all random numbers of planning and flight.
    pub seed: u64,
}

/// Jobs, and the files (or pairs of file and planner) that were rejected.
#[derive(Default)]
pub struct Jobs {
    /// The jobs, in the order of the files and of the planners.
    pub runnable: Vec<Job>,
    /// The rejected files.
    pub rejected: Vec<RejectedJob>,
}

/// A file that was rejected.
#[derive(Debug)]
pub struct RejectedJob {
    /// The file.
    pub file: PathBuf,
    /// The reason.
    pub error: Error,
}

/// The registered planners of these names.
///
/// # Errors
///
/// [`Error::UnknownPlanner`] for the first unknown name.
pub fn planners_named(names: &[String]) -> Result<Vec<PlanSource>, Error> {
    let named = |name: &String| planners::find(name).map(PlanSource::Registered).ok_or_else(|| unknown_planner(name));
    names.iter().map(named).collect()
}

/// Loads every file and pairs its scenario with `plan_sources`; if there are none, with the planner that it names.
///
/// - `seed`: replaces the seeds of the scenarios
/// - `is_wanted`: scenarios for which it is false are left out; an invalid file is always rejected
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
///
/// # Errors
///
/// If the file is rejected, and [`Error::OnePlanner`] if there are several plan sources.
pub fn load_one(file: &Path, plan_sources: &[PlanSource], seed: Option<u64>) -> Result<Job, Error> {
    let mut jobs = load(&[file.to_owned()], plan_sources, seed, |_| true);
    match (jobs.rejected.pop(), jobs.runnable.pop()) {
        (Some(rejected), _) => Err(rejected.error),
        (None, Some(job)) if jobs.runnable.is_empty() => Ok(job),
        (None, _) => Err(Error::OnePlanner),
    }
}

/// Loads one file.
///
/// - `seed`: replaces the seed of the scenario
///
/// # Errors
///
/// If the file cannot be read, or is not a valid scenario.
pub fn load_file(file: &Path, seed: Option<u64>) -> Result<(ScenarioFile, Scenario), Error> {
    let source = ScenarioFile::read(file)?;
    let mut scenario = source.scenario()?;
    scenario.simulation.seed = seed.unwrap_or(scenario.simulation.seed);
    Ok((source, scenario))
}

/// One job per plan source; if there are none, one for the planner that the scenario names.
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
    let supported = |plan_source: &PlanSource| match plan_source {
        PlanSource::Registered(planner) => match (planner.unsupported_reason)(scenario) {
            Some(reason) => Err(Error::Unfit { file: file.display().to_string(), planner: planner.name, reason }),
            None => Ok(job(plan_source.clone())),
        },
        PlanSource::External(planner) => check_in_the_loop(file, planner, scenario).map(|()| job(plan_source.clone())),
        _ => Ok(job(plan_source.clone())),
    };
    plan_sources.iter().map(supported).collect()
}

/// The planner that the scenario names. An error names the line of the file.
fn named_by_scenario(file: &Path, source: &ScenarioFile, scenario: &Scenario) -> Result<PlanSource, Error> {
    let name = &scenario.planner.name;
    let issue = |expected: String, remedy: String| {
        source.error(vec![Issue::new("planner.name", format!("\"{name}\""), expected).remedy(remedy)])
    };
    if let Some(command) = &scenario.planner.command {
        if planners::find(name).is_some() {
            let expected = "another name for a planner with a `command`: this one is a registered planner";
            return Err(issue(expected.into(), "rename it, or remove `command`".into()).into());
        }
        let beside = file.parent().filter(|folder| !folder.as_os_str().is_empty()).unwrap_or(Path::new("."));
        let folder = scenario.planner.folder.as_ref().map_or(beside.to_owned(), |folder| beside.join(folder));
        let planner = ExternalPlanner {
            name: name.clone(),
            command: command.clone(),
            folder,
            time_limit_s: scenario.planner.time_limit_s,
            in_loop: scenario.planner.in_loop,
        };
        return check_in_the_loop(file, &planner, scenario).map(|()| PlanSource::External(planner));
    }
    let Some(planner) = planners::find(name) else {
        return Err(issue(format!("the name of a planner: {}", known_planners()), remedy_for(name)).into());
    };
    check_support(planner, scenario, issue).map(|()| PlanSource::Registered(planner))
}

fn check_support(
    planner: &Planner,
    scenario: &Scenario,
    issue: impl Fn(String, String) -> scenarios::LoadError,
) -> Result<(), Error> {
    match (planner.unsupported_reason)(scenario) {
        None => Ok(()),
        Some(reason) => {
            let expected = format!("a planner that can handle this scenario: {reason}");
            Err(issue(expected, "`harness list` shows what each planner handles".into()).into())
        }
    }
}

/// Only vehicles that sense obstacles are planned for in the loop.
fn check_in_the_loop(file: &Path, planner: &ExternalPlanner, scenario: &Scenario) -> Result<(), Error> {
    if planner.in_loop && !scenario.family().senses_obstacles() {
        let (file, planner) = (file.display().to_string(), planner.name.clone());
        return Err(Error::NotInTheLoop { file, planner });
    }
    Ok(())
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
        None => {
            "`harness list` shows the planners; an external planner needs a `command`, see `harness run --help`".into()
        }
    }
}
