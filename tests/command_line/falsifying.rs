//! `harness falsify` and `harness shrink`.

use crate::workplace::{PAIR, Workplace, code, has_python, stderr, stdout};

/// Two aircraft whose paths cross, planned with six intervals: nothing keeps them apart between the nodes.
fn crossing() -> String {
    let [left, right] = ["goal = { x_m = 1000, y_m = -100,", "goal = { x_m = 1000, y_m = 100,"];
    assert!(PAIR.contains(left) && PAIR.contains(right));
    let swapped = PAIR.replace(left, "LEFT").replace(right, left).replace("LEFT", right);
    swapped.replace("intervals = 20", "intervals = 6")
}

/// The margin of a check, and whether it failed.
fn margin(workplace: &Workplace, report: &str, check: &str) -> (f64, bool) {
    let report = workplace.json(report);
    let found = report["checks"].as_array().unwrap().iter().find(|found| found["name"] == check).unwrap();
    (found["margin"].as_f64().unwrap(), found["status"] == "fail")
}

#[test]
fn a_failure_that_was_found_fails_again_to_the_bit() {
    let workplace = Workplace::new(&[("pair.toml", &crossing())]);
    let vary = ["--vary", "vehicles.uav-2.goal.y_m=-300..0", "--vary", "vehicles[0].start.x_m=0..200"];
    let search = |out: &str, more: &[&str]| {
        let asked = ["falsify", "pair.toml", "-n", "8", "--check", "plan.separation", "-o", out];
        let output = workplace.harness(&[&asked[..], &vary[..], more].concat());
        assert_eq!(code(&output), 1, "{}", stderr(&output));
        (stdout(&output), workplace.json(&format!("{out}/pair/parallel-scp/falsify.json")))
    };
    let (said, found) = search("one", &["-j", "1"]);
    assert!(said.contains("failure 1: plan.separation -") && said.contains("vehicles.uav-2.goal.y_m ="), "{said}");
    assert_eq!(search("two", &["-j", "2"]).1, found, "the number of threads decides nothing");
    assert_eq!(found["flights"].as_u64().unwrap(), 8);

    let scenario = "one/pair/parallel-scp/failures/pair-failure-1.toml";
    let output = workplace.harness(&["run", scenario, "--record", "none", "-q", "-o", "again"]);
    assert_eq!(code(&output), 1, "{}", stderr(&output));
    let (flown, fails) = margin(&workplace, "again/pair-failure-1/parallel-scp/report.json", "plan.separation");
    assert!(fails);
    assert_eq!(flown, found["failures"][0]["margin"].as_f64().unwrap());
}

#[test]
fn a_shrunk_scenario_is_smaller_and_fails_by_the_same_check() {
    let third = crossing()
        + "\n[[vehicles]]\nname = \"uav-3\"\nmodel = \"scout\"\n\
        start = { x_m = 0, y_m = 400.125, z_m = 400, speed_mps = 35 }\n\
        goal = { x_m = 1000, y_m = 400.125, z_m = 400, speed_mps = 35 }\n";
    let workplace = Workplace::new(&[("pair.toml", &third)]);
    let output = workplace.harness(&["shrink", "pair.toml", "--check", "plan.separation", "-n", "60"]);
    assert_eq!(code(&output), 0, "{}", stderr(&output));
    let small = "out/pair/parallel-scp/pair-small.toml";
    let text = std::fs::read_to_string(workplace.path(small)).unwrap();
    assert!(!text.contains("uav-3") && text.contains("uav-1") && text.contains("uav-2"), "{text}");
    assert!(text.contains("separation_m = 100"), "limits stay: {text}");
    let output = workplace.harness(&["run", small, "--record", "none", "-q", "-o", "again"]);
    assert_eq!(code(&output), 1, "{}", stderr(&output));
    assert!(margin(&workplace, "again/pair-small/parallel-scp/report.json", "plan.separation").1);
}

#[test]
fn a_scenario_that_passes_cannot_be_shrunk() {
    let workplace = Workplace::new(&[("pair.toml", PAIR)]);
    let output = workplace.harness(&["shrink", "pair.toml"]);
    assert_eq!(code(&output), 1);
    assert!(stderr(&output).contains("nothing to shrink"), "{}", stderr(&output));
    assert!(!workplace.path("out/pair/parallel-scp/pair-small.toml").exists());
}

/// The planner is a command in another folder than the failures that it leaves.
#[cfg(unix)]
#[test]
fn failures_of_a_command_are_repeated_from_their_own_folder() {
    if !has_python("numpy") {
        return;
    }
    let planner = include_str!("../../examples/external-planner/planner.py");
    let scenario = include_str!("../../scenarios/fixed-wing/rendezvous-1.toml");
    let workplace = Workplace::new(&[("rendezvous-1.toml", scenario), ("spline.py", planner)]);
    let output = workplace.harness(&[
        "falsify",
        "rendezvous-1.toml",
        "-n",
        "2",
        "--planner-command",
        "python3 spline.py",
        "--check",
        "plan.goal",
        "--vary",
        "vehicles.uav-1.goal.speed_mps=38..40",
    ]);
    assert_eq!(code(&output), 1, "{}{}", stdout(&output), stderr(&output));
    let scenario = "out/rendezvous-1/spline/failures/rendezvous-1-failure-1.toml";
    let output = workplace.harness(&["run", scenario, "--record", "none", "-o", "again"]);
    assert_eq!(code(&output), 1, "{}", stderr(&output));
    assert!(margin(&workplace, "again/rendezvous-1-failure-1/spline/report.json", "plan.goal").1);
}

#[test]
fn a_search_that_judges_nothing_is_no_all_clear() {
    let workplace = Workplace::new(&[("pair.toml", PAIR)]);
    for (arguments, wanted) in [
        (["--vary", "vehicles[0].start.x_m=1e9..2e9"], "nothing was judged"),
        (["--vary", "vehicles[0].goal.y_m=0..1"], "no check `flight.requirement.nosuch`"),
    ] {
        let check = if wanted.contains("nosuch") { &["--check", "flight.requirement.nosuch"][..] } else { &[] };
        for flights in ["5", "6"] {
            let output = workplace.harness(&[&["falsify", "pair.toml", "-n", flights][..], &arguments, check].concat());
            assert_eq!(code(&output), 2, "{}{}", stdout(&output), stderr(&output));
            assert!(stderr(&output).replace("\n  │ ", " ").contains(wanted), "{}", stderr(&output));
        }
    }
}

#[test]
fn wrong_fields_ranges_and_checks_are_refused() {
    let workplace = Workplace::new(&[("pair.toml", PAIR)]);
    for (arguments, wanted) in [
        (["--vary", "vehicles[7].goal.y_m=0..1", "-n", "1"], "vehicles[7].goal.y_m"),
        (["--vary", "vehicles[0].goal.y_m=1..0", "-n", "1"], "a field and its range"),
        (["--vary", "vehicles[0].goal.y_m=0..1", "--check", "plan.seperation"], "did you mean `plan.separation`?"),
    ] {
        let output = workplace.harness(&[&["falsify", "pair.toml"][..], &arguments[..]].concat());
        assert_eq!(code(&output), 2, "{arguments:?}");
        let said = stderr(&output).replace("\n  │ ", " ");
        assert!(said.contains(wanted), "{said}");
    }
}
