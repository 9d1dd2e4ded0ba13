//! `harness figures`: the figures of the four papers, from our plans and flights.
//!
//! `FLIGHTS` lists the figures of single flights, `STUDIES` those over fleet sizes and methods; operation counts have a
//! function and `swarms` a file of their own. The papers' positions are ours where they print none, so a figure is to be compared
//! in its shape; where a paper prints a number, it stands beside ours.

mod chart;
mod flights;
mod papers;
mod studies;
mod swarms;

use std::path::{Path, PathBuf};

use scenarios::{LoadError, Scenario, shipped};

use super::bench::ipm;
use crate::error::Error;
pub use papers::page;
use papers::{FLIGHTS, STUDIES};

/// Name of the figure of operation counts.
const OPERATION_COUNTS: &str = "1-operation-counts";

/// What to draw.
#[derive(Clone, Debug)]
pub struct Options {
    /// Folder of the scenarios; `None`: the shipped ones.
    pub scenarios: Option<PathBuf>,
    /// Number of the paper; `None`: all.
    pub paper: Option<u8>,
    /// Small fleets and few sizes: a smoke test.
    pub is_quick: bool,
}

impl Options {
    /// The scenario of a file below the folder.
    fn load(&self, file: &str) -> Result<Scenario, LoadError> {
        match &self.scenarios {
            Some(folder) => scenarios::load(&folder.join(file)),
            None => scenarios::load(Path::new(&format!("{}{file}", shipped::PREFIX))),
        }
    }
}

/// A figure.
#[derive(Clone, Debug)]
pub struct Figure {
    /// Number of the paper.
    pub paper: u8,
    /// Name of its file, without `.svg`.
    pub name: String,
    /// What it shows, with the result.
    pub caption: String,
    /// The drawing.
    pub svg: String,
}

/// Names of all figures, in the order of the papers.
pub fn names() -> Vec<String> {
    let flights = FLIGHTS.iter().flat_map(|flight| flight.names());
    let studies = STUDIES.iter().flat_map(studies::Study::names);
    let mut names: Vec<String> = flights
        .chain(studies)
        .chain([OPERATION_COUNTS, swarms::REPLAN_TIMES, swarms::CONVERGENCE].map(str::to_owned))
        .collect();
    names.sort();
    names
}

/// Plans, flies and draws.
///
/// - `progress`: receives the name of each flight and study
///
/// # Errors
///
/// A scenario that cannot be loaded.
pub fn run(options: &Options, progress: &mut dyn FnMut(&str)) -> Result<Vec<Figure>, Error> {
    let is_wanted = |paper: u8| options.paper.is_none_or(|wanted| wanted == paper);
    let mut figures = Vec::new();
    for flight in FLIGHTS.iter().filter(|flight| is_wanted(flight.paper)) {
        progress(flight.name);
        figures.extend(flight.draw(options)?);
    }
    for study in STUDIES.iter().filter(|study| is_wanted(study.paper)) {
        progress(study.name);
        figures.extend(study.draw(options)?);
    }
    if is_wanted(1) {
        progress(OPERATION_COUNTS);
        figures.push(operation_counts(options)?);
    }
    if is_wanted(3) {
        progress("3-swarms");
        figures.extend(swarms::draw(options)?);
    }
    figures.sort_by(|a, b| a.name.cmp(&b.name));
    Ok(figures)
}

fn operation_counts(options: &Options) -> Result<Figure, Error> {
    let scenario = options.load("fixed-wing/rendezvous-7.toml")?;
    let plan = match options.is_quick {
        true => ipm::Plan::quick(),
        false => ipm::Plan { intervals: vec![4, 8, 20, 40], repetitions: 3, max_solve_s: 1.0 },
    };
    let svg = ipm::svg(&ipm::run(&scenario, &plan, &mut |_| {}));
    let caption =
        "Operation counts of the paper's methods I, II and III (its figure 4) and measured times, with ours".into();
    Ok(Figure { paper: 1, name: OPERATION_COUNTS.into(), caption, svg })
}

#[cfg(test)]
mod tests {
    use super::names;

    #[test]
    fn every_figure_has_a_name_of_its_own() {
        let names = names();
        let mut unique = names.clone();
        unique.dedup();
        assert_eq!(names, unique);
        assert!((1..=4).all(|paper| names.iter().any(|name| name.starts_with(&format!("{paper}-")))));
    }
}
