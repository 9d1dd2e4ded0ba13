//! The shipped scenarios without a checkout of the repository, and `harness --version`.

use crate::workplace::{PAIR, Workplace, code, stderr, stdout};

#[test]
fn shipped_scenarios_run_away_from_the_repository() {
    let workplace = Workplace::new(&[]);
    let listed = workplace.harness(&["list", "--name", "rendezvous-*"]);
    assert_eq!(code(&listed), 0, "{}", stderr(&listed));
    assert!(stdout(&listed).contains("rendezvous-7") && !stdout(&listed).contains("paper-map"));
    let ran = workplace.harness(&["run", "--name", "rendezvous-1", "--record", "none"]);
    assert_eq!(code(&ran), 0, "{}", stderr(&ran));
    assert_eq!(workplace.json("out/rendezvous-1/fleet-scp/report.json")["verdict"], "pass");
    let plan = "out/rendezvous-1/fleet-scp/plan.csv";
    let checked = workplace.harness(&["check", "shipped:rendezvous-1", "--plan", plan, "--record", "none", "-q"]);
    assert_ne!(code(&checked), 2, "{}", stderr(&checked));
}

#[test]
fn own_scenarios_come_first_and_shipped_ones_by_name() {
    let workplace = Workplace::new(&[("scenarios/pair.toml", PAIR)]);
    let own = stdout(&workplace.harness(&["list"]));
    assert!(own.contains("pair") && !own.contains("rendezvous-7"), "{own}");
    let both = stdout(&workplace.harness(&["list", "scenarios", "shipped:rendezvous-7"]));
    assert!(both.contains("pair") && both.contains("rendezvous-7") && !both.contains("rendezvous-6"), "{both}");
}

#[test]
fn an_unknown_shipped_scenario_has_a_suggestion() {
    let workplace = Workplace::new(&[]);
    let stress = ["stress", "--over", "wind", "shipped:rendezvous7"];
    for arguments in [&["run", "shipped:rendezvous7"][..], &stress] {
        let output = workplace.harness(arguments);
        assert_eq!(code(&output), 2, "{}", stdout(&output));
        assert!(stderr(&output).contains("shipped:rendezvous7: found no shipped scenario"), "{}", stderr(&output));
    }
    assert!(stderr(&workplace.harness(&["run", "shipped:rendezvous7"])).contains("you mean `shipped:rendezvous-7`?"));
}

#[test]
fn the_version_names_commit_and_features() {
    let workplace = Workplace::new(&[]);
    let text = stdout(&workplace.harness(&["--version"]));
    let lines: Vec<&str> = text.lines().collect();
    assert_eq!(lines[0], format!("harness {}", env!("CARGO_PKG_VERSION")));
    assert!(lines[1].strip_prefix("commit ").is_some_and(|commit| !commit.is_empty()), "{text}");
    assert_eq!(lines[2].contains("mcap"), cfg!(feature = "mcap"), "{text}");
}
