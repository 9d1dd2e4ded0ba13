//! From paths and planner names to what has to be run: every scenario with every planner.

use std::path::{Path, PathBuf};

use planners::Planner;
use scenarios::{Problem, Scenario, Source, nearest};

use crate::error::Error;

/// One scenario for one planner.
#[derive(Clone)]
pub struct Job {
    /// The question.
    pub scenario: Scenario,
    /// Who answers.
    pub planner: &'static Planner,
    /// Seed of everything random in planning and flight.
    pub seed: u64,
}

/// Jobs, and the files (or pairs of file and planner) that gave none.
#[derive(Default)]
pub struct Jobs {
    /// What can be run, in the order of the files and of the planners.
    pub good: Vec<Job>,
    /// What cannot, and why.
    pub bad: Vec<Refusal>,
}

/// A file that cannot be run.
#[derive(Debug)]
pub struct Refusal {
    /// The file.
    pub file: PathBuf,
    /// Why.
    pub error: Error,
}

/// The planners of these names. An unknown name is an error, since nothing that was asked for can be done then.
pub fn planners_named(names: &[String]) -> Result<Vec<&'static Planner>, Error> {
    names.iter().map(|name| planners::find(name).ok_or_else(|| unknown_planner(name))).collect()
}

/// Loads every file and pairs its scenario with `planners`, or with the planner that it names if there are none.
///
/// - `seed`: replaces the scenarios' own
pub fn load(files: &[PathBuf], planners: &[&'static Planner], seed: Option<u64>) -> Jobs {
    let mut jobs = Jobs::default();
    for file in files {
        match load_file(file, planners, seed) {
            Ok(pairs) => pairs.into_iter().for_each(|pair| match pair {
                Ok(job) => jobs.good.push(job),
                Err(error) => jobs.bad.push(Refusal { file: file.clone(), error }),
            }),
            Err(error) => jobs.bad.push(Refusal { file: file.clone(), error }),
        }
    }
    jobs
}

fn load_file(file: &Path, planners: &[&'static Planner], seed: Option<u64>) -> Result<Vec<Result<Job, Error>>, Error> {
    let source = Source::read(file)?;
    let mut scenario = source.scenario()?;
    scenario.simulation.seed = seed.unwrap_or(scenario.simulation.seed);
    if planners.is_empty() {
        let planner = named_by_scenario(&source, &scenario)?;
        return Ok(vec![Ok(Job { seed: scenario.simulation.seed, scenario, planner })]);
    }
    let pair = |planner: &&'static Planner| match (planner.refuses)(&scenario) {
        Some(reason) => Err(Error::Unfit { file: file.display().to_string(), planner: planner.name, reason }),
        None => Ok(Job { scenario: scenario.clone(), planner, seed: scenario.simulation.seed }),
    };
    Ok(planners.iter().map(pair).collect())
}

/// The planner that the scenario names; if that cannot be, an error that points to the line.
fn named_by_scenario(source: &Source, scenario: &Scenario) -> Result<&'static Planner, Error> {
    let name = &scenario.planner.name;
    let problem = |expected: String, remedy: String| {
        source.error(vec![Problem::new("planner.name", format!("\"{name}\""), expected).remedy(remedy)])
    };
    let Some(planner) = planners::find(name) else {
        return Err(problem(format!("the name of a planner: {}", known_planners()), remedy_for(name)).into());
    };
    match (planner.refuses)(scenario) {
        None => Ok(planner),
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
    match nearest(name, planners::registry().iter().map(|entry| entry.name)) {
        Some(known) => format!("did you mean `{known}`?"),
        None => "`harness list` shows the planners".into(),
    }
}
