//! Equal runs do not differ, and an injected change is found.

use std::collections::BTreeMap;

use super::{Baseline, CheckEntry, Entry, Scope, Severity, Snapshot, compare, rules};
use crate::verdict::{Outcome, Status};

fn entry() -> Entry {
    let check = |status, unit: &str| CheckEntry { status, unit: unit.to_owned(), advisory: false };
    let figures = [
        ("margin of flight.separation", 4.2),
        ("margin of nodes.state_limits", 1e-7),
        (rules::FLOWN_TIME, 225.9),
        (rules::TRACKING_MAX, 1.06),
        (rules::PLANNING_TIME, 0.2),
    ];
    Entry {
        scenario: "pair".into(),
        planner: "by-hand".into(),
        seed: 0,
        verdict: Outcome::Pass,
        checks: BTreeMap::from([
            ("flight.separation".to_owned(), check(Status::Pass, "m")),
            ("nodes.state_limits".to_owned(), check(Status::Pass, "m/s")),
        ]),
        figures: figures.into_iter().map(|(name, value)| (name.to_owned(), value)).collect(),
    }
}

fn snapshot(change: impl Fn(&mut Entry)) -> Snapshot {
    let mut entry = entry();
    change(&mut entry);
    Snapshot { entries: vec![entry] }
}

/// Severities and subjects of the differences after a change.
fn found(change: impl Fn(&mut Entry)) -> Vec<(Severity, String)> {
    let comparison = compare(&snapshot(|_| {}), &snapshot(change), Scope::Everything);
    comparison.differences.into_iter().map(|difference| (difference.rating, difference.what)).collect()
}

fn scaled(figure: &'static str, factor: f64) -> impl Fn(&mut Entry) {
    move |entry| *entry.figures.get_mut(figure).expect("a figure") *= factor
}

#[test]
fn nothing_differs_from_itself() {
    assert_eq!(found(|_| {}), []);
}

#[test]
fn a_change_of_three_percent_is_found_in_every_deciding_figure_and_one_of_a_tenth_of_a_percent_in_none() {
    for (figure, worse) in
        [("margin of flight.separation", 0.97), (rules::FLOWN_TIME, 1.03), (rules::TRACKING_MAX, 1.03)]
    {
        assert_eq!(found(scaled(figure, worse)), [(Severity::Worse, figure.to_owned())]);
        assert_eq!(found(scaled(figure, 2.0 - worse)), [(Severity::Better, figure.to_owned())]);
        assert_eq!(found(scaled(figure, 1.0 + (worse - 1.0) / 30.0)), [], "{figure}");
    }
}

#[test]
fn rounding_in_a_zero_margin_is_no_change() {
    assert_eq!(found(scaled("margin of nodes.state_limits", -3.0)), []);
}

/// Another quantity decides the check: metres of one and degrees of the other are not compared.
#[test]
fn margins_in_two_units_are_not_compared() {
    let turned = |entry: &mut Entry| {
        entry.checks.get_mut("flight.separation").expect("a check").unit = "deg".to_owned();
        scaled("margin of flight.separation", 0.5)(entry);
    };
    assert_eq!(found(turned), []);
}

#[test]
fn planning_times_are_notes() {
    assert_eq!(found(scaled(rules::PLANNING_TIME, 1.5)), []);
    assert_eq!(found(scaled(rules::PLANNING_TIME, 9.0)), [(Severity::Note, rules::PLANNING_TIME.to_owned())]);
}

#[test]
fn nan_is_worse() {
    let lost = |entry: &mut Entry| *entry.figures.get_mut(rules::FLOWN_TIME).expect("a figure") = f64::NAN;
    assert_eq!(found(lost), [(Severity::Worse, rules::FLOWN_TIME.to_owned())]);
}

#[test]
fn statuses_and_verdicts_have_an_order() {
    let set = |status| move |entry: &mut Entry| entry.checks.get_mut("flight.separation").unwrap().status = status;
    let name = "flight.separation".to_owned();
    for status in [Status::Fail, Status::Undecided, Status::Skip] {
        assert_eq!(found(set(status)), [(Severity::Worse, name.clone())], "{status:?}");
        let back = compare(&snapshot(set(status)), &snapshot(|_| {}), Scope::Everything);
        assert_eq!(back.differences[0].rating, Severity::Better, "{status:?}");
    }
    assert_eq!(found(|entry| entry.verdict = Outcome::Fail), [(Severity::Worse, "verdict".to_owned())]);
    let gone = |entry: &mut Entry| drop(entry.checks.remove("flight.separation"));
    assert_eq!(found(gone), [(Severity::Worse, name)]);
}

#[test]
fn differences_of_advisory_checks_are_notes() {
    let advisory = |entry: &mut Entry| entry.checks.get_mut("flight.separation").unwrap().advisory = true;
    let failed = |entry: &mut Entry| {
        advisory(entry);
        entry.checks.get_mut("flight.separation").unwrap().status = Status::Fail;
        *entry.figures.get_mut("margin of flight.separation").unwrap() = -1.0;
    };
    let comparison = compare(&snapshot(advisory), &snapshot(failed), Scope::Everything);
    assert_eq!(comparison.differences.len(), 2);
    assert!(comparison.differences.iter().all(|difference| difference.rating == Severity::Note));
}

/// A judge that was weakened is a regression, although every status is as it was.
#[test]
fn a_check_that_became_advisory_is_worse() {
    let advisory = |entry: &mut Entry| entry.checks.get_mut("flight.separation").unwrap().advisory = true;
    assert_eq!(found(advisory), [(Severity::Worse, "flight.separation".to_owned())]);
    let back = compare(&snapshot(advisory), &snapshot(|_| {}), Scope::Everything);
    assert_eq!(back.differences.len(), 1);
    assert_eq!(back.differences[0].sentence(), "flight.separation: advisory before, decides now");
    assert_eq!(back.differences[0].rating, Severity::Better);
}

#[test]
fn a_missing_result_is_worse_unless_only_a_part_was_run() {
    let (old, new) = (snapshot(|_| {}), Snapshot::default());
    assert!(!compare(&old, &new, Scope::Everything).is_good());
    assert!(compare(&old, &new, Scope::NewRunOnly).is_good());
    assert_eq!(compare(&new, &old, Scope::Everything).differences[0].rating, Severity::Note);
}

#[test]
fn a_baseline_keeps_its_reasons_and_the_results_that_were_not_run() {
    let first = Baseline::accept(None, snapshot(|_| {}), "first");
    let other = snapshot(|entry| entry.scenario = "other".into());
    let second = Baseline::accept(Some(first), other, "second");
    let names: Vec<&str> = second.results.entries.iter().map(|entry| entry.scenario.as_str()).collect();
    let reasons: Vec<&str> = second.accepted.iter().map(|acceptance| acceptance.reason.as_str()).collect();
    assert_eq!((names, reasons), (vec!["other", "pair"], vec!["first", "second"]));
    assert!(second.results.entries.iter().all(|entry| !entry.figures.contains_key(rules::PLANNING_TIME)));
}
