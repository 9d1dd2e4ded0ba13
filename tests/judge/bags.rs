//! Flights in MCAP files: `px4.mcap` was written by the Python library of MCAP (`tests/command_line/write_bags.py --fixture`).

use std::path::Path;

use harness::plan_source::logs::{self, Selection, Topic};
use harness::plan_source::plan_import::complete_flight;
use harness::verdict::recorded::RecordedFlight;
use harness::verdict::{Outcome, Status, Verdict, judge_recorded};
use scenarios::Scenario;
use scenarios::plan_input::flight_from_tables;

const HOVERER: &str = include_str!("../scenarios/hoverer.toml");
const PX4: &[u8] = include_bytes!("px4.mcap");
const ROUNDS: usize = 2000;

fn hoverer() -> Scenario {
    scenarios::parse("hoverer.toml", HOVERER).expect("a good scenario")
}

fn selection() -> Selection {
    let topics = vec![Topic::parse("/fmu/out/vehicle_local_position")];
    let setpoints = vec![Topic::parse("/fmu/in/trajectory_setpoint")];
    Selection { topics, setpoints, fields: Vec::new() }
}

/// The verdict on a log, or why it is refused.
fn judged(bytes: &[u8], scenario: &Scenario, selection: &Selection) -> Result<Verdict, String> {
    let path = Path::new("px4.mcap");
    let log = logs::parse(path, bytes, scenario, selection).map_err(|error| error.to_string())?;
    let rows = flight_from_tables(path, log.document, scenario).map_err(|error| error.lines().join("\n"))?;
    let (rows, _) = complete_flight(scenario, rows, "px4");
    let (provenance, setpoints) = (&rows.provenance, &log.setpoints);
    Ok(judge_recorded(&RecordedFlight { scenario, rows: &rows.plan, provenance, setpoints }))
}

#[test]
fn a_log_of_px4_is_judged_in_the_frame_of_the_scenario() {
    let found = judged(PX4, &hoverer(), &selection()).expect("a log");
    assert_eq!(found.outcome, Outcome::Pass, "{:#?}", found.checks);
    let tracking = found.check("flight.tracking_max").expect("every check is answered");
    assert_eq!(tracking.status, Status::Pass);
    // 0.01 m to the north all the time; the setpoint is linear between samples, the vehicle is not known there.
    assert!(tracking.lower.is_some_and(|it| it < 0.011) && tracking.upper.is_some_and(|it| it > 0.01), "{tracking:#?}");
}

#[test]
fn fields_that_the_user_names_are_read() {
    let fields = |axes: [&str; 3]| {
        let named = ["x", "y", "z"].into_iter().zip(axes).map(|(name, path)| (name.to_owned(), path.to_owned()));
        Selection { fields: named.collect(), setpoints: Vec::new(), ..selection() }
    };
    let found = judged(PX4, &hoverer(), &fields(["y", "x", "-z"])).expect("a log");
    assert_eq!(found.outcome, Outcome::Pass, "{:#?}", found.checks);
    // North and east exchanged: elsewhere than at the start is refused or fails, as a frame that is not that of the scenario.
    let wrong = judged(PX4, &hoverer(), &fields(["x", "y", "z"]));
    assert!(wrong.as_ref().is_err() || wrong.as_ref().is_ok_and(|it| it.outcome == Outcome::Fail), "{wrong:#?}");
    let missing = judged(PX4, &hoverer(), &fields(["y", "x", "height"])).expect_err("no such field");
    assert!(missing.contains("no number at `height`"), "{missing}");
}

#[test]
fn topics_that_are_not_there_or_not_named_are_refused() {
    let scenario = hoverer();
    let of = |topic: &str| Selection { topics: vec![Topic::parse(topic)], ..Selection::default() };
    for (selection, part) in [
        (of("/nope"), "no message on `/nope`, expected one of the topics: /fmu/in/trajectory_setpoint"),
        (Selection::default(), "several topics of known types"),
        (of("uav-9=/fmu/out/vehicle_local_position"), "found `uav-9`, expected one topic for each of uav-1"),
    ] {
        let refused = judged(PX4, &scenario, &selection).expect_err(part);
        assert!(refused.contains(part), "{part}: {refused}");
    }
}

#[test]
fn a_truncated_log_is_refused_wherever_it_ends() {
    let scenario = hoverer();
    for length in (0..PX4.len()).step_by(97) {
        assert!(judged(&PX4[..length], &scenario, &selection()).is_err(), "{length} bytes");
    }
}

#[test]
fn damaged_logs_are_judged_without_a_panic_and_those_that_pass_still_end_at_the_goal() {
    let scenario = hoverer();
    let mut rng = scenarios::stream(0, "damaged bags");
    let (mut passed, mut failed) = (0, 0);
    for _ in 0..ROUNDS {
        let mut bytes = PX4.to_vec();
        let mut below = |n: usize| (rand::Rng::next_u64(&mut rng) % n as u64) as usize;
        for _ in 0..=below(3) {
            let at = below(bytes.len());
            match below(3) {
                0 => bytes[at] ^= 1 << below(8),
                1 => bytes[at] = below(256) as u8,
                _ => drop(bytes.drain(at..(at + 1 + below(40)).min(PX4.len().min(bytes.len())))),
            }
        }
        let Ok(found) = judged(&bytes, &scenario, &selection()) else { continue };
        if found.outcome == Outcome::Pass {
            passed += 1;
            let goal = found.check("flight.goal").expect("every check is answered");
            assert!(goal.status == Status::Pass && goal.value <= goal.limit, "{goal:#?}");
        } else {
            failed += 1;
        }
    }
    assert!(passed > 10 && failed > 10, "{passed} passed, {failed} failed");
}
