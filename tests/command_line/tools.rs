//! Completions, man pages, selection by tags and names, the shipped files' schema lines.

use std::fs;
use std::path::Path;

use crate::workplace::{PAIR, Workplace, code, stderr, stdout};

#[test]
fn every_shell_gets_completions() {
    for shell in ["bash", "zsh", "fish", "elvish", "powershell"] {
        let output = Workplace::new(&[]).harness(&["completions", shell]);
        assert_eq!(code(&output), 0);
        let script = stdout(&output);
        assert!(["harness", "compare", "baseline"].iter().all(|word| script.contains(word)), "{shell}");
    }
}

#[test]
fn every_command_gets_a_man_page() {
    let workplace = Workplace::new(&[]);
    let output = workplace.harness(&["man", "pages"]);
    assert_eq!(code(&output), 0, "{}", stderr(&output));
    let pages = workplace.files("pages");
    for page in ["harness.1", "harness-run.1", "harness-check.1", "harness-baseline-accept.1"] {
        assert!(pages.iter().any(|name| name == page), "{page} is missing in {pages:?}");
    }
    assert!(fs::read_to_string(workplace.path("pages/harness-check.1")).unwrap().contains("flight_path_rad"));
}

fn fleet_of_three() -> Workplace {
    let named =
        |name: &str, tags: &str| PAIR.replace("name = \"pair\"", &format!("name = \"{name}\"\ntags = [{tags}]"));
    Workplace::new(&[
        ("scenarios/pair.toml", PAIR),
        ("scenarios/quick-1.toml", &named("quick-1", "\"ci\"")),
        ("scenarios/quick-2.toml", &named("quick-2", "\"ci\", \"wind\"")),
    ])
}

/// Names of the scenarios that `list` selects.
fn selected(workplace: &Workplace, more: &[&str]) -> Vec<String> {
    let output = workplace.harness(&[&["list", "--json"], more].concat());
    assert_eq!(code(&output), 0, "{}", stderr(&output));
    let listed: serde_json::Value = serde_json::from_str(&stdout(&output)).unwrap();
    let names = listed["scenarios"].as_array().unwrap().iter().map(|scenario| scenario["name"].as_str().unwrap());
    names.map(str::to_owned).collect()
}

#[test]
fn tags_and_names_select() {
    let workplace = fleet_of_three();
    assert_eq!(selected(&workplace, &[]), ["pair", "quick-1", "quick-2"]);
    assert_eq!(selected(&workplace, &["--tag", "ci"]), ["quick-1", "quick-2"]);
    assert_eq!(selected(&workplace, &["--tag", "wind", "--name", "quick-*"]), ["quick-2"]);
    assert_eq!(selected(&workplace, &["--name", "*-1", "--name", "p?ir"]), ["pair", "quick-1"]);
    let output = workplace.harness(&["run", "--name", "quick-1", "--record", "none", "-q"]);
    assert_eq!(code(&output), 0, "{}", stderr(&output));
    assert_eq!(workplace.files("out"), ["junit.xml", "quick-1", "summary.json", "summary.md"]);
}

#[test]
fn an_empty_selection_is_an_error() {
    let workplace = fleet_of_three();
    for arguments in [&["run", "--tag", "cj"][..], &["list", "--name", "nothing*"]] {
        let output = workplace.harness(arguments);
        assert_eq!(code(&output), 2, "{arguments:?}");
        assert!(stderr(&output).contains("no scenario matches --"), "{}", stderr(&output));
    }
}

#[test]
fn the_json_list_says_which_planner_handles_what() {
    let output = fleet_of_three().harness(&["list", "--json"]);
    let listed: serde_json::Value = serde_json::from_str(&stdout(&output)).unwrap();
    let first = &listed["scenarios"][0];
    assert_eq!((&first["file"], &first["vehicles"]), (&"scenarios/pair.toml".into(), &2.into()));
    assert!(first["handled_by"].as_array().unwrap().contains(&"parallel-scp".into()), "{first}");
    assert_eq!(listed["planners"].as_array().unwrap().len(), planners::registry().len());
}

/// An editor finds the schema without a network, from the repository alone.
#[test]
fn shipped_scenarios_name_an_existing_schema() {
    let root = Path::new(env!("CARGO_MANIFEST_DIR"));
    let files =
        scenarios::find(&[root.join("scenarios"), root.join("examples"), root.join("tests/scenarios")]).unwrap();
    assert!(files.len() > 16);
    for file in files {
        let text = fs::read_to_string(&file).unwrap();
        let schema = text.lines().next().and_then(|line| line.strip_prefix("#:schema ")).unwrap_or_default();
        let path = file.parent().unwrap().join(schema);
        assert!(path.is_file() && path.ends_with("schema/scenario.json"), "{}: {schema:?}", file.display());
    }
}
