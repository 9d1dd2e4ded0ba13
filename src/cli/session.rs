use std::fs;
use std::path::{Path, PathBuf};

use clap::{Args, ValueEnum};
use scenarios::PlanningClock;

use super::job_queue;
use crate::campaign::comparison::{self, Comparison, Scope, Snapshot};
use crate::console;
use crate::error::{Error, Exit};
use crate::interrupt;
use crate::jobs::{Job, Jobs, RejectedJob};
use crate::output;
use crate::output::page;
use crate::output::recording::Recorder;
use crate::output::recording::scene_json::SceneJson;
use crate::output::report::json_lines::Event;
use crate::output::report::terminal::{self, Detail};
use crate::output::report::{Links, Summary, comparison_table, github, json_lines, junit};
use crate::pipeline;
use crate::pipeline::{JobResult, Outputs};
use crate::plan_source::PlanSource;
use crate::progress;
use crate::progress::Progress;
use crate::report::Report;

/// Where results are written, in which formats, and what is printed.
#[derive(Args, Debug)]
pub struct Session {
    /// Folder for the results
    #[arg(short, long, value_name = "DIR", default_value = "out")]
    out: PathBuf,
    /// Recordings to write, separated by commas
    #[arg(long, value_name = "FORMAT", value_delimiter = ',', default_value = DEFAULT_RECORDING)]
    record: Vec<Recording>,
    /// Integration-error estimate; checks with smaller margins are undecided
    #[arg(long, value_enum, value_name = "FORM", default_value = "cheap")]
    second_integrator: SecondIntegrator,
    /// Report margin budgets: nodes, between the nodes, tracking, model errors, wind, delay, noise; one more flight for each
    #[arg(long)]
    waterfall: bool,
    /// Write the report page DIR/index.html; `harness report` does so afterwards
    #[arg(long)]
    html: bool,
    /// Write planned and flown paths also as TUM files, the format of evo
    #[arg(long)]
    tum: bool,
    /// Compare with a baseline file or an earlier result folder; the exit code is 1 if anything got worse
    #[arg(long, value_name = "FILE")]
    baseline: Option<PathBuf>,
    /// Show the flights of an earlier result folder, or of one of its jobs, as ghosts in the recordings [default: those of
    /// --baseline, if it is a folder]
    #[arg(long, value_name = "DIR")]
    ghost: Option<PathBuf>,
    /// Number of worker threads, and of scenarios that run side by side [default: one per core]; results do not depend on it,
    /// planning times do. An external planner has the machine for itself
    #[arg(short, long, value_name = "N", value_parser = clap::value_parser!(u16).range(1..))]
    jobs: Option<u16>,
    /// Format of standard output
    #[arg(long, value_enum, value_name = "FORMAT", default_value = "text")]
    format: Format,
    /// List every check; without it, failures and the closest margins
    #[arg(short, long)]
    verbose: bool,
    /// Print errors only
    #[arg(short, long)]
    quiet: bool,
}

const DEFAULT_RECORDING: &str = if cfg!(feature = "rrd") { "rrd,page" } else { "page" };

/// Formats of recordings.
#[derive(Clone, Copy, Debug, PartialEq, Eq, ValueEnum)]
enum Recording {
    /// Recording for the rerun viewer
    Rrd,
    /// Recording with Foxglove schemas, for Foxglove and other viewers
    Mcap,
    /// Flight log as a table, with exact numbers
    Parquet,
    /// The scene that `harness report` draws: scene.json
    Page,
    /// No recording
    None,
}

/// Estimates of the integration error.
#[derive(Clone, Copy, Debug, PartialEq, Eq, ValueEnum)]
enum SecondIntegrator {
    /// Replay the log with an integrator of order 6, window by window
    Cheap,
    /// Repeat the flight with a half and a quarter of the plant's step, with the air sampled as finely; after planning in the
    /// loop, with the same references
    Full,
}

/// Formats of standard output.
#[derive(Clone, Copy, Debug, PartialEq, Eq, ValueEnum)]
pub enum Format {
    /// Tables, for people
    Text,
    /// One JSON object per line, for tools
    JsonLines,
}

/// Carries out one job, with its results in a folder.
pub type Execute<'a> = dyn Fn(&Job, &Outputs, &Path, &mut Progress) -> Result<JobResult, Error> + Sync + 'a;

/// Results so far.
#[derive(Default)]
struct Completed {
    summary: Summary,
    reports: Vec<Report>,
    jobs: Vec<Job>,
    annotations: Vec<String>,
}

impl Session {
    /// Removes the results of an earlier run of a job that is now refused: they must not be taken for its own. Those that
    /// cannot be removed are left, since the refusal is the error to tell.
    ///
    /// - `job`: names of scenario and planner, as far as they are known
    pub fn retract(&self, job: Option<[&str; 2]>) {
        let summaries = ["summary.json", "summary.md", "junit.xml", page::FILE_NAME].map(|name| self.out.join(name));
        let report = job.map(|[scenario, planner]| self.out.join(scenario).join(planner).join("report.json"));
        for path in summaries.into_iter().chain(report) {
            let _ = output::remove_stale(&path);
        }
    }

    /// Removes the reports of earlier runs of a scenario whose file, or whose planner, is now refused. A scenario has the name
    /// of its file.
    fn retract_file(&self, refused: &RejectedJob) {
        let folder = self.out.join(refused.file.file_stem().unwrap_or_default());
        let planners = match &refused.error {
            Error::Unfit { planner, .. } => vec![folder.join(planner)],
            _ => folders_in(&folder),
        };
        for planner in planners {
            let _ = output::remove_stale(&planner.join("report.json"));
        }
    }

    /// The options given that are about simulated flights.
    pub fn simulation_options(&self) -> Vec<&'static str> {
        let given = [
            ("--second-integrator", self.second_integrator == SecondIntegrator::Full),
            ("--waterfall", self.waterfall),
            ("--tum", self.tum),
            ("--ghost", self.ghost.is_some()),
        ];
        given.into_iter().filter(|(_, is_given)| *is_given).map(|(name, _)| name).collect()
    }

    /// Runs all valid jobs, reports the others, and writes the summaries.
    pub fn run(&self, jobs: Jobs) -> Result<Exit, Error> {
        self.run_by(jobs, &pipeline::run)
    }

    /// As [`run`](Self::run), with `execute` in place of the pipeline.
    pub fn run_by(&self, jobs: Jobs, execute: &Execute<'_>) -> Result<Exit, Error> {
        let outputs = Outputs {
            waterfall: self.waterfall,
            recorders: self.recorders()?,
            tum: self.tum,
            ghost: self.ghost.clone().or_else(|| self.baseline.clone().filter(|baseline| baseline.is_dir())),
            refine_step: self.second_integrator == SecondIntegrator::Full,
        };
        let baseline = self.baseline.as_deref().map(Snapshot::read).transpose()?;
        start_threads(self.jobs)?;
        let mut done = Completed::default();
        for refusal in jobs.rejected {
            self.retract_file(&refusal);
            let refused = done.summary.refuse(&refusal);
            self.event(&Event::Refused { file: refused })?;
            done.annotations.extend(github::load_error_annotations(&refusal.error));
            console::print_error(refusal.error);
        }
        let total = jobs.runnable.len();
        interrupt::begin_jobs(
            jobs.runnable.iter().map(|job| format!("{} ({})", job.scenario.name, job.plan_source.name())),
        );
        let work = |index: usize, job: &Job| self.run_job(job, &outputs, [index, total], execute);
        job_queue::in_order(&jobs.runnable, rayon::current_num_threads(), uses_wall_clock, work, |_, result| {
            done.summary.add(&result.report);
            progress::suspended(|| self.show_result(&result))?;
            done.reports.push(result.report);
            Ok(())
        })?;
        done.jobs = jobs.runnable;
        self.finish(done, baseline.as_ref())
    }

    fn run_job(
        &self,
        job: &Job,
        outputs: &Outputs,
        [index, total]: [usize; 2],
        execute: &Execute<'_>,
    ) -> Result<JobResult, Error> {
        interrupt::start_job(index);
        let mut progress = Progress::new(job, index + 1, total, self.quiet);
        let folder = self.out.join(&job.scenario.name).join(job.plan_source.name());
        let result = execute(job, outputs, &folder, &mut progress)?;
        interrupt::complete_job(index);
        progress.finish();
        Ok(result)
    }

    fn show_result(&self, result: &JobResult) -> Result<(), Error> {
        let detail = if self.verbose { Detail::All } else { Detail::Decisive };
        self.show(&terminal::report(&result.report, result.log.as_deref(), detail))?;
        self.event(&Event::Report { report: &result.report })
    }

    fn finish(&self, mut done: Completed, baseline: Option<&Snapshot>) -> Result<Exit, Error> {
        let compared = baseline.map(|old| comparison::compare(old, &Snapshot::of(&done.reports), Scope::NewRunOnly));
        if let Some(compared) = &compared {
            done.summary.set_baseline(compared);
        }
        let Completed { summary, reports, .. } = &done;
        let compared_page = compared.as_ref().map_or_else(String::new, comparison_table::markdown);
        output::create_folder(&self.out)?;
        output::write_json(&self.out.join("summary.json"), summary)?;
        let links = if self.html { Links::Page } else { Links::Reports };
        output::write_file(&self.out.join("summary.md"), |writer| {
            write!(writer, "{}\n{compared_page}", summary.markdown(reports, links))
        })?;
        let xml = junit::document(reports, summary);
        output::replace_file(&self.out.join("junit.xml"), |partial| Ok(std::fs::write(partial, xml?)?))?;
        github::add_to_job_summary(&format!("{}\n{compared_page}", summary.markdown(reports, Links::None)))?;
        page::write_comparison(&self.out, self.baseline.as_deref().zip(compared.as_ref()))?;
        if self.html {
            page::write(&self.out)?;
        } else {
            output::remove_stale(&self.out.join(page::FILE_NAME))?;
        }
        let exit = summary.exit();
        self.event(&Event::Summary { summary, exit_code: exit.code() })?;
        self.show(&terminal::summary(summary, &self.out))?;
        if let Some(compared) = &compared {
            self.event(&Event::Comparison { comparison: compared })?;
            self.show(&comparison_table::text(compared))?;
        }
        self.annotate(&done, compared.as_ref())?;
        Ok(exit)
    }

    /// On GitHub, points to the lines of the scenario files. Beside a stream of JSON they go to standard error, which the
    /// runner reads too.
    fn annotate(&self, done: &Completed, compared: Option<&Comparison>) -> Result<(), Error> {
        if !github::is_github_actions() {
            return Ok(());
        }
        let findings: Vec<github::Finding<'_>> = done
            .reports
            .iter()
            .zip(&done.jobs)
            .map(|(report, job)| github::Finding {
                report,
                scenario: &job.scenario,
                source: &job.source,
                losses: compared.map_or_else(Vec::new, |it| it.losses(&report.scenario, &report.planner)),
            })
            .collect();
        for line in done.annotations.iter().cloned().chain(github::annotations(&findings)) {
            if self.quiet || self.format == Format::JsonLines { console::eprint(&line) } else { console::print(&line)? }
        }
        Ok(())
    }

    /// The page needs what it draws, also without other recordings.
    fn recorders(&self) -> Result<Vec<Box<dyn Recorder>>, Error> {
        let page = self.html.then_some(Recording::Page);
        recorders(&self.record.iter().copied().chain(page).collect::<Vec<_>>())
    }

    fn show(&self, text: &str) -> Result<(), Error> {
        if self.quiet || self.format != Format::Text { Ok(()) } else { console::print(text) }
    }

    fn event(&self, event: &Event<'_>) -> Result<(), Error> {
        if self.quiet || self.format != Format::JsonLines { Ok(()) } else { json_lines::print(event) }
    }
}

/// Whether wall-clock time decides about a job: what runs beside it would change its result.
fn uses_wall_clock(job: &Job) -> bool {
    matches!(job.plan_source, PlanSource::External(_))
        || job.scenario.simulation.planning.time == PlanningClock::Measured
}

/// The folders in a folder; none if it cannot be read.
fn folders_in(folder: &Path) -> Vec<PathBuf> {
    let entries = fs::read_dir(folder).into_iter().flatten().flatten();
    entries.map(|entry| entry.path()).filter(|path| path.is_dir()).collect()
}

/// Starts the given number of worker threads; without one, the default applies.
pub fn start_threads(jobs: Option<u16>) -> Result<(), Error> {
    let Some(jobs) = jobs.map(usize::from) else { return Ok(()) };
    let pool = rayon::ThreadPoolBuilder::new().num_threads(jobs);
    pool.build_global().map_err(|error| Error::Threads { jobs, reason: error.to_string() })
}

fn recorders(formats: &[Recording]) -> Result<Vec<Box<dyn Recorder>>, Error> {
    let mut recorders: Vec<Box<dyn Recorder>> = Vec::new();
    if formats.contains(&Recording::Page) {
        recorders.push(Box::new(SceneJson));
    }
    if formats.contains(&Recording::Rrd) {
        recorders.push(rrd()?);
    }
    if formats.contains(&Recording::Mcap) {
        recorders.push(mcap()?);
    }
    if formats.contains(&Recording::Parquet) {
        recorders.push(parquet()?);
    }
    Ok(recorders)
}

#[cfg(feature = "rrd")]
fn rrd() -> Result<Box<dyn Recorder>, Error> {
    Ok(Box::new(crate::output::recording::rrd::Rrd))
}

#[cfg(not(feature = "rrd"))]
fn rrd() -> Result<Box<dyn Recorder>, Error> {
    Err(Error::RecordingNotBuilt { format: "rrd", what: "rerun recording" })
}

#[cfg(feature = "mcap")]
fn mcap() -> Result<Box<dyn Recorder>, Error> {
    Ok(Box::new(crate::output::recording::mcap::Mcap))
}

#[cfg(not(feature = "mcap"))]
fn mcap() -> Result<Box<dyn Recorder>, Error> {
    Err(Error::RecordingNotBuilt { format: "mcap", what: "MCAP recording" })
}

#[cfg(feature = "parquet")]
fn parquet() -> Result<Box<dyn Recorder>, Error> {
    Ok(Box::new(crate::output::recording::parquet::Parquet))
}

#[cfg(not(feature = "parquet"))]
fn parquet() -> Result<Box<dyn Recorder>, Error> {
    Err(Error::RecordingNotBuilt { format: "parquet", what: "flight log as a table" })
}
