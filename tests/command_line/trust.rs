//! Evidence for a verdict: the selftest, two integrators, bit-identical flights, and failure thresholds.

use std::fs;

use serde_json::Value;

use crate::workplace::{PAIR, Workplace, code, shooting_pair, stderr, stdout};

#[test]
fn every_fault_is_caught_every_near_miss_passes_and_no_check_is_idle() {
    let workplace = Workplace::new(&[]);
    let output = workplace.harness(&["selftest"]);
    assert_eq!(code(&output), 0, "{}{}", stdout(&output), stderr(&output));
    let results = workplace.json("out/selftest.json");
    let list = |name: &str| results[name].as_array().unwrap().clone();
    assert!(list("faults").len() >= 500 && list("near_misses").len() > 30 && list("checks").len() > 60);
    assert!(list("faults").iter().all(|fault| fault["caught"] == true));
    assert!(list("near_misses").iter().all(|near_miss| near_miss["green"] == true));
    assert!(list("checks").iter().all(|check| check["faults"].as_u64() > Some(0)));
    let page = fs::read_to_string(workplace.path("out/selftest.md")).unwrap();
    assert!(page.contains("a pole of 2 cm stands between two samples"), "{page}");
}

/// The report without the fields that may differ from run to run.
fn settled(mut report: Value) -> Value {
    let object = report.as_object_mut().unwrap();
    object.remove("timings");
    let plan = object["plan"].as_object_mut().unwrap();
    plan.remove("wall_s");
    plan.remove("distributed_s");
    report
}

#[cfg(feature = "parquet")]
#[test]
fn flights_are_identical_on_any_number_of_threads_and_differ_after_one_ulp() {
    let workplace = Workplace::new(&[("pair.toml", &shooting_pair())]);
    for jobs in ["1", "2"] {
        let output = workplace.harness(&["run", "pair.toml", "--record", "parquet", "-q", "-j", jobs, "-o", jobs]);
        assert_eq!(code(&output), 0, "{}", stderr(&output));
    }
    let report = |folder: &str| settled(workplace.json(&format!("{folder}/report.json")));
    assert_eq!(report("1/pair/parallel-scp"), report("2/pair/parallel-scp"));
    let output = workplace.harness(&["diverge", "1/pair/parallel-scp", "2/pair/parallel-scp"]);
    assert_eq!((code(&output), stdout(&output).trim()), (0, "the flights are the same to the last bit"));

    // The smallest change of a control of the second vehicle, half way.
    let mut plan = workplace.json("1/pair/parallel-scp/plan.json");
    let trajectory = &mut plan["trajectories"][1];
    let (node, t_s) = (10, trajectory["times_s"][9].as_f64().unwrap());
    let control = &mut trajectory["controls"][node]["n_z"];
    *control = control.as_f64().unwrap().next_up().into();
    fs::write(workplace.path("changed.json"), plan.to_string()).unwrap();
    let output =
        workplace.harness(&["check", "pair.toml", "--plan", "changed.json", "--record", "parquet", "-q", "-o", "3"]);
    assert_eq!(code(&output), 0, "{}", stderr(&output));
    let output = workplace.harness(&["diverge", "1/pair/parallel-scp", "3/pair/changed"]);
    let said = stdout(&output);
    assert_eq!(code(&output), 1, "{said}");
    let parted_s: f64 = said.split_once(" at ").and_then(|(_, rest)| rest.split(' ').next()).unwrap().parse().unwrap();
    assert!((t_s..t_s + 3.0).contains(&parted_s) && said.contains("uav-2"), "after {t_s} s: {said}");

    for folder in ["1/pair/parallel-scp", "3/pair/changed"] {
        fs::remove_file(workplace.path(folder).join("flight.parquet")).unwrap();
    }
    let output = workplace.harness(&["diverge", "1/pair/parallel-scp", "3/pair/changed"]);
    assert!(code(&output) == 1 && stdout(&output).contains("the flights part between"), "{}", stdout(&output));
    let output = workplace.harness(&["diverge", "1/pair/parallel-scp", "nowhere"]);
    assert!(code(&output) == 2 && stderr(&output).contains("nowhere"), "{}", stderr(&output));
}

#[test]
fn the_second_integrator_is_reported_in_either_form() {
    let workplace = Workplace::new(&[("pair.toml", PAIR)]);
    for (form, method) in [("cheap", "replay"), ("full", "finer-steps")] {
        let output =
            workplace.harness(&["run", "pair.toml", "--record", "none", "-q", "--second-integrator", form, "-o", form]);
        assert!(code(&output) < 2, "{}", stderr(&output));
        let report = workplace.json(&format!("{form}/pair/parallel-scp/report.json"));
        assert_eq!(report["integration"]["method"], method);
        let disagreement_m = report["integration"]["disagreement_m"].as_f64().unwrap();
        assert!((0.0..1e-3).contains(&disagreement_m), "{disagreement_m}");
    }
}

const HOP: &str = r#"name = "hop"
description = "A multirotor flies 4 m east in a breeze."

[world]
map = { x_m = [-5, 10], y_m = [-5, 5], z_m = [0, 6] }

[models.multirotor.quad]
mass_kg = 1.5
body_radius_m = 0.35
sensor_range_m = 8
drag_area_m2 = 0.05
limits = { speed_mps = 9, acceleration_mps2 = 6 }
planning_limits = { speed_mps = 3, acceleration_mps2 = 3 }

[[vehicles]]
name = "uav-1"
model = "quad"
start = { x_m = 0, y_m = 0, z_m = 3 }
goal = { x_m = 4, y_m = 0, z_m = 3 }

[planner]
name = "rhc"

[simulation]
max_duration_s = 30
tracker = { natural_frequency_radps = 2.5 }
wind = { mean_mps = [0, 1, 0], gusts = { wind_at_20ft_mps = 3, sigma_aloft_mps = 1 } }
"#;

#[test]
fn a_flight_that_is_planned_in_the_loop_is_flown_with_finer_steps_as_well() {
    let workplace = Workplace::new(&[("hop.toml", HOP)]);
    let output = workplace.harness(&["run", "hop.toml", "--record", "none", "-q", "--second-integrator", "full"]);
    assert_eq!(code(&output), 0, "{}{}", stdout(&output), stderr(&output));
    let integration = &workplace.json("out/hop/rhc/report.json")["integration"];
    assert_eq!(integration["method"], "finer-steps");
    let [whole_m, half_m] = ["disagreement_m", "half_to_quarter_m"].map(|key| integration[key].as_f64().unwrap());
    assert!(1e-7 < whole_m && whole_m < 1e-2 && half_m < whole_m, "{integration}");
}

#[test]
fn wind_without_effect_is_refused_and_not_sampled() {
    let still = HOP.replace("drag_area_m2 = 0.05\n", "");
    let still = &still[..still.find("wind = ").unwrap()];
    let workplace = Workplace::new(&[("hop.toml", still)]);
    for (arguments, option) in [
        (&["stress", "hop.toml", "--over", "mass,wind"][..], "--over wind"),
        (&["sweep", "hop.toml", "-n", "2", "--wind", "2"][..], "--wind"),
    ] {
        let output = workplace.harness(arguments);
        let said = stderr(&output);
        assert!(code(&output) == 2 && stdout(&output).is_empty(), "{said}");
        assert!(said.contains(&format!("{option} has no effect")) && said.contains("drag_area_m2"), "{said}");
    }
    let output = workplace.harness(&["sweep", "hop.toml", "-n", "2"]);
    assert_eq!(code(&output), 0, "{}{}", stdout(&output), stderr(&output));
    assert_eq!(workplace.json("out/hop/rhc/sweep.json")["spread"]["wind_mps"], 0.0);
}

#[test]
fn stress_finds_the_level_at_which_the_verdict_changes() {
    let workplace = Workplace::new(&[("pair.toml", &shooting_pair())]);
    let output = workplace.harness(&["stress", "pair.toml", "--over", "wind,mass,delay"]);
    let said = stdout(&output);
    assert_eq!(code(&output), 0, "{said}{}", stderr(&output));
    assert!(said.contains("wind ") && said.contains(" m/s: passes at") && said.contains("mass +"), "{said}");
    // The delay is in steps of 10 ms: at 35 m/s, 5 m of tracking error are 0.14 s.
    let delay = &workplace.json("out/pair/parallel-scp/stress-delay.json")["turns"];
    let [passes, fails] = ["passes", "fails"].map(|end| delay[end].as_f64().unwrap());
    assert!((0.05..0.5).contains(&passes) && fails - passes < 0.0101, "{delay}");
    for what in ["wind", "mass"] {
        let result = workplace.json(&format!("out/pair/parallel-scp/stress-{what}.json"));
        let [passes, fails] = ["passes", "fails"].map(|end| result["turns"][end].as_f64().unwrap());
        assert!(0.0 < passes && passes < fails && fails <= 1.006 * passes, "{result}");
        assert!(!result["turns"]["red"].as_array().unwrap().is_empty());
    }
}
