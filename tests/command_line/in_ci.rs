//! What CI servers and tools read: JUnit, the job's summary, annotations, JSON lines.

use std::fs;
use std::process::{Command, Output};

use serde_json::Value;

use crate::workplace::{PAIR, Workplace, code, stderr, stdout};

/// A folder with a scenario that passes, one that fails, one without a plan, and a file that is not a scenario.
fn workplace() -> Workplace {
    let failing = PAIR.replace("\"pair\"", "\"strict\"")
        + "\n[simulation]\nwind = { mean_mps = [0, 5, 0] }\n[verdict]\ntracking_max_m = 0.001\n";
    let lost = PAIR
        .replace("\"pair\"", "\"lost\"")
        .replace("name = \"parallel-scp\"\nintervals = 20", "name = \"theirs\"\ncommand = [\"false\"]");
    let bad = PAIR.replace("\"pair\"", "\"bad\"").replace("body_radius_m = 1.5", "body_radius_m = -1");
    Workplace::new(&[
        ("all/pair.toml", PAIR),
        ("all/strict.toml", &failing),
        ("all/lost.toml", &lost),
        ("all/bad.toml", &bad),
    ])
}

fn on_github(workplace: &Workplace, arguments: &[&str]) -> Output {
    Command::new(env!("CARGO_BIN_EXE_harness"))
        .current_dir(workplace.path(""))
        .env("GITHUB_ACTIONS", "true")
        .env("GITHUB_WORKSPACE", workplace.path(""))
        .env("GITHUB_STEP_SUMMARY", workplace.path("step.md"))
        .args(arguments)
        .output()
        .unwrap()
}

/// Ant's schema has times without a zone; the reader wants one.
fn in_utc(xml: &str) -> String {
    let mut parts = xml.split("timestamp=\"");
    let head = parts.next().unwrap_or_default().to_owned();
    parts.fold(head, |text, rest| format!("{text}timestamp=\"{}Z{}", &rest[..19], &rest[19..]))
}

#[test]
fn junit_has_a_suite_per_result_and_a_case_per_check() {
    let workplace = workplace();
    let output = workplace.harness(&["run", "all", "--record", "none", "-q"]);
    assert_eq!(code(&output), 2);
    let xml = fs::read_to_string(workplace.path("out/junit.xml")).unwrap();
    let document = quick_junit::Report::deserialize_from_str(&in_utc(&xml)).expect("junit.xml is well formed");
    let suite = |name: &str| document.test_suites.iter().find(|suite| suite.name.as_str() == name).expect(name);
    let pair = suite("pair · parallel-scp");
    assert_eq!(
        (pair.tests, pair.failures, pair.errors),
        (scenarios::check_names(scenarios::Family::FixedWing).count(), 0, 0)
    );
    let strict = suite("strict · parallel-scp");
    assert!(strict.failures > 0 && strict.errors == 0);
    let lost = suite("lost · theirs");
    assert_eq!((lost.failures, lost.errors), (0, 1));
    assert_eq!(suite("all/bad.toml").errors, 1);
    let tracking = xml
        .split("<testcase ")
        .find(|case| case.starts_with("name=\"flight.tracking_max\"") && case.contains("failure"));
    let tracking = tracking.expect("a failed case");
    for part in ["limit 0.001 m", "margin -", "uav-", " s, "] {
        assert!(tracking.contains(part), "`{part}` is missing in {tracking}");
    }
    assert!(xml.contains("it ended with exit code 1") && xml.contains("body_radius_m: found -1"));
}

#[test]
fn github_gets_a_summary_and_annotations_on_the_lines_that_matter() {
    let workplace = workplace();
    fs::write(workplace.path("step.md"), "# What an earlier step said\n").unwrap();
    let output = on_github(&workplace, &["run", "all", "--record", "none"]);
    let page = stdout(&output);
    let annotations: Vec<&str> = page.lines().filter(|line| line.starts_with("::error ")).collect();
    assert!(annotations.len() <= 10 && annotations.len() >= 3, "{annotations:#?}");
    let line_of = |name: &str, word: &str| {
        let text = fs::read_to_string(workplace.path(name)).unwrap();
        text.lines().position(|line| line.starts_with(word)).expect(word) + 1
    };
    let tracking = format!("file=all/strict.toml,line={}", line_of("all/strict.toml", "tracking_max_m"));
    let is_there = |parts: &[&str]| annotations.iter().any(|line| parts.iter().all(|part| line.contains(part)));
    assert!(is_there(&[&tracking, "flight.tracking_max", "::", "limit 0.001 m"]), "{annotations:#?}");
    let command = format!("file=all/lost.toml,line={}", line_of("all/lost.toml", "command"));
    assert!(is_there(&[&command, "no plan", "exit code 1"]), "{annotations:#?}");
    let radius = format!("file=all/bad.toml,line={}", line_of("all/bad.toml", "body_radius_m"));
    assert!(is_there(&[&radius, "found -1"]), "{annotations:#?}");

    let summary = fs::read_to_string(workplace.path("step.md")).unwrap();
    assert!(
        summary
            .starts_with("# What an earlier step said\n# 1 refused as bad input, 1 failed, 1 without a plan, 1 passed"),
        "{summary}"
    );
    let place = |text: &str| summary.find(text).unwrap_or_else(|| panic!("`{text}` is missing in {summary}"));
    assert!(place("| FAIL |") < place("| PASS |") && place("| NO PLAN |") < place("| PASS |"));
    assert!(place("## strict · parallel-scp") > 0 && place("`flight.tracking_max`") > 0);
}

#[test]
fn nothing_is_annotated_elsewhere() {
    let output = workplace().harness(&["run", "all", "--record", "none"]);
    assert!(!stdout(&output).contains("::error"));
}

#[test]
fn standard_output_holds_json_lines_only() {
    let workplace = workplace();
    let output = on_github(&workplace, &["run", "all", "--record", "none", "--format", "json-lines"]);
    let lines: Vec<Value> = stdout(&output).lines().map(|line| serde_json::from_str(line).expect(line)).collect();
    let events: Vec<&str> = lines.iter().map(|line| line["event"].as_str().unwrap()).collect();
    assert_eq!(events, ["refused", "report", "report", "report", "summary"]);
    assert_eq!(lines[0]["file"], "all/bad.toml");
    let verdicts: Vec<&str> = lines[1..4].iter().map(|line| line["report"]["verdict"].as_str().unwrap()).collect();
    assert_eq!(verdicts, ["no-plan", "pass", "fail"]);
    assert_eq!((&lines[4]["exit_code"], code(&output)), (&2.into(), 2));
    assert!(stderr(&output).contains("::error "), "annotations go where they do no harm");
}

/// A margin that shrinks beyond its tolerance fails the run although every check passes, in everything that CI shows.
#[test]
fn a_loss_against_the_baseline_is_in_junit_in_an_annotation_and_first_in_the_summary() {
    let workplace = Workplace::new(&[("pair.toml", PAIR)]);
    workplace.harness(&["run", "pair.toml", "--record", "none", "-q"]);
    assert_eq!(code(&workplace.harness(&["baseline", "accept", "--reason", "the first"])), 0);
    let against_baseline = &["run", "pair.toml", "--record", "none", "--baseline", "baseline.json"];
    let case = |kind: &str| {
        let xml = fs::read_to_string(workplace.path("out/junit.xml")).unwrap();
        let case =
            xml.split("<testcase ").find(|case| case.starts_with("name=\"baseline\"")).expect("a case").to_owned();
        assert_eq!(case.contains("<failure"), kind == "failure", "{case}");
        case
    };

    let output = on_github(&workplace, against_baseline);
    assert_eq!(code(&output), 0, "{}", stderr(&output));
    assert!(!stdout(&output).contains("::error"));
    assert_eq!(workplace.json("out/summary.json")["worse_than_baseline"], 0);
    case("success");

    fs::write(workplace.path("pair.toml"), PAIR.replace("separation_m = 100", "separation_m = 120")).unwrap();
    fs::remove_file(workplace.path("step.md")).unwrap();
    let output = on_github(&workplace, against_baseline);
    assert_eq!(code(&output), 1, "{}", stderr(&output));
    let failure = case("failure");
    for part in
        ["worse-than-baseline", "margin of flight.separation: 99.999 m before, 79.967 m now, -20.032 m (tolerance"]
    {
        assert!(failure.contains(part), "`{part}` is missing in {failure}");
    }
    let line = PAIR.lines().position(|line| line.starts_with("separation_m")).unwrap() + 1;
    let page = stdout(&output);
    let annotations: Vec<&str> = page.lines().filter(|line| line.starts_with("::error ")).collect();
    assert_eq!(annotations.len(), 1, "{annotations:#?}");
    let expected = format!("::error file=pair.toml,line={line},title=pair · parallel-scp%3A worse than the baseline::");
    assert!(annotations[0].starts_with(&expected) && annotations[0].contains("79.967 m now"), "{annotations:#?}");
    for file in ["out/summary.md", "step.md"] {
        let summary = fs::read_to_string(workplace.path(file)).unwrap();
        assert!(summary.starts_with("# 1 worse than the baseline, 1 passed\n"), "{file}: {summary}");
    }
    assert!(page.contains("1 worse than the baseline, 1 passed"), "{page}");

    let output = on_github(&workplace, &[&against_baseline[..], &["--format", "json-lines"]].concat());
    let lines: Vec<Value> = stdout(&output).lines().map(|line| serde_json::from_str(line).expect(line)).collect();
    let summary = lines.iter().find(|line| line["event"] == "summary").unwrap();
    assert_eq!((&summary["exit_code"], &summary["summary"]["worse_than_baseline"]), (&1.into(), &1.into()));
}

/// Passed, failed, advisory, undecided, no plan, refused, worse than a baseline: every kind of entry in the file.
#[test]
fn junit_is_valid_against_the_schemas_of_jenkins_and_of_ant() {
    let workplace = workplace();
    workplace.harness(&["run", "all/pair.toml", "--record", "none", "-q"]);
    assert_eq!(code(&workplace.harness(&["baseline", "accept", "--reason", "the first"])), 0);
    fs::write(workplace.path("all/pair.toml"), PAIR.replace("separation_m = 100", "separation_m = 120")).unwrap();
    let output = workplace.harness(&["run", "all", "--record", "none", "-q", "--baseline", "baseline.json"]);
    assert_eq!(code(&output), 2);
    let xml = fs::read_to_string(workplace.path("out/junit.xml")).unwrap();
    for part in
        ["worse-than-baseline", "no-plan", "bad-input", "name=\"flight.separation.margin\" value=\"79.967", "hostname="]
    {
        assert!(xml.contains(part), "`{part}` is missing in {xml}");
    }
    assert!(xml.lines().any(|line| line.starts_with("pass ") && line.contains("flight.separation: measured")), "{xml}");
    if Command::new("xmllint").arg("--version").output().is_err() {
        return crate::workplace::skip_without("xmllint (libxml2-utils)");
    }
    for schema in ["jenkins", "ant"] {
        let schema = std::path::Path::new(env!("CARGO_MANIFEST_DIR")).join(format!("tests/junit/{schema}.xsd"));
        let mut command = Command::new("xmllint");
        let output = command.args(["--noout", "--schema"]).arg(&schema).arg(workplace.path("out/junit.xml")).output();
        let output = output.unwrap();
        assert!(output.status.success(), "{}: {}", schema.display(), stderr(&output));
    }
}
