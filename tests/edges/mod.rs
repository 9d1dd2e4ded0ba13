//! Every check of a vehicle family on both sides of its limit: the tests of a table of [`Edge`]s.

use std::collections::BTreeSet;

use harness::verdict::{Check, Outcome, Status, Verdict};
use scenarios::{Family, check_names};

/// A scenario with a plan and a flight that pass every check.
pub trait PassingCase {
    /// The case.
    fn good() -> Self;
    /// The verdict on it.
    fn judge(&self) -> Verdict;
}

/// A check, a way to bring what it measures to a given value, and values just beyond and just inside its limit.
pub struct Edge<C> {
    pub check: &'static str,
    apply: fn(&mut C, f64),
    fails: f64,
    passes: f64,
}

/// One row of the table.
pub const fn edge<C>(check: &'static str, apply: fn(&mut C, f64), fails: f64, passes: f64) -> Edge<C> {
    Edge { check, apply, fails, passes }
}

impl<C: PassingCase> Edge<C> {
    /// The verdict once the case is changed by this amount.
    pub fn verdict(&self, amount: f64) -> Verdict {
        let mut case = C::good();
        (self.apply)(&mut case, amount);
        case.judge()
    }
}

/// The check of this name.
pub fn check<'a>(verdict: &'a Verdict, name: &str) -> &'a Check {
    verdict.checks.iter().find(|check| check.name == name).unwrap_or_else(|| panic!("no check {name}"))
}

/// Asserts that the verdict passes, and answers every check of the family in the order of their declaration.
pub fn assert_passes(verdict: &Verdict, family: Family) {
    let bad: Vec<_> = verdict.checks.iter().filter(|check| check.is_bad()).collect();
    assert!(bad.is_empty(), "{bad:#?}");
    assert_eq!((verdict.outcome, verdict.overclaimed), (Outcome::Pass, false));
    let names: Vec<&str> = verdict.checks.iter().map(|check| check.name.as_str()).collect();
    assert_eq!(names, check_names(family).collect::<Vec<_>>());
}

/// Asserts that every check, and the verdict with it, fails just beyond its limit, and that the check passes just inside.
pub fn assert_both_sides<C: PassingCase>(edges: &[Edge<C>]) {
    for edge in edges {
        let verdict = edge.verdict(edge.fails);
        let beyond = check(&verdict, edge.check);
        assert_eq!(beyond.status, Status::Fail, "beyond: {beyond:#?}");
        assert_eq!(verdict.outcome, Outcome::Fail, "{}", edge.check);
        let verdict = edge.verdict(edge.passes);
        let inside = check(&verdict, edge.check);
        assert_eq!(inside.status, Status::Pass, "inside: {inside:#?}");
        assert!(inside.margin.is_some_and(|margin| margin >= 0.0), "{inside:#?}");
    }
}

/// Asserts that the table has a row for every check of the family, apart from those that the case skips.
pub fn assert_complete<C: PassingCase>(edges: &[Edge<C>], family: Family, skipped: &[&str]) {
    let covered: BTreeSet<&str> = edges.iter().map(|edge| edge.check).chain(skipped.iter().copied()).collect();
    assert_eq!(covered, check_names(family).collect());
    let verdict = C::good().judge();
    for name in skipped {
        let check = check(&verdict, name);
        assert_eq!(check.status, Status::Skip, "{check:?}");
    }
}
