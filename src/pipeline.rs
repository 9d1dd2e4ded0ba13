//! One job from the scenario to the files on disk.
//!
//! ```text
//! Scenario -> planner -> Plan -> sim -> Flight -> judge -> Verdict -> recording + reports
//! ```

use std::path::{Path, PathBuf};
use std::time::Instant;

use scenarios::Plan;
use scenarios::plan_input::Setpoints;
use sim::{Flight, FlightOptions};

use crate::campaign::margin_budget;
use crate::error::Error;
use crate::jobs::Job;
use crate::metrics;
use crate::output;
use crate::output::ghost::Ghost;
use crate::output::recording::{self, Recorder, Run};
use crate::output::tum;
use crate::plan_source::plan_import::CompletedPlan;
use crate::plan_source::{Flown, Guidance, PlanSource, PlannerOutput};
use crate::progress::Progress;
use crate::report::{ReplanTimes, Report, Timings};
use crate::verdict::recorded::RecordedFlight;
use crate::verdict::{self, Integration};

/// File with the standard error of an external planner.
const PLANNER_LOG: &str = "planner.log";
/// Names of the recordings that a result folder may hold.
const RECORDINGS: [&str; 4] = ["flight.rrd", "flight.mcap", "flight.parquet", "scene.json"];

/// What to write beside plan and report.
pub struct Outputs {
    /// The recordings.
    pub recorders: Vec<Box<dyn Recorder>>,
    /// Whether to write planned and flown paths as TUM files.
    pub tum: bool,
    /// Whether to repeat the flight with finer steps, for a better estimate of the integration error.
    pub refine_step: bool,
    /// Whether to compute the margin budgets.
    pub waterfall: bool,
    /// Result folder of an earlier run, whose flights are shown beside the new ones.
    pub ghost: Option<PathBuf>,
}

/// Result of a job.
pub struct JobResult {
    /// All measurements.
    pub report: Report,
    /// Standard error of an external planner.
    pub log: Option<String>,
}

/// Plans, flies (or both at once), judges, records and reports one job into `folder`, which is created if necessary.
///
/// # Errors
///
/// [`Error::Write`] if a result cannot be written. That no plan was found is a result.
pub fn run(job: &Job, outputs: &Outputs, folder: &Path, progress: &mut Progress) -> Result<JobResult, Error> {
    let mut timings = Timings::default();
    let PlannerOutput { guidance, log } = timed(&mut timings.planning_s, || prepare(job, progress));
    let Flown { answer, flight } = timed(&mut timings.flying_s, || fly(job, guidance, progress));
    let log = log.map(|log| log());
    attribute_replanning(&mut timings, job, &answer.plan, flight.as_ref());
    let (plan, flight) = (&answer.plan, flight.as_ref());
    let refined = flight.filter(|_| outputs.refine_step);
    let integration = timed(&mut timings.flying_s, || refined.map(|flight| refine_step(job, plan, flight)));
    progress.judging();
    let (verdict, metrics) = timed(&mut timings.judging_s, || {
        rayon::join(
            || verdict::judge_with(&job.scenario, plan, &answer.provenance, flight, integration),
            || metrics::measure(&job.scenario, plan, flight),
        )
    });
    output::create_folder(folder)?;
    let budgets =
        || margin_budget::budgets(&job.scenario, &job.plan_source.fixed_to(answer.clone()), job.seed, &verdict);
    let waterfall = if outputs.waterfall { budgets() } else { Vec::new() };
    let own = Path::new(&job.scenario.name).join(job.plan_source.name());
    let ghost = outputs.ghost.as_ref().map(|results| Ghost::read(results, &own)).transpose()?.flatten();
    let run =
        Run { scenario: &job.scenario, plan, flight, verdict: &verdict, waterfall: &waterfall, ghost: ghost.as_ref() };
    timed(&mut timings.recording_s, || record(&run, &outputs.recorders, folder, progress))?;
    export(flight, outputs, folder)?;
    let report = Report { waterfall, ..Report::new(&answer, flight, verdict, metrics, timings) };
    write_log(log.as_deref(), folder)?;
    write(plan, &report, folder)?;
    Ok(JobResult { report, log })
}

/// Judges, records and reports a flight that was flown elsewhere into `folder`, which is created if necessary.
///
/// - `log`: its samples, and what they give
/// - `setpoints`: where the vehicles were told to be
///
/// # Errors
///
/// [`Error::Write`] if a result cannot be written.
pub fn judge_flight(
    job: &Job,
    (log, setpoints): (&CompletedPlan, &[Option<Setpoints>]),
    outputs: &Outputs,
    folder: &Path,
    progress: &mut Progress,
) -> Result<JobResult, Error> {
    let mut timings = Timings::default();
    let CompletedPlan { plan, provenance } = log;
    let scenario = &job.scenario;
    progress.judging();
    let verdict = timed(&mut timings.judging_s, || {
        verdict::judge_recorded(&RecordedFlight { scenario, rows: plan, provenance, setpoints })
    });
    output::create_folder(folder)?;
    let run = Run { scenario, plan, flight: None, verdict: &verdict, waterfall: &[], ghost: None };
    timed(&mut timings.recording_s, || record(&run, &outputs.recorders, folder, progress))?;
    export(None, outputs, folder)?;
    write_log(None, folder)?;
    let metrics = metrics::measure(scenario, plan, None);
    let report = Report { recorded: true, ..Report::new(log, None, verdict, metrics, timings) };
    write(plan, &report, folder)?;
    Ok(JobResult { report, log: None })
}

/// The plan, or the in-loop planners.
pub fn prepare(job: &Job, progress: &mut Progress) -> PlannerOutput {
    let plans_now = !matches!(job.plan_source, PlanSource::Imported(_)) && !job.plan_source.plans_in_the_loop();
    if plans_now {
        progress.planning();
    }
    job.plan_source.prepare(&job.scenario, job.seed, &mut |iteration| progress.planned(iteration))
}

/// What a campaign flies many times: the plan, made once, or the in-loop planner, which plans anew in every flight.
pub fn plan_once(job: &Job, progress: &mut Progress) -> PlanSource {
    if job.plan_source.plans_in_the_loop() {
        return job.plan_source.clone();
    }
    let answer = prepare(job, progress).guidance.into_plan().expect("a source that plans before the flight has a plan");
    job.plan_source.fixed_to(answer)
}

fn fly(job: &Job, guidance: Guidance, progress: &mut Progress) -> Flown {
    if let Some(duration_s) = guidance.max_flight_duration_s(&job.scenario) {
        progress.flying(duration_s);
    }
    guidance.fly(&job.scenario, job.seed, &mut |t_s| progress.flown(t_s))
}

/// Counts the planning time of in-loop planners, which passes during the flight, as planning.
fn attribute_replanning(timings: &mut Timings, job: &Job, followed: &Plan, flight: Option<&Flight>) {
    if let Some(planning) = flight.and_then(|flight| flight.planning.as_ref()) {
        timings.planning_s += followed.timings.wall_s;
        timings.flying_s = (timings.flying_s - followed.timings.wall_s).max(0.0);
        timings.replans = ReplanTimes::of(planning, job.scenario.simulation.planning.deadline_s);
    }
}

/// Repeats the flight with half and with a quarter of the plant's step, and measures the differences. What was planned in
/// the loop is not planned again: the vehicles follow the same references, so that only the integrator differs.
fn refine_step(job: &Job, plan: &Plan, flight: &Flight) -> Integration {
    let source = || if flight.planning.is_some() { sim::ReferenceSource::Recorded(flight) } else { plan.into() };
    let finer =
        |halvings| sim::fly_with(&job.scenario, source(), job.seed, &FlightOptions::finer(halvings), &mut |_| {});
    let (half, quarter) = rayon::join(|| finer(1), || finer(2));
    Integration::by_finer_steps(flight, [&half, &quarter])
}

fn record(run: &Run<'_>, recorders: &[Box<dyn Recorder>], folder: &Path, progress: &mut Progress) -> Result<(), Error> {
    let is_stale = |name: &&str| recorders.iter().all(|recorder| recorder.file_name() != *name);
    RECORDINGS.iter().copied().filter(is_stale).try_for_each(|name| output::remove_stale(&folder.join(name)))?;
    for recorder in recorders {
        progress.recording(recorder.file_name());
        recording::record(recorder.as_ref(), run, folder)?;
    }
    Ok(())
}

fn export(flight: Option<&Flight>, outputs: &Outputs, folder: &Path) -> Result<(), Error> {
    match flight.filter(|_| outputs.tum) {
        Some(flight) => tum::write(flight, folder),
        None => tum::remove_stale(folder),
    }
}

/// Writes the log of an external planner; without one, removes that of an earlier run.
fn write_log(log: Option<&str>, folder: &Path) -> Result<(), Error> {
    let path = folder.join(PLANNER_LOG);
    match log.filter(|log| !log.is_empty()) {
        Some(log) => output::write_file(&path, |writer| writer.write_all(log.as_bytes())),
        None => output::remove_stale(&path),
    }
}

fn write(plan: &Plan, report: &Report, folder: &Path) -> Result<(), Error> {
    output::write_file(&folder.join("plan.json"), |writer| plan.write_json(writer))?;
    output::write_file(&folder.join("plan.csv"), |writer| plan.write_csv(writer))?;
    output::write_json(&folder.join("report.json"), report)
}

/// Runs `work` and adds its wall time to `total_s`.
fn timed<T>(total_s: &mut f64, work: impl FnOnce() -> T) -> T {
    let began = Instant::now();
    let result = work();
    *total_s += began.elapsed().as_secs_f64();
    result
}
