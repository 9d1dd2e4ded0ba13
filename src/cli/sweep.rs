use std::collections::BTreeSet;
use std::path::{Path, PathBuf};
use std::sync::Mutex;

use clap::Args;
use serde::Serialize;

use super::plan::has_no_plan;
use super::run::{ClockArgs, PlannerArgs};
use super::session::start_threads;
use crate::campaign::failure_threshold::Disturbance;
use crate::campaign::monte_carlo::resume::{self, Checkpoint};
use crate::campaign::monte_carlo::{self, Dispersions, Experiment, Partition, Sample, Statistics, Sweep, table};
use crate::console;
use crate::error::{Error, Exit};
use crate::jobs::{self, Job};
use crate::output;
use crate::output::page;
use crate::pipeline;
use crate::plan_source::PlanSource;
use crate::progress::Progress;

/// Fly one plan many times under random perturbations (Monte Carlo)
///
/// The scenario is planned once, and the plan is flown in randomly perturbed worlds; in-loop planners plan anew in every
/// flight. Without any of --wind, --mass, --noise and --start, all four are perturbed by typical amounts (wind only if the
/// vehicles have drag); with some of them, the others stay as in the scenario. Every sample has its own seed, and gives the same flight on any machine. The exit
/// code is 1 if fewer samples pass than --at-least demands.
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
    dispersions: DispersionArgs,
    /// Fly only the K-th of N partitions, to distribute the samples over N machines; see `harness merge`
    #[arg(long, value_name = "K/N", value_parser = partition)]
    partition: Option<Partition>,
    /// Keep the samples that DIR holds of the same sweep, killed or with fewer samples, and fly the others. What flies must be
    /// the same: scenario, plan, options, and the program itself
    #[arg(long)]
    resume: bool,
    #[command(flatten)]
    planners: PlannerArgs,
    #[command(flatten)]
    clock: ClockArgs,
    /// Seed of the first sample, in place of the scenario's; it grows by one from sample to sample
    #[arg(long, value_name = "N")]
    seed: Option<u64>,
    /// Folder for the results
    #[arg(short, long, value_name = "DIR", default_value = "out")]
    out: PathBuf,
    #[command(flatten)]
    results: ResultArgs,
    /// Number of worker threads [default: one per core]; results do not depend on it
    #[arg(short, long, value_name = "N", value_parser = clap::value_parser!(u16).range(1..))]
    jobs: Option<u16>,
}

/// Magnitudes of the perturbations.
#[derive(Args, Debug)]
struct DispersionArgs {
    /// Largest speed of a random mean wind that is added to the scenario's, in any horizontal direction, m/s
    #[arg(long, value_name = "M/S", value_parser = not_negative)]
    wind: Option<f64>,
    /// Largest deviation of the true masses, to either side, %
    #[arg(long, value_name = "%", value_parser = percent)]
    mass: Option<f64>,
    /// Largest standard deviation of the measured position, m; other sensor noise grows with it
    #[arg(long, value_name = "M", value_parser = not_negative)]
    noise: Option<f64>,
    /// Largest horizontal distance of a vehicle from its start, m
    #[arg(long, value_name = "M", value_parser = not_negative)]
    start: Option<f64>,
}

/// The required pass rate, and what is printed.
#[derive(Args, Debug)]
pub struct ResultArgs {
    /// Required pass rate, %
    #[arg(long, value_name = "%", default_value = "100", value_parser = percent)]
    at_least: f64,
    /// Write the report page DIR/index.html, with histograms of the margins; `harness report` does so afterwards
    #[arg(long)]
    pub html: bool,
    /// Print errors only
    #[arg(short, long)]
    pub quiet: bool,
}

const EXAMPLES: &str = "\
Examples:
  harness sweep scenarios/fixed-wing/rendezvous-7.toml --samples 200
  harness sweep scenarios/slung/rectangle-wind.toml -n 500 --wind 2 --mass 5 --at-least 95
  harness sweep scenarios/multirotor/forest.toml -n 1000 --partition 1/4 -o out/1
                                                     the part of the first of four machines
  harness sweep scenarios/multirotor/forest.toml -n 5000 --resume
                                                     4000 more, or the rest of a killed sweep
  harness merge out/*/forest/rhc/sweep.parquet -o out/forest

Results, in out/<scenario>/<planner>/:
  sweep.parquet          one row per sample: perturbation, verdict, the margin of every check
  sweep.json             the pass rate with its 95 % confidence interval, quantiles of the margins
  worst/<scenario>.toml  the scenario of the sample with the most failed checks
  plan.json              the plan

`harness check worst/<scenario>.toml --plan plan.json` repeats and records the worst sample; for an
in-loop planner, `harness run worst/<scenario>.toml` does.";

impl SweepCommand {
    /// Plans, flies, writes and prints.
    pub fn execute(&self) -> Result<Exit, Error> {
        start_threads(self.jobs)?;
        let plan_sources = self.planners.sources()?;
        let job = &self.clock.applied_to(jobs::load_one(&self.scenario, &plan_sources, self.seed)?);
        if let Some(issue) = self
            .dispersions
            .wind
            .filter(|wind_mps| *wind_mps > 0.0)
            .and_then(|_| Disturbance::Wind.without_effect(&job.scenario))
        {
            return Err(Error::NoEffect { file: self.scenario.clone(), option: "--wind", issue: Box::new(issue) });
        }
        let mut progress = Progress::new(job, 1, 1, self.results.quiet);
        let system = &pipeline::plan_once(job, &mut progress);
        if has_no_plan(system) {
            progress.finish();
            return Ok(Exit::Failed);
        }
        let experiment = Experiment { scenario: &job.scenario, system };
        let sweep = Sweep::new(&experiment, self.samples as usize, self.dispersions.about(job));
        let folder = self.out.join(&job.scenario.name).join(job.plan_source.name());
        let known = self.known(&folder, &sweep)?;
        output::create_folder(&folder)?;
        let samples = self.fly(&experiment, &sweep, &folder, known, progress)?;
        if let PlanSource::Imported(answer) = system {
            output::write_file(&folder.join("plan.json"), |writer| answer.plan.write_json(writer))?;
        }
        let worst = write_worst(&experiment, &sweep, &samples, &folder)?;
        let exit = self.results.finish(&sweep, &samples, &folder, &self.out)?;
        resume::remove_checkpoint(&folder)?;
        if let Some(number) = worst.filter(|_| !self.results.quiet) {
            console::print(&format!("sample {number} failed the most checks; its scenario is in worst/"))?;
        }
        Ok(exit)
    }

    /// The samples of the partition that the folder holds; without `--resume` none.
    fn known(&self, folder: &Path, sweep: &Sweep) -> Result<Vec<Sample>, Error> {
        if !self.resume {
            resume::remove_checkpoint(folder)?;
            return Ok(Vec::new());
        }
        let partition = self.partition.unwrap_or(Partition::WHOLE);
        let mut known = resume::known_samples(folder, sweep)?;
        known.retain(|sample| sample.number < sweep.samples && partition.holds(sample.number));
        if !self.results.quiet {
            let total = partition.numbers(sweep.samples).count();
            console::eprint(&format!("{} of {total} samples are there", known.len()));
        }
        Ok(known)
    }

    fn fly(
        &self,
        experiment: &Experiment<'_>,
        sweep: &Sweep,
        folder: &Path,
        known: Vec<Sample>,
        progress: Progress,
    ) -> Result<Vec<Sample>, Error> {
        let flown: BTreeSet<usize> = known.iter().map(|sample| sample.number).collect();
        let partition = self.partition.unwrap_or(Partition::WHOLE);
        let missing: Vec<usize> = partition.numbers(sweep.samples).filter(|number| !flown.contains(number)).collect();
        let checkpoint = Checkpoint::new(sweep, folder, known);
        let progress = Mutex::new((progress, 0));
        monte_carlo::run(experiment, sweep, &missing, &|sample| {
            checkpoint.add(sample);
            if let Ok(mut progress) = progress.lock() {
                progress.1 += 1;
                let done = progress.1;
                progress.0.swept(done, missing.len());
            }
        });
        if let Ok((progress, _)) = progress.into_inner() {
            progress.finish();
        }
        checkpoint.finish()
    }
}

impl DispersionArgs {
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

impl ResultArgs {
    /// Writes and prints the results. An empty partition passes.
    ///
    /// - `out`: the result folder, in which `folder` lies
    pub fn finish(&self, sweep: &Sweep, samples: &[Sample], folder: &Path, out: &Path) -> Result<Exit, Error> {
        #[derive(Serialize)]
        struct SweepJson<'a> {
            #[serde(flatten)]
            sweep: &'a Sweep,
            statistics: &'a Statistics,
        }
        let statistics = Statistics::of(sweep, samples);
        table::write(sweep, samples, &folder.join(resume::TABLE))?;
        output::write_json(&folder.join("sweep.json"), &SweepJson { sweep, statistics: &statistics })?;
        if self.html {
            page::write(out)?;
        }
        if !self.quiet {
            match samples {
                [] => console::print("this partition has no samples; `harness merge` takes its table all the same")?,
                _ => console::print(&monte_carlo::text(sweep, &statistics))?,
            }
            console::print(&format!("results in {}", folder.display()))?;
        }
        let has_passed = match samples {
            [] => true,
            _ => 100.0 * statistics.passed as f64 / statistics.samples as f64 >= self.at_least,
        };
        Ok(if has_passed { Exit::Passed } else { Exit::Failed })
    }
}

/// Writes the scenario of the worst sample and returns its number; if all passed, removes that of an earlier sweep.
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
        let text = format!("# Sample {number} of a sweep of {}.\n{}", scenario.name, toml::to_string(&scenario)?);
        Ok(std::fs::write(partial, text)?)
    })?;
    Ok(Some(number))
}

fn partition(text: &str) -> Result<Partition, String> {
    let numbers = text.split_once('/').and_then(|(part, parts)| Some((part.parse().ok()?, parts.parse().ok()?)));
    match numbers {
        Some((part, parts)) if 1 <= part && part <= parts => Ok(Partition { part, parts }),
        _ => Err(
            "expected the number of the partition and the number of partitions, from `1/4` to `4/4` for four machines"
                .to_owned(),
        ),
    }
}

fn not_negative(text: &str) -> Result<f64, String> {
    let value = text.parse::<f64>().ok().filter(|value| value.is_finite() && *value >= 0.0);
    value.ok_or_else(|| "expected a number >= 0".to_owned())
}

fn percent(text: &str) -> Result<f64, String> {
    not_negative(text)
        .ok()
        .filter(|value| *value <= 100.0)
        .ok_or_else(|| "expected a percentage from 0 to 100".to_owned())
}

#[cfg(test)]
mod tests {
    use super::{Partition, partition, percent};

    #[test]
    fn partitions_and_percentages_are_parsed_and_invalid_ones_rejected() {
        assert_eq!(partition("2/3"), Ok(Partition { part: 2, parts: 3 }));
        assert!(["0/3", "4/3", "2", "2/", "a/b", "-1/2", "1/0"].iter().all(|text| partition(text).is_err()));
        assert_eq!(percent("95"), Ok(95.0));
        assert!(["-1", "101", "NaN", "inf", "x"].iter().all(|text| percent(text).is_err()));
    }
}
