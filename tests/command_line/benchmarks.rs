//! `harness bench`.

use std::fs;

use serde_json::Value;

use crate::workplace::{PAIR, Workplace, code, stderr, stdout};

#[test]
fn bench_ipm_measures_every_backend_on_every_subproblem() {
    let workplace = Workplace::new(&[("pair.toml", PAIR)]);
    let output = workplace.harness(&["bench", "ipm", "pair.toml", "--quick"]);
    assert_eq!(code(&output), 0, "{}", stderr(&output));
    assert_eq!(workplace.files("out/bench"), ["ipm.json", "ipm.md", "ipm.svg"]);
    let results = workplace.json("out/bench/ipm.json");
    assert_eq!(results["scenario"], "pair");
    let rows = results["rows"].as_array().unwrap();
    let backends =
        ["clarabel", "block x4", "block", "sparse-ldl", "sparse-ldl infeasible", "dense-reduced", "dense-kkt"];
    assert_eq!(rows.len(), 3 * backends.len());
    for of_one_shape in rows.chunks(backends.len()) {
        for (row, backend) in of_one_shape.iter().zip(backends) {
            assert_eq!((&row["backend"], &row["shape"]), (&Value::from(backend), &of_one_shape[0]["shape"]));
            assert_eq!(row["n_a"].as_u64().unwrap(), 2 * row["n_x"].as_u64().unwrap());
            let number = |field: &str| row[field].as_f64().unwrap_or_else(|| panic!("{field} of {row}"));
            let iterations = number("iterations");
            assert!(iterations > 1.0 && number("time_us") > 0.0 && number("planes") >= 0.0, "{row}");
            assert!((number("time_per_iteration_us") * iterations / number("time_us") - 1.0).abs() < 1e-9);
            assert!(number("speedup_vs_clarabel") > 0.0);
            // With rows of large weight Clarabel and the reduced systems may stall, and say so.
            let block = of_one_shape[2]["objective"].as_f64().unwrap();
            let is_alike = (number("objective") - block).abs() < 1e-6 * block.abs().max(1.0);
            assert!(is_alike || row["status"] != "solved", "{row}");
            assert!(row["status"] == "solved" || !backend.starts_with("block"), "{row}");
        }
    }
    let page = fs::read_to_string(workplace.path("out/bench/ipm.md")).unwrap();
    assert!(page.starts_with("# Interior point on subproblems of pair\n") && page.contains("| dense-kkt |"), "{page}");
    assert!(stdout(&output).contains("sparse-ldl"));
}

/// The project's own scenarios.
const SHIPPED: &str = concat!(env!("CARGO_MANIFEST_DIR"), "/scenarios/fixed-wing");

#[test]
fn bench_horizon_measures_one_experiment_where_asked() {
    let workplace = Workplace::new(&[]);
    let output = workplace.harness(&["bench", "horizon", "--experiment", "cost-maps", "--quick"]);
    assert_eq!(code(&output), 0, "{}", stderr(&output));
    let results = workplace.json("out/bench/horizon.json");
    let rows = results["rows"].as_array().unwrap();
    assert_eq!(rows.len(), 5);
    assert!(rows.iter().all(|row| row["experiment"] == "cost-maps" && row["scenario"] == "paper-map"), "{rows:?}");
    assert_eq!(results["seeds"], 2);
    let unknown = workplace.harness(&["bench", "horizon", "--experiment", "cost-map"]);
    assert_eq!(code(&unknown), 2);
    assert!(stderr(&unknown).contains("cost-maps"), "{}", stderr(&unknown));
}

#[test]
fn bench_cooperative_measures_every_method_on_both_missions() {
    let workplace = Workplace::new(&[]);
    let output = workplace.harness(&["bench", "cooperative", SHIPPED, "--quick"]);
    assert_eq!(code(&output), 0, "{}", stderr(&output));
    assert_eq!(workplace.files("out/bench"), ["cooperative.json", "cooperative.md"]);
    let results = workplace.json("out/bench/cooperative.json");
    let rows = results["rows"].as_array().unwrap();
    assert_eq!(rows.len(), 2 * 2 * 3);
    for pair in rows.chunks(3) {
        let methods = [0, 1, 2].map(|k| pair[k]["solver"].as_str().unwrap());
        assert_eq!(methods, ["block", "clarabel", "decoupled-lgr"]);
        let flight_time_s = |row: &Value| row["metrics"]["flight_time_s"].as_f64();
        let own_s = flight_time_s(&pair[0]).unwrap();
        // Clarabel's plan may miss its start: then it has no figures.
        let is_alike = flight_time_s(&pair[1]).is_none_or(|other_s| (own_s / other_s - 1.0).abs() < 0.01);
        assert!(is_alike, "{pair:?}");
        assert!(pair.iter().all(|row| row["planning_s"].as_f64().unwrap() > 0.0));
    }
    assert!(rows.iter().filter(|row| row["metrics"]["flight_time_s"].is_number()).count() >= 6, "{rows:?}");
    assert_eq!(results["means"].as_array().unwrap().len(), 6);
    assert!(stdout(&output).contains("reconfiguration-7"));
}

#[test]
fn bench_fleets_measures_every_planner_and_a_time_limit_is_a_result() {
    let workplace = Workplace::new(&[]);
    let output = workplace.harness(&["bench", "fleets", SHIPPED, "--quick", "-q"]);
    assert_eq!(code(&output), 0, "{}", stderr(&output));
    let results = workplace.json("out/bench/fleets.json");
    let rows = results["rows"].as_array().unwrap();
    let planners: Vec<&str> = rows.iter().map(|row| row["planner"].as_str().unwrap()).collect();
    assert_eq!(planners, ["coupled-scp", "serial-scp", "parallel-scp", "dpd-scp", "fleet-scp"]);
    assert_eq!(rows[4]["ending"], "pass");
    assert!(rows.iter().all(|row| row["vehicles"] == 2 && row["iterations"].as_u64().unwrap() > 1));

    let output = workplace.harness(&["bench", "cooperative", SHIPPED, "--quick", "--limit-s", "0.001"]);
    assert_eq!(code(&output), 0, "{}", stderr(&output));
    let rows = workplace.json("out/bench/cooperative.json")["rows"].take();
    assert!(rows.as_array().unwrap().iter().all(|row| row["ending"] == "timed-out" && row["planning_s"].is_null()));
}

#[test]
fn bench_refuses_bad_usage_and_leaves_nothing_behind() {
    let workplace = Workplace::new(&[]);
    for (arguments, message) in [(["bench", "ipm", "missing.toml"], "missing.toml"), (["bench", "lp", "-q"], "ipm")] {
        let output = workplace.harness(&arguments);
        assert_eq!(code(&output), 2, "{arguments:?}");
        assert!(stderr(&output).contains(message), "{arguments:?}: {}", stderr(&output));
    }
    assert!(!workplace.path("out").exists());
}
