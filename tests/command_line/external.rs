//! External planners, from the command line.

use std::fs;
use std::path::{Path, PathBuf};
use std::process::{Command, Output};

use crate::workplace::{PAIR, Workplace, code, has_cpp_compiler, has_python, stderr, stdout};

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

/// Runs the scenario of the in-loop example with its planner, changed: `from` is replaced by `to`.
#[track_caller]
fn online(from: &str, to: &str, arguments: &[&str]) -> (Workplace, Output) {
    let example = fs::read_to_string(example("online.py")).unwrap();
    let script = example.replace(from, to);
    assert!(script != example, "`{from}` is not in the example");
    let scenario = fs::read_to_string(self::example("online.toml")).unwrap();
    let workplace = Workplace::new(&[("online.toml", &scenario), ("theirs.py", &script)]);
    let command = ["run", "online.toml", "--record", "none", "--planner-command", "python3 theirs.py", "--in-loop"];
    let output = workplace.harness(&[&command, arguments].concat());
    (workplace, output)
}

fn report(workplace: &Workplace) -> serde_json::Value {
    workplace.json("out/online/theirs/report.json")
}

fn planner_check(report: &serde_json::Value) -> &serde_json::Value {
    report["checks"].as_array().unwrap().iter().find(|check| check["name"] == "flight.planner").unwrap()
}

/// The line of the example before which faults are inserted.
const REPLY: &str = "    print(json.dumps";

#[test]
fn only_multirotors_are_planned_for_in_the_loop() {
    let in_scenario = PAIR
        .replace("\"pair\"", "\"named\"")
        .replace("name = \"parallel-scp\"\nintervals = 20", "name = \"theirs\"\ncommand = [\"true\"]\nin_loop = true");
    let workplace = Workplace::new(&[("pair.toml", PAIR), ("named.toml", &in_scenario)]);
    for arguments in [
        &["run", "pair.toml", "--planner-command", "true", "--in-loop"][..],
        &["sweep", "pair.toml", "-n", "1", "--planner-command", "true", "--in-loop"],
        &["run", "named.toml"],
    ] {
        let output = workplace.harness(arguments);
        assert_eq!(code(&output), 2, "{arguments:?}: {}", stderr(&output));
        let told = [stdout(&output), stderr(&output)].concat();
        assert!(told.contains("only for multirotors"), "{arguments:?}: {told}");
    }
}

#[test]
fn an_in_loop_planner_that_crashes_fails_a_check() {
    if !has_python("json") {
        return;
    }
    let fault = "    if request['t_s'] > 3: raise RuntimeError('out of memory')\n    print(json.dumps";
    let (workplace, output) = online(REPLY, fault, &[]);
    let page = stdout(&output);
    assert_eq!(code(&output), 1, "{page}{}", stderr(&output));
    assert!(page.contains("FAIL  online · theirs") && page.contains("flight.planner"), "{page}");
    let report = report(&workplace);
    let check = planner_check(&report);
    assert_eq!((&check["status"], &check["at_s"]), (&"fail".into(), &3.25.into()), "{check}");
    let reason = "it ended with exit code 1; the last line in planner.log: RuntimeError: out of memory";
    assert!(check["reason"].as_str().unwrap().ends_with(reason), "{check}");
    assert_eq!((&report["plan"]["status"], &report["plan"]["reason"]), (&"not-converged".into(), &reason.into()));
    assert!(report["metrics"]["in_loop"]["failed"].as_u64().unwrap() > 10);
    let junit = fs::read_to_string(workplace.path("out/junit.xml")).unwrap();
    assert!(junit.contains("RuntimeError: out of memory"), "{junit}");
}

#[test]
fn an_in_loop_planner_without_ids_is_accepted_with_a_note() {
    if !has_python("json") {
        return;
    }
    let chatty = "    print('[INFO] replanning')\n    print(json.dumps";
    let (workplace, output) = online(REPLY, chatty, &[]);
    assert_eq!(code(&output), 0, "{}", stdout(&output));
    assert!(stdout(&output).contains("are no replies: "), "{}", stdout(&output));
    assert!(report(&workplace)["metrics"]["in_loop"]["remarks"][0].as_str().unwrap().contains("`[INFO] replanning`"));
    let (workplace, output) = online("\"id\": request[\"id\"], ", "", &[]);
    assert_eq!(code(&output), 0, "{}", stdout(&output));
    assert!(stdout(&output).contains("protocol 1"), "{}", stdout(&output));
    let junit = fs::read_to_string(workplace.path("out/junit.xml")).unwrap();
    assert!(junit.contains("protocol 1"), "{junit}");
}

#[test]
fn in_loop_replies_that_do_not_match_fail_a_check() {
    if !has_python("json") {
        return;
    }
    for (from, to, reason) in [
        ("\"id\": request[\"id\"]", "\"id\": request[\"id\"] - 1", "has the id 0, and the request has 1"),
        ("flush=True)", "flush=True); print('{\"keep\": \"\"}', flush=True)", "repl"),
        ("\"fly\": ramp(", "\"path\": ramp(", "its reply is invalid: unknown field `path`"),
        ("request[\"takes_effect_s\"]", "request[\"takes_effect_s\"] + 1", "after it takes effect"),
        ("ramp(here, ", "ramp([here[0] - 0.5, *here[1:]], ", "0.500 m away from the reference in force"),
        (
            "own[\"planning_limits\"])}",
            "{\"speed_mps\": 9, \"acceleration_mps2\": 3})}",
            "the vehicle's limit is 3 m/s",
        ),
    ] {
        let (workplace, output) = online(from, to, &[]);
        assert_eq!(code(&output), 1, "{to}: {}", stdout(&output));
        let report = report(&workplace);
        let check = planner_check(&report);
        assert!(check["status"] == "fail" && check["reason"].as_str().unwrap().contains(reason), "{to}: {check}");
    }
}

#[test]
fn a_slow_in_loop_planner_is_reported_and_by_the_wall_clock_flown_late() {
    if !has_python("json") {
        return;
    }
    let slow = "    import time; time.sleep(0.2)\n    print(json.dumps";
    let (workplace, output) = online(REPLY, slow, &[]);
    assert_eq!(code(&output), 0, "{}", stdout(&output));
    assert!(stdout(&output).contains("took longer on this machine than their deadline"), "{}", stdout(&output));
    let report = report(&workplace);
    let (in_loop, times) = (&report["metrics"]["in_loop"], &report["timings"]["replans"]);
    // Most replies keep the reference: they cannot be late.
    let over_deadline = times["over_deadline"].as_u64().unwrap();
    let new = in_loop["replans"].as_u64().unwrap() - in_loop["kept"].as_u64().unwrap();
    assert!(in_loop["late"] == 0 && over_deadline == new && new > 0, "{over_deadline}: {in_loop}");
    let (workplace, output) = online(REPLY, slow, &["--planner-clock", "measured"]);
    assert!(!stdout(&output).contains("were flown in time"), "{}", stdout(&output));
    let report = self::report(&workplace);
    let in_loop = &report["metrics"]["in_loop"];
    assert!(in_loop["late"].as_u64().unwrap() > 0 && in_loop["latest_s"].as_f64().unwrap() > 0.1, "{in_loop}");
}

/// The example in C++, compiled as its first lines say.
#[test]
#[cfg(unix)]
fn the_example_in_cpp_flies_its_scenario() {
    if !has_cpp_compiler() {
        return;
    }
    let scenario = fs::read_to_string(example("online.toml")).unwrap();
    let workplace = Workplace::new(&[("online.toml", &scenario)]);
    let mut compiler = Command::new("c++");
    compiler.args(["-std=c++17", "-Wall", "-Werror", "-o"]).arg(workplace.path("online")).arg(example("online.cpp"));
    assert!(compiler.status().unwrap().success());
    let output =
        workplace.harness(&["run", "online.toml", "--record", "none", "--planner-command", "./online", "--in-loop"]);
    assert_eq!(code(&output), 0, "{}{}", stdout(&output), stderr(&output));
    let in_loop = &workplace.json("out/online/online/report.json")["metrics"]["in_loop"];
    assert!(in_loop["remarks"].is_null() && in_loop["failed"] == 0, "{in_loop}");
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
    assert!(page.contains("PASS  pair · parallel-scp") && page.contains("1 without a plan, 1 passed"), "{page}");
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

/// The scenario of an example, run in its folder: exit code and page.
fn run_example(scenario: &str) -> (i32, String) {
    let root = std::path::Path::new(env!("CARGO_MANIFEST_DIR"));
    let workplace = Workplace::new(&[]);
    let scenario = root.join("examples").join(scenario);
    let output = workplace.harness(&["run", scenario.to_str().unwrap(), "--record", "none"]);
    (code(&output), stdout(&output) + &stderr(&output))
}

#[test]
fn the_flatness_example_passes() {
    if has_python("numpy") {
        let (code, page) = run_example("flatness/pillar.toml");
        assert_eq!(code, 0, "{page}");
    }
}

/// The trapezoidal rule fails between its nodes only; the second scenario has what it lacks.
#[test]
fn the_casadi_example_fails_and_passes_as_it_says() {
    if has_python("numpy, casadi") {
        let (code, page) = run_example("casadi/trapezoid.toml");
        assert_eq!(code, 1, "{page}");
        let fails = |check: &str| page.lines().any(|line| line.starts_with(check) && line.contains(" fail "));
        for check in ["plan.clearance", "plan.dynamics", "plan.rollout"] {
            assert!(fails(check), "{check} does not fail in\n{page}");
        }
        assert!(!fails("nodes."), "{page}");
        let (code, page) = run_example("casadi/passes.toml");
        assert_eq!(code, 0, "{page}");
    }
}
