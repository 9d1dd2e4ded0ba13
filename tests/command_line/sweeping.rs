//! `harness sweep` and `harness merge`.

use crate::workplace::{Workplace, code, shooting_pair, stderr, stdout};

fn pair() -> Workplace {
    Workplace::new(&[("pair.toml", &shooting_pair())])
}

const FOLDER: &str = "pair/parallel-scp";

#[test]
fn merged_partitions_are_the_sweep_of_one_machine() {
    let workplace = pair();
    let sweep = |more: &[&str]| {
        let output = workplace.harness(&[&["sweep", "pair.toml", "-n", "7", "--seed", "5"], more].concat());
        assert!(code(&output) < 2, "{}", stderr(&output));
        stdout(&output)
    };
    let said = sweep(&["-o", "whole", "-j", "1"]);
    assert!(said.contains("passed") && said.contains("of 7") && said.contains("flight.tracking_max"), "{said}");
    sweep(&["-o", "one", "--partition", "1/2", "-q"]);
    sweep(&["-o", "two", "--partition", "2/2", "-q"]);
    let parts = [&format!("two/{FOLDER}/sweep.parquet"), &format!("one/{FOLDER}/sweep.parquet")];
    let output = workplace.harness(&["merge", parts[0], parts[1], "-o", "merged", "-q"]);
    assert!(code(&output) < 2, "{}", stderr(&output));
    let whole = workplace.json(&format!("whole/{FOLDER}/sweep.json"));
    assert_eq!(workplace.json("merged/sweep.json"), whole);
    assert_eq!(whole["statistics"]["samples"], 7);

    let output = workplace.harness(&["merge", parts[0], "-o", "half"]);
    assert_eq!(code(&output), 2);
    let errors = stderr(&output).replace("\n  │ ", " ");
    assert!(errors.contains("4 of 7 samples are missing; the first is sample 0"), "{errors}");
    assert!(!workplace.path("half/sweep.json").exists());
}

#[test]
fn the_worst_sample_can_be_repeated_alone() {
    let workplace = pair();
    let output = workplace.harness(&["sweep", "pair.toml", "-n", "1", "--start", "40", "--wind", "3", "--mass", "2"]);
    assert_eq!(code(&output), 1, "{}", stderr(&output));
    let sweep = workplace.json(&format!("out/{FOLDER}/sweep.json"));
    let [scenario, plan] = ["worst/pair.toml", "plan.json"].map(|name| format!("out/{FOLDER}/{name}"));
    let output = workplace.harness(&["check", &scenario, "--plan", &plan, "--record", "none", "-q", "-o", "again"]);
    assert_eq!(code(&output), 1, "{}", stderr(&output));
    let report = workplace.json("again/pair/plan/report.json");
    let mut compared = 0;
    for check in sweep["statistics"]["checks"].as_array().unwrap().iter().filter(|check| !check["margins"].is_null()) {
        let flown = report["checks"].as_array().unwrap().iter().find(|flown| flown["name"] == check["name"]).unwrap();
        if check["unit"] == flown["unit"] {
            assert_eq!(check["margins"][0], flown["margin"], "{check}");
            compared += 1;
        }
    }
    assert!(compared > 8, "{compared} checks");
    let tracking = report["checks"].as_array().unwrap().iter().find(|it| it["name"] == "flight.tracking_max").unwrap();
    assert!((5.0..=40.5).contains(&tracking["value"].as_f64().unwrap()), "the start was off: {tracking}");
}

#[test]
fn a_sweep_without_perturbations_passes() {
    let workplace = pair();
    let output = workplace.harness(&["sweep", "pair.toml", "-n", "2", "--wind", "0"]);
    let said = stdout(&output);
    assert_eq!(code(&output), 0, "{said}{}", stderr(&output));
    assert!(said.contains("no perturbation but the seed") && said.contains("passed 2 of 2, 100.0 %"), "{said}");
    assert!(!workplace.path(format!("out/{FOLDER}/worst/pair.toml")).exists());
}

#[test]
fn invalid_arguments_are_errors() {
    let workplace = pair();
    let none: [&[&str]; 5] = [
        &["-n", "0"],
        &["-n", "3", "--partition", "4/3"],
        &["-n", "3", "--wind", "-1"],
        &["-n", "3", "--mass", "120"],
        &["-n", "3", "--at-least", "NaN"],
    ];
    for arguments in none {
        let output = workplace.harness(&[&["sweep", "pair.toml"], arguments].concat());
        assert_eq!(code(&output), 2, "{arguments:?}: {}", stdout(&output));
    }
}

#[test]
fn an_empty_partition_passes_and_can_be_merged() {
    let workplace = pair();
    for part in ["1/3", "2/3", "3/3"] {
        let output =
            workplace.harness(&["sweep", "pair.toml", "-n", "2", "--wind", "0", "--partition", part, "-o", part]);
        assert_eq!(code(&output), 0, "{part}: {}{}", stdout(&output), stderr(&output));
        assert_eq!(stdout(&output).contains("this partition has no samples"), part == "3/3", "{}", stdout(&output));
    }
    let tables = ["1/3", "2/3", "3/3"].map(|part| format!("{part}/{FOLDER}/sweep.parquet"));
    let output = workplace.harness(&["merge", &tables[0], &tables[1], &tables[2], "-o", "merged", "-q"]);
    assert_eq!(code(&output), 0, "{}", stderr(&output));
    assert_eq!(workplace.json("merged/sweep.json")["statistics"]["passed"], 2);
}

/// The unit of the margin of state limits is that of the decisive quantity, which differs from sample to sample.
#[test]
fn every_failed_check_has_its_margin_and_its_unit() {
    let workplace =
        Workplace::new(&[("pair.toml", &shooting_pair().replace("speed_mps = [22, 50]", "speed_mps = [29.9, 40.1]"))]);
    let output = workplace.harness(&["sweep", "pair.toml", "-n", "6", "--wind", "12", "--mass", "10"]);
    assert_eq!(code(&output), 1, "{}{}", stdout(&output), stderr(&output));
    let sweep = workplace.json(&format!("out/{FOLDER}/sweep.json"));
    let checks = sweep["statistics"]["checks"].as_array().unwrap();
    let limits: Vec<_> = checks.iter().filter(|check| check["name"] == "flight.state_limits").collect();
    assert!(limits.iter().any(|check| check["red"].as_u64() > Some(0)), "{checks:?}");
    for check in limits {
        assert!(check["margins"].is_array() && check["unit"] != "-" && check["worst"].is_u64(), "{check}");
    }
    assert!(stdout(&output).contains("flight.state_limits"), "{}", stdout(&output));
}

/// Killed as by a power failure: what was written is kept, and the result is that of a sweep in one go.
#[cfg(unix)]
#[test]
fn a_killed_sweep_is_resumed_without_flying_its_samples_again() {
    let workplace = pair();
    let sweep = ["sweep", "pair.toml", "-n", "300", "-j", "1"];
    let checkpoint = workplace.path(format!("out/{FOLDER}/sweep-checkpoint.parquet"));
    let mut command = std::process::Command::new(env!("CARGO_BIN_EXE_harness"));
    let mut child = command.args([&sweep[..], &["-q"]].concat()).current_dir(workplace.path("")).spawn().unwrap();
    while !checkpoint.exists() {
        assert!(child.try_wait().unwrap().is_none(), "the sweep ended before its first checkpoint");
        std::thread::sleep(std::time::Duration::from_millis(5));
    }
    child.kill().unwrap();
    child.wait().unwrap();

    let output = workplace.harness(&[&sweep[..], &["--resume"]].concat());
    let said = stderr(&output);
    assert!(code(&output) < 2, "{said}");
    let kept: usize = said.split_once(" of 300 samples are there").unwrap().0.lines().last().unwrap().parse().unwrap();
    assert!(kept > 0 && kept < 300 && said.contains(&format!("of {} flights", 300 - kept)), "{said}");
    assert!(!checkpoint.exists());
    let resumed = workplace.json(&format!("out/{FOLDER}/sweep.json"));
    assert!(code(&workplace.harness(&[&sweep[..], &["-q", "-o", "whole"]].concat())) < 2);
    assert_eq!(workplace.json(&format!("whole/{FOLDER}/sweep.json")), resumed);
}

#[test]
fn samples_are_added_to_a_sweep_and_not_to_another_one() {
    let workplace = pair();
    let sweep = |more: &[&str]| {
        let output = workplace.harness(&[&["sweep", "pair.toml"], more].concat());
        (code(&output), stderr(&output).replace("\n  │ ", " "))
    };
    assert!(sweep(&["-n", "3", "-q"]).0 < 2);
    let (code, said) = sweep(&["-n", "5", "--resume"]);
    assert!(code < 2 && said.contains("3 of 5 samples are there") && said.contains("2 of 2 flights"), "{said}");
    assert!(sweep(&["-n", "5", "-q", "-o", "whole"]).0 < 2);
    let added = workplace.json(&format!("out/{FOLDER}/sweep.json"));
    assert_eq!(workplace.json(&format!("whole/{FOLDER}/sweep.json")), added);
    for (other, wanted) in [(["--seed", "9"], "seed differs"), (["--wind", "1"], "dispersions differs")] {
        let (code, said) = sweep(&[&["-n", "5", "--resume"][..], &other].concat());
        assert!(code == 2 && said.contains(wanted), "{said}");
    }
    let (code, said) = sweep(&["-n", "4", "--resume"]);
    assert!(code == 2 && said.contains("it holds 5 samples, and 4 are asked for"), "{said}");
    let moved = shooting_pair().replace("goal = { x_m = 1000, y_m = 100,", "goal = { x_m = 1000, y_m = 101,");
    std::fs::write(workplace.path("pair.toml"), moved).unwrap();
    let (code, said) = sweep(&["-n", "5", "--resume"]);
    assert!(code == 2 && said.contains("scenario or plan differs"), "{said}");
    assert_eq!(workplace.json(&format!("out/{FOLDER}/sweep.json")), added, "it was left as it was");
}

/// Sample k of both is a pair: a weaker tracker shows in few samples, and a sweep is equal to itself.
#[test]
fn two_sweeps_are_compared_pair_by_pair() {
    let workplace = pair();
    let sweep = |out: &str, text: &str, more: &[&str]| {
        std::fs::write(workplace.path("pair.toml"), text).unwrap();
        let output = workplace.harness(&[&["sweep", "pair.toml", "-n", "30", "-q", "-o", out], more].concat());
        assert!(code(&output) < 2, "{}", stderr(&output));
        format!("{out}/{FOLDER}/sweep.parquet")
    };
    let old = sweep("old", &shooting_pair(), &[]);
    // A smaller limit of the tracking error: every margin of it shrinks by 1 m.
    let tight = shooting_pair() + "\n[verdict]\ntracking_max_m = 4.0\n";
    let new = sweep("new", &tight, &["--wind", "5", "--mass", "3", "--noise", "0.5", "--start", "0.5"]);
    let compare = |a: &str, b: &str| {
        let output = workplace.harness(&["compare", a, b]);
        (code(&output), stdout(&output) + &stderr(&output).replace("\n  │ ", " "))
    };
    let (exit, said) = compare(&old, &old);
    assert!(exit == 0 && said.contains("30 pairs compared: 0 worse, 0 better"), "{said}");
    let (exit, said) = compare(&old, &new);
    assert!(exit == 2 && said.contains("its dispersions differ"), "{said}");
    let same = sweep("same", &shooting_pair(), &["--wind", "5", "--mass", "3", "--noise", "0.5", "--start", "0.5"]);
    let (exit, said) = compare(&same, &new);
    assert!(
        exit == 1 && said.contains("worse") && said.contains("flight.tracking_max") && said.contains("-1.000"),
        "{said}"
    );
    let (exit, said) = compare(&new, &same);
    assert!(exit == 0 && said.contains("better") && said.contains("+1.000"), "{said}");
}
