//! Edge cases of the input, from the file to the results.

use std::fmt::Write;

use crate::workplace::{PAIR, Workplace, code, stderr, stdout};

/// The pair, planned by multiple shooting: it passes.
fn shooting() -> String {
    PAIR.replace("intervals = 20", "intervals = 20\ntranscription = \"shooting\"")
}

fn without_the_second(text: &str) -> String {
    let from = text.rfind("[[vehicles]]").unwrap();
    let to = from + text[from..].find("\n[fleet]").unwrap();
    format!("{}{}", &text[..from], &text[to..])
}

#[test]
fn the_longest_names_appear_in_every_file_and_table() {
    let [scenario, vehicle, pole] = ["s", "v", "p"].map(|letter| letter.repeat(64));
    let text =
        shooting().replace("\"pair\"", &format!("\"{scenario}\"")).replace("\"uav-1\"", &format!("\"{vehicle}\""));
    let text = format!("{text}\n[[world.cylinders]]\nname = \"{pole}\"\ncenter_m = [0, 300]\nradius_m = 5\n");
    let workplace = Workplace::new(&[(&format!("{scenario}.toml"), &text)]);
    let output = workplace.harness(&["run", &format!("{scenario}.toml"), "--tum"]);
    assert_eq!(code(&output), 0, "{}{}", stdout(&output), stderr(&output));
    assert!(stdout(&output).contains(&vehicle), "{}", stdout(&output));
    let report = workplace.json(&format!("out/{scenario}/parallel-scp/report.json"));
    assert_eq!(report["verdict"], "pass");
}

#[test]
fn a_single_vehicle_has_no_separation() {
    let workplace = Workplace::new(&[("pair.toml", &without_the_second(&shooting()))]);
    let output = workplace.harness(&["run", "pair.toml", "-q"]);
    assert_eq!(code(&output), 0, "{}", stderr(&output));
    let report = workplace.json("out/pair/parallel-scp/report.json");
    let checks = report["checks"].as_array().unwrap();
    let separation = checks.iter().filter(|check| check["name"].as_str().unwrap().ends_with(".separation"));
    assert!(separation.clone().count() == 3 && separation.clone().all(|check| check["status"] == "skip"), "{report:#}");
}

#[test]
fn a_wind_of_zero_changes_nothing() {
    let calm =
        "\n[simulation]\nwind = { mean_mps = [0, 0, 0], gusts = { wind_at_20ft_mps = 0, sigma_aloft_mps = 0 } }\n";
    let with_none = format!("{}{calm}", shooting());
    let workplace = Workplace::new(&[("a/pair.toml", &shooting()), ("b/pair.toml", &with_none)]);
    for folder in ["a", "b"] {
        let output =
            workplace.harness(&["run", &format!("{folder}/pair.toml"), "--record", "none", "-q", "-o", folder]);
        assert_eq!(code(&output), 0, "{}", stderr(&output));
    }
    let checks = |folder: &str| workplace.json(&format!("{folder}/pair/parallel-scp/report.json"))["checks"].clone();
    assert_eq!(checks("a"), checks("b"));
}

#[test]
fn thousands_of_obstacles_are_planned_judged_and_recorded() {
    let mut text = shooting();
    for index in 0..5000 {
        let (x_m, y_m) = (index % 100 * 15 - 250, 300 + index / 100 * 3);
        writeln!(text, "\n[[world.cylinders]]\nname = \"tree-{index}\"\ncenter_m = [{x_m}, {y_m}]\nradius_m = 1")
            .unwrap();
    }
    let workplace = Workplace::new(&[("pair.toml", &text)]);
    let output = workplace.harness(&["run", "pair.toml", "-p", "fleet-scp", "-q"]);
    assert_eq!(code(&output), 0, "{}", stderr(&output));
    let report = workplace.json("out/pair/fleet-scp/report.json");
    let checks = report["checks"].as_array().unwrap();
    let clearance = checks.iter().find(|check| check["name"] == "flight.clearance").unwrap();
    assert!(clearance["between"][1].as_str().unwrap().starts_with("tree-"), "{clearance}");
}

/// Plans without duration: all times zero, two nodes at one time, a single node. Never a pass, never a panic.
#[test]
fn a_plan_without_duration_never_passes() {
    let workplace = Workplace::new(&[("pair.toml", PAIR)]);
    let output = workplace.harness(&["plan", "pair.toml", "-q", "-o", "plan.json"]);
    assert!(code(&output) < 2, "{}", stderr(&output));
    let plan = workplace.json("plan.json");
    let last = plan["trajectories"][0]["times_s"].as_array().unwrap().len() - 1;
    let all_zero = vec![0.0; last + 1];
    let mut twice = plan["trajectories"][0]["times_s"].clone();
    twice[1] = 0.0.into();
    for times_s in [serde_json::json!(all_zero), twice, serde_json::json!([0.0]), serde_json::json!([])] {
        let mut broken = plan.clone();
        broken["trajectories"][0]["times_s"] = times_s.clone();
        std::fs::write(workplace.path("broken.json"), broken.to_string()).unwrap();
        let output = workplace.harness(&["check", "pair.toml", "--plan", "broken.json", "--record", "none", "-q"]);
        assert!([1, 2].contains(&code(&output)), "{times_s}: {}", stderr(&output));
    }
}
