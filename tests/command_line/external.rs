//! External planners, from the command line.

use std::fs;
use std::path::{Path, PathBuf};
use std::process::Command;

use crate::workplace::{PAIR, Workplace, code, has_python, stderr, stdout};

fn example(name: &str) -> PathBuf {
    Path::new(env!("CARGO_MANIFEST_DIR")).join("examples/external-planner").join(name)
}

#[test]
fn the_example_passes_its_scenario_and_a_shipped_one() {
    if !has_python("numpy") {
        return;
    }
    let workplace = Workplace::new(&[]);
    let own = example("spline-rendezvous.toml").display().to_string();
    let output = workplace.harness(&["run", &own, "--record", "none"]);
    assert_eq!(code(&output), 0, "{}{}", stdout(&output), stderr(&output));
    assert!(stdout(&output).contains("PASS  spline-rendezvous · spline"), "{}", stdout(&output));
    let shipped = Path::new(env!("CARGO_MANIFEST_DIR")).join("scenarios/fixed-wing/rendezvous-1.toml");
    let command = format!("python3 {}", example("planner.py").display());
    let shipped = shipped.display().to_string();
    let output = workplace.harness(&["run", &shipped, "--record", "none", "--planner-command", &command]);
    assert_eq!(code(&output), 0, "{}{}", stdout(&output), stderr(&output));
    assert!(stdout(&output).contains("PASS  rendezvous-1 · planner"), "{}", stdout(&output));
}

#[test]
fn an_in_loop_planner_flies_its_scenario() {
    if !has_python("numpy") {
        return;
    }
    let workplace = Workplace::new(&[]);
    let own = example("online.toml").display().to_string();
    let output = workplace.harness(&["run", &own, "--record", "none"]);
    assert_eq!(code(&output), 0, "{}{}", stdout(&output), stderr(&output));
    assert!(stdout(&output).contains("PASS  online · straight-on"), "{}", stdout(&output));
    let command = format!("python3 {}", example("online.py").display());
    let output = workplace.harness(&["run", &own, "--record", "none", "--planner-command", &command, "--in-loop"]);
    assert_eq!(code(&output), 0, "{}{}", stdout(&output), stderr(&output));
    assert!(stdout(&output).contains("PASS  online · online"), "{}", stdout(&output));
}

#[test]
fn a_planner_that_crashes_is_a_verdict_and_the_others_run() {
    let external = PAIR
        .replace("\"pair\"", "\"broken\"")
        .replace("name = \"parallel-scp\"\nintervals = 20", "name = \"theirs\"\ncommand = [\"sh\", \"planner.sh\"]");
    assert!(external.contains("planner.sh"));
    let script = "echo 'I give up' >&2\nexit 3\n";
    let files = [("all/broken.toml", external.as_str()), ("all/pair.toml", PAIR), ("all/planner.sh", script)];
    let workplace = Workplace::new(&files);
    let output = workplace.harness(&["run", "all", "--record", "none"]);
    let page = stdout(&output);
    assert_eq!(code(&output), 1, "{page}{}", stderr(&output));
    let verdict = "NO PLAN  broken · theirs  it ended with exit code 3; the last line in planner.log: I give up";
    assert!(page.contains(verdict), "{page}");
    assert!(page.contains("PASS  pair · parallel-scp") && page.contains("1 passed, 1 without a plan"), "{page}");
    assert_eq!(workplace.json("out/broken/theirs/report.json")["verdict"], "no-plan");
    assert_eq!(fs::read_to_string(workplace.path("out/broken/theirs/planner.log")).unwrap(), "I give up\n");
}

#[test]
fn a_planner_that_hangs_is_terminated_at_its_time_limit() {
    let workplace = Workplace::new(&[("pair.toml", PAIR)]);
    let arguments = ["run", "pair.toml", "--record", "none", "--planner-command", "sleep 600", "--time-limit", "0.3"];
    let output = workplace.harness(&arguments);
    assert_eq!(code(&output), 1, "{}", stderr(&output));
    assert!(
        stdout(&output).contains("it took longer than its limit of 0.3 s and was terminated"),
        "{}",
        stdout(&output)
    );
}

/// Ctrl-C terminates the planner as well, although it is in a process group of its own.
#[test]
#[cfg(unix)]
fn an_interrupted_run_terminates_its_planner() {
    let workplace = Workplace::new(&[("pair.toml", PAIR)]);
    let alive = workplace.path("alive");
    let script = format!("touch started; sleep 3; touch {}", alive.display());
    fs::write(workplace.path("planner.sh"), script).unwrap();
    let mut harness = Command::new(env!("CARGO_BIN_EXE_harness"))
        .current_dir(workplace.path(""))
        .args(["run", "pair.toml", "--record", "none", "-q", "--planner-command", "sh planner.sh"])
        .spawn()
        .unwrap();
    while !workplace.path("started").exists() {
        std::thread::sleep(std::time::Duration::from_millis(20));
    }
    let kill = Command::new("kill").args(["-INT", &harness.id().to_string()]).status().unwrap();
    assert!(kill.success());
    assert_eq!(harness.wait().unwrap().code(), Some(130));
    std::thread::sleep(std::time::Duration::from_secs(4));
    assert!(!alive.exists(), "the planner survived");
}

#[test]
fn invalid_settings_are_errors_with_their_field() {
    let with = |planner: &str| PAIR.replace("name = \"parallel-scp\"\nintervals = 20", planner);
    for (planner, message) in [
        ("name = \"theirs\"\ncommand = []", "planner.command: found no program"),
        ("name = \"parallel-scp\"\ncommand = [\"true\"]", "another name for a planner"),
        ("name = \"a/b\"\ncommand = [\"true\"]", "planner.name: found \"a/b\""),
        ("name = \"theirs\"\ncommand = [\"true\"]\ntime_limit_s = 0", "planner.time_limit_s: found 0"),
        ("name = \"parallel-scp\"\noptions = { speed = 3 }", "planner.options: found an option of external planners"),
    ] {
        let workplace = Workplace::new(&[("pair.toml", &with(planner))]);
        let output = workplace.harness(&["run", "pair.toml"]);
        assert_eq!(code(&output), 2, "{planner}");
        let errors = stderr(&output).replace("\n", " ");
        assert!(errors.contains(message), "{planner}: {errors}");
    }
}
