//! The files of a run.

use std::fs;

use scenarios::fixed_wing::CSV_COLUMNS;
use scenarios::{Family, Plan, check_names};
use serde_json::Value;

use crate::workplace::{PAIR, Workplace, code, stderr, stdout};

const FOLDER: &str = "out/pair/parallel-scp";

/// A scenario with every source of randomness.
fn disturbed_pair() -> String {
    let disturbances = "[simulation]\n\
        wind = { mean_mps = [1, 2, 0], gusts = { wind_at_20ft_mps = 5, sigma_aloft_mps = 1 } }\n\
        sensors = { position_noise_m = 0.1, velocity_noise_mps = 0.1 }\n";
    format!("{PAIR}\n{disturbances}")
}

fn run(workplace: &Workplace, more: &[&str]) {
    let arguments = [&["run", "pair.toml", "--quiet"], more].concat();
    let output = workplace.harness(&arguments);
    assert!(code(&output) < 2, "{}", stderr(&output));
}

/// The value without what depends on the machine: `timings`, `wall_s`, `distributed_s`.
fn reproducible(value: Value) -> Value {
    match value {
        Value::Object(object) => {
            let is_reproducible = |key: &String| !["timings", "wall_s", "distributed_s"].contains(&key.as_str());
            let kept = object.into_iter().filter(|(key, _)| is_reproducible(key));
            Value::Object(kept.map(|(key, inner)| (key, reproducible(inner))).collect())
        }
        Value::Array(values) => Value::Array(values.into_iter().map(reproducible).collect()),
        other => other,
    }
}

#[test]
fn the_report_holds_every_check_with_the_fields_of_the_contract() {
    let workplace = Workplace::new(&[("pair.toml", PAIR)]);
    run(&workplace, &["--record", "none", "--seed", "3"]);
    let report = workplace.json(&format!("{FOLDER}/report.json"));
    assert_eq!((&report["schema"], &report["seed"]), (&1.into(), &3.into()));
    assert_eq!((&report["scenario"], &report["planner"]), (&"pair".into(), &"parallel-scp".into()));
    assert_eq!(report["verdict"], "pass");
    let checks = report["checks"].as_array().unwrap();
    let names: Vec<&str> = checks.iter().map(|check| check["name"].as_str().unwrap()).collect();
    assert_eq!(names, check_names(Family::FixedWing).collect::<Vec<_>>());
    let separation = checks.iter().find(|check| check["name"] == "flight.separation").unwrap();
    assert_eq!((&separation["status"], &separation["unit"]), (&"pass".into(), &"m".into()));
    assert_eq!((&separation["limit"], &separation["between"]), (&100.0.into(), &serde_json::json!(["uav-1", "uav-2"])));
    let [value, margin] = ["value", "margin"].map(|field| separation[field].as_f64().unwrap());
    assert!((value - margin - 100.0).abs() < 1e-9 && value > 190.0 && value < 200.5, "{separation}");
    for field in ["status", "iterations", "wall_s", "distributed_s", "flight_time_s", "objective"] {
        assert!(!report["plan"][field].is_null(), "{field}");
    }
    let flight_time_s = report["plan"]["flight_time_s"].as_f64().unwrap();
    assert!((25.0..33.4).contains(&flight_time_s), "1 km at 30 to 40 m/s takes 25 to 33.4 s, not {flight_time_s} s");
}

#[test]
fn the_plan_is_written_in_both_formats_and_they_agree() {
    let workplace = Workplace::new(&[("pair.toml", PAIR)]);
    run(&workplace, &["--record", "none"]);
    let json = fs::read_to_string(workplace.path(FOLDER).join("plan.json")).unwrap();
    let plan: Plan = serde_json::from_str(&json).unwrap();
    let csv = fs::read_to_string(workplace.path(FOLDER).join("plan.csv")).unwrap();
    let mut lines = csv.lines();
    assert_eq!(lines.next().unwrap(), CSV_COLUMNS.join(","));
    for trajectory in plan.trajectories.iter().map(scenarios::Trajectory::fixed_wing) {
        for (node, t_s) in trajectory.times_s.iter().enumerate() {
            let cells: Vec<&str> = lines.next().unwrap().split(',').collect();
            assert_eq!((cells[0], cells.len()), (trajectory.vehicle.as_str(), CSV_COLUMNS.len()));
            let numbers: Vec<f64> = cells[1..].iter().map(|cell| cell.parse().unwrap()).collect();
            let state = trajectory.states[node].to_array();
            let expected = [&[*t_s][..], &state, &trajectory.controls[node].to_array()].concat();
            assert_eq!(numbers, expected);
        }
    }
    assert_eq!(lines.next(), None);
}

#[test]
fn one_seed_gives_one_report_on_any_number_of_threads_and_another_seed_another() {
    let workplace = Workplace::new(&[("pair.toml", &disturbed_pair())]);
    let report = |out: &str, more: &[&str]| {
        run(&workplace, &[&["--record", "none", "--out", out], more].concat());
        let folder = FOLDER.replace("out", out);
        let csv = fs::read_to_string(workplace.path(format!("{folder}/plan.csv"))).unwrap();
        (csv, reproducible(workplace.json(&format!("{folder}/report.json"))))
    };
    let first = report("a", &["--jobs", "1"]);
    assert_eq!(first, report("b", &["--jobs", "2"]));
    let other = report("c", &["--seed", "1"]);
    let tracking = |report: &Value| report["metrics"]["flight"]["tracking_max_m"].as_f64().unwrap();
    assert_ne!(tracking(&first.1), tracking(&other.1), "other gusts should lead to another flight");
}

/// Scenarios run side by side: reports, summaries and what is printed are those of one after the other.
#[test]
fn several_scenarios_give_the_same_results_in_the_same_order_on_any_number_of_threads() {
    let names = ["a", "b", "c", "d", "e"];
    let file = |name: &&str| {
        (format!("{name}.toml"), disturbed_pair().replace("name = \"pair\"", &format!("name = \"{name}\"")))
    };
    let files: Vec<(String, String)> = names.iter().map(file).collect();
    let files: Vec<(&str, &str)> = files.iter().map(|(name, text)| (name.as_str(), text.as_str())).collect();
    let workplace = Workplace::new(&files);
    let results = |out: &str, jobs: &str| {
        let paths = files.iter().map(|(name, _)| *name);
        let options = ["--record", "none", "--out", out, "--jobs", jobs, "--format", "json-lines"];
        let output = workplace.harness(&["run"].into_iter().chain(paths).chain(options).collect::<Vec<_>>());
        let lines = stdout(&output);
        let lines = lines.lines().map(|line| serde_json::from_str::<Value>(line).unwrap());
        let said: Vec<String> =
            lines.filter_map(|line| line["report"]["scenario"].as_str().map(str::to_owned)).collect();
        let report = |name: &&str| reproducible(workplace.json(&format!("{out}/{name}/parallel-scp/report.json")));
        (said, names.iter().map(report).collect::<Vec<_>>(), code(&output))
    };
    let one = results("one", "1");
    assert_eq!(one.0, names, "one line per report");
    assert_eq!(one, results("four", "4"));
}

#[test]
fn the_folder_holds_the_results_of_the_last_run_and_no_temporary_file() {
    let workplace = Workplace::new(&[("pair.toml", PAIR)]);
    if cfg!(feature = "rrd") {
        run(&workplace, &["--html"]);
        assert!(workplace.path("out/index.html").exists());
        assert_eq!(workplace.files(FOLDER), ["flight.rrd", "plan.csv", "plan.json", "report.json", "scene.json"]);
        assert!(fs::metadata(workplace.path(FOLDER).join("flight.rrd")).unwrap().len() > 1000);
    }
    run(&workplace, &["--record", "none"]);
    assert_eq!(workplace.files(FOLDER), ["plan.csv", "plan.json", "report.json"], "no recording of an earlier run");
    assert_eq!(workplace.files("out"), ["junit.xml", "pair", "summary.json", "summary.md"]);
}

#[test]
fn the_summary_leads_to_every_report() {
    let second = PAIR.replace("\"pair\"", "\"second\"");
    let workplace = Workplace::new(&[("all/pair.toml", PAIR), ("all/second.toml", &second)]);
    let output = workplace.harness(&["run", "all", "--record", "none", "--quiet"]);
    assert_eq!(code(&output), 0, "{}", stderr(&output));
    let summary = workplace.json("out/summary.json");
    let page = fs::read_to_string(workplace.path("out/summary.md")).unwrap();
    assert!(page.starts_with("# 2 passed\n"), "{page}");
    for (run, name) in summary["runs"].as_array().unwrap().iter().zip(["pair", "second"]) {
        let link = format!("{}/report.json", run["folder"].as_str().unwrap());
        let report = workplace.json(&format!("out/{link}"));
        assert_eq!((&run["scenario"], &report["scenario"]), (&name.into(), &name.into()));
        assert_eq!(run["flight_time_s"], report["plan"]["flight_time_s"]);
        assert!(page.contains(&format!("| PASS | [{name}]({link}) | parallel-scp | 0 |")), "{page}");
    }
}

#[test]
fn reports_of_a_file_that_is_now_refused_are_removed() {
    let workplace = Workplace::new(&[("pair.toml", "name = ")]);
    let reports = ["out/pair/fleet-scp/report.json", "out/pair/other/report.json", "out/other/rhc/report.json"];
    for report in reports {
        fs::create_dir_all(workplace.path(report).parent().unwrap()).unwrap();
        fs::write(workplace.path(report), "{}").unwrap();
    }
    let output = workplace.harness(&["run", "pair.toml", "-q"]);
    assert_eq!(code(&output), 2, "{}", stderr(&output));
    assert_eq!(reports.map(|report| workplace.path(report).exists()), [false, false, true]);
}
