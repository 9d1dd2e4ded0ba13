//! `harness check`: plans from files.

use std::fs;

use crate::workplace::{PAIR, Workplace, code, shooting_pair, stderr, stdout};

/// A workplace with a plan of the pair by a planner of the harness, reduced to its first `columns` columns.
fn planned(columns: usize) -> Workplace {
    let workplace = Workplace::new(&[("pair.toml", &shooting_pair())]);
    let output = workplace.harness(&["run", "pair.toml", "--record", "none", "-q"]);
    assert_eq!(code(&output), 0, "{}", stderr(&output));
    let csv = fs::read_to_string(workplace.path("out/pair/parallel-scp/plan.csv")).unwrap();
    let cut = |line: &str| line.split(',').take(columns).collect::<Vec<_>>().join(",") + "\n";
    fs::write(workplace.path("theirs.csv"), csv.lines().map(cut).collect::<String>()).unwrap();
    workplace
}

fn check(workplace: &Workplace, plan: &str) -> (i32, String, String) {
    let output = workplace.harness(&["check", "pair.toml", "--plan", plan, "--record", "none"]);
    (code(&output), stdout(&output), stderr(&output))
}

#[test]
fn a_plan_of_the_harness_keeps_its_verdict_in_either_format() {
    let workplace = planned(11);
    for (plan, name) in [("theirs.csv", "theirs"), ("out/pair/parallel-scp/plan.json", "plan")] {
        let (code, page, errors) = check(&workplace, plan);
        assert_eq!(code, 0, "{page}{errors}");
        let [ours, theirs] =
            ["parallel-scp", name].map(|planner| workplace.json(&format!("out/pair/{planner}/report.json")));
        assert_eq!(theirs["planner"], name);
        assert_eq!(theirs["checks"], ours["checks"], "{plan}");
        assert_eq!(theirs["metrics"], ours["metrics"], "{plan}");
    }
}

#[test]
fn results_of_an_earlier_run_do_not_outlive_a_refusal() {
    let workplace = planned(11);
    assert_eq!(check(&workplace, "theirs.csv").0, 0);
    let results = ["out/summary.json", "out/summary.md", "out/junit.xml", "out/pair/theirs/report.json"];
    assert!(results.iter().all(|file| workplace.path(file).exists()));
    fs::write(workplace.path("theirs.csv"), "vehicle,t_s\nuav-1,nan\n").unwrap();
    assert_eq!(check(&workplace, "theirs.csv").0, 2);
    let left: Vec<_> = results.iter().filter(|file| workplace.path(file).exists()).collect();
    assert!(left.is_empty(), "{left:?}");
}

#[test]
fn missing_controls_are_reconstructed_and_reported() {
    let workplace = planned(8);
    let (code, page, errors) = check(&workplace, "theirs.csv");
    assert_eq!(code, 0, "{page}{errors}");
    assert!(page.contains("skipped: nodes.control_limits (the plan gives no controls)"), "{page}");
    assert!(page.contains("skipped: plan.rollout"), "{page}");
    assert!(page.contains("controls reconstructed: they miss the nodes by"), "{page}");
    let report = workplace.json("out/pair/theirs/report.json");
    let missed_m = report["plan"]["reconstruction"]["position_m"].as_f64().unwrap();
    assert!(missed_m < 1e-3, "{missed_m} m");
    assert_eq!(report["plan"]["status"], "unstated");
}

#[test]
fn a_required_check_that_the_plan_does_not_allow_fails() {
    let workplace = planned(8);
    let strict = format!("{}\n[verdict]\nrequired = [\"plan.rollout\"]\n", shooting_pair());
    fs::write(workplace.path("pair.toml"), strict).unwrap();
    let (code, page, _) = check(&workplace, "theirs.csv");
    assert_eq!(code, 1, "{page}");
    let report = workplace.json("out/pair/theirs/report.json");
    let checks = report["checks"].as_array().unwrap();
    let rollout = checks.iter().find(|check| check["name"] == "plan.rollout").unwrap();
    assert_eq!(rollout["status"], "fail");
    let reason = rollout["reason"].as_str().unwrap();
    assert!(reason.starts_with("required, but it could not be asked: the plan gives no controls"), "{reason}");
}

#[test]
fn plans_of_positions_are_judged_with_their_uncertainty() {
    let workplace = planned(5);
    let (_, page, errors) = check(&workplace, "theirs.csv");
    assert!(page.contains("skipped: nodes.state_limits (the plan gives no velocities)"), "{page}{errors}");
    assert!(page.contains("velocities and controls reconstructed"), "{page}");
}

#[test]
fn a_plan_that_ends_in_the_wrong_place_fails() {
    let workplace = planned(11);
    let scenario = shooting_pair().replace("goal = { x_m = 1000, y_m = 100,", "goal = { x_m = 1000, y_m = 120,");
    fs::write(workplace.path("pair.toml"), scenario).unwrap();
    let (code, page, _) = check(&workplace, "theirs.csv");
    assert_eq!(code, 1, "{page}");
    assert!(page.contains("plan.goal") && page.contains("FAIL  pair · theirs"), "{page}");
}

#[test]
fn an_invalid_plan_file_is_exit_code_2_and_leaves_nothing_behind() {
    let csv = "vehicle,t_s,x_m,y_m,z_m\nuav-1,0,0,-100,400\nuav-1,10,350,-100,400\nuav-3,0,0,100,400\n";
    let workplace = Workplace::new(&[("pair.toml", PAIR), ("theirs.csv", csv), ("theirs.doc", csv)]);
    let (exit, _, errors) = check(&workplace, "theirs.csv");
    assert_eq!(exit, 2);
    for part in
        ["theirs.csv is not a valid plan for `pair`: 2 errors", "theirs.csv:4", "found \"uav-3\"", "no row of `uav-2`"]
    {
        assert!(errors.contains(part), "`{part}` is missing in\n{errors}");
    }
    for (plan, message) in [("theirs.doc", "ends in .csv, .json or"), ("missing.csv", "missing.csv")] {
        let (exit, _, errors) = check(&workplace, plan);
        assert_eq!(exit, 2);
        assert!(errors.contains(message), "{errors}");
    }
    assert!(!workplace.path("out").exists());
}
