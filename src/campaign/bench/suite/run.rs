//! The runs of a suite, several at a time, and their rows.

use std::path::PathBuf;
use std::sync::Mutex;
use std::sync::atomic::{AtomicUsize, Ordering};

use rayon::prelude::*;
use scenarios::Scenario;

use super::entry::{self, Entry, Outcome};
use super::lower_bound::lower_bound_s;
use super::{Failure, Plan, Row, RunOutcome};
use crate::campaign::generate::{GenerateError, Generated, Request};
use crate::error::Error;
use crate::output;
use crate::report::Report;
use crate::statistics::quantile_index;
use crate::verdict::Check;

/// A scenario and a planner.
pub struct Run {
    request: Request,
    generated: Generated,
    scenario: Scenario,
    planner: String,
}

/// What a run measured.
pub struct Measured {
    outcome: RunOutcome,
    reason: String,
    planning_s: Option<f64>,
    over_lower_bound: Option<f64>,
}

/// All runs, those of a row one after the other, and the commands that generate nothing since nothing feasible was found.
pub fn list(plan: &Plan) -> Result<(Vec<Run>, Vec<String>), Error> {
    let (mut runs, mut infeasible) = (Vec::new(), Vec::new());
    for case in &plan.cases {
        let seeds: Vec<u64> = (0..plan.seeds).map(|index| plan.first_seed + index).collect();
        let results = seeds.into_par_iter().map(|seed| Request { seed, ..*case }).map(|it| (it, it.generate()));
        let mut generated: Vec<(Request, Generated)> = Vec::new();
        for (request, result) in results.collect::<Vec<_>>() {
            match result {
                Ok(scenario) => generated.push((request, scenario)),
                Err(GenerateError::NoRoom { .. }) => infeasible.push(request.command()),
                Err(error) => return Err(error.into()),
            }
        }
        runs.extend(paired(plan, &generated));
    }
    Ok((runs, infeasible))
}

/// The scenarios of a case, with one planner after the other.
fn paired(plan: &Plan, generated: &[(Request, Generated)]) -> Vec<Run> {
    let planners = generated.first().map_or_else(Vec::new, |(_, first)| planners(plan, &first.scenario()));
    let with = |planner: String| {
        generated.iter().map(move |(request, generated)| Run {
            request: *request,
            generated: generated.clone(),
            scenario: generated.scenario(),
            planner: planner.clone(),
        })
    };
    planners.into_iter().flat_map(with).collect()
}

/// The planners of the plan that support the scenarios like `example`.
fn planners(plan: &Plan, example: &Scenario) -> Vec<String> {
    if plan.planners.is_empty() {
        return vec![example.planner.name.clone()];
    }
    let supports =
        |name: &&String| planners::find(name).is_some_and(|planner| (planner.unsupported_reason)(example).is_none());
    plan.planners.iter().filter(supports).cloned().collect()
}

/// Whether two runs differ only in their seeds.
pub fn same_row(a: &Run, b: &Run) -> bool {
    a.planner == b.planner && Request { seed: 0, ..a.request }.name() == Request { seed: 0, ..b.request }.name()
}

/// Runs all, in the order of the list as far as `plan.jobs` at a time allow, and keeps the scenarios that were not passed.
pub fn all(plan: &Plan, runs: &[Run], progress: &mut (dyn FnMut(&str) + Send)) -> Result<Vec<Measured>, Error> {
    let next = AtomicUsize::new(0);
    let progress = Mutex::new(progress);
    let work = || -> Result<Vec<(usize, Measured)>, Error> {
        let mut measured = Vec::new();
        while let Some((index, run)) = take(&next, runs) {
            let result = measure(plan, run)?;
            let line = format!(
                "[{}/{}] {} · {}: {}",
                index + 1,
                runs.len(),
                run.generated.name,
                run.planner,
                result.outcome.name()
            );
            progress.lock().expect("no thread panics while it reports")(&line);
            measured.push((index, result));
        }
        Ok(measured)
    };
    let mut measured: Vec<(usize, Measured)> = std::thread::scope(|scope| {
        let workers: Vec<_> = (0..plan.jobs.max(1)).map(|_| scope.spawn(work)).collect();
        let joined = workers.into_iter().map(|worker| worker.join().expect("a worker does not panic"));
        joined.collect::<Result<Vec<_>, Error>>()
    })?
    .into_iter()
    .flatten()
    .collect();
    measured.sort_by_key(|(index, _)| *index);
    Ok(measured.into_iter().map(|(_, measured)| measured).collect())
}

fn take<'a>(next: &AtomicUsize, runs: &'a [Run]) -> Option<(usize, &'a Run)> {
    let index = next.fetch_add(1, Ordering::Relaxed);
    runs.get(index).map(|run| (index, run))
}

fn measure(plan: &Plan, run: &Run) -> Result<Measured, Error> {
    let measured = match entry::run(&run.scenario, &run.planner, plan.limit_s) {
        Ok(entry) => Measured::of(run, entry),
        Err(Error::Bench { what, reason }) => Measured {
            outcome: RunOutcome::Fail,
            reason: format!("cannot {what}: {reason}"),
            planning_s: None,
            over_lower_bound: None,
        },
        Err(error) => return Err(error),
    };
    if measured.outcome != RunOutcome::Pass {
        output::create_folder(&plan.folder)?;
        output::write_file(&file(plan, run), |writer| writer.write_all(run.generated.text.as_bytes()))?;
    }
    Ok(measured)
}

fn file(plan: &Plan, run: &Run) -> PathBuf {
    plan.folder.join(format!("{}.toml", run.generated.name))
}

impl Measured {
    fn of(run: &Run, Entry { outcome, report }: Entry) -> Self {
        let outcome = match (outcome, report.as_ref().is_some_and(|report| report.overclaimed)) {
            (Outcome::Fail, true) => RunOutcome::Overclaimed,
            (Outcome::Fail, false) => RunOutcome::Fail,
            (Outcome::Pass, _) => RunOutcome::Pass,
            (Outcome::NoPlan, _) => RunOutcome::NoPlan,
            (Outcome::TimedOut, _) => RunOutcome::TimedOut,
        };
        let flight_time_s =
            report.as_ref().filter(|_| outcome == RunOutcome::Pass).and_then(|it| it.plan.flight_time_s);
        Self {
            outcome,
            reason: report.as_ref().map_or_else(|| "the time limit was reached".to_owned(), reason),
            planning_s: report.map(|report| report.timings.planning_s),
            over_lower_bound: flight_time_s.zip(lower_bound_s(&run.scenario)).map(|(time_s, bound_s)| time_s / bound_s),
        }
    }
}

/// The failed checks, or why there is no plan.
fn reason(report: &Report) -> String {
    let failed: Vec<&str> =
        report.checks.iter().filter(|check| Check::is_bad(check)).map(|check| check.name.as_ref()).collect();
    match (&report.plan.reason, failed.is_empty() || report.verdict == crate::verdict::Outcome::NoPlan) {
        (Some(reason), true) => reason.clone(),
        _ => failed.join(", "),
    }
}

/// The row of runs that differ only in their seeds.
pub fn row(runs: &[Run], measured: &[Measured]) -> Row {
    let request = &runs[0].request;
    let count = |outcome: RunOutcome| measured.iter().filter(|it| it.outcome == outcome).count();
    Row {
        family: request.kind.family,
        kind: request.kind.name,
        variant: request.variant().map(|variant| variant.name()),
        size: request.size,
        density: request.density,
        planner: runs[0].planner.clone(),
        runs: runs.len(),
        pass: count(RunOutcome::Pass),
        no_plan: count(RunOutcome::NoPlan),
        fail: count(RunOutcome::Fail),
        overclaimed: count(RunOutcome::Overclaimed),
        timed_out: count(RunOutcome::TimedOut),
        planning_s: quantiles(measured.iter().filter_map(|it| it.planning_s), [0.5, 0.9, 1.0]),
        over_lower_bound: quantiles(measured.iter().filter_map(|it| it.over_lower_bound), [0.5, 1.0]),
    }
}

/// A run that did not pass.
pub fn failure(plan: &Plan, run: &Run, measured: &Measured) -> Option<Failure> {
    (measured.outcome != RunOutcome::Pass).then(|| Failure {
        scenario: run.generated.name.clone(),
        planner: run.planner.clone(),
        outcome: measured.outcome,
        reason: measured.reason.clone(),
        generate: run.request.command(),
        file: file(plan, run),
    })
}

/// Quantiles at these fractions.
fn quantiles<const N: usize>(values: impl Iterator<Item = f64>, fractions: [f64; N]) -> Option<[f64; N]> {
    let mut values: Vec<f64> = values.collect();
    values.sort_by(f64::total_cmp);
    let at = |fraction: f64| quantile_index(values.len(), fraction).map(|index| values[index]);
    let quantiles: Vec<f64> = fractions.into_iter().map_while(at).collect();
    quantiles.try_into().ok()
}

#[cfg(test)]
mod tests {
    use super::quantiles;

    #[test]
    fn quantiles_are_values_of_the_sample() {
        let values = || (1..=20).rev().map(f64::from);
        assert_eq!(quantiles(values(), [0.5, 0.9, 1.0]), Some([10.0, 18.0, 20.0]));
        assert_eq!(quantiles([3.0].into_iter(), [0.5, 0.9, 1.0]), Some([3.0; 3]));
        assert_eq!(quantiles(std::iter::empty(), [0.5]), None);
    }
}
