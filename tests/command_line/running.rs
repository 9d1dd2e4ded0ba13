//! `harness run`: exit codes, bad input, output.

use crate::workplace::{PAIR, Workplace, code, stderr, stdout};

/// No tracker stays within a nanometre in this wind.
const STRICT: &str = "[simulation]\nwind = { mean_mps = [0, 5, 0] }\n[verdict]\ntracking_max_m = 1e-9\n";

fn strict_pair() -> String {
    format!("{}\n{STRICT}", PAIR.replace("\"pair\"", "\"strict\""))
}

#[test]
fn a_passing_scenario_is_exit_code_0_and_one_line() {
    let workplace = Workplace::new(&[("pair.toml", PAIR)]);
    let output = workplace.harness(&["run", "pair.toml", "--record", "none"]);
    let page = stdout(&output);
    assert_eq!(code(&output), 0, "{page}{}", stderr(&output));
    assert!(page.lines().any(|line| line.starts_with("PASS  pair · parallel-scp  smallest margins: ")), "{page}");
    assert!(page.contains("skipped: flight.tension, flight.slack, flight.swing (no vehicle carries a load)"), "{page}");
    assert!(page.contains("1 passed; results in out"), "{page}");
}

#[test]
fn a_failed_check_is_named_and_is_exit_code_1() {
    let workplace = Workplace::new(&[("strict.toml", &strict_pair())]);
    let output = workplace.harness(&["run", "strict.toml", "--record", "none"]);
    assert_eq!(code(&output), 1, "{}", stderr(&output));
    let page = stdout(&output);
    let verdict = page.lines().find(|line| line.starts_with("FAIL  strict · parallel-scp")).expect("a verdict line");
    assert!(verdict.contains("flight.tracking_max -"), "{verdict}");
}

#[test]
fn an_advisory_check_that_fails_is_shown_but_does_not_decide() {
    let advisory = strict_pair() + "advisory = [\"flight.tracking_max\"]\n";
    let workplace = Workplace::new(&[("strict.toml", &advisory)]);
    let output = workplace.harness(&["run", "strict.toml", "--record", "none"]);
    let page = stdout(&output);
    assert_eq!(code(&output), 0, "{page}");
    assert!(page.contains("advisory checks failed: flight.tracking_max"), "{page}");
}

#[test]
fn a_bad_file_is_named_with_line_and_column_and_the_good_ones_still_run() {
    let bad = PAIR.replace("\"pair\"", "\"bad\"").replace("body_radius_m = 1.5", "body_radius_m = -1");
    let workplace = Workplace::new(&[("all/pair.toml", PAIR), ("all/deep/bad.toml", &bad)]);
    let output = workplace.harness(&["run", "all", "--record", "none"]);
    assert_eq!(code(&output), 2);
    let errors = stderr(&output);
    for part in ["all/deep/bad.toml:14:17", "models.fixed-wing.scout.body_radius_m", "found -1", "a number greater"] {
        assert!(errors.contains(part), "`{part}` is missing in\n{errors}");
    }
    assert!(stdout(&output).contains("1 refused as bad input, 1 passed"));
    assert_eq!(workplace.json("out/pair/parallel-scp/report.json")["verdict"], "pass");
    let refused = &workplace.json("out/summary.json")["refused"][0];
    assert_eq!(refused["file"], "all/deep/bad.toml");
    assert!(refused["faults"][0].as_str().unwrap().starts_with("all/deep/bad.toml:14:17: "), "{refused}");
}

#[test]
fn an_unknown_planner_in_a_scenario_is_located() {
    let workplace = Workplace::new(&[("pair.toml", &PAIR.replace("parallel-scp", "paralel-scp"))]);
    let output = workplace.harness(&["run", "pair.toml"]);
    let errors = stderr(&output);
    assert_eq!(code(&output), 2);
    for part in ["pair.toml:49:8", "planner.name", "found \"paralel-scp\"", "did you mean `parallel-scp`?"] {
        assert!(errors.contains(part), "`{part}` is missing in\n{errors}");
    }
}

#[test]
fn bad_usage_is_exit_code_2_and_leaves_nothing_behind() {
    let workplace = Workplace::new(&[("pair.toml", PAIR), ("empty/notes.txt", "")]);
    let cases: [(&[&str], &str); 6] = [
        (&["run", "pair.toml", "--planner", "paralel-scp"], "did you mean `parallel-scp`?"),
        (&["run", "missing.toml"], "missing.toml"),
        (&["run", "empty"], "empty: found no scenario file"),
        (&["run", "pair.toml", "--record", "bag"], "possible values: rrd, mcap, parquet, page, none"),
        (&["run", "pair.toml", "--jobs", "0"], "--jobs"),
        (&["run", "pair.toml", "--seed", "x"], "--seed"),
    ];
    for (arguments, message) in cases {
        let output = workplace.harness(arguments);
        assert_eq!(code(&output), 2, "{arguments:?}");
        assert!(stderr(&output).contains(message), "{arguments:?}: {}", stderr(&output));
        assert!(!workplace.path("out").exists(), "{arguments:?}");
    }
}

#[test]
fn two_scenarios_of_one_name_are_refused_before_anything_runs() {
    let workplace = Workplace::new(&[("a/pair.toml", PAIR), ("b/pair.toml", PAIR)]);
    let output = workplace.harness(&["run", "a", "b"]);
    assert_eq!(code(&output), 2);
    assert!(stderr(&output).contains("two scenarios are named `pair`"), "{}", stderr(&output));
}

#[test]
fn quiet_means_errors_only() {
    let workplace = Workplace::new(&[("pair.toml", PAIR)]);
    let output = workplace.harness(&["run", "pair.toml", "--record", "none", "--quiet"]);
    assert_eq!((code(&output), stdout(&output).as_str(), stderr(&output).as_str()), (0, "", ""));
    assert_eq!(workplace.json("out/summary.json")["runs"][0]["verdict"], "pass");
}

#[test]
fn without_a_terminal_progress_is_plain_lines_and_nothing_is_coloured() {
    let workplace = Workplace::new(&[("pair.toml", PAIR)]);
    let output = workplace.harness(&["run", "pair.toml", "--record", "none"]);
    let progress = stderr(&output);
    let stages: Vec<&str> =
        progress.lines().filter_map(|line| line.strip_prefix("[1/1] pair · parallel-scp: ")).collect();
    assert_eq!(stages.len(), 3, "{progress}");
    assert!(stages[0] == "planning" && stages[1].starts_with("flying ") && stages[2] == "judging", "{progress}");
    assert!(!progress.contains('\u{1b}') && !stdout(&output).contains('\u{1b}'));
}

#[test]
fn a_result_folder_that_cannot_be_created_is_an_error() {
    let workplace = Workplace::new(&[("pair.toml", PAIR), ("out", "a file, not a folder")]);
    let output = workplace.harness(&["run", "pair.toml", "--record", "none"]);
    assert_eq!(code(&output), 2);
    assert!(stderr(&output).contains("cannot write out/pair/parallel-scp"), "{}", stderr(&output));
}

#[test]
fn without_arguments_the_help_is_shown() {
    let output = Workplace::new(&[]).harness(&[]);
    assert_eq!(code(&output), 2);
    assert!(stderr(&output).contains("Examples:") && stderr(&output).contains("Exit codes:"));
}

/// The reader of standard error may close it early (`harness run 2>&1 | head`): bad input is still exit code 2.
#[test]
fn bad_input_is_exit_code_2_even_if_standard_error_is_closed() {
    let (reader, writer) = std::io::pipe().expect("a pipe");
    drop(reader);
    let status = std::process::Command::new(env!("CARGO_BIN_EXE_harness"))
        .args(["run", "no-such-scenario.toml"])
        .stderr(writer)
        .status()
        .expect("the harness starts");
    assert_eq!(status.code(), Some(2));
}

#[test]
fn the_table_shows_what_decides_in_80_columns_and_every_check_on_demand() {
    let workplace = Workplace::new(&[("strict.toml", &strict_pair())]);
    let brief = stdout(&workplace.harness(&["run", "strict.toml", "--record", "none"]));
    let table: Vec<&str> = brief.lines().take_while(|line| !line.contains("more checks passed")).collect();
    assert!(table.len() > 3 && table.iter().all(|line| line.chars().count() <= 80), "{brief}");
    assert!(table.iter().any(|line| line.starts_with("flight.tracking_max") && line.contains("fail")), "{brief}");
    assert!(!brief.contains("nodes.finite") && !brief.contains("plan.finite"), "{brief}");
    assert!(!brief.contains("uav-1 and uav-1"), "{brief}");
    let all = stdout(&workplace.harness(&["run", "strict.toml", "--record", "none", "-v"]));
    assert!(all.contains("plan.finite") && !all.contains("more checks passed"), "{all}");
}

/// What happened to the flight comes before what was wrong with the plan.
#[test]
fn the_headline_begins_with_the_flight() {
    let both = strict_pair() + "rollout_m = 1e-6\n";
    let workplace = Workplace::new(&[("strict.toml", &both)]);
    let page = stdout(&workplace.harness(&["run", "strict.toml", "--record", "none"]));
    let verdict = page.lines().find(|line| line.starts_with("FAIL  strict")).expect("a verdict line");
    let place = |check: &str| verdict.find(check).unwrap_or_else(|| panic!("{check} is missing in {verdict}"));
    assert!(place("flight.tracking_max") < place("plan.rollout"), "{verdict}");
}
