//! Faults of the machine: processes killed at any moment, full disks, missing permissions.

use std::fs;
use std::process::{Command, Stdio};
use std::thread::sleep;
use std::time::Instant;

use serde_json::Value;

use crate::workplace::{PAIR, Workplace, code, stderr};

const RESULT: &str = "out/pair/parallel-scp";

fn run(workplace: &Workplace, seed: &str) -> Command {
    let mut command = Command::new(env!("CARGO_BIN_EXE_harness"));
    command.env_remove("GITHUB_ACTIONS").env_remove("GITHUB_STEP_SUMMARY").current_dir(workplace.path(""));
    command.args(["run", "pair.toml", "--record", "none", "-q", "--seed", seed]).stderr(Stdio::null());
    command
}

/// Fifty times over the length of a run. Every file that exists is complete, and from one of the two runs.
#[cfg(unix)]
#[test]
fn killed_at_any_moment_a_run_leaves_whole_files_and_a_rerun_finishes() {
    let workplace = Workplace::new(&[("pair.toml", PAIR)]);
    let began = Instant::now();
    run(&workplace, "0").status().unwrap();
    let length = began.elapsed();
    let mut killed = 0;
    for moment in 0..50 {
        let mut child = run(&workplace, "1").spawn().unwrap();
        sleep(length.mul_f64(f64::from(moment) / 50.0));
        child.kill().unwrap();
        killed += u32::from(child.wait().unwrap().code().is_none());
        let results = ["report.json", "plan.json"].map(|name| workplace.json(&format!("{RESULT}/{name}")));
        assert!(results.iter().all(|it| it["seed"] == 0 || it["seed"] == 1), "moment {moment}");
        let summary: Value = workplace.json("out/summary.json");
        assert_eq!(summary["runs"].as_array().map(Vec::len), Some(1), "moment {moment}");
        assert!(fs::read_to_string(workplace.path("out/junit.xml")).unwrap().trim_end().ends_with("</testsuites>"));
        // The next run starts from the same earlier results.
        if results[0]["seed"] == 1 {
            run(&workplace, "0").status().unwrap();
        }
    }
    assert!(killed > 10, "{killed} of 50 were killed before they had ended after {length:?}");
    assert!(run(&workplace, "2").status().unwrap().code().is_some_and(|code| code < 2));
    assert_eq!(workplace.json(&format!("{RESULT}/report.json"))["seed"], 2);
}

#[test]
fn an_unwritable_folder_is_named_in_the_error() {
    let workplace = Workplace::new(&[("pair.toml", PAIR), ("taken", "a file where the folder should be")]);
    let output = workplace.harness(&["run", "pair.toml", "--record", "none", "-q", "-o", "taken"]);
    assert_eq!(code(&output), 2, "{}", stderr(&output));
    assert!(stderr(&output).contains("taken"), "{}", stderr(&output));
    assert_eq!(fs::read_to_string(workplace.path("taken")).unwrap(), "a file where the folder should be");
}

/// A limit on file size stands in for a full disk: the write fails half way.
#[cfg(target_os = "linux")]
#[test]
fn a_full_disk_is_an_error_that_names_the_file_and_leaves_earlier_results() {
    let workplace = Workplace::new(&[("pair.toml", PAIR)]);
    run(&workplace, "0").status().unwrap();
    let files = workplace.files(RESULT);
    let command = "trap '' XFSZ; ulimit -f 4; exec \"$0\" run pair.toml --record none -q --seed 1";
    let mut shell = Command::new("sh");
    shell.env_remove("GITHUB_ACTIONS").current_dir(workplace.path(""));
    let output = shell.args(["-c", command, env!("CARGO_BIN_EXE_harness")]).output().unwrap();
    assert_eq!(code(&output), 2, "{}", stderr(&output));
    assert!(stderr(&output).contains("plan.json"), "{}", stderr(&output));
    assert_eq!(workplace.files(RESULT), files, "nothing is left over");
    for name in ["report.json", "plan.json"] {
        assert_eq!(workplace.json(&format!("{RESULT}/{name}"))["seed"], 0);
    }
}

#[cfg(target_os = "linux")]
#[test]
fn standard_output_that_is_full_is_an_error() {
    let workplace = Workplace::new(&[("pair.toml", PAIR)]);
    let mut command = Command::new(env!("CARGO_BIN_EXE_harness"));
    command.current_dir(workplace.path("")).args(["plan", "pair.toml", "-q", "-o", "-"]);
    let full = fs::OpenOptions::new().write(true).open("/dev/full").unwrap();
    let output = command.stdout(full).stderr(Stdio::piped()).output().unwrap();
    assert_eq!(code(&output), 2);
    assert!(stderr(&output).contains("output"), "{}", stderr(&output));
}
