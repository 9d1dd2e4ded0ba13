//! A flight with a load is recorded whole, and a broken one is recorded too.

use harness::output::recording::rrd::Rrd;
use harness::output::recording::{Run, record};

use crate::case::Case;

/// Size of the recording, bytes.
fn recorded(case: &Case) -> u64 {
    let folder = tempfile::tempdir().unwrap();
    let verdict = case.judge();
    let run = Run {
        scenario: &case.scenario,
        plan: &case.plan,
        flight: case.flight.as_ref(),
        verdict: &verdict,
        waterfall: &[],
        ghost: None,
    };
    let path = record(&Rrd, &run, folder.path()).unwrap();
    std::fs::metadata(path).unwrap().len()
}

#[test]
fn flights_right_and_wrong_are_recorded() {
    let whole = recorded(&Case::good());
    assert!((100_000..3_000_000).contains(&whole), "{whole} bytes");
    assert!(recorded(&Case::caught()) > 50_000);
    let mut case = Case::good();
    case.flight = None;
    assert!(recorded(&case) < whole);
    let mut case = Case::good();
    case.trajectory().states.truncate(9);
    case.samples()[7].position_m[0] = f64::NAN;
    case.loads()[9].tension_n = f64::INFINITY;
    case.loads().truncate(500);
    assert!(recorded(&case) > 10_000);
    let mut case = Case::good();
    (case.plan.trajectories, case.flight) = (vec![], None);
    assert!(recorded(&case) > 1_000);
}
