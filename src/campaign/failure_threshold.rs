//! How much of a disturbance does a plan bear? The disturbance at which the verdict turns, as a number.
//!
//! The plan stays (who plans in the loop plans anew); only what disturbs the flight grows. First in doubling steps until a
//! flight fails, then on a grid up to beyond that, because a response need not be monotone (a gust may push a vehicle away
//! from what it would have hit), then by bisection at the first failure.

mod axis;

use rayon::prelude::*;
use scenarios::Scenario;
use serde::Serialize;

use crate::campaign::system_under_test::SystemUnderTest;
use crate::verdict::Outcome;

pub use axis::Axis;

/// Levels of the grid, up to a quarter beyond the first failure.
const GRID: usize = 20;
const BEYOND: f64 = 1.25;
/// The bracket is closed to this share of its upper end.
const RESOLUTION: f64 = 0.005;
/// What rounding leaves of a bracket, as a share of it.
const ROUNDING: f64 = 1e-9;
/// Version of the form of the results.
const SCHEMA: u32 = 1;

/// What came of it.
#[derive(Clone, Debug, PartialEq, Serialize)]
pub struct Stress {
    /// Version of this form: 1.
    pub schema: u32,
    /// Name of the scenario.
    pub scenario: String,
    /// Name of the planner.
    pub planner: String,
    /// What grows.
    pub over: Axis,
    /// Unit of the levels.
    pub unit: &'static str,
    /// The level of the scenario itself.
    pub asked: f64,
    /// Every level that was flown, in growing order.
    pub trials: Vec<Trial>,
    /// Where the verdict first turns; absent if nothing failed, or everything did.
    pub turns: Option<Turn>,
    /// Did some level pass above one that failed?
    pub is_monotone: bool,
}

/// One flight.
#[derive(Clone, Debug, PartialEq, Serialize)]
pub struct Trial {
    /// How strong the disturbance was.
    pub level: f64,
    /// Did every deciding check pass?
    pub passed: bool,
    /// The checks that decided against it.
    pub red: Vec<String>,
}

/// Where the verdict turns.
#[derive(Clone, Debug, PartialEq, Serialize)]
pub struct Turn {
    /// The last level that passes, below which all that were tried do.
    pub passes: f64,
    /// The level above it that fails.
    pub fails: f64,
    /// By which checks it fails.
    pub red: Vec<String>,
}

/// Searches for the level of a disturbance at which a plan, or one who plans in the loop, fails.
///
/// - `seed`: of gusts and noise, the same at every level
/// - `progress`: is called before every round of flights, with the number of levels in it
pub fn run(
    scenario: &Scenario,
    contender: SystemUnderTest<'_>,
    over: Axis,
    seed: u64,
    progress: &mut dyn FnMut(usize),
) -> Stress {
    let fly = |level: f64| trial(scenario, contender, over, seed, level);
    progress(1);
    let mut trials = vec![fly(0.0)];
    let mut level = over.first_step(scenario);
    while trials.last().is_some_and(|trial| trial.passed) && level <= over.largest(scenario) {
        progress(1);
        trials.push(fly(level));
        level *= 2.0;
    }
    if trials.last().is_some_and(|trial| !trial.passed) && trials.len() > 1 {
        let end = BEYOND * trials.last().map_or(0.0, |trial| trial.level);
        progress(GRID);
        let levels: Vec<f64> = (1..=GRID).map(|i| end * i as f64 / GRID as f64).collect();
        trials.par_extend(levels.into_par_iter().map(fly));
        close_in(&mut trials, over.finest(scenario), &fly, progress);
    }
    sort(&mut trials);
    Stress {
        schema: SCHEMA,
        scenario: scenario.name.clone(),
        planner: contender.planner().to_owned(),
        over,
        unit: over.unit(),
        asked: over.level_of(scenario),
        turns: first_turn(&trials),
        is_monotone: is_monotone(&trials),
        trials,
    }
}

/// Halves the first bracket until it is narrow enough, or as narrow as levels differ.
fn close_in(trials: &mut Vec<Trial>, finest: f64, fly: &impl Fn(f64) -> Trial, progress: &mut dyn FnMut(usize)) {
    loop {
        sort(trials);
        let Some(turn) = first_turn(trials) else { return };
        let narrow = (RESOLUTION * turn.fails).max(finest) * (1.0 + ROUNDING);
        if turn.fails - turn.passes <= narrow {
            return;
        }
        progress(1);
        trials.push(fly(f64::midpoint(turn.passes, turn.fails)));
    }
}

fn trial(scenario: &Scenario, contender: SystemUnderTest<'_>, over: Axis, seed: u64, level: f64) -> Trial {
    let (mut disturbed, level) = (scenario.clone(), over.nearest(scenario, level));
    over.set(&mut disturbed, level);
    let verdict = contender.judged_in(&disturbed, seed);
    let decisive = verdict.checks.into_iter().filter(|check| check.is_bad() && !check.advisory);
    let red = decisive.map(|check| check.name).collect();
    Trial { level, passed: verdict.outcome == Outcome::Pass, red }
}

fn sort(trials: &mut Vec<Trial>) {
    trials.sort_by(|a, b| a.level.total_cmp(&b.level));
    trials.dedup_by(|a, b| a.level == b.level);
}

/// Between the first level that fails and the one below it.
fn first_turn(trials: &[Trial]) -> Option<Turn> {
    let pair = trials.windows(2).find(|pair| pair[0].passed && !pair[1].passed)?;
    Some(Turn { passes: pair[0].level, fails: pair[1].level, red: pair[1].red.clone() })
}

fn is_monotone(trials: &[Trial]) -> bool {
    trials.is_sorted_by_key(|trial| !trial.passed)
}

#[cfg(test)]
mod tests {
    use super::{Trial, close_in, first_turn, is_monotone, sort};

    fn trial(level: f64, passed: bool) -> Trial {
        Trial { level, passed, red: Vec::new() }
    }

    #[test]
    fn the_bracket_closes_in_on_the_first_failure() {
        // Fails from 6.4 to 7.0, passes again up to 8.0.
        let fly = |level: f64| trial(level, level < 6.4 || (7.0..8.0).contains(&level));
        let mut trials: Vec<Trial> = (0..=10).map(|level| fly(f64::from(level))).collect();
        trials.push(fly(6.7));
        close_in(&mut trials, 0.0, &fly, &mut |_| {});
        sort(&mut trials);
        let turn = first_turn(&trials).unwrap();
        assert!(turn.passes < 6.4 && 6.4 <= turn.fails && turn.fails - turn.passes <= 0.005 * turn.fails, "{turn:?}");
        assert!(!is_monotone(&trials));
    }

    #[test]
    fn levels_that_are_the_same_are_not_told_apart() {
        let fly = |level: f64| trial(level, (level / 0.01).round() < 7.0);
        let mut trials = vec![fly(0.04), fly(0.08)];
        close_in(&mut trials, 0.01, &fly, &mut |_| {});
        let turn = first_turn(&trials).unwrap();
        assert!(turn.fails - turn.passes < 0.01 + 1e-12 && trials.len() == 4, "{trials:?}");
    }

    #[test]
    fn a_response_that_never_or_always_fails_has_no_turn() {
        assert_eq!(first_turn(&[trial(0.0, true), trial(1.0, true)]), None);
        assert_eq!(first_turn(&[trial(0.0, false), trial(1.0, false)]), None);
        assert!(is_monotone(&[trial(0.0, true), trial(1.0, true), trial(2.0, false)]));
        assert!(!is_monotone(&[trial(0.0, false), trial(1.0, true)]));
    }
}
