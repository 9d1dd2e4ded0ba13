use std::path::{Path, PathBuf};
use std::sync::Mutex;

use clap::Args;
use serde::Serialize;

use super::plan::has_no_plan;
use super::run::AuthorArgs;
use super::session::start_threads;
use crate::campaign::monte_carlo::{self, Dispersions, Experiment, Partition, Sample, Statistics, Sweep, table};
use crate::console;
use crate::error::{Error, Exit};
use crate::jobs::{self, Job};
use crate::output;
use crate::pipeline;
use crate::plan_source::PlanSource;
use crate::progress::Progress;

/// Fly one plan in many worlds that are drawn: wind, mass, noise, start.
///
/// The scenario is planned once (a planner in the loop plans in every flight anew), and the plan is flown in worlds drawn
/// about the scenario's. With none of --wind, --mass, --noise and --start something usual is drawn of each; with some of
/// them the others stay as the scenario has them. Every sample has a seed of its own, and gives the same flight on any
/// machine. The exit code is 1 if fewer pass than asked for.
#[derive(Args, Debug)]
#[command(after_help = EXAMPLES)]
pub struct SweepCommand {
    /// The scenario file
    #[arg(value_name = "SCENARIO")]
    scenario: PathBuf,
    /// Number of samples
    #[arg(short = 'n', long, value_name = "N", value_parser = clap::value_parser!(u32).range(1..))]
    samples: u32,
    #[command(flatten)]
    dispersions: SpreadArgs,
    /// Fly only part K of N parts: one for each machine, for `harness merge`
    #[arg(long, value_name = "K/N", value_parser = partition)]
    partition: Option<Partition>,
    #[command(flatten)]
    plan_source: AuthorArgs,
    /// Seed of the first sample, instead of the scenario's own; of each next one it is one more
    #[arg(long, value_name = "N")]
    seed: Option<u64>,
    /// Folder for the results
    #[arg(short, long, value_name = "DIR", default_value = "out")]
    out: PathBuf,
    #[command(flatten)]
    shown: Shown,
    /// Number of worker threads [default: one per core]; results do not depend on it
    #[arg(short, long, value_name = "N", value_parser = clap::value_parser!(u16).range(1..))]
    jobs: Option<u16>,
}

/// How far the worlds are drawn.
#[derive(Args, Debug)]
struct SpreadArgs {
    /// A wind of up to this speed, in any direction, is added to the scenario's, m/s
    #[arg(long, value_name = "M/S", value_parser = not_negative)]
    wind: Option<f64>,
    /// True masses are up to this far off to either side, %
    #[arg(long, value_name = "%", value_parser = percent)]
    mass: Option<f64>,
    /// Standard deviation of the measured position is up to this, m; other noise grows with it
    #[arg(long, value_name = "M", value_parser = not_negative)]
    noise: Option<f64>,
    /// Vehicles start up to this far from where they should, horizontally, m
    #[arg(long, value_name = "M", value_parser = not_negative)]
    start: Option<f64>,
}

/// What is asked of the samples, and what is printed.
#[derive(Args, Debug)]
pub struct Shown {
    /// So many have to pass, %
    #[arg(long, value_name = "%", default_value = "100", value_parser = percent)]
    at_least: f64,
    /// Print nothing but errors; the files tell the rest
    #[arg(short, long)]
    quiet: bool,
}

const EXAMPLES: &str = "\
Examples:
  harness sweep scenarios/fixed-wing/rendezvous-7.toml --samples 200
  harness sweep scenarios/slung/rectangle-wind.toml -n 500 --wind 2 --mass 5 --at-least 95
  harness sweep scenarios/multirotor/forest.toml -n 1000 --partition 1/4 -o out/1    on the first of four machines
  harness merge out/*/forest/rhc/sweep.parquet -o out/forest

Results:
  out/<scenario>/<planner>/sweep.parquet          one row per sample: what was drawn, the verdict, every margin
  out/<scenario>/<planner>/sweep.json             how many passed, and the margins' quantiles
  out/<scenario>/<planner>/worst/<scenario>.toml  the sample that failed most, as a scenario
  out/<scenario>/<planner>/plan.json              the plan that was flown

`harness check worst/<scenario>.toml --plan plan.json` flies the worst sample again and records it; of a planner in the
loop `harness run worst/<scenario>.toml` does.";

impl SweepCommand {
    /// Plans, flies, writes and prints.
    pub fn execute(&self) -> Result<Exit, Error> {
        start_threads(self.jobs)?;
        let plan_sources = self.plan_source.plan_sources()?;
        let job = &jobs::load_one(&self.scenario, &plan_sources, self.seed)?;
        let mut progress = Progress::new(job, 1, 1, self.shown.quiet);
        let system = &pipeline::plan_once(job, &mut progress);
        if has_no_plan(system) {
            progress.finish();
            return Ok(Exit::Failed);
        }
        let experiment = Experiment { scenario: &job.scenario, system };
        let sweep = Sweep::new(&experiment, self.samples as usize, self.dispersions.about(job));
        let samples = self.fly(&experiment, &sweep, progress);
        let folder = self.out.join(&job.scenario.name).join(job.plan_source.name());
        output::create_folder(&folder)?;
        if let PlanSource::Imported(answer) = system {
            output::write_file(&folder.join("plan.json"), |writer| answer.plan.write_json(writer))?;
        }
        let worst = write_worst(&experiment, &sweep, &samples, &folder)?;
        let exit = self.shown.finish(&sweep, &samples, &folder)?;
        if let Some(number) = worst.filter(|_| !self.shown.quiet) {
            console::print(&format!("sample {number} failed most; its scenario stands in worst/"))?;
        }
        Ok(exit)
    }

    fn fly(&self, experiment: &Experiment<'_>, sweep: &Sweep, progress: Progress) -> Vec<Sample> {
        let partition = self.partition.unwrap_or(Partition::WHOLE);
        let total = partition.numbers(sweep.samples).count();
        let progress = Mutex::new((progress, 0));
        let samples = monte_carlo::run(experiment, sweep, partition, &|| {
            if let Ok(mut progress) = progress.lock() {
                progress.1 += 1;
                let done = progress.1;
                progress.0.swept(done, total);
            }
        });
        if let Ok((progress, _)) = progress.into_inner() {
            progress.finish();
        }
        samples
    }
}

impl SpreadArgs {
    fn about(&self, job: &Job) -> Dispersions {
        let Self { wind, mass, noise, start } = *self;
        if [wind, mass, noise, start].iter().all(Option::is_none) {
            return Dispersions::usual(&job.scenario);
        }
        Dispersions {
            wind_mps: wind.unwrap_or(0.0),
            mass: mass.unwrap_or(0.0) / 100.0,
            noise_m: noise.unwrap_or(0.0),
            start_m: start.unwrap_or(0.0),
        }
    }
}

impl Shown {
    /// Writes what there is, prints it, and decides.
    pub fn finish(&self, sweep: &Sweep, samples: &[Sample], folder: &Path) -> Result<Exit, Error> {
        #[derive(Serialize)]
        struct Whole<'a> {
            #[serde(flatten)]
            sweep: &'a Sweep,
            statistics: &'a Statistics,
        }
        let statistics = Statistics::of(sweep, samples);
        table::write(sweep, samples, &folder.join("sweep.parquet"))?;
        output::write_json(&folder.join("sweep.json"), &Whole { sweep, statistics: &statistics })?;
        if !self.quiet {
            match samples.is_empty() {
                true => console::print("this partition has no samples; merge its table with the others'")?,
                false => console::print(&monte_carlo::text(sweep, &statistics))?,
            }
            console::print(&format!("results in {}", folder.display()))?;
        }
        if samples.is_empty() && sweep.samples > 0 {
            return Ok(Exit::Passed);
        }
        // Written so that a sweep of nothing has not passed.
        let share = 100.0 * statistics.passed as f64 / statistics.samples as f64;
        Ok(if share >= self.at_least { Exit::Passed } else { Exit::Failed })
    }
}

/// The worst sample as a scenario, and its number, or the removal of that of an earlier sweep.
fn write_worst(
    experiment: &Experiment<'_>,
    sweep: &Sweep,
    samples: &[Sample],
    folder: &Path,
) -> Result<Option<usize>, Error> {
    let folder = folder.join("worst");
    let path = folder.join(format!("{}.toml", experiment.scenario.name));
    let Some(number) = monte_carlo::worst(samples) else { return output::remove_stale(&path).map(|()| None) };
    output::create_folder(&folder)?;
    let (scenario, _) = experiment.scenario_of(&sweep.dispersions, number);
    output::replace_file(&path, |partial| {
        let text = format!("# Sample {number} of a sweep about {}.\n{}", scenario.name, toml::to_string(&scenario)?);
        Ok(std::fs::write(partial, text)?)
    })?;
    Ok(Some(number))
}

fn partition(text: &str) -> Result<Partition, String> {
    let numbers = text.split_once('/').and_then(|(part, parts)| Some((part.parse().ok()?, parts.parse().ok()?)));
    match numbers {
        Some((part, parts)) if 1 <= part && part <= parts => Ok(Partition { part, parts }),
        _ => Err("expected the part and the number of parts, from `1/4` to `4/4` for four machines".to_owned()),
    }
}

fn not_negative(text: &str) -> Result<f64, String> {
    let value = text.parse::<f64>().ok().filter(|value| value.is_finite() && *value >= 0.0);
    value.ok_or_else(|| "expected a number that is not negative".to_owned())
}

fn percent(text: &str) -> Result<f64, String> {
    not_negative(text).ok().filter(|value| *value <= 100.0).ok_or_else(|| "expected 0 to 100, in %".to_owned())
}

#[cfg(test)]
mod tests {
    use super::{Partition, partition, percent};

    #[test]
    fn parts_and_shares_are_read_and_nonsense_is_refused() {
        assert_eq!(partition("2/3"), Ok(Partition { part: 2, parts: 3 }));
        assert!(["0/3", "4/3", "2", "2/", "a/b", "-1/2", "1/0"].iter().all(|text| partition(text).is_err()));
        assert_eq!(percent("95"), Ok(95.0));
        assert!(["-1", "101", "NaN", "inf", "x"].iter().all(|text| percent(text).is_err()));
    }
}
