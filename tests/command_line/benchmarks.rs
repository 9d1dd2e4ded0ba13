//! `harness bench`.

use std::fs;

use serde_json::Value;

use crate::workplace::{PAIR, Workplace, code, stderr, stdout};

#[test]
fn bench_ipm_measures_every_backend_on_every_subproblem() {
    let workplace = Workplace::new(&[("pair.toml", PAIR)]);
    let output = workplace.harness(&["bench", "ipm", "pair.toml", "--quick"]);
    assert_eq!(code(&output), 0, "{}", stderr(&output));
    assert_eq!(workplace.files("out/bench"), ["ipm.json", "ipm.md"]);
    let results = workplace.json("out/bench/ipm.json");
    assert_eq!(results["scenario"], "pair");
    let rows = results["rows"].as_array().unwrap();
    let backends = ["clarabel", "block x4", "block", "sparse-ldl", "dense-reduced", "dense-kkt"];
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
            let baseline = of_one_shape[0]["objective"].as_f64().unwrap();
            assert!((number("objective") - baseline).abs() < 1e-6 * baseline.abs().max(1.0), "{row}");
        }
    }
    let page = fs::read_to_string(workplace.path("out/bench/ipm.md")).unwrap();
    assert!(page.starts_with("# Interior point on subproblems of pair\n") && page.contains("| dense-kkt |"), "{page}");
    assert!(stdout(&output).contains("sparse-ldl"));
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
