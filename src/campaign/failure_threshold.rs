//! The smallest disturbance that makes a plan fail.
//!
//! The plan stays fixed (an in-loop planner plans anew in every flight) and one disturbance grows: in doubling steps until a
//! flight fails, then on a grid up to a quarter beyond that, because the response need not be monotone (a gust may push a
//! vehicle away from an obstacle), then by bisection at the first failure.

mod disturbance;

use rayon::prelude::*;
use scenarios::Scenario;
use serde::Serialize;

use crate::plan_source::PlanSource;
use crate::verdict::Outcome;

pub use disturbance::Disturbance;

/// Levels of the grid.
const GRID_LEVELS: usize = 20;
/// End of the grid, as a multiple of the first level that failed.
const GRID_END: f64 = 1.25;
/// Width to which the bracket is closed, relative to its upper end.
const BRACKET_WIDTH: f64 = 0.005;
/// Relative rounding error of a bracket.
const ROUNDING: f64 = 1e-9;
/// Version of the result format.
const SCHEMA: u32 = 1;

/// The result of a search.
#[derive(Clone, Debug, PartialEq, Serialize)]
pub struct FailureThreshold {
    /// Version of this format: 1.
    pub schema: u32,
    /// Name of the scenario.
    pub scenario: String,
    /// Name of the planner.
    pub planner: String,
    /// The disturbance that was varied.
    pub over: Disturbance,
    /// Unit of the levels.
    pub unit: &'static str,
    /// The level in the scenario.
    pub asked: f64,
    /// Every level that was flown, ascending.
    pub trials: Vec<Trial>,
    /// Where the verdict first turns; absent if nothing failed, or everything did.
    #[serde(rename = "turns")]
    pub bracket: Option<FailureBracket>,
    /// Whether no level above a failing one passes.
    pub is_monotone: bool,
}

/// One flight.
#[derive(Clone, Debug, PartialEq, Serialize)]
pub struct Trial {
    /// How strong the disturbance was.
    pub level: f64,
    /// Whether every deciding check passed.
    pub passed: bool,
    /// Names of the deciding checks that failed.
    #[serde(rename = "red")]
    pub failed_checks: Vec<String>,
}

/// The level that passes and the level above it that fails.
#[derive(Clone, Debug, PartialEq, Serialize)]
pub struct FailureBracket {
    /// The highest level below the first failure; every level tried below it passes.
    pub passes: f64,
    /// The level above it that fails.
    pub fails: f64,
    /// Names of the deciding checks that failed.
    #[serde(rename = "red")]
    pub failed_checks: Vec<String>,
}

/// Searches for the level of a disturbance at which a plan, or an in-loop planner, fails.
///
/// - `system`: the system under test: a plan, or an in-loop planner, which plans anew in every flight
/// - `seed`: of gusts and noise, the same at every level
/// - `progress`: is called before every round of flights, with the number of levels in it
pub fn run(
    scenario: &Scenario,
    system: &PlanSource,
    over: Disturbance,
    seed: u64,
    progress: &mut dyn FnMut(usize),
) -> FailureThreshold {
    let fly = |level: f64| trial(scenario, system, over, seed, level);
    progress(1);
    let mut trials = vec![fly(0.0)];
    let mut level = over.first_step(scenario);
    while trials.last().is_some_and(|trial| trial.passed) && level <= over.max_level(scenario) {
        progress(1);
        trials.push(fly(level));
        level *= 2.0;
    }
    if trials.last().is_some_and(|trial| !trial.passed) && trials.len() > 1 {
        let end = GRID_END * trials.last().map_or(0.0, |trial| trial.level);
        progress(GRID_LEVELS);
        let levels: Vec<f64> = (1..=GRID_LEVELS).map(|i| end * i as f64 / GRID_LEVELS as f64).collect();
        trials.par_extend(levels.into_par_iter().map(fly));
        bisect(&mut trials, over.level_step(scenario), &fly, progress);
    }
    sort(&mut trials);
    FailureThreshold {
        schema: SCHEMA,
        scenario: scenario.name.clone(),
        planner: system.name().to_owned(),
        over,
        unit: over.unit(),
        asked: over.level_of(scenario),
        bracket: first_bracket(&trials),
        is_monotone: is_monotone(&trials),
        trials,
    }
}

/// Bisects the first bracket until it is narrow enough.
///
/// - `finest`: smallest difference between two levels
fn bisect(trials: &mut Vec<Trial>, finest: f64, fly: &impl Fn(f64) -> Trial, progress: &mut dyn FnMut(usize)) {
    loop {
        sort(trials);
        let Some(bracket) = first_bracket(trials) else { return };
        let narrow = (BRACKET_WIDTH * bracket.fails).max(finest) * (1.0 + ROUNDING);
        if bracket.fails - bracket.passes <= narrow {
            return;
        }
        progress(1);
        trials.push(fly(f64::midpoint(bracket.passes, bracket.fails)));
    }
}

fn trial(scenario: &Scenario, system: &PlanSource, over: Disturbance, seed: u64, level: f64) -> Trial {
    let (mut disturbed, level) = (scenario.clone(), over.round_level(scenario, level));
    over.set(&mut disturbed, level);
    let verdict = system.fly(&disturbed, seed).judge(&disturbed);
    Trial { level, passed: verdict.outcome == Outcome::Pass, failed_checks: verdict.failed_checks() }
}

fn sort(trials: &mut Vec<Trial>) {
    trials.sort_by(|a, b| a.level.total_cmp(&b.level));
    trials.dedup_by(|a, b| a.level == b.level);
}

/// The first level that fails and the one below it.
fn first_bracket(trials: &[Trial]) -> Option<FailureBracket> {
    let pair = trials.windows(2).find(|pair| pair[0].passed && !pair[1].passed)?;
    Some(FailureBracket { passes: pair[0].level, fails: pair[1].level, failed_checks: pair[1].failed_checks.clone() })
}

fn is_monotone(trials: &[Trial]) -> bool {
    trials.is_sorted_by_key(|trial| !trial.passed)
}

#[cfg(test)]
mod tests {
    use super::{Trial, bisect, first_bracket, is_monotone, sort};

    fn trial(level: f64, passed: bool) -> Trial {
        Trial { level, passed, failed_checks: Vec::new() }
    }

    #[test]
    fn the_bracket_closes_in_on_the_first_failure() {
        // Fails from 6.4 to 7.0, passes again up to 8.0.
        let fly = |level: f64| trial(level, level < 6.4 || (7.0..8.0).contains(&level));
        let mut trials: Vec<Trial> = (0..=10).map(|level| fly(f64::from(level))).collect();
        trials.push(fly(6.7));
        bisect(&mut trials, 0.0, &fly, &mut |_| {});
        sort(&mut trials);
        let bracket = first_bracket(&trials).unwrap();
        assert!(
            bracket.passes < 6.4 && 6.4 <= bracket.fails && bracket.fails - bracket.passes <= 0.005 * bracket.fails,
            "{bracket:?}"
        );
        assert!(!is_monotone(&trials));
    }

    #[test]
    fn levels_closer_than_the_finest_difference_are_one() {
        let fly = |level: f64| trial(level, (level / 0.01).round() < 7.0);
        let mut trials = vec![fly(0.04), fly(0.08)];
        bisect(&mut trials, 0.01, &fly, &mut |_| {});
        let bracket = first_bracket(&trials).unwrap();
        assert!(bracket.fails - bracket.passes < 0.01 + 1e-12 && trials.len() == 4, "{trials:?}");
    }

    #[test]
    fn a_response_that_never_or_always_fails_has_no_bracket() {
        assert_eq!(first_bracket(&[trial(0.0, true), trial(1.0, true)]), None);
        assert_eq!(first_bracket(&[trial(0.0, false), trial(1.0, false)]), None);
        assert!(is_monotone(&[trial(0.0, true), trial(1.0, true), trial(2.0, false)]));
        assert!(!is_monotone(&[trial(0.0, false), trial(1.0, true)]));
    }
}
