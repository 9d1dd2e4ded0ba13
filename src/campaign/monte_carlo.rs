//! Monte Carlo: one plan flown many times, each time in a randomly perturbed world.
//!
//! A sample is identified by its number. All its random streams are derived from that number, so that machines can share the
//! samples among them, and any single sample can be flown again.

mod merge;
mod perturbation;
pub mod resume;
mod show;
mod statistics;
pub mod table;

use rayon::prelude::*;
use scenarios::requirement::Requirement;
use scenarios::{Group, Scenario, checks_of};
use serde::{Deserialize, Serialize};

use crate::campaign::trial::has_several_quantities;
use crate::plan_source::PlanSource;
use crate::verdict::{Outcome, Verdict};

pub use merge::merge;
pub use perturbation::{Dispersions, Perturbation};
pub use show::text;
pub use statistics::{CheckStatistics, Statistics, worst};

/// The samples of one machine: those whose number is `part - 1` modulo `parts`.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Partition {
    /// From 1.
    pub part: usize,
    /// Number of partitions.
    pub parts: usize,
}

impl Partition {
    /// All samples.
    pub const WHOLE: Self = Self { part: 1, parts: 1 };

    /// Whether a sample belongs to it.
    pub fn holds(self, number: usize) -> bool {
        number % self.parts == self.part - 1
    }

    /// The numbers of its samples out of `samples`, counted from 0.
    pub fn numbers(self, samples: usize) -> impl Iterator<Item = usize> {
        (self.part - 1..samples).step_by(self.parts)
    }
}

/// What all samples of one sweep have in common.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
pub struct Sweep {
    /// Version of this format: 1.
    pub schema: u32,
    /// Version of the harness that flew.
    pub version: String,
    /// Name of the scenario.
    pub scenario: String,
    /// Name of the planner.
    pub planner: String,
    /// Seed of sample 0; each further sample adds one.
    pub seed: u64,
    /// Number of samples, all partitions together.
    pub samples: usize,
    /// Fingerprint of scenario and plan, in hexadecimal digits.
    #[serde(default)]
    pub fingerprint: String,
    /// What is perturbed, and by how much.
    #[serde(rename = "spread")]
    pub dispersions: Dispersions,
    /// Names of the checks of a flight and units of their margins, in the order of the table's columns.
    pub checks: Vec<(String, String)>,
}

/// One flight.
#[derive(Clone, Debug, PartialEq)]
pub struct Sample {
    /// Its number, from 0.
    pub number: usize,
    /// Its perturbation.
    pub perturbation: Perturbation,
    /// The verdict in one word.
    pub verdict: Outcome,
    /// Names of the deciding checks that failed.
    pub failed_checks: Vec<String>,
    /// The margin of every check of the flight; NaN where it has none.
    pub margins: Vec<f64>,
    /// The unit of every margin: of a check of several quantities, that of the decisive one.
    pub units: Vec<String>,
}

/// Version of the result format.
const SCHEMA: u32 = 1;

impl Sweep {
    /// A sweep of `samples` flights about the scenario of an experiment.
    pub fn new(experiment: &Experiment<'_>, samples: usize, dispersions: Dispersions) -> Self {
        let Experiment { scenario, system } = experiment;
        let of_flight = checks_of(scenario.family()).filter(|check| check.group == Group::Flight);
        let requirements = scenario.all_requirements();
        let of_requirements = requirements.iter().flat_map(Requirement::check_names);
        let of_requirements = of_requirements.filter(|name| name.starts_with("flight."));
        Self {
            schema: SCHEMA,
            version: env!("CARGO_PKG_VERSION").to_owned(),
            scenario: scenario.name.clone(),
            planner: system.name().to_owned(),
            seed: scenario.simulation.seed,
            samples,
            fingerprint: resume::fingerprint(experiment),
            dispersions,
            checks: of_flight
                .map(|check| (check.name.to_owned(), check.unit.to_owned()))
                .chain(of_requirements.map(|name| (name, "-".to_owned())))
                .collect(),
        }
    }
}

/// The system under test and the scenario to perturb.
pub struct Experiment<'a> {
    /// The unperturbed scenario.
    pub scenario: &'a Scenario,
    /// What is flown in every sample: a plan, or an in-loop planner, which plans anew in every flight.
    pub system: &'a PlanSource,
}

impl Experiment<'_> {
    /// The scenario of one sample. Run as a file of its own, it gives the same flight.
    pub fn scenario_of(&self, dispersions: &Dispersions, number: usize) -> (Scenario, Perturbation) {
        let mut scenario = self.scenario.clone();
        let seed = scenario.simulation.seed.wrapping_add(number as u64);
        scenario.simulation.seed = seed;
        let perturbation = dispersions.draw(seed);
        perturbation.apply(&mut scenario);
        (scenario, perturbation)
    }
}

/// Flies the samples of these numbers, on all threads.
///
/// - `flown`: receives every sample after its flight, from any thread, in any order
pub fn run(experiment: &Experiment<'_>, sweep: &Sweep, numbers: &[usize], flown: &(dyn Fn(Sample) + Sync)) {
    numbers.par_iter().for_each(|&number| {
        let (scenario, perturbation) = experiment.scenario_of(&sweep.dispersions, number);
        let verdict = experiment.system.fly(&scenario, scenario.simulation.seed).judge(&scenario);
        flown(Sample::of(number, perturbation, &verdict, &sweep.checks));
    });
}

impl Sample {
    fn of(number: usize, perturbation: Perturbation, verdict: &Verdict, asked: &[(String, String)]) -> Self {
        let measured = |(name, declared_unit): &(String, String)| {
            let check = verdict.check(name);
            let own_unit = check.filter(|_| has_several_quantities(name)).map(|check| &check.unit);
            (check.and_then(|check| check.margin).unwrap_or(f64::NAN), own_unit.unwrap_or(declared_unit).clone())
        };
        let (margins, units) = asked.iter().map(measured).unzip();
        Self { number, perturbation, verdict: verdict.outcome, failed_checks: verdict.failed_checks(), margins, units }
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
        let part = Partition { part: 2, parts: 3 };
        assert!(part.numbers(10).all(|number| part.holds(number)) && !part.holds(3));
        assert_eq!(Partition::WHOLE.numbers(4).collect::<Vec<_>>(), [0, 1, 2, 3]);
        assert_eq!(Partition { part: 7, parts: 7 }.numbers(3).count(), 0);
    }
}
