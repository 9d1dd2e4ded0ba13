//! `harness judge`: flights that were flown elsewhere.

use std::fs;

use crate::workplace::{PAIR, Workplace, code, shooting_pair, stderr, stdout};

/// A workplace with the simulated flight of the pair as a table.
fn flown() -> Workplace {
    let workplace = Workplace::new(&[("pair.toml", &shooting_pair())]);
    let output = workplace.harness(&["run", "pair.toml", "--record", "parquet", "-q"]);
    assert_eq!(code(&output), 0, "{}", stderr(&output));
    workplace
}

fn judge(workplace: &Workplace, flight: &str) -> (i32, String, String) {
    let output = workplace.harness(&["judge", "pair.toml", "--flight", flight, "--record", "none", "-v"]);
    (code(&output), stdout(&output), stderr(&output))
}

#[cfg(feature = "parquet")]
#[test]
fn a_simulated_flight_keeps_the_distances_of_its_verdict() {
    let workplace = flown();
    let (code, page, errors) = judge(&workplace, "out/pair/parallel-scp/flight.parquet");
    assert_eq!(code, 0, "{page}{errors}");
    assert!(page.contains("log: flown elsewhere"), "{page}");
    assert!(page.contains("(a flight is judged, there is no plan)"), "{page}");
    let [simulated, recorded] =
        ["parallel-scp", "flight"].map(|name| workplace.json(&format!("out/pair/{name}/report.json")));
    assert_eq!((&recorded["recorded"], &recorded["planner"]), (&true.into(), &"flight".into()));
    assert!(simulated.get("recorded").is_none());
    let value = |report: &serde_json::Value, name: &str| {
        let checks = report["checks"].as_array().unwrap();
        checks.iter().find(|check| check["name"] == name).unwrap()["value"].as_f64().unwrap()
    };
    for (name, tolerance) in [("flight.separation", 1e-3), ("flight.tracking_max", 1e-2), ("flight.duration", 0.1)] {
        let [a, b] = [&simulated, &recorded].map(|report| value(report, name));
        assert!((a - b).abs() < tolerance, "{name}: {a} and {b}");
    }
    let files = workplace.files("out/pair/flight");
    assert!(files.iter().any(|name| name == "report.json") && workplace.path("out/junit.xml").exists(), "{files:?}");
}

#[test]
fn a_log_that_is_not_one_of_the_scenario_is_refused_and_leaves_no_result() {
    let workplace = Workplace::new(&[("pair.toml", PAIR)]);
    let header = "vehicle,t_s,x_m,y_m,z_m\n";
    for (name, text, part) in [
        ("log.csv", "uav-1,0,0,-100,400\nuav-1,0.1,3.5,-100,400\n".to_owned(), "no row of `uav-2`"),
        ("log.csv", "uav-1,0,0,-100,400\nuav-1,0.1,nan,-100,400\n".to_owned(), "log.csv:3"),
        ("log.bin", String::new(), "a flight log is a table"),
    ] {
        fs::write(workplace.path(name), header.to_owned() + &text).unwrap();
        let (code, page, errors) = judge(&workplace, name);
        assert_eq!(code, 2, "{page}{errors}");
        assert!(errors.contains(part), "{part}: {errors}");
        assert!(!workplace.path("out/pair/log/report.json").exists());
    }
}

#[test]
fn a_flight_that_does_not_reach_its_goal_has_exit_code_1() {
    let workplace = Workplace::new(&[("pair.toml", PAIR)]);
    let row =
        |(name, y_m): (&str, i32), k: u32| format!("{name},{},{},{y_m},400\n", f64::from(k) / 10.0, 3.5 * f64::from(k));
    let rows: String =
        [("uav-1", -100), ("uav-2", 100)].into_iter().flat_map(|it| (0..200).map(move |k| row(it, k))).collect();
    fs::write(workplace.path("log.csv"), format!("vehicle,t_s,x_m,y_m,z_m\n{rows}")).unwrap();
    let (code, page, errors) = judge(&workplace, "log.csv");
    assert_eq!(code, 1, "{page}{errors}");
    assert!(page.contains("flight.goal") && page.contains("FAIL"), "{page}");
}

#[test]
fn flights_of_slung_loads_are_refused() {
    let workplace = Workplace::new(&[("log.csv", "t_s,x_m,y_m,z_m\n0,0,0,0\n1,0,0,0\n")]);
    let output = workplace.harness(&["judge", "shipped:gate", "--flight", "log.csv"]);
    assert_eq!(code(&output), 2);
    assert!(stderr(&output).contains("cannot be judged"), "{}", stderr(&output));
}
