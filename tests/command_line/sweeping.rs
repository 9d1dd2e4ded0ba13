//! `harness sweep` and `harness merge`.

use crate::workplace::{Workplace, code, shooting_pair, stderr, stdout};

fn pair() -> Workplace {
    Workplace::new(&[("pair.toml", &shooting_pair())])
}

const FOLDER: &str = "pair/parallel-scp";

#[test]
fn parts_of_several_machines_are_the_sweep_of_one() {
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
    assert!(stderr(&output).contains("4 of 7 samples are missing, 0 first"), "{}", stderr(&output));
    assert!(!workplace.path("half/sweep.json").exists());
}

#[test]
fn the_worst_sample_can_be_flown_again_alone() {
    let workplace = pair();
    let output = workplace.harness(&["sweep", "pair.toml", "-n", "1", "--start", "40", "--wind", "3", "--mass", "2"]);
    assert_eq!(code(&output), 1, "{}", stderr(&output));
    let sweep = workplace.json(&format!("out/{FOLDER}/sweep.json"));
    let [scenario, plan] = ["worst/pair.toml", "plan.json"].map(|name| format!("out/{FOLDER}/{name}"));
    let output = workplace.harness(&["check", &scenario, "--plan", &plan, "--record", "none", "-q", "-o", "again"]);
    assert_eq!(code(&output), 1, "{}", stderr(&output));
    let report = workplace.json("again/pair/plan/report.json");
    let mut compared = 0;
    for check in sweep["statistics"]["checks"].as_array().unwrap() {
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
fn nothing_that_differs_is_nothing_that_fails() {
    let workplace = pair();
    let output = workplace.harness(&["sweep", "pair.toml", "-n", "2", "--wind", "0"]);
    let said = stdout(&output);
    assert_eq!(code(&output), 0, "{said}{}", stderr(&output));
    assert!(said.contains("only the seed differs") && said.contains("passed 2 of 2, 100.0 %"), "{said}");
    assert!(!workplace.path(format!("out/{FOLDER}/worst/pair.toml")).exists());
}

#[test]
fn nonsense_is_refused() {
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
