//! Ctrl-C in every phase: complete results stay, incomplete ones are listed, and no partial file is left.

use std::fs;
use std::io::{BufRead, BufReader, Read};
use std::path::Path;
use std::process::{Child, Command, Stdio};

use crate::workplace::{PAIR, Workplace, code, stderr};

/// A shipped scenario whose phases last long enough to be interrupted.
fn long_one() -> (&'static str, String) {
    let file = concat!(env!("CARGO_MANIFEST_DIR"), "/scenarios/fixed-wing/exchange-25.toml");
    ("exchange-25.toml", fs::read_to_string(file).unwrap())
}

fn start(workplace: &Workplace, arguments: &[&str]) -> Child {
    let mut command = Command::new(env!("CARGO_BIN_EXE_harness"));
    command.env_remove("GITHUB_ACTIONS").env_remove("GITHUB_STEP_SUMMARY").current_dir(workplace.path(""));
    command.args(arguments).stdout(Stdio::null()).stderr(Stdio::piped()).spawn().unwrap()
}

/// Presses ctrl-C when `when` appears on standard error. Returns the exit code and the output after it.
fn stopped_when(mut child: Child, when: &str) -> (i32, String) {
    let mut said = BufReader::new(child.stderr.take().unwrap());
    let mut line = String::new();
    while !line.contains(when) {
        line.clear();
        assert_ne!(said.read_line(&mut line).unwrap(), 0, "it never said {when}");
    }
    press_ctrl_c(&child);
    let mut rest = String::new();
    said.read_to_string(&mut rest).unwrap();
    (child.wait().unwrap().code().expect("it ended by itself"), rest)
}

fn press_ctrl_c(child: &Child) {
    assert!(Command::new("kill").args(["-INT", &child.id().to_string()]).status().unwrap().success());
}

/// Every file below a folder.
fn files_below(folder: &Path) -> Vec<String> {
    let mut names = Vec::new();
    for entry in fs::read_dir(folder).into_iter().flatten().flatten() {
        let path = entry.path();
        if path.is_dir() { names.extend(files_below(&path)) } else { names.push(path.display().to_string()) }
    }
    names
}

fn assert_no_partial_files(workplace: &Workplace) {
    let partial: Vec<String> =
        files_below(&workplace.path("out")).into_iter().filter(|name| name.contains(".partial")).collect();
    assert!(partial.is_empty(), "{partial:?}");
}

#[test]
fn in_every_phase_complete_results_stay_and_incomplete_ones_are_listed() {
    let (name, text) = long_one();
    let first = PAIR.replace("name = \"pair\"", "name = \"a-pair\"");
    let workplace = Workplace::new(&[("a-pair.toml", &first), (name, &text)]);
    let phases = ["exchange-25 · fleet-scp: planning", "exchange-25 · fleet-scp: flying", "fleet-scp: judging"];
    for phase in phases {
        let child = start(&workplace, &["run", "a-pair.toml", name, "--record", "none", "-j", "1"]);
        let (code, said) = stopped_when(child, phase);
        assert_eq!(code, 130, "{phase}: {said}");
        assert!(said.contains("1 of 2 are complete: a-pair (parallel-scp)"), "{phase}: {said}");
        assert!(said.contains("not complete: exchange-25 (fleet-scp)"), "{phase}: {said}");
        assert!(workplace.path("out/a-pair/parallel-scp/report.json").exists(), "{phase}");
        assert_no_partial_files(&workplace);
        assert!(!workplace.path("out/exchange-25/fleet-scp/report.json").exists(), "{phase}");
        assert!(!workplace.path("out/summary.json").exists(), "{phase}");
    }
}

#[test]
fn all_jobs_that_run_side_by_side_are_listed() {
    let (name, text) = long_one();
    let second = text.replace("name = \"exchange-25\"", "name = \"z-exchange\"");
    let workplace = Workplace::new(&[(name, &text), ("z-exchange.toml", &second)]);
    let child = start(&workplace, &["run", name, "z-exchange.toml", "--record", "none", "-j", "2"]);
    let (code, said) = stopped_when(child, "exchange-25 · fleet-scp: flying");
    assert_eq!(code, 130, "{said}");
    assert!(said.contains("not complete: exchange-25 (fleet-scp), z-exchange (fleet-scp); their folders"), "{said}");
    assert_no_partial_files(&workplace);
}

#[test]
fn an_interrupted_recording_leaves_no_file() {
    let (name, text) = long_one();
    let workplace = Workplace::new(&[(name, &text)]);
    let (code, said) = stopped_when(start(&workplace, &["run", name, "--record", "parquet"]), "recording");
    assert_eq!(code, 130, "{said}");
    assert_no_partial_files(&workplace);
    assert!(!workplace.path("out/exchange-25/fleet-scp/report.json").exists());
}

#[test]
fn an_external_planner_ends_with_the_run() {
    let workplace = Workplace::new(&[("pair.toml", PAIR)]);
    let command = "sh -c 'echo $$ > pid; exec sleep 600'";
    let child = start(&workplace, &["run", "pair.toml", "--planner-command", command, "--time-limit", "600"]);
    while fs::read_to_string(workplace.path("pid")).map_or(true, |pid| pid.trim().is_empty()) {
        std::thread::sleep(std::time::Duration::from_millis(5));
    }
    let (code, said) = {
        press_ctrl_c(&child);
        let output = child.wait_with_output().unwrap();
        (code(&output), stderr(&output))
    };
    assert_eq!(code, 130, "{said}");
    let pid = fs::read_to_string(workplace.path("pid")).unwrap();
    let is_there = || fs::read_to_string(format!("/proc/{}/comm", pid.trim())).is_ok_and(|name| name.trim() == "sleep");
    let is_gone = (0..1000).any(|_| {
        std::thread::sleep(std::time::Duration::from_millis(5));
        !is_there()
    });
    assert!(is_gone, "the command lives on");
}

#[test]
fn selftest_stress_and_benchmarks_can_be_interrupted() {
    let (name, text) = long_one();
    let rendezvous = include_str!("../../scenarios/fixed-wing/rendezvous-7.toml");
    let workplace = Workplace::new(&[(name, &text), ("scenarios/fixed-wing/rendezvous-7.toml", rendezvous)]);
    for (arguments, when) in [
        (&["selftest"][..], "faults"),
        (&["stress", name, "--over", "wind"][..], "planning"),
        (&["bench", "ipm", "--quick"][..], ":"),
    ] {
        let (code, said) = stopped_when(start(&workplace, arguments), when);
        assert_eq!(code, 130, "{arguments:?}: {said}");
        assert!(said.contains("no incomplete files are left"), "{arguments:?}: {said}");
        assert_no_partial_files(&workplace);
    }
}

#[test]
fn temporary_files_of_a_killed_run_are_removed_by_the_next() {
    let workplace = Workplace::new(&[("pair.toml", PAIR)]);
    let (name, text) = long_one();
    fs::write(workplace.path(name), text).unwrap();
    let folder = "out/exchange-25/fleet-scp";
    // Killed while a recording is being written: its temporary file is left over.
    let mut child = start(&workplace, &["run", name, "--record", "parquet"]);
    let mut said = BufReader::new(child.stderr.take().unwrap());
    let mut line = String::new();
    while !line.contains("recording") {
        line.clear();
        assert_ne!(said.read_line(&mut line).unwrap(), 0);
    }
    let is_partial = |name: &String| name.contains(".partial");
    while !files_below(&workplace.path(folder)).iter().any(is_partial) {
        assert!(child.try_wait().unwrap().is_none(), "it ended before it could be killed");
    }
    child.kill().unwrap();
    child.wait().unwrap();
    assert!(files_below(&workplace.path(folder)).iter().any(is_partial));
    let output = workplace.harness(&["run", name, "--record", "none", "-q"]);
    assert!(code(&output) < 2, "{}", stderr(&output));
    assert_no_partial_files(&workplace);
}
