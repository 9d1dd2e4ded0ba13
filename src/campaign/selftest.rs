//! Does the judge notice? Known faults are injected, one at a time, into flights and plans that pass, and judged again
//! by the judge of every run.
//!
//! A fault must fail the verdict, by the check that it aims at. Near misses, just inside a limit, must pass. And every
//! check that can be asked must be turned red by something: one that never fails may as well not be there.

mod family;
mod fault;
mod faults;
pub mod fixed_wing;
pub mod multirotor;
mod near_misses;
mod reference_case;
mod show;
pub mod slung_load;

use std::collections::BTreeSet;

use rayon::prelude::*;
use scenarios::Family;
use serde::Serialize;

use crate::families;
use crate::verdict::{Check, Outcome, Status};

pub use family::FamilySelftest;
pub use fault::{Fault, NearMiss};
pub use reference_case::ReferenceCase;
pub use show::{markdown, text};

/// Version of the form of `selftest.json`.
const SCHEMA: u32 = 1;

/// What came of all of it.
#[derive(Clone, Debug, Serialize)]
pub struct Selftest {
    /// Version of this form: 1.
    pub schema: u32,
    /// Version of the harness.
    pub harness: &'static str,
    /// Every fault, family by family.
    pub faults: Vec<FaultResult>,
    /// What is just inside a limit.
    pub near_misses: Vec<NearMissResult>,
    /// Every check that is asked of a family, and how many faults turned it red.
    pub checks: Vec<Coverage>,
}

/// What became of a fault.
#[derive(Clone, Debug, Serialize)]
pub struct FaultResult {
    /// Family of the reference.
    pub family: String,
    /// Scenario of the reference.
    pub scenario: String,
    /// What was wrong.
    pub fault: &'static str,
    /// The check that has to notice, by its full name.
    pub aims_at: &'static str,
    /// Did the verdict fail, with that check red?
    pub caught: bool,
    /// All checks that turned red, in the order of the verdict.
    pub red: Vec<String>,
}

/// What became of a near miss.
#[derive(Clone, Debug, Serialize)]
pub struct NearMissResult {
    /// Family of the reference.
    pub family: String,
    /// Scenario of the reference.
    pub scenario: String,
    /// What is nearly wrong.
    pub near_miss: &'static str,
    /// Did everything pass?
    pub green: bool,
    /// Checks that turned red all the same.
    pub red: Vec<String>,
}

/// How often a check turned red.
#[derive(Clone, Debug, Serialize)]
pub struct Coverage {
    /// Family of the vehicles.
    pub family: String,
    /// Name of the check.
    pub check: String,
    /// Number of faults that turned it red.
    pub faults: usize,
}

impl Selftest {
    /// Was every fault caught, every near miss passed, and every check turned red by something?
    pub fn is_good(&self) -> bool {
        let faults = self.faults.iter().all(|fault| fault.caught);
        let near_misses = self.near_misses.iter().all(|near_miss| near_miss.green);
        !self.faults.is_empty() && faults && near_misses && self.checks.iter().all(|check| check.faults > 0)
    }
}

/// Runs all faults and near misses of all families.
///
/// - `progress`: is told what is being done
///
/// From a reference that does not pass before anything is injected nothing can be learnt: it counts as a near miss that
/// turned red, and nothing is injected into it.
pub fn run(progress: &mut dyn FnMut(&str)) -> Selftest {
    let mut selftest = Selftest {
        schema: SCHEMA,
        harness: env!("CARGO_PKG_VERSION"),
        faults: Vec::new(),
        near_misses: Vec::new(),
        checks: Vec::new(),
    };
    for family in Family::ALL {
        let mut asked = BTreeSet::new();
        for reference in (families::of(family).selftest.reference_cases)() {
            progress(&format!("{}: planning and flying", reference.scenario.name));
            let reference = reference.flown();
            let untouched = approach(&reference, &NearMiss::new("nothing is changed", |_| {}));
            let is_good = untouched.green;
            selftest.near_misses.push(untouched);
            asked.extend(reference.asked());
            if !is_good {
                continue;
            }
            let faults = faults::of(&reference);
            progress(&format!("{}: {} faults", reference.scenario.name, faults.len()));
            selftest.faults.par_extend(faults.par_iter().map(|fault| inject(&reference, fault)));
            let near_misses = near_misses::of(&reference);
            selftest.near_misses.par_extend(near_misses.par_iter().map(|near_miss| approach(&reference, near_miss)));
        }
        let of_family = |fault: &&FaultResult| fault.family == family.to_string();
        let count =
            |check: &String| selftest.faults.iter().filter(of_family).filter(|fault| fault.red.contains(check)).count();
        let coverage =
            |check: &String| Coverage { family: family.to_string(), check: check.clone(), faults: count(check) };
        let checks: Vec<Coverage> = in_order(family, &asked).map(coverage).collect();
        selftest.checks.extend(checks);
    }
    selftest
}

fn inject(reference: &ReferenceCase, fault: &Fault) -> FaultResult {
    let mut mutated = reference.clone();
    (fault.inject)(&mut mutated);
    let verdict = mutated.judge();
    let red = red(&verdict.checks);
    FaultResult {
        family: reference.family().to_string(),
        scenario: reference.scenario.name.clone(),
        fault: fault.name,
        aims_at: fault.aims_at,
        caught: verdict.outcome != Outcome::Pass && red.iter().any(|check| check == fault.aims_at),
        red,
    }
}

fn approach(reference: &ReferenceCase, near_miss: &NearMiss) -> NearMissResult {
    let mut close = reference.clone();
    (near_miss.approach)(&mut close);
    let verdict = close.judge();
    NearMissResult {
        family: reference.family().to_string(),
        scenario: reference.scenario.name.clone(),
        near_miss: near_miss.name,
        green: verdict.outcome == Outcome::Pass,
        red: red(&verdict.checks),
    }
}

fn red(checks: &[Check]) -> Vec<String> {
    checks.iter().filter(|check| check.is_bad()).map(|check| check.name.clone()).collect()
}

fn in_order(family: Family, asked: &BTreeSet<String>) -> impl Iterator<Item = &String> {
    scenarios::check_names(family).filter_map(|name| asked.get(name))
}

impl ReferenceCase {
    /// The checks that are asked of it.
    fn asked(&self) -> Vec<String> {
        let checks = self.judge().checks;
        checks.into_iter().filter(|check| check.status != Status::Skip).map(|check| check.name).collect()
    }
}
