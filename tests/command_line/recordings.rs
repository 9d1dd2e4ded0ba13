//! The MCAP recording, read back by somebody else's library.

use std::path::Path;
use std::process::Command;

use crate::workplace::{PAIR, Workplace, code, stderr};

/// Is there a Python with these modules? If not, says that a test is left out.
fn has_python(modules: &str) -> bool {
    let import = format!("import {modules}");
    let found = Command::new("python3").args(["-c", &import]).output().is_ok_and(|out| out.status.success());
    if !found {
        eprintln!("left out: there is no python3 with {modules}");
    }
    found
}

#[test]
fn an_independent_reader_finds_everything_in_the_recording() {
    if !has_python("mcap, mcap_protobuf") {
        return;
    }
    let workplace = Workplace::new(&[("pair.toml", PAIR)]);
    let output = workplace.harness(&["run", "pair.toml", "--record", "mcap", "-q"]);
    assert_eq!(code(&output), 0, "{}", stderr(&output));
    let script = Path::new(env!("CARGO_MANIFEST_DIR")).join("tests/command_line/read_mcap.py");
    let recording = workplace.path("out/pair/parallel-scp/flight.mcap");
    let reader = Command::new("python3").arg(script).arg(recording).output().unwrap();
    assert!(reader.status.success(), "{}", String::from_utf8_lossy(&reader.stderr));
}
