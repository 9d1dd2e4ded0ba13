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

/// The messages of a file, written again with checksums.
fn with_checksums(bytes: &[u8]) -> Vec<u8> {
    let mut writer = mcap::Writer::new(std::io::Cursor::new(Vec::new())).expect("a writer");
    for message in mcap::MessageStream::new(bytes).expect("a file") {
        writer.write(&message.expect("a message")).expect("written");
    }
    writer.finish().expect("finished");
    writer.into_inner().into_inner()
}

#[test]
fn what_a_checksum_does_not_confirm_is_refused() {
    let (scenario, bytes) = (hoverer(), with_checksums(PX4));
    assert_eq!(judged(&bytes, &scenario, &selection()).expect("a log").outcome, Outcome::Pass);
    for at in (bytes.len() / 8..bytes.len() / 2).step_by(37) {
        let mut damaged = bytes.clone();
        damaged[at] ^= 4;
        assert!(judged(&damaged, &scenario, &selection()).is_err(), "byte {at} of {}", bytes.len());
    }
}

/// A length that no file has is an error, not an attempt to reserve memory for it.
#[test]
fn a_length_beyond_all_reason_is_refused() {
    let scenario = hoverer();
    for at in (0..PX4.len() - 8).step_by(11) {
        let mut damaged = PX4.to_vec();
        damaged[at..at + 8].copy_from_slice(&(u64::MAX / 3).to_le_bytes());
        drop(judged(&damaged, &scenario, &selection()));
    }
}

const POSE: &str = "std_msgs/Header header\ngeometry_msgs/Pose pose\n================================================================================
MSG: std_msgs/Header\nbuiltin_interfaces/Time stamp\nstring frame_id\n================================================================================
MSG: builtin_interfaces/Time\nint32 sec\nuint32 nanosec\n================================================================================
MSG: geometry_msgs/Pose\ngeometry_msgs/Point position\ngeometry_msgs/Quaternion orientation\n================================================================================
MSG: geometry_msgs/Point\nfloat64 x\nfloat64 y\nfloat64 z\n================================================================================
MSG: geometry_msgs/Quaternion\nfloat64 x 0\nfloat64 y 0\nfloat64 z 0\nfloat64 w 1";

/// A pose in CDR, at the start of the hoverer.
fn pose(second: i32, frame: &str) -> Vec<u8> {
    let mut body: Vec<u8> = [second.to_le_bytes(), 0_i32.to_le_bytes()].concat();
    body.extend((frame.len() as u32 + 1).to_le_bytes());
    body.extend(frame.as_bytes());
    body.push(0);
    body.resize(body.len().next_multiple_of(8), 0);
    body.extend([0.0, 0.0, 2.0, 0.0, 0.0, 0.0, 1.0_f64].iter().flat_map(|it| it.to_le_bytes()));
    [vec![0, 1, 0, 0], body].concat()
}

#[test]
fn a_topic_in_two_frames_is_refused() {
    let log = |frames: &[&str]| {
        let mut writer = mcap::Writer::new(std::io::Cursor::new(Vec::new())).expect("a writer");
        let schema = writer.add_schema("geometry_msgs/msg/PoseStamped", "ros2msg", POSE.as_bytes()).expect("a schema");
        let channel =
            writer.add_channel(schema, "/pose", "cdr", &std::collections::BTreeMap::new()).expect("a channel");
        for (number, frame) in frames.iter().enumerate() {
            let time_ns = number as u64 * 1_000_000_000;
            let header = mcap::records::MessageHeader {
                channel_id: channel,
                sequence: 0,
                log_time: time_ns,
                publish_time: time_ns,
            };
            writer.write_to_known_channel(&header, &pose(number as i32, frame)).expect("written");
        }
        writer.finish().expect("finished");
        let selection = Selection { topics: vec![Topic::parse("/pose")], setpoints: Vec::new(), fields: Vec::new() };
        judged(&writer.into_inner().into_inner(), &hoverer(), &selection)
    };
    assert!(log(&["map", "map", "map"]).is_ok());
    let mixed = log(&["map", "map", "odom_ned"]).expect_err("two frames");
    assert!(mixed.contains("odom_ned") && mixed.contains("frame map"), "{mixed}");
}
