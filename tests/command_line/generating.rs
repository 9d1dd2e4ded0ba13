//! `harness generate` and `harness bench suite`.

use std::fs;

use serde_json::Value;

use crate::workplace::{Workplace, code, stderr, stdout};

#[test]
fn a_generated_scenario_names_the_command_that_reproduces_it() {
    let workplace = Workplace::new(&[]);
    let output = workplace.harness(&["generate", "fixed-wing", "--kind", "ring", "--size", "3", "--seed", "5"]);
    assert_eq!(code(&output), 0, "{}", stderr(&output));
    assert_eq!(workplace.files("generated"), ["ring-3-d5-s5.toml"]);
    let text = fs::read_to_string(workplace.path("generated/ring-3-d5-s5.toml")).unwrap();
    let command = text.lines().next().unwrap().split_once(": harness ").unwrap().1.to_owned();
    assert_eq!(command, "generate ring --size 3 --density 0.05 --seed 5");
    let again = workplace.harness(&[command.split(' ').collect::<Vec<_>>(), vec!["-o", "-"]].concat());
    assert_eq!(stdout(&again), text);
    assert!(text.contains("kind ring, size 3, density 0.05, seed 5"), "{text}");
}

#[test]
fn a_file_of_any_name_holds_a_scenario_of_that_name() {
    let workplace = Workplace::new(&[]);
    let generate = ["generate", "forest", "--size", "16", "--density", "0.05", "--hidden", "-o", "mine.toml"];
    assert_eq!(code(&workplace.harness(&generate)), 0);
    let output = workplace.harness(&["run", "mine.toml", "--record", "none"]);
    assert_eq!(code(&output), 0, "{}", stderr(&output));
    assert_eq!(workplace.json("out/mine/rhc/report.json")["verdict"], "pass");
}

#[test]
fn every_kind_of_a_family_with_several_seeds() {
    let workplace = Workplace::new(&[]);
    let output = workplace.harness(&["generate", "slung-load", "--size", "1", "--count", "2", "-o", "some"]);
    assert_eq!(code(&output), 0, "{}", stderr(&output));
    let files = workplace.files("some");
    assert_eq!(files.len(), 2 * 5, "{files:?}");
    assert_eq!(stdout(&output).lines().count(), files.len());
    assert!(files.contains(&"gates-1-s1.toml".to_owned()), "{files:?}");
}

#[test]
fn errors_name_the_valid_kinds_and_ranges() {
    let workplace = Workplace::new(&[]);
    for (arguments, expected) in [
        (&["rimg"][..], &["found `rimg`", "fixed-wing", "ring, mixed", "forest", "did you mean `ring`?"][..]),
        (&["multirotor", "--kind", "ring"], &["a kind of the family multirotor: field, forest"]),
        (&["ring", "--kind", "mixed"], &["`ring` is a kind already"]),
        (&["ring", "--size", "0"], &["--size 0", "(aircraft) is 1 to 100"]),
        (&["forest", "--density", "0.9"], &["--density 0.9", "0 to 0.25"]),
        (&["crossing", "--hidden"], &["--hidden", "`crossing`"]),
        (&["multirotor", "-o", "all.toml"], &["all.toml", "6 scenarios"]),
    ] {
        let output = workplace.harness(&[&["generate"], arguments].concat());
        assert_eq!(code(&output), 2, "{arguments:?}");
        let message = stderr(&output).replace('\n', " ");
        let words = message.split_whitespace().filter(|word| *word != "│").collect::<Vec<_>>().join(" ");
        assert!(expected.iter().all(|part| words.contains(part)), "{words}");
    }
    assert!(!workplace.path("generated").exists());
}

/// Smallest number of passes of each kind at its smallest size, when the test was written. A lower number is a regression of
/// the planner or of the generator; a higher one should be entered here.
const FLOORS: &[(&str, u64)] = &[
    ("ring", 4),
    ("ring --free-arrival", 4),
    ("mixed", 4),
    ("mixed --free-arrival", 4),
    ("transit", 4),
    ("transit --free-arrival", 4),
    ("uneven", 4),
    ("uneven --free-arrival", 4),
    ("headings", 4),
    ("headings --free-arrival", 4),
    ("near", 4),
    ("near --free-arrival", 4),
    ("blocks", 4),
    ("passages", 4),
    ("gates", 4),
    ("pick-up", 4),
    ("drop", 4),
    ("field", 4),
    ("field --hidden", 4),
    ("forest", 4),
    ("forest --hidden", 4),
    ("building", 4),
    ("building --hidden", 4),
    ("moving", 4),
    ("crossing", 4),
    ("courtyard", 4),
    ("courtyard --hidden", 4),
];

#[test]
fn bench_suite_finds_no_false_claim_in_a_hundred_scenarios() {
    let workplace = Workplace::new(&[]);
    let output = workplace.harness(&["bench", "suite", "--quick", "--jobs", "2", "--json"]);
    assert_eq!(code(&output), 0, "{}", stderr(&output));
    let results = workplace.json("out/bench/suite.json");
    assert_eq!(serde_json::from_str::<Value>(&stdout(&output)).unwrap(), results);
    let rows = results["rows"].as_array().unwrap();
    let number = |row: &Value, field: &str| row[field].as_u64().unwrap();
    let runs: u64 = rows.iter().map(|row| number(row, "runs")).sum();
    assert!(runs >= 100, "{runs}");
    for row in rows {
        assert_eq!(number(row, "overclaimed"), 0, "{row}");
        let variant = row["variant"].as_str().map_or_else(String::new, |variant| format!(" --{variant}"));
        let name = format!("{}{variant}", row["kind"].as_str().unwrap());
        let floor = FLOORS.iter().find(|(kind, _)| *kind == name).unwrap_or_else(|| panic!("no floor for {name}")).1;
        assert!(number(row, "pass") >= floor, "{row}");
    }
    let failures = results["failures"].as_array().unwrap();
    let passed: u64 = rows.iter().map(|row| number(row, "pass")).sum();
    assert_eq!(failures.len() as u64, runs - passed);
    for failure in failures {
        assert!(workplace.path(failure["file"].as_str().unwrap()).exists(), "{failure}");
    }
}

#[test]
fn bench_suite_runs_the_selected_kinds_and_planners() {
    let workplace = Workplace::new(&[]);
    let asked = ["--kind", "field", "--size", "16", "--density", "0.05", "--seeds", "2", "--first-seed", "7"];
    let planners = ["-p", "rhc", "-p", "sparse-astar", "-p", "fleet-scp"];
    let output = workplace.harness(&[&["bench", "suite"][..], &asked, &planners].concat());
    assert_eq!(code(&output), 0, "{}", stderr(&output));
    let rows = workplace.json("out/bench/suite.json")["rows"].as_array().unwrap().clone();
    let of_rows: Vec<(Value, Value)> =
        rows.iter().map(|row| (row["variant"].clone(), row["planner"].clone())).collect();
    let hidden = Value::from("hidden");
    let [rhc, astar] = ["rhc", "sparse-astar"].map(Value::from);
    assert_eq!(
        of_rows,
        [(Value::Null, rhc.clone()), (Value::Null, astar.clone()), (hidden.clone(), rhc), (hidden, astar)]
    );
    assert!(rows.iter().all(|row| row["runs"] == 2 && row["size"] == 16 && row["density"] == 0.05));
    assert_eq!(stderr(&output).lines().count(), 1 + 8, "one line of progress for each run: {}", stderr(&output));
    assert!(stderr(&output).contains("[1/8] field-16-d5-s7 · rhc: pass"), "{}", stderr(&output));
    let page = fs::read_to_string(workplace.path("out/bench/suite.md")).unwrap();
    assert!(page.contains("| field --hidden | 16 | 0.05 | 2 | "), "{page}");
}

#[test]
fn bench_suite_terminates_runs_at_the_time_limit_and_keeps_the_scenario() {
    let workplace = Workplace::new(&[]);
    let asked = ["--kind", "blocks", "--size", "3", "--seeds", "1", "--limit-s", "0.001"];
    let output = workplace.harness(&[&["bench", "suite"][..], &asked].concat());
    assert_eq!(code(&output), 0, "{}", stderr(&output));
    let results = workplace.json("out/bench/suite.json");
    assert_eq!(results["rows"][0]["timed_out"], 1);
    assert_eq!(results["failures"][0]["outcome"], "timed-out");
    assert_eq!(workplace.files("out/bench/suite"), ["blocks-3-d20-s0.toml"]);
    assert!(
        stdout(&output).contains("harness run out/bench/suite/blocks-3-d20-s0.toml -p slung-lgr"),
        "{}",
        stdout(&output)
    );
}

#[test]
fn options_of_another_benchmark_are_refused() {
    let workplace = Workplace::new(&[]);
    for arguments in [&["bench", "ipm", "--kind", "ring"][..], &["bench", "suite", "scenarios"]] {
        let output = workplace.harness(arguments);
        assert_eq!(code(&output), 2, "{arguments:?}");
        assert!(stderr(&output).contains("does not belong to this benchmark"), "{}", stderr(&output));
    }
}
