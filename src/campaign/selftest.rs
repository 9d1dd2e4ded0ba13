//! Selftest of the judge: known faults are injected, one at a time, into plans and flights that pass, and judged again.
//!
//! A fault must fail the verdict by its target check. Near misses, just inside a limit, must pass. Every check that applies
//! to a family must fail for at least one fault: a check that never fails is useless.

mod edit_trajectory;
mod family;
mod fault;
mod faults;
mod fixed_wing;
mod multirotor;
mod near_misses;
mod reference_case;
mod show;
mod slung_load;

use std::collections::BTreeSet;

use rayon::prelude::*;
use scenarios::Family;
use serde::Serialize;

use crate::verdict::{Check, Outcome, Status};

use family::FamilySelftest;
pub use fault::{Fault, NearMiss};
pub use reference_case::ReferenceCase;
pub use show::{markdown, text};

/// Version of the format of `selftest.json`.
const SCHEMA: u32 = 1;

/// The selftests of all families.
static FAMILIES: [&FamilySelftest; 3] = [&fixed_wing::SELFTEST, &slung_load::SELFTEST, &multirotor::SELFTEST];

/// Results of the selftest.
#[derive(Clone, Debug, Serialize)]
pub struct Selftest {
    /// Version of this format: 1.
    pub schema: u32,
    /// Version of the harness.
    pub harness: &'static str,
    /// Every fault, family by family.
    pub faults: Vec<FaultResult>,
    /// Every near miss, family by family.
    pub near_misses: Vec<NearMissResult>,
    /// Every check that applies to a family, with the number of faults that it detected.
    pub checks: Vec<Coverage>,
}

/// Result of a fault.
#[derive(Clone, Debug, Serialize)]
pub struct FaultResult {
    /// Vehicle family of the reference case.
    pub family: String,
    /// Scenario of the reference case.
    pub scenario: String,
    /// Description of the fault.
    pub fault: &'static str,
    /// The target check, which has to fail, by its full name.
    pub aims_at: &'static str,
    /// Whether the verdict failed, with the target check among the failed ones.
    pub caught: bool,
    /// All checks that failed, in the order of the verdict.
    #[serde(rename = "red")]
    pub failed_checks: Vec<String>,
}

/// Result of a near miss.
#[derive(Clone, Debug, Serialize)]
pub struct NearMissResult {
    /// Vehicle family of the reference case.
    pub family: String,
    /// Scenario of the reference case.
    pub scenario: String,
    /// Description of the near miss.
    pub near_miss: &'static str,
    /// Whether the verdict is a pass.
    #[serde(rename = "green")]
    pub passed: bool,
    /// Checks that failed.
    #[serde(rename = "red")]
    pub failed_checks: Vec<String>,
}

/// Coverage of a check by faults.
#[derive(Clone, Debug, Serialize)]
pub struct Coverage {
    /// Vehicle family.
    pub family: String,
    /// Full name of the check.
    pub check: String,
    /// Number of faults for which it failed.
    pub faults: usize,
}

impl Selftest {
    /// Whether every fault was caught, every near miss passed, and every check failed for some fault.
    pub fn is_good(&self) -> bool {
        let faults = self.faults.iter().all(|fault| fault.caught);
        let near_misses = self.near_misses.iter().all(|near_miss| near_miss.passed);
        !self.faults.is_empty() && faults && near_misses && self.checks.iter().all(|check| check.faults > 0)
    }
}

/// Runs all faults and near misses of all families.
///
/// - `progress`: receives a description of each stage
///
/// A reference case that does not pass counts as a failed near miss, and no fault is injected into it.
pub fn run(progress: &mut dyn FnMut(&str)) -> Selftest {
    let mut selftest = Selftest {
        schema: SCHEMA,
        harness: env!("CARGO_PKG_VERSION"),
        faults: Vec::new(),
        near_misses: Vec::new(),
        checks: Vec::new(),
    };
    for tests in FAMILIES {
        let family = tests.family;
        let mut applicable = BTreeSet::new();
        for reference in (tests.reference_cases)() {
            progress(&format!("{}: planning and flying", reference.scenario.name));
            let reference = reference.flown(tests.edit);
            let untouched = approach(&reference, &NearMiss::new("nothing is changed", |_| {}));
            let is_good = untouched.passed;
            selftest.near_misses.push(untouched);
            applicable.extend(reference.applicable_checks());
            if !is_good {
                continue;
            }
            let faults = faults::of(&reference, tests.faults);
            progress(&format!("{}: {} faults", reference.scenario.name, faults.len()));
            selftest.faults.par_extend(faults.par_iter().map(|fault| inject(&reference, fault)));
            let near_misses = near_misses::of(&reference, tests.near_misses);
            selftest.near_misses.par_extend(near_misses.par_iter().map(|near_miss| approach(&reference, near_miss)));
        }
        let of_family = |fault: &&FaultResult| fault.family == family.to_string();
        let count = |check: &String| {
            selftest.faults.iter().filter(of_family).filter(|fault| fault.failed_checks.contains(check)).count()
        };
        let coverage =
            |check: &String| Coverage { family: family.to_string(), check: check.clone(), faults: count(check) };
        let checks: Vec<Coverage> = in_order(family, &applicable).map(coverage).collect();
        selftest.checks.extend(checks);
    }
    selftest
}

fn inject(reference: &ReferenceCase, fault: &Fault) -> FaultResult {
    let mut mutated = reference.clone();
    (fault.inject)(&mut mutated);
    let verdict = mutated.judge();
    let failed_checks = failed(&verdict.checks);
    FaultResult {
        family: reference.family().to_string(),
        scenario: reference.scenario.name.clone(),
        fault: fault.name,
        aims_at: fault.aims_at,
        caught: verdict.outcome != Outcome::Pass && failed_checks.iter().any(|check| check == fault.aims_at),
        failed_checks,
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
        passed: verdict.outcome == Outcome::Pass,
        failed_checks: failed(&verdict.checks),
    }
}

/// Names of the checks that failed, advisory ones included.
fn failed(checks: &[Check]) -> Vec<String> {
    checks.iter().filter(|check| check.is_bad()).map(|check| check.name.clone()).collect()
}

fn in_order(family: Family, applicable: &BTreeSet<String>) -> impl Iterator<Item = &String> {
    scenarios::check_names(family).filter_map(|name| applicable.get(name))
}

impl ReferenceCase {
    /// Names of the checks that are not skipped for it.
    fn applicable_checks(&self) -> Vec<String> {
        let checks = self.judge().checks;
        checks.into_iter().filter(|check| check.status != Status::Skip).map(|check| check.name).collect()
    }
}
