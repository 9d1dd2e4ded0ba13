//! `harness compare`, `harness baseline`, `harness run --baseline`.

use std::fs;

use crate::workplace::{PAIR, Workplace, code, stderr, stdout};

fn run(workplace: &Workplace, more: &[&str]) -> (i32, String) {
    let output = workplace.harness(&[&["run", "pair.toml", "--record", "none"], more].concat());
    (code(&output), stdout(&output) + &stderr(&output))
}

/// Changes a number in a report.
fn plant(workplace: &Workplace, path: &str, change: impl FnOnce(&mut serde_json::Value)) {
    let mut report = workplace.json(path);
    change(&mut report);
    fs::write(workplace.path(path), report.to_string()).unwrap();
}

fn flown_time(report: &mut serde_json::Value) -> &mut serde_json::Value {
    &mut report["metrics"]["flight"]["flight_time_s"]
}

#[test]
fn two_runs_of_one_version_are_equal_and_an_injected_loss_is_found() {
    let workplace = Workplace::new(&[("pair.toml", PAIR)]);
    run(&workplace, &["-o", "a", "--jobs", "1"]);
    run(&workplace, &["-o", "b", "--jobs", "2"]);
    let output = workplace.harness(&["compare", "a", "b"]);
    assert_eq!((code(&output), stdout(&output).trim()), (0, "1 result compared: 0 worse, 0 better"));

    plant(&workplace, "b/pair/parallel-scp/report.json", |report| {
        let time_s = flown_time(report).as_f64().unwrap();
        *flown_time(report) = (1.03 * time_s).into();
    });
    let output = workplace.harness(&["compare", "a", "b"]);
    let page = stdout(&output);
    assert_eq!(code(&output), 1, "{page}");
    assert!(page.contains("worse") && page.contains("flown time") && page.contains("pair · parallel-scp"), "{page}");
    let output = workplace.harness(&["compare", "b", "a"]);
    assert_eq!(code(&output), 0, "what is a loss one way is a gain the other way: {}", stdout(&output));
    assert!(stdout(&output).contains("1 better"));

    let output = workplace.harness(&["compare", "a", "b", "--format", "json-lines"]);
    let line: serde_json::Value = serde_json::from_str(&stdout(&output)).unwrap();
    assert_eq!((&line["event"], &line["comparison"]["compared"]), (&"comparison".into(), &1.into()));
    assert_eq!(line["comparison"]["differences"][0]["rating"], "worse");
}

#[test]
fn a_baseline_is_accepted_with_a_reason_and_compared_with_later_runs() {
    let workplace = Workplace::new(&[("pair.toml", PAIR)]);
    run(&workplace, &[]);
    let output = workplace.harness(&["baseline", "accept", "--reason", "the first"]);
    assert_eq!(code(&output), 0, "{}", stderr(&output));
    assert!(stdout(&output).contains("1 result accepted into baseline.json"), "{}", stdout(&output));
    assert_eq!(workplace.json("baseline.json")["accepted"][0]["reason"], "the first");

    let (exit, page) = run(&workplace, &["--baseline", "baseline.json"]);
    assert_eq!(exit, 0, "{page}");
    assert!(page.contains("1 result compared: 0 worse"), "{page}");

    // The same aircraft on a longer path.
    let longer = PAIR.replace("x_m = 1000,", "x_m = 1100,");
    fs::write(workplace.path("pair.toml"), longer).unwrap();
    let (exit, page) = run(&workplace, &["--baseline", "baseline.json"]);
    assert_eq!(exit, 1, "{page}");
    assert!(page.contains("planned flight time"), "{page}");
    assert!(fs::read_to_string(workplace.path("out/summary.md")).unwrap().contains("Against the baseline"));

    workplace.harness(&["baseline", "accept", "--reason", "a longer way"]);
    let (exit, page) = run(&workplace, &["--baseline", "baseline.json"]);
    assert_eq!(exit, 0, "{page}");
    assert_eq!(workplace.json("baseline.json")["accepted"].as_array().unwrap().len(), 2);
}

#[test]
fn what_cannot_be_compared_is_an_error() {
    let workplace = Workplace::new(&[("pair.toml", PAIR), ("empty/notes.txt", ""), ("broken.json", "{}")]);
    for arguments in [
        &["compare", "missing", "empty"][..],
        &["compare", "empty", "empty"],
        &["compare", "broken.json", "broken.json"],
        &["baseline", "accept", "empty", "--reason", "none"],
        &["baseline", "accept", "empty"],
        &["run", "pair.toml", "--baseline", "missing.json"],
    ] {
        let output = workplace.harness(arguments);
        assert_eq!(code(&output), 2, "{arguments:?}");
        assert!(!stderr(&output).is_empty());
    }
    assert!(!workplace.path("out").exists() && !workplace.path("baseline.json").exists());
}
