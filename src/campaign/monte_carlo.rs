//! Monte Carlo: the same plan flown again and again, in a world that is drawn anew each time.
//!
//! A sample is a number. Everything that is drawn for it comes from streams of that number, so that many machines can
//! share the samples among them, and any one of them can be flown again alone.

mod draw;
mod merge;
mod show;
mod statistics;
pub mod table;

use rayon::prelude::*;
use scenarios::{Plan, PlanStatus, Scenario};
use serde::{Deserialize, Serialize};

use crate::campaign::system_under_test::SystemUnderTest;
use crate::verdict::{self, Outcome, Verdict};

pub use draw::{Draw, Spread};
pub use merge::merge;
pub use show::text;
pub use statistics::{CheckStatistics, Statistics, worst};

/// Which of the samples are flown: those whose number leaves the rest `part - 1` when divided by `parts`.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Partition {
    /// From 1.
    pub part: usize,
    /// How many there are.
    pub parts: usize,
}

impl Partition {
    /// All of them.
    pub const WHOLE: Self = Self { part: 1, parts: 1 };

    /// The numbers of its samples out of `samples`, counted from 0.
    pub fn numbers(self, samples: usize) -> impl Iterator<Item = usize> {
        (self.part - 1..samples).step_by(self.parts)
    }
}

/// What makes samples comparable: those of one sweep agree in all of it.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
pub struct Sweep {
    /// Version of this form: 1.
    pub schema: u32,
    /// Version of the harness that flew.
    pub version: String,
    /// Name of the scenario.
    pub scenario: String,
    /// Name of the planner.
    pub planner: String,
    /// Seed of the first sample; of each next one it is one more.
    pub seed: u64,
    /// Number of samples, all partitions together.
    pub samples: usize,
    /// What is drawn.
    pub spread: Spread,
    /// What can be asked of a flight, with the units of the margins, in the order of the table's columns.
    pub checks: Vec<(String, String)>,
}

/// One flight.
#[derive(Clone, Debug, PartialEq)]
pub struct Sample {
    /// Its number, from 0.
    pub number: usize,
    /// What was drawn for it.
    pub draw: Draw,
    /// The verdict in one word.
    pub verdict: Outcome,
    /// Names of the checks that decided against it.
    pub red: Vec<String>,
    /// The margin of every check of the flight; NaN where it has none, or one in another unit (of several quantities that
    /// a check holds against their limits now one is worst, now another).
    pub margins: Vec<f64>,
}

/// Version of the form of the results.
const SCHEMA: u32 = 1;

impl Sweep {
    /// So many samples about the question's scenario.
    pub fn new(question: &Question<'_>, samples: usize, spread: Spread) -> Self {
        let Question { scenario, contender } = question;
        let verdict = verdict::judge(scenario, &unanswered(scenario), None);
        let of_flight = verdict.checks.into_iter().filter(|check| check.name.starts_with("flight."));
        Self {
            schema: SCHEMA,
            version: env!("CARGO_PKG_VERSION").to_owned(),
            scenario: scenario.name.clone(),
            planner: contender.planner().to_owned(),
            seed: scenario.simulation.seed,
            samples,
            spread,
            checks: of_flight.map(|check| (check.name, check.unit)).collect(),
        }
    }
}

/// No plan at all: every check that there is says so.
fn unanswered(scenario: &Scenario) -> Plan {
    Plan { status: PlanStatus::NoPlan, ..Plan::new(&scenario.name, "", 0, Vec::new()) }
}

/// Who is flown, and where.
pub struct Question<'a> {
    /// The scenario around which is drawn.
    pub scenario: &'a Scenario,
    /// Who is flown in every sample.
    pub contender: SystemUnderTest<'a>,
}

impl Question<'_> {
    /// The scenario of one sample: as a file of its own it would give the same flight.
    pub fn scenario_of(&self, spread: &Spread, number: usize) -> (Scenario, Draw) {
        let mut scenario = self.scenario.clone();
        let seed = scenario.simulation.seed.wrapping_add(number as u64);
        scenario.simulation.seed = seed;
        let draw = spread.draw(seed);
        draw.apply(&mut scenario);
        (scenario, draw)
    }
}

/// Flies a partition of the samples, on all threads, and returns them in the order of their numbers.
///
/// - `flown`: is called after every flight, from any thread
pub fn run(question: &Question<'_>, sweep: &Sweep, partition: Partition, flown: &(dyn Fn() + Sync)) -> Vec<Sample> {
    let numbers: Vec<usize> = partition.numbers(sweep.samples).collect();
    let sample = |number: usize| {
        let (scenario, draw) = question.scenario_of(&sweep.spread, number);
        let verdict = question.contender.judged_in(&scenario, scenario.simulation.seed);
        flown();
        Sample::of(number, draw, &verdict, &sweep.checks)
    };
    numbers.into_par_iter().map(sample).collect()
}

impl Sample {
    fn of(number: usize, draw: Draw, verdict: &Verdict, asked: &[(String, String)]) -> Self {
        let decisive = verdict.checks.iter().filter(|check| check.is_bad() && !check.advisory);
        let margin = |(name, unit): &(String, String)| {
            let check = verdict.checks.iter().find(|check| check.name == *name && check.unit == *unit);
            check.and_then(|check| check.margin).unwrap_or(f64::NAN)
        };
        Self {
            number,
            draw,
            verdict: verdict.outcome,
            red: decisive.map(|check| check.name.clone()).collect(),
            margins: asked.iter().map(margin).collect(),
        }
    }
}

#[cfg(test)]
mod tests {
    use super::Partition;

    #[test]
    fn partitions_hold_every_sample_once() {
        let mut all: Vec<usize> = (1..=3).flat_map(|part| Partition { part, parts: 3 }.numbers(10)).collect();
        all.sort_unstable();
        assert_eq!(all, (0..10).collect::<Vec<_>>());
        assert_eq!(Partition::WHOLE.numbers(4).collect::<Vec<_>>(), [0, 1, 2, 3]);
        assert_eq!(Partition { part: 7, parts: 7 }.numbers(3).count(), 0);
    }
}
