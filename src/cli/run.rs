use std::path::{Path, PathBuf};

use clap::{Args, ValueEnum};

use crate::error::{Error, Exit};
use crate::jobs::{self, Job};
use crate::progress::Progress;
use crate::record::Recorder;
use crate::report::{Summary, terminal};
use crate::{output, pipeline};

/// Plan, fly, judge and record scenarios.
///
/// Each scenario is planned, the plan is flown in simulation by a tracking controller in the scenario's wind, and the
/// judge measures what the planner saw at its nodes, what the plan is between them, and what was flown. A scenario passes
/// if every deciding check does.
#[derive(Args, Debug)]
#[command(after_help = EXAMPLES)]
pub struct Run {
    /// Scenario files, or folders that are searched for *.toml to the bottom
    #[arg(value_name = "PATH", default_value = "scenarios")]
    paths: Vec<PathBuf>,
    /// Planner to use instead of the one that the scenario names; repeat it to run several
    #[arg(short, long = "planner", value_name = "NAME")]
    planners: Vec<String>,
    /// Folder for the results
    #[arg(short, long, value_name = "DIR", default_value = "out")]
    out: PathBuf,
    /// Recordings to write, separated by commas
    #[arg(long, value_name = "FORMAT", value_delimiter = ',', default_value = DEFAULT_RECORDING)]
    record: Vec<Recording>,
    /// Seed of everything random, instead of the scenario's own
    #[arg(long, value_name = "N")]
    seed: Option<u64>,
    /// Number of worker threads [default: one per core]; results do not depend on it
    #[arg(short, long, value_name = "N", value_parser = clap::value_parser!(u16).range(1..))]
    jobs: Option<u16>,
    /// Print nothing but errors; the exit code and the files tell the rest
    #[arg(short, long)]
    quiet: bool,
}

const EXAMPLES: &str = "\
Examples:
  harness run scenarios/fixed-wing/rendezvous-7.toml    one scenario
  harness run -p parallel-scp --seed 3 -o out/seed-3    another planner, another seed, another folder
  harness run --record none -q                          verdicts only, as in continuous integration

Results:
  out/<scenario>/<planner>/report.json           every check with value, limit and margin
  out/<scenario>/<planner>/flight.rrd            the recording, for the rerun viewer
  out/<scenario>/<planner>/plan.json, plan.csv   the plan
  out/summary.json, out/summary.md               the whole run";

const DEFAULT_RECORDING: &str = if cfg!(feature = "rrd") { "rrd" } else { "none" };

/// Formats of recordings.
#[derive(Clone, Copy, Debug, PartialEq, Eq, ValueEnum)]
enum Recording {
    /// For the rerun viewer
    Rrd,
    /// No recording
    None,
}

impl Run {
    /// Runs everything that can be run, and names what cannot.
    pub fn execute(&self) -> Result<Exit, Error> {
        let recorders = recorders(&self.record)?;
        let planners = jobs::planners_named(&self.planners)?;
        let files = scenarios::find(&self.paths)?;
        self.start_threads()?;
        let jobs = jobs::load(&files, &planners, self.seed);
        let mut summary = Summary::default();
        for refusal in jobs.bad {
            summary.refuse(&refusal);
            refusal.error.print();
        }
        for (index, job) in jobs.good.iter().enumerate() {
            let mut progress = Progress::new(job, index + 1, jobs.good.len(), self.quiet);
            let report = pipeline::run(job, &recorders, &result_folder(&self.out, job), &mut progress)?;
            progress.finish();
            self.show(&terminal::report(&report))?;
            summary.add(&report);
        }
        self.finish(&summary)
    }

    fn start_threads(&self) -> Result<(), Error> {
        let Some(jobs) = self.jobs.map(usize::from) else { return Ok(()) };
        let pool = rayon::ThreadPoolBuilder::new().num_threads(jobs);
        pool.build_global().map_err(|error| Error::Threads { jobs, reason: error.to_string() })
    }

    fn finish(&self, summary: &Summary) -> Result<Exit, Error> {
        output::create_folder(&self.out)?;
        output::write_json(&self.out.join("summary.json"), summary)?;
        output::write_file(&self.out.join("summary.md"), |writer| write!(writer, "{}", summary.markdown()))?;
        self.show(&terminal::summary(summary, &self.out))?;
        Ok(summary.exit())
    }

    fn show(&self, text: &str) -> Result<(), Error> {
        if self.quiet { Ok(()) } else { output::print(text) }
    }
}

fn result_folder(out: &Path, job: &Job) -> PathBuf {
    out.join(&job.scenario.name).join(job.planner.name)
}

fn recorders(formats: &[Recording]) -> Result<Vec<Box<dyn Recorder>>, Error> {
    if formats.contains(&Recording::Rrd) { Ok(vec![rrd()?]) } else { Ok(Vec::new()) }
}

#[cfg(feature = "rrd")]
fn rrd() -> Result<Box<dyn Recorder>, Error> {
    Ok(Box::new(crate::record::rrd::Rrd))
}

#[cfg(not(feature = "rrd"))]
fn rrd() -> Result<Box<dyn Recorder>, Error> {
    Err(Error::RecordingNotBuilt)
}
