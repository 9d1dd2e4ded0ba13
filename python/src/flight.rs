//! Plans, flights and verdicts.

use std::path::{Path, PathBuf};
use std::sync::Arc;
use std::time::Instant;

use harness::metrics;
use harness::output::flight_table;
use harness::output::recording::{Recorder, Run, mcap, parquet, rrd};
use harness::plan_source::external::protocol;
use harness::plan_source::plan_import::{self, CompletedPlan};
use harness::plan_source::{Flown, Guidance, PlanSource};
use harness::report::{Report, Timings};
use harness::verdict::{self, Verdict};
use pyo3::buffer::PyBuffer;
use pyo3::prelude::*;
use pyo3::types::PyByteArray;
use scenarios::plan_input::{self, ColumnTable, PlanDocument, PlanHeader, RowLocations};

use crate::arrays::{bytes, numbers};
use crate::error::{invalid, of_plan};
use crate::planner;
use crate::scenario::Scenario;
use crate::worker::{self, Failure, Reporter};

/// A plan that is complete, with what of it was reconstructed.
#[pyclass(frozen, module = "uav_harness.native")]
pub struct Plan {
    completed: CompletedPlan,
}

#[pymethods]
impl Plan {
    fn to_json(&self) -> String {
        let mut text = Vec::new();
        self.completed.plan.write_json(&mut text).expect("writing to memory");
        String::from_utf8(text).expect("JSON is UTF-8")
    }

    fn to_csv(&self) -> String {
        let mut text = Vec::new();
        self.completed.plan.write_csv(&mut text).expect("writing to memory");
        String::from_utf8(text).expect("CSV is UTF-8")
    }
}

/// Columns of a vehicle: its name, the times, and the other columns by name.
type Table<'py> = (String, Bound<'py, PyAny>, Vec<(String, Bound<'py, PyAny>)>);

/// Reads a plan from tables, one per vehicle.
#[pyfunction]
pub fn read_plan_tables(py: Python<'_>, scenario: &Scenario, name: &str, tables: Vec<Table<'_>>) -> PyResult<Plan> {
    let tables = tables.into_iter().map(|table| column_table(py, table)).collect::<PyResult<_>>()?;
    let document = PlanDocument { tables, ..PlanDocument::default() };
    let read = plan_input::from_tables("plan", document, &scenario.scenario);
    let (header, tracks) = read.map_err(|error| of_plan(&error))?;
    Ok(completed(scenario, header, tracks, name))
}

fn column_table(py: Python<'_>, (vehicle, times, columns): Table<'_>) -> PyResult<ColumnTable> {
    let times_s = numbers(py, &PyBuffer::get(&times)?)?;
    let column = |(name, values): (String, Bound<'_, PyAny>)| {
        let values = numbers(py, &PyBuffer::get(&values)?)?;
        if values.len() == times_s.len() {
            return Ok((name, values));
        }
        Err(invalid(format!("plan: {name}: found {} values, expected {}, one per time", values.len(), times_s.len())))
    };
    let columns = columns.into_iter().map(column).collect::<PyResult<_>>()?;
    let locations = RowLocations::Rows((1..=times_s.len()).collect());
    Ok(ColumnTable { vehicle, locations, times_s, columns, planner_nodes: Vec::new() })
}

/// Reads a plan file: CSV, JSON or Parquet.
#[pyfunction]
pub fn read_plan_file(scenario: &Scenario, path: PathBuf) -> PyResult<Plan> {
    let (header, tracks) = plan_input::read(&path, &scenario.scenario).map_err(|error| of_plan(&error))?;
    let stem = path.file_stem().unwrap_or_default().to_string_lossy().into_owned();
    let name = header.planner.clone().unwrap_or(stem);
    Ok(completed(scenario, header, tracks, &name))
}

/// Reads the reply of a planner, JSON.
#[pyfunction]
pub fn read_plan_reply(scenario: &Scenario, name: &str, seed: u64, text: &str) -> PyResult<Plan> {
    let completed = protocol::read_plan(text, &scenario.scenario, name, seed).map_err(invalid)?;
    Ok(Plan { completed })
}

fn completed(scenario: &Scenario, header: PlanHeader, tracks: Vec<plan_input::ImportedTrajectory>, name: &str) -> Plan {
    let scenario = &scenario.scenario;
    let seed = scenario.simulation.seed;
    Plan { completed: plan_import::complete(scenario, header, tracks, name, seed) }
}

/// A plan and its flight.
#[pyclass(frozen, module = "uav_harness.native")]
pub struct Flight {
    flown: Arc<Flown>,
    timings: Timings,
}

#[pymethods]
impl Flight {
    /// The plan; of in-loop planners, the references that the vehicles followed.
    #[getter]
    fn plan(&self) -> Plan {
        Plan { completed: self.flown.answer.clone() }
    }

    /// Whether the plan could be flown.
    #[getter]
    fn is_flown(&self) -> bool {
        self.flown.flight.is_some()
    }

    /// Names of the vehicles with a log.
    #[getter]
    fn vehicles(&self) -> Vec<&str> {
        self.flown.flight.iter().flat_map(|flight| &flight.vehicles).map(|log| log.vehicle.as_str()).collect()
    }

    /// The log of a vehicle: names of the columns, and their numbers as bytes.
    fn columns<'py>(&self, py: Python<'py>, vehicle: usize) -> Vec<(&'static str, Bound<'py, PyByteArray>)> {
        let Some(flight) = &self.flown.flight else { return Vec::new() };
        let Some(log) = flight.vehicles.get(vehicle) else { return Vec::new() };
        let names = flight_table::columns(flight);
        let rows: Vec<Vec<f64>> =
            (0..log.samples.len()).map(|step| flight_table::values(log, step, names.len())).collect();
        let column = |(index, name)| (name, bytes(py, rows.iter().map(|row| row[index])));
        names.into_iter().enumerate().map(column).collect()
    }
}

/// Plans with a registered planner and flies.
#[pyfunction]
pub fn fly_registered(
    py: Python<'_>,
    scenario: &Scenario,
    name: &str,
    seed: u64,
    progress: Option<&Bound<'_, PyAny>>,
) -> PyResult<Flight> {
    let planner = planners::find(name).ok_or_else(|| unknown_planner(name))?;
    if let Some(reason) = (planner.unsupported_reason)(&scenario.scenario) {
        let scenario = &scenario.scenario.name;
        return Err(invalid(format!("{scenario}: planner `{name}` cannot handle this scenario: {reason}")));
    }
    let scenario = Arc::clone(&scenario.scenario);
    worker::run(py, progress, &Failure::default(), move |reporter| {
        let began = Instant::now();
        let output = PlanSource::Registered(planner).prepare(&scenario, seed, &mut |iteration| {
            reporter.report(|| format!("planning: objective {:.3}", iteration.objective));
        });
        let planning_s = began.elapsed().as_secs_f64();
        fly(&scenario, output.guidance, seed, planning_s, reporter)
    })
}

fn unknown_planner(name: &str) -> PyErr {
    let names = || planners::registry().iter().map(|planner| planner.name);
    let known = names().collect::<Vec<_>>().join(", ");
    let closest = scenarios::closest_name(name, names());
    let remedy = closest.map_or_else(String::new, |closest| format!("; did you mean `{closest}`?"));
    invalid(format!("planner {name}: there is no planner of that name, expected one of {known}{remedy}"))
}

/// Flies a plan.
#[pyfunction]
pub fn fly_plan(
    py: Python<'_>,
    scenario: &Scenario,
    plan: &Plan,
    seed: u64,
    progress: Option<&Bound<'_, PyAny>>,
) -> PyResult<Flight> {
    let (scenario, completed) = (Arc::clone(&scenario.scenario), Box::new(plan.completed.clone()));
    worker::run(py, progress, &Failure::default(), move |reporter| {
        fly(&scenario, Guidance::Plan(completed), seed, 0.0, reporter)
    })
}

/// Flies with an in-loop planner in Python, `replan(vehicle, request) -> reply`.
#[pyfunction]
pub fn fly_in_loop(
    py: Python<'_>,
    scenario: &Scenario,
    name: String,
    replan: Py<PyAny>,
    seed: u64,
    progress: Option<&Bound<'_, PyAny>>,
) -> PyResult<Flight> {
    let scenario = Arc::clone(&scenario.scenario);
    let failure = Failure::default();
    let guidance = planner::guidance(&scenario, name, replan, &failure);
    worker::run(py, progress, &failure, move |reporter| fly(&scenario, guidance, seed, 0.0, reporter))
}

fn fly(
    scenario: &scenarios::Scenario,
    guidance: Guidance,
    seed: u64,
    planning_s: f64,
    reporter: &mut Reporter,
) -> Flight {
    let began = Instant::now();
    let flown = guidance.fly(scenario, seed, &mut |t_s| reporter.report(|| format!("flying: {t_s:.0} s")));
    let timings = Timings { planning_s, flying_s: began.elapsed().as_secs_f64(), ..Timings::default() };
    Flight { flown: Arc::new(flown), timings }
}

/// A verdict, with all that it is about.
#[pyclass(frozen, module = "uav_harness.native")]
pub struct Judged {
    scenario: Arc<scenarios::Scenario>,
    flown: Arc<Flown>,
    verdict: Verdict,
    report: String,
}

#[pymethods]
impl Judged {
    /// `report.json`.
    #[getter]
    fn report(&self) -> &str {
        &self.report
    }

    /// Writes the recording that the extension names: .rrd, .mcap or .parquet.
    fn save(&self, py: Python<'_>, path: PathBuf) -> PyResult<()> {
        let recorder = recorder(&path)?;
        let (plan, flight) = (&self.flown.answer.plan, self.flown.flight.as_ref());
        let run = Run { scenario: &self.scenario, plan, flight, verdict: &self.verdict, waterfall: &[], ghost: None };
        py.detach(|| recorder.write(&run, &path).map_err(|error| error.to_string()))
            .map_err(|reason| invalid(format!("cannot write {}: {reason}", path.display())))
    }
}

fn recorder(path: &Path) -> PyResult<Box<dyn Recorder + Send + Sync>> {
    match path.extension().and_then(|extension| extension.to_str()) {
        Some("rrd") => Ok(Box::new(rrd::Rrd)),
        Some("mcap") => Ok(Box::new(mcap::Mcap)),
        Some("parquet") => Ok(Box::new(parquet::Parquet)),
        _ => Err(invalid(format!("{}: a recording is written as .rrd, .mcap or .parquet", path.display()))),
    }
}

/// Judges a flight against a scenario.
#[pyfunction]
pub fn judge(py: Python<'_>, scenario: &Scenario, flight: &Flight) -> PyResult<Judged> {
    let (scenario, flown) = (Arc::clone(&scenario.scenario), Arc::clone(&flight.flown));
    let timings = flight.timings.clone();
    worker::run(py, None, &Failure::default(), move |_| {
        let began = Instant::now();
        let (answer, flight) = (&flown.answer, flown.flight.as_ref());
        let verdict = verdict::judge_imported(&scenario, &answer.plan, &answer.provenance, flight);
        let metrics = metrics::measure(&scenario, &answer.plan, flight);
        let timings = Timings { judging_s: began.elapsed().as_secs_f64(), ..timings };
        let report = Report::new(answer, flight, verdict.clone(), metrics, timings);
        let report = serde_json::to_string(&report).expect("a report has no keys but text");
        Judged { scenario, flown, verdict, report }
    })
}
