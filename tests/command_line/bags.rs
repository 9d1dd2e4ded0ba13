//! MCAP files and ROS 2 bags as plans and flights, written by the Python libraries of others.

use std::path::Path;
use std::process::Command;

use crate::workplace::{Workplace, code, has_python, stderr, stdout};

const HOVERER: &str = include_str!("../scenarios/hoverer.toml");

/// A workplace with the same flight in bags and in log.csv; `None` without Python and the libraries.
fn written() -> Option<Workplace> {
    if !has_python("mcap_ros2, rosbags, pyulog, numpy") {
        return None;
    }
    let workplace = Workplace::new(&[("hoverer.toml", HOVERER)]);
    let script = Path::new(env!("CARGO_MANIFEST_DIR")).join("tests/command_line/write_bags.py");
    let output = Command::new("python3").arg(script).arg(workplace.path("")).output().unwrap();
    assert!(output.status.success(), "{}", stderr(&output));
    Some(workplace)
}

/// Judges a flight and returns exit code, output and the values of its checks.
fn judge(workplace: &Workplace, arguments: &[&str]) -> (i32, String, serde_json::Value) {
    let fixed = ["judge", "hoverer.toml", "--record", "none", "--name", "it", "-v", "--flight"];
    let output = workplace.harness(&[&fixed[..], arguments].concat());
    let report =
        if code(&output) == 2 { serde_json::Value::Null } else { workplace.json("out/hoverer/it/report.json") };
    (code(&output), stdout(&output) + &stderr(&output), report)
}

fn value(report: &serde_json::Value, name: &str) -> f64 {
    let checks = report["checks"].as_array().unwrap();
    checks.iter().find(|check| check["name"] == name).unwrap()["value"].as_f64().unwrap()
}

#[test]
fn flights_in_bags_are_judged_like_the_same_flight_in_a_table() {
    let Some(workplace) = written() else { return };
    let (exit, page, table) = judge(&workplace, &["log.csv"]);
    assert_eq!(exit, 0, "{page}");
    let local = "/fmu/out/vehicle_local_position";
    for (arguments, remark) in [
        (vec!["odometry/odometry.mcap"], "velocities rotated from the axes of the body"),
        (vec!["px4.ulg"], "vehicle_local_position: north, east, down, converted to east, north, up"),
        (vec!["flights.mcap", "--topic", "/pose"], "/pose: taken as east, north, up (frame map)"),
        (vec!["flights.mcap", "--topic", local], "north, east, down, converted to east, north, up"),
        (
            vec!["flights.mcap", "--topic", "/own", "--field", "x=place.east", "--field", "y=place.north"]
                .into_iter()
                .chain(["--field", "z=-place.down", "--field", "t=seconds"])
                .collect(),
            "times count from the first stamp, 5.000000000 s",
        ),
    ] {
        let (exit, page, report) = judge(&workplace, &arguments);
        assert_eq!(exit, 0, "{arguments:?}: {page}");
        assert!(page.replace("\n", " ").contains(remark), "{remark}: {page}");
        for name in ["flight.clearance", "flight.goal", "flight.duration"] {
            let [ours, theirs] = [&table, &report].map(|report| value(report, name));
            assert!((ours - theirs).abs() < 1e-3, "{arguments:?}: {name} {theirs}, not {ours}");
        }
    }
}

#[test]
fn setpoints_of_a_topic_are_tracked() {
    let Some(workplace) = written() else { return };
    let topics = ["flights.mcap", "--topic", "/pose", "--setpoint-topic", "uav-1=/pose"];
    let (exit, page, report) = judge(&workplace, &topics);
    assert_eq!(exit, 0, "{page}");
    assert!(value(&report, "flight.tracking_max") < 1e-3);
    let px4 = ["flights.mcap", "--topic", "/fmu/out/vehicle_local_position"];
    let (exit, page, report) =
        judge(&workplace, &[&px4[..], &["--setpoint-topic", "/fmu/in/trajectory_setpoint"]].concat());
    assert_eq!(exit, 0, "{page}");
    assert!((value(&report, "flight.tracking_max") - 0.01).abs() < 1e-3);
    let (exit, page, report) = judge(&workplace, &["px4.ulg", "--setpoint-topic", "trajectory_setpoint"]);
    assert_eq!(exit, 0, "{page}");
    assert!((value(&report, "flight.tracking_max") - 0.01).abs() < 1e-3);
    // The clocks of the two differ by centuries: no setpoint is given during the flight.
    let (exit, page, _) = judge(&workplace, &[&px4[..], &["--setpoint-topic", "/pose"]].concat());
    let page = page.split_whitespace().collect::<Vec<_>>().join(" ");
    assert!(exit == 1 && page.contains("no setpoint is given for any time of the flight"), "{page}");
}

#[test]
fn paths_and_trajectories_in_bags_are_plans() {
    let Some(workplace) = written() else { return };
    for topic in ["/path", "/trajectory"] {
        let output =
            workplace.harness(&["check", "hoverer.toml", "--plan", "plans.mcap", "--topic", topic, "--record", "none"]);
        assert_eq!(code(&output), 0, "{topic}: {}{}", stdout(&output), stderr(&output));
    }
}

#[test]
fn what_is_not_understood_is_refused_with_the_remedy() {
    let Some(workplace) = written() else { return };
    std::fs::write(workplace.path("text.mcap"), "no log").unwrap();
    for (arguments, part) in [
        (vec!["text.mcap"], "expected a whole MCAP file"),
        (vec!["flights.mcap"], "several topics of known types"),
        (vec!["flights.mcap", "--topic", "/own"], "messages of the type own_msgs/State"),
        (vec!["flights.mcap", "--topic", "/own", "--field", "x=east"], "--field `y`"),
        (vec!["flights.mcap", "--topic", "/own", "--field", "east=x"], "--field `east`"),
        (vec!["plans.mcap", "--topic", "/nope"], "no message on `/nope`"),
        (
            vec!["px4.ulg", "--topic", "sensor"],
            "no message of `sensor`, expected one of the topics: vehicle_local_position",
        ),
        (vec!["missing.mcap"], "missing.mcap"),
    ] {
        let (exit, page, _) = judge(&workplace, &arguments);
        let page = page.replace("\n  │ ", " ");
        assert!(exit == 2 && page.contains(part), "{part}: {exit} {page}");
    }
}
