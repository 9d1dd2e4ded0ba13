//! Figures over fleet sizes and methods, with the papers' own numbers where they print them.

use std::path::Path;

use scenarios::{PlanStatus, Scenario, Solver};

use super::chart::{Chart, Curve};
use super::flights::registered;
use super::{Figure, Options};
use crate::error::Error;
use crate::plan_source::PlanSource;

/// Colours of the methods.
const COLOURS: [[u8; 3]; 4] = [[29, 99, 196], [214, 120, 20], [20, 128, 60], [140, 60, 170]];

/// Plans of several methods over fleets of several sizes.
pub struct Study {
    /// Number of the paper.
    pub paper: u8,
    /// Beginning of the figures' names.
    pub name: &'static str,
    /// Scenario file of the largest fleet; a smaller one is its first vehicles.
    pub scenario: &'static str,
    /// The methods.
    pub methods: &'static [Method],
    /// What the paper prints, of its largest fleet.
    pub printed: &'static [Printed],
}

/// A planner with a solver.
pub struct Method {
    /// Name in the legend.
    pub label: &'static str,
    /// Planner.
    pub planner: &'static str,
    /// Solver of its subproblems; `None`: its own.
    pub solver: Option<Solver>,
    /// Fleet sizes.
    pub sizes: &'static [usize],
}

/// A result of a paper.
pub struct Printed {
    /// Name in the legend.
    pub label: &'static str,
    /// Index of the method of ours that it has the colour of.
    pub method: usize,
    /// Number of vehicles.
    pub vehicles: usize,
    /// Flight time, s.
    pub flight_time_s: f64,
    /// Planning time on the paper's machine, s; NaN where it is not printed.
    pub planning_s: f64,
}

/// One plan.
struct Measured {
    vehicles: usize,
    planning_s: f64,
    flight_time_s: Option<f64>,
    is_solved: bool,
}

impl Study {
    /// Names of the figures.
    pub fn names(&self) -> [String; 2] {
        ["flight-time", "planning-time"].map(|ending| format!("{}-{ending}", self.name))
    }

    /// Plans and draws: flight time and planning time over the number of vehicles.
    ///
    /// # Errors
    ///
    /// A scenario that cannot be loaded.
    pub fn draw(&self, options: &Options) -> Result<[Figure; 2], Error> {
        let measured: Vec<Vec<Measured>> =
            self.methods.iter().map(|method| self.measure(method, options)).collect::<Result<_, _>>()?;
        let [flight_name, planning_name] = self.names();
        let printed = |value: fn(&Printed) -> f64| {
            let known = self.printed.iter().filter(move |it| value(it).is_finite());
            known
                .map(|it| Curve::dots(it.label, COLOURS[it.method], vec![(it.vehicles as f64, value(it))]))
                .collect::<Vec<_>>()
        };
        let flight_time =
            self.chart("flight time [s]", &measured, |it| it.flight_time_s, printed(|it| it.flight_time_s));
        let planning =
            self.chart("planning time [s]", &measured, |it| Some(it.planning_s), printed(|it| it.planning_s));
        let planning = Chart { is_log: true, ..planning };
        let unsolved = measured.iter().flatten().filter(|it| !it.is_solved).count();
        let note = if unsolved > 0 {
            format!("; {unsolved} plans are not solved by their own account")
        } else {
            String::new()
        };
        let figure = |name: String, what: &str, chart: &Chart| Figure {
            paper: self.paper,
            name,
            caption: format!("{what} over the number of vehicles, first vehicles of {}{note}", stem(self.scenario)),
            svg: chart.svg().unwrap_or_default(),
        };
        Ok([
            figure(flight_name, "Flight time", &flight_time),
            figure(planning_name, "Planning time on this machine (the paper's numbers: on its own)", &planning),
        ])
    }

    fn measure(&self, method: &Method, options: &Options) -> Result<Vec<Measured>, Error> {
        let largest = options.load(self.scenario)?;
        let sizes = method.sizes.iter().take(if options.is_quick { 2 } else { usize::MAX });
        Ok(sizes.map(|&vehicles| plan(&largest, method, vehicles)).collect())
    }

    fn chart(
        &self,
        label: &str,
        measured: &[Vec<Measured>],
        value: fn(&Measured) -> Option<f64>,
        printed: Vec<Curve>,
    ) -> Chart {
        let methods = self.methods.iter().zip(measured).zip(COLOURS);
        let curves = methods.map(|((method, rows), colour)| {
            let points = rows.iter().filter_map(|row| Some((row.vehicles as f64, value(row)?)));
            Curve::line(method.label, colour, points.collect())
        });
        let labels = ["number of vehicles".to_owned(), label.to_owned()];
        Chart { labels, curves: curves.chain(printed).collect(), ..Chart::default() }
    }
}

fn plan(largest: &Scenario, method: &Method, vehicles: usize) -> Measured {
    let mut scenario = largest.clone();
    scenario.vehicles.truncate(vehicles);
    scenario.planner.solver = method.solver.or(scenario.planner.solver);
    let source = PlanSource::Registered(registered(method.planner));
    let prepared = source.prepare(&scenario, scenario.simulation.seed, &mut |_| {}).guidance;
    let plan = prepared.into_plan().expect("a planner that plans before the flight").plan;
    Measured {
        vehicles,
        planning_s: plan.timings.wall_s,
        flight_time_s: plan.flight_time_s(),
        is_solved: plan.status == PlanStatus::Solved,
    }
}

fn stem(scenario: &str) -> String {
    Path::new(scenario).file_stem().unwrap_or_default().to_string_lossy().into_owned()
}
