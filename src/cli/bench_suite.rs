use std::path::Path;

use clap::Args;
use scenarios::Family;

use crate::campaign::bench::suite::{self, Plan};
use crate::campaign::generate::{self, GenerateError, Kind, Request};
use crate::error::Error;
use crate::jobs;

/// Seeds of every case, in a full run and in a quick one.
const SEEDS: u64 = 20;
const QUICK_SEEDS: u64 = 4;

/// Options of `harness bench suite`.
#[derive(Args, Debug)]
#[command(next_help_heading = "Options of `suite`")]
pub struct SuiteArgs {
    /// Family of vehicles: fixed-wing, slung-load or multirotor [default: all]
    #[arg(long, value_name = "FAMILY", value_parser = family)]
    family: Option<Family>,
    /// Kind of scenario; repeatable [default: all; `harness generate --help` lists them]
    #[arg(long, value_name = "KIND")]
    kind: Vec<String>,
    /// Planner; repeatable; each runs on the scenarios that it supports [default: the one that the scenario names]
    #[arg(short, long, value_name = "NAME")]
    planner: Vec<String>,
    /// Number of seeds of every kind and size [default: 20]
    #[arg(long, value_name = "N")]
    seeds: Option<u64>,
    /// The first of them
    #[arg(long, value_name = "S")]
    first_seed: Option<u64>,
    /// Size of the scenarios; repeatable [default: three for each kind]
    #[arg(long, value_name = "N")]
    size: Vec<usize>,
    /// Density of the obstacles [default: that of the kind, and its largest at the middle size]
    #[arg(long, value_name = "D")]
    density: Option<f64>,
    /// Number of runs at a time; planning times are reliable with one only [default: 1]
    #[arg(short, long, value_name = "N")]
    jobs: Option<usize>,
    /// Print the results as JSON instead of a table
    #[arg(long)]
    pub json: bool,
}

fn family(name: &str) -> Result<Family, String> {
    let keys = || Family::ALL.map(Family::key).join(", ");
    Family::ALL.into_iter().find(|family| family.key() == name).ok_or_else(|| format!("expected one of {}", keys()))
}

impl SuiteArgs {
    /// The first option that was given, if any.
    pub fn first_given(&self) -> Option<&'static str> {
        let given = [
            ("--family", self.family.is_some()),
            ("--kind", !self.kind.is_empty()),
            ("--planner", !self.planner.is_empty()),
            ("--seeds", self.seeds.is_some()),
            ("--first-seed", self.first_seed.is_some()),
            ("--size", !self.size.is_empty()),
            ("--density", self.density.is_some()),
            ("--jobs", self.jobs.is_some()),
            ("--json", self.json),
        ];
        given.into_iter().find(|(_, is_given)| *is_given).map(|(name, _)| name)
    }

    /// What to measure.
    ///
    /// - `folder`: for the scenarios that were not passed
    pub fn plan(&self, is_quick: bool, limit_s: f64, folder: &Path) -> Result<Plan, Error> {
        let mut cases = suite::cases(&self.kinds()?);
        if is_quick {
            cases.retain(|case| case.size == case.kind.size.suite[0]);
        }
        if !self.size.is_empty() {
            cases.retain(|case| case.size == case.kind.size.suite[0]);
            let sizes = |case: Request| self.size.iter().map(move |&size| Request { size, ..case });
            cases = cases.into_iter().flat_map(sizes).collect();
        }
        if let Some(density) = self.density {
            cases.retain(|case| case.density == case.kind.density.default);
            cases.iter_mut().for_each(|case| case.density = density);
        }
        Ok(Plan {
            cases,
            planners: self.planners()?,
            first_seed: self.first_seed.unwrap_or(0),
            seeds: self.seeds.unwrap_or(if is_quick { QUICK_SEEDS } else { SEEDS }),
            limit_s,
            jobs: self.jobs.unwrap_or(1),
            folder: folder.to_owned(),
        })
    }

    fn kinds(&self) -> Result<Vec<&'static Kind>, GenerateError> {
        let of_family = || generate::kinds().filter(|kind| self.family.is_none_or(|family| kind.family == family));
        if self.kind.is_empty() {
            return Ok(of_family().collect());
        }
        self.kind.iter().map(|name| generate::find_among(name, "a kind", of_family())).collect()
    }

    /// The names of the planners, all of which exist.
    fn planners(&self) -> Result<Vec<String>, Error> {
        let sources = jobs::planners_named(&self.planner)?;
        Ok(sources.iter().map(|source| source.name().to_owned()).collect())
    }
}
