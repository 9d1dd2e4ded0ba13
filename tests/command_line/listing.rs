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
    let planners = page.split_once("Planners\n").expect("a second table").1;
    for entry in planners::registry() {
        let first_word = entry.summary.split(' ').next().expect("a summary");
        let is_listed = |line: &str| [entry.name, entry.handles, first_word].iter().all(|part| line.contains(part));
        assert!(planners.lines().any(is_listed), "{} is not listed in\n{planners}", entry.name);
    }
}

#[test]
fn long_descriptions_are_wrapped_without_losing_a_word() {
    let description = "word ".repeat(60);
    let long = PAIR
        .replace("Two aircraft fly 1 km straight ahead, side by side, and arrive together.", description.trim_end());
    assert_ne!(long, PAIR);
    let workplace = Workplace::new(&[("scenarios/pair.toml", &long)]);
    let page = stdout(&workplace.harness(&["list"]));
    assert!(page.lines().all(|line| line.chars().count() <= 120), "{page}");
    assert_eq!(page.matches("word").count(), 60, "{page}");
}

#[test]
fn a_bad_file_is_named_and_the_others_are_listed() {
    let workplace = Workplace::new(&[("scenarios/pair.toml", PAIR), ("scenarios/bad.toml", "name = 3")]);
    let output = workplace.harness(&["list"]);
    assert_eq!(code(&output), 2);
    assert!(stdout(&output).contains("fly 1 km straight ahead"));
    assert!(stderr(&output).contains("scenarios/bad.toml:1:8"), "{}", stderr(&output));
}
