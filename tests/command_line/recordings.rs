//! The MCAP recording, read back by an independent library.

use std::path::Path;
use std::process::Command;

use crate::workplace::{PAIR, Workplace, code, has_python, stderr};

/// Runs the scenario in `file` and checks its recording with the reader.
fn check(workplace: &Workplace, file: &str, recording: &str) {
    let output = workplace.harness(&["run", file, "--record", "mcap", "-q"]);
    assert_eq!(code(&output), 0, "{}", stderr(&output));
    let script = Path::new(env!("CARGO_MANIFEST_DIR")).join("tests/command_line/read_mcap.py");
    let reader = Command::new("python3").arg(script).arg(workplace.path(recording)).output().unwrap();
    assert!(reader.status.success(), "{recording}: {}", String::from_utf8_lossy(&reader.stderr));
}

#[test]
fn an_independent_reader_finds_everything_in_the_recording() {
    if !has_python("mcap, mcap_protobuf") {
        return;
    }
    let workplace = Workplace::new(&[("pair.toml", PAIR)]);
    check(&workplace, "pair.toml", "out/pair/parallel-scp/flight.mcap");
}

/// Moving and hidden obstacles, horizons, gates and cables, which only some families have, are recorded too.
#[test]
fn no_vehicle_family_is_left_out_of_the_recording() {
    if !has_python("mcap, mcap_protobuf") {
        return;
    }
    let workplace = Workplace::new(&[]);
    for (folder, name, planner) in
        [("multirotor", "corridor-moving", "rhc"), ("multirotor", "pop-up", "rhc"), ("slung", "gate", "slung-lgr")]
    {
        let file = Path::new(env!("CARGO_MANIFEST_DIR")).join(format!("scenarios/{folder}/{name}.toml"));
        check(&workplace, &file.display().to_string(), &format!("out/{name}/{planner}/flight.mcap"));
    }
}
