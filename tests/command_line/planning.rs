//! `harness plan`.

use std::fs;

use crate::workplace::{PAIR, Workplace, code, stderr, stdout};

#[test]
fn a_plan_is_written_without_a_flight_and_check_reads_it() {
    let workplace = Workplace::new(&[("pair.toml", PAIR)]);
    for file in ["plan.csv", "plan.json"] {
        let output = workplace.harness(&["plan", "pair.toml", "-o", file]);
        assert_eq!(code(&output), 0, "{}", stderr(&output));
        assert!(stdout(&output).contains(&format!("plan: solved; written to {file}")), "{}", stdout(&output));
        assert!(!workplace.path("out").exists());
    }
    let output = workplace.harness(&["check", "pair.toml", "--plan", "plan.csv", "--record", "none", "-q"]);
    assert_eq!(code(&output), 0, "{}", stderr(&output));
}

#[test]
fn a_dash_prints_nothing_but_the_plan() {
    let workplace = Workplace::new(&[("pair.toml", PAIR)]);
    let output = workplace.harness(&["plan", "pair.toml", "-o", "-"]);
    let plan: serde_json::Value = serde_json::from_str(&stdout(&output)).unwrap();
    assert_eq!((&plan["status"], plan["trajectories"].as_array().unwrap().len()), (&"solved".into(), 2));
}

#[test]
fn no_plan_is_exit_code_1_and_leaves_the_old_file() {
    let workplace = Workplace::new(&[("pair.toml", PAIR), ("plan.csv", "old")]);
    let output = workplace.harness(&["plan", "pair.toml", "-o", "plan.csv", "--planner-command", "false"]);
    assert_eq!(code(&output), 1);
    assert!(stderr(&output).contains("no plan: it ended with exit code 1"), "{}", stderr(&output));
    assert_eq!(fs::read_to_string(workplace.path("plan.csv")).unwrap(), "old");
}

#[test]
fn bad_usage_is_exit_code_2() {
    let workplace = Workplace::new(&[("pair.toml", PAIR)]);
    for (arguments, message) in [
        (&["plan", "pair.toml", "-o", "plan.txt"][..], "written as .json or .csv"),
        (&["plan", "missing.toml"], "missing.toml"),
        (&["plan", "pair.toml", "-p", "paralel-scp"], "did you mean `parallel-scp`?"),
        (&["plan", "pair.toml", "-p", "parallel-scp", "-p", "parallel-scp"], "one planner makes one plan"),
    ] {
        let output = workplace.harness(arguments);
        assert_eq!(code(&output), 2, "{arguments:?}");
        assert!(stderr(&output).contains(message), "{arguments:?}: {}", stderr(&output));
    }
}
