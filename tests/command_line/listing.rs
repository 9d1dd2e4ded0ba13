//! `harness list`.

use crate::workplace::{PAIR, Workplace, code, stderr, stdout};

#[test]
fn scenarios_and_planners_are_listed() {
    let workplace = Workplace::new(&[("scenarios/pair.toml", PAIR)]);
    let output = workplace.harness(&["list"]);
    assert_eq!(code(&output), 0, "{}", stderr(&output));
    let page = stdout(&output);
    let pair = page.lines().find(|line| line.trim_start().starts_with("pair ")).expect("the scenario is listed");
    assert!(
        pair.contains(" 2 ") && pair.contains("parallel-scp") && pair.contains("fly 1 km straight ahead"),
        "{pair}"
    );
    for entry in planners::registry() {
        let line = page.lines().find(|line| line.contains(entry.summary)).expect("every planner is listed");
        assert!(line.contains(entry.name) && line.contains(entry.handles), "{line}");
    }
}

#[test]
fn a_bad_file_is_named_and_the_others_are_listed() {
    let workplace = Workplace::new(&[("scenarios/pair.toml", PAIR), ("scenarios/bad.toml", "name = 3")]);
    let output = workplace.harness(&["list"]);
    assert_eq!(code(&output), 2);
    assert!(stdout(&output).contains("fly 1 km straight ahead"));
    assert!(stderr(&output).contains("scenarios/bad.toml:1:8"), "{}", stderr(&output));
}
