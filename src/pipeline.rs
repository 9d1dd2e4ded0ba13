//! One job from the scenario to the files on disk.
//!
//! ```text
//! Scenario -> planner -> Plan -> sim -> Flight -> judge -> Verdict -> recording + reports
//! ```

use std::path::Path;
use std::time::Instant;

use scenarios::{Plan, Scenario};
use sim::{Flight, FlightOptions};

use crate::campaign::margin_budget;
use crate::campaign::margin_budget::MarginBudget;
use crate::error::Error;
use crate::jobs::Job;
use crate::metrics;
use crate::output;
use crate::output::recording::{self, Recorder, Run};
use crate::output::tum;
use crate::plan_source::in_loop;
use crate::plan_source::plan_import::CompletedPlan;
use crate::plan_source::{InLoopPlanners, Log, PlanSource, PlannerOutput};
use crate::progress::Progress;
use crate::report::{ReplanTimes, Report, Timings};
use crate::verdict;
use crate::verdict::{Integration, Verdict};

/// What an outside planner wrote to its standard error.
const PLANNER_LOG: &str = "planner.log";
/// Names of the recordings that a result folder may hold.
const RECORDINGS: [&str; 3] = ["flight.rrd", "flight.mcap", "flight.parquet"];

/// What is written beside plan and report.
pub struct Outputs {
    /// The recordings.
    pub recorders: Vec<Box<dyn Recorder>>,
    /// PlannedMotions and flown paths as TUM files?
    pub tum: bool,
    /// Is every flight repeated with finer steps?
    pub refine_step: bool,
    /// Is it told where the margins went?
    pub waterfall: bool,
}

/// What a job brought.
pub struct JobResult {
    /// Everything that was measured.
    pub report: Report,
    /// What an outside planner wrote to its standard error.
    pub log: Option<String>,
}

/// Plans, flies (or both at once), judges, records and reports one job into `folder`, which is made if it is not there.
pub fn run(job: &Job, outputs: &Outputs, folder: &Path, progress: &mut Progress) -> Result<JobResult, Error> {
    let mut timings = Timings::default();
    let (PlannerOutput { answer, log }, flight) = match job.plan_source.crew(&job.scenario, job.seed) {
        Some((crew, log)) => fly_in_loop(job, crew, log, &mut timings, progress),
        None => {
            let output = timed(&mut timings.planning_s, || plan(job, progress));
            let flight = timed(&mut timings.flying_s, || fly(job, &output.answer.plan, progress));
            (output, flight)
        }
    };
    let plan = &answer.plan;
    let again = flight.as_ref().filter(|flight| outputs.refine_step && flight.planning.is_none());
    let integration = timed(&mut timings.flying_s, || again.map(|flight| refine_step(job, plan, flight)));
    progress.judging();
    let (verdict, metrics) = timed(&mut timings.judging_s, || {
        rayon::join(
            || verdict::judge_with(&job.scenario, plan, &answer.provenance, flight.as_ref(), integration),
            || metrics::measure(&job.scenario, plan, flight.as_ref()),
        )
    });
    output::create_folder(folder)?;
    let waterfall = if outputs.waterfall { waterfall(job, &answer, &verdict) } else { Vec::new() };
    let run = Run { scenario: &job.scenario, plan, flight: flight.as_ref(), verdict: &verdict, waterfall: &waterfall };
    timed(&mut timings.recording_s, || record(&run, &outputs.recorders, folder, progress))?;
    export(flight.as_ref(), outputs, folder)?;
    let report = Report { waterfall, ..Report::new(&answer, flight.as_ref(), verdict, metrics, timings) };
    write_log(log.as_deref(), folder)?;
    write(plan, &report, folder)?;
    Ok(JobResult { report, log })
}

/// The plan alone, without flying it.
pub fn plan(job: &Job, progress: &mut Progress) -> PlannerOutput {
    if !matches!(job.plan_source, PlanSource::Imported(_)) {
        progress.planning();
    }
    job.plan_source.plan(&job.scenario, job.seed, &mut |iteration| progress.planned(iteration))
}

/// The plan alone, where the plan_source makes one before the flight.
pub fn answer(job: &Job, progress: &mut Progress) -> Option<CompletedPlan> {
    (!job.plan_source.plans_in_the_loop()).then(|| plan(job, progress).answer)
}

/// No flight if there is nothing that could be flown; the judge says why.
fn fly(job: &Job, plan: &Plan, progress: &mut Progress) -> Option<Flight> {
    verdict::is_flyable(&job.scenario, plan).ok()?;
    progress.flying(flight_duration_s(&job.scenario, plan));
    Some(sim::fly(&job.scenario, plan, job.seed, &mut |t_s| progress.flown(t_s)))
}

/// The same flight with half and with a quarter of the plant's step, and how far they are apart.
fn refine_step(job: &Job, plan: &Plan, flight: &Flight) -> Integration {
    let finer = |halvings| sim::fly_with(&job.scenario, plan, job.seed, &FlightOptions::finer(halvings), &mut |_| {});
    let (half, quarter) = rayon::join(|| finer(1), || finer(2));
    Integration::by_finer_steps(flight, [&half, &quarter])
}

/// The flight of a planner in the loop, and what was planned during it as a plan. Planning is timed apart from flying.
fn fly_in_loop(
    job: &Job,
    crew: InLoopPlanners,
    log: Option<Log>,
    timings: &mut Timings,
    progress: &mut Progress,
) -> (PlannerOutput, Option<Flight>) {
    progress.flying(job.scenario.simulation.max_duration_s);
    let mut both_s = 0.0;
    let flight = timed(&mut both_s, || sim::fly_in_loop(&job.scenario, crew, job.seed, &mut |t_s| progress.flown(t_s)));
    let planning = flight.planning.as_ref().expect("what flies in the loop has a log of its planning");
    let plan = in_loop::as_plan(&job.scenario, job.plan_source.name(), job.seed, planning);
    timings.planning_s = plan.timings.wall_s;
    timings.flying_s = (both_s - plan.timings.wall_s).max(0.0);
    timings.replans = ReplanTimes::of(planning);
    (PlannerOutput { answer: CompletedPlan::whole(plan), log: log.map(|log| log()) }, Some(flight))
}

/// Where the margins went, step by step.
fn waterfall(job: &Job, answer: &CompletedPlan, verdict: &Verdict) -> Vec<MarginBudget> {
    match job.plan_source.plans_in_the_loop() {
        true => margin_budget::in_the_loop(&job.scenario, &job.plan_source, job.seed, verdict),
        false => margin_budget::of(&job.scenario, &answer.plan, &answer.provenance, job.seed, verdict),
    }
}

fn flight_duration_s(scenario: &Scenario, plan: &Plan) -> f64 {
    let plan_end_s = plan.flight_time_s().unwrap_or(0.0);
    (plan_end_s + scenario.simulation.coast_s).min(scenario.simulation.max_duration_s)
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

/// What an outside planner said, or the removal of what an earlier one did.
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

/// Does `work` and adds the time it took to `total_s`.
fn timed<T>(total_s: &mut f64, work: impl FnOnce() -> T) -> T {
    let began = Instant::now();
    let done = work();
    *total_s += began.elapsed().as_secs_f64();
    done
}
