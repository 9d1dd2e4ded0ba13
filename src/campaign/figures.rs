//! `harness figures`: the figures of the four papers, from our plans and flights.
//!
//! `FLIGHTS` lists the figures of single flights, `STUDIES` those over fleet sizes and methods; operation counts and replan
//! times have functions of their own. The papers' positions are ours where they print none, so a figure is to be compared
//! in its shape; where a paper prints a number, it stands beside ours.

mod chart;
mod flights;
mod papers;
mod studies;

use std::path::PathBuf;

use self::chart::{Chart, Curve};
use self::flights::registered;
use super::bench::ipm;
use crate::error::Error;
use crate::plan_source::PlanSource;
pub use papers::page;
use papers::{FLIGHTS, STUDIES};

/// Name of the figure of operation counts.
const OPERATION_COUNTS: &str = "1-operation-counts";
/// Name of the figure of replan times.
const REPLAN_TIMES: &str = "3-replan-times";

/// What to draw.
#[derive(Clone, Debug)]
pub struct Options {
    /// Folder of the scenarios.
    pub scenarios: PathBuf,
    /// Number of the paper; `None`: all.
    pub paper: Option<u8>,
    /// Small fleets and few sizes: a smoke test.
    pub is_quick: bool,
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
    let mut names: Vec<String> =
        flights.chain(studies).chain([OPERATION_COUNTS, REPLAN_TIMES].map(str::to_owned)).collect();
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
        progress(REPLAN_TIMES);
        figures.push(replan_times(options)?);
    }
    figures.sort_by(|a, b| a.name.cmp(&b.name));
    Ok(figures)
}

fn operation_counts(options: &Options) -> Result<Figure, Error> {
    let scenario = scenarios::load(&options.scenarios.join("fixed-wing/rendezvous-7.toml"))?;
    let plan = match options.is_quick {
        true => ipm::Plan::quick(),
        false => ipm::Plan { intervals: vec![4, 8, 20, 40], repetitions: 3, max_solve_s: 1.0 },
    };
    let svg = ipm::svg(&ipm::run(&scenario, &plan, &mut |_| {}));
    let caption =
        "Operation counts of the paper's methods I, II and III (its figure 4) and measured times, with ours".into();
    Ok(Figure { paper: 1, name: OPERATION_COUNTS.into(), caption, svg })
}

/// Time of every replan of the two swarms, on the same map with the same seed.
fn replan_times(options: &Options) -> Result<Figure, Error> {
    let scenario = scenarios::load(&options.scenarios.join("multirotor/paper-map.toml"))?;
    let mut means = Vec::new();
    let mut curve = |planner: &'static str, label: &str, colour| {
        let flown = PlanSource::Registered(registered(planner)).fly(&scenario, scenario.simulation.seed);
        let replans = flown.flight.and_then(|flight| flight.planning).map(|planning| planning.replans);
        let points: Vec<(f64, f64)> =
            replans.unwrap_or_default().iter().map(|replan| (replan.asked_s, 1e3 * replan.wall_s)).collect();
        means.push(points.iter().map(|point| point.1).sum::<f64>() / points.len().max(1) as f64);
        Curve::line(label, colour, points)
    };
    let curves = vec![curve("rhc-pso", "PSO", [214, 120, 20]), curve("rhc-fpso", "FPSO", [29, 99, 196])];
    let labels = ["time of the flight [s]".to_owned(), "time of a replan [ms]".to_owned()];
    let svg = Chart { labels, curves, ..Chart::default() }.svg().unwrap_or_default();
    let caption = format!(
        "Time of each replan: mean {:.2} ms with PSO, {:.2} ms with FPSO (the paper: 641.9 ms and 369.5 ms, Matlab)",
        means[0], means[1]
    );
    Ok(Figure { paper: 3, name: REPLAN_TIMES.into(), caption, svg })
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
