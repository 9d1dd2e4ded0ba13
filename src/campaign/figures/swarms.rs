//! Figures of the two swarms of the third paper, on the same map.

use scenarios::Scenario;
use sim::Replan;

use super::chart::{Chart, Curve};
use super::flights::registered;
use super::{Figure, Options};
use crate::error::Error;
use crate::plan_source::PlanSource;
use crate::statistics::mean;

/// Name of the figure of replan times.
pub const REPLAN_TIMES: &str = "3-replan-times";
/// Name of the figure of convergence.
pub const CONVERGENCE: &str = "3-swarm-convergence";

/// Searches whose mean is drawn, each with a seed of its own.
const SEARCHES: u64 = 20;

/// Planner, label and colour of each swarm.
const SWARMS: [(&str, &str, [u8; 3]); 2] = [("rhc-pso", "PSO", [214, 120, 20]), ("rhc-fpso", "FPSO", [29, 99, 196])];

/// Draws both figures.
///
/// # Errors
///
/// A scenario that cannot be loaded.
pub fn draw(options: &Options) -> Result<[Figure; 2], Error> {
    let scenario = options.load("multirotor/paper-map.toml")?;
    Ok([replan_times(&scenario), convergence(scenario, if options.is_quick { 2 } else { SEARCHES })])
}

fn replans(scenario: &Scenario, planner: &str, seed: u64) -> Vec<Replan> {
    let flown = PlanSource::Registered(registered(planner)).fly(scenario, seed);
    flown.flight.and_then(|flight| flight.planning).map_or_else(Vec::new, |planning| planning.replans)
}

/// Time of every replan of one flight.
fn replan_times(scenario: &Scenario) -> Figure {
    let curves = SWARMS.map(|(planner, label, colour)| {
        let replans = replans(scenario, planner, scenario.simulation.seed);
        Curve::line(label, colour, replans.iter().map(|replan| (replan.asked_s, 1e3 * replan.wall_s)).collect())
    });
    let [pso, fpso] = curves.each_ref().map(|curve| {
        let times = || curve.points.iter().map(|point| point.1);
        let [min, max] = [times().fold(f64::INFINITY, f64::min), times().fold(0.0, f64::max)];
        format!("{:.2} ms ({min:.2} .. {max:.2})", mean(times()).unwrap_or(f64::NAN))
    });
    let labels = ["time of the flight [s]".to_owned(), "time of a replan [ms]".to_owned()];
    let caption = format!(
        "Time of each replan: mean {pso} with PSO, {fpso} with FPSO (the paper: 641.9 ms (460 .. 800) and 369.5 ms (310 .. 440), \
         Matlab)"
    );
    figure(REPLAN_TIMES, caption, &Chart { labels, curves: curves.into(), ..Chart::default() })
}

/// Lowest cost after every iteration of the first search of a flight, the same problem for both swarms: the mean over the
/// searches, from the iteration on at which all of them have a feasible particle.
fn convergence(mut scenario: Scenario, searches: u64) -> Figure {
    // one replan is enough
    scenario.simulation.max_duration_s = scenario.simulation.step_s;
    let curves = SWARMS.map(|(planner, label, colour)| {
        let first = |seed| replans(&scenario, planner, seed).into_iter().next();
        let histories: Vec<Vec<Option<f64>>> =
            (0..searches).filter_map(first).map(|replan| replan.diagnostics.convergence).collect();
        let iterations = histories.iter().map(Vec::len).min().unwrap_or(0);
        let mean_at = |iteration: usize| {
            let costs: Option<Vec<f64>> = histories.iter().map(|history| history[iteration]).collect();
            Some((iteration as f64 + 1.0, mean(costs?.into_iter())?))
        };
        Curve::line(label, colour, (0..iterations).filter_map(mean_at).collect())
    });
    let [pso, fpso] = curves.each_ref().map(|curve| {
        let ends =
            [curve.points.first(), curve.points.last()].map(|point| point.copied().unwrap_or((f64::NAN, f64::NAN)));
        format!("{:.2} m after iteration {:.0} and {:.2} m at the end", ends[0].1, ends[0].0, ends[1].1)
    });
    let labels = ["iteration".to_owned(), "lowest cost [m]".to_owned()];
    let caption = format!(
        "Convergence of the swarms on the same problem, the first of paper-map; mean of {searches} searches: PSO {pso}, FPSO \
         {fpso} (the paper's figure 9: nearly equal)"
    );
    figure(CONVERGENCE, caption, &Chart { labels, curves: curves.into(), ..Chart::default() })
}

fn figure(name: &str, caption: String, chart: &Chart) -> Figure {
    Figure { paper: 3, name: name.into(), caption, svg: chart.svg().unwrap_or_default() }
}
