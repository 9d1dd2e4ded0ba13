//! Text that is not a valid scenario: each issue has field, line, column, found and expected value.

mod minimal;

use minimal::{TEXT, assert_issue, issues, load_changed};

#[test]
fn the_minimal_scenario_is_valid() {
    let scenario = scenarios::parse("folder/minimal.toml", TEXT).unwrap();
    assert_eq!(scenario.vehicles.len(), 2);
    assert_eq!(scenario.world.cylinders[0].radius_m, 50.0);
}

#[test]
fn toml_syntax_errors_are_reported_with_their_place() {
    assert_issue("radius_m = 50", "radius_m = ", ("TOML syntax", 10, 12), "", "");
    assert_issue("[fleet]", "[fleet", ("TOML syntax", 44, 7), "unclosed table", "`]`");
    assert_issue("goal_m = 5\n", "goal_m = 5\ngoal_m = 6\n", ("TOML syntax", 70, 1), "duplicate key", "");
}

#[test]
fn all_syntax_errors_are_reported_together() {
    let text = TEXT.replace("[fleet]", "[fleet").replace("[verdict]", "[verdict");
    let error = scenarios::parse("minimal.toml", &text).unwrap_err();
    assert_eq!(error.issues().len(), 2);
}

#[test]
fn an_unknown_key_is_rejected_with_a_suggestion() {
    assert_issue("margin_m = 1", "margins_m = 1", ("planner.margins_m", 50, 1), "an unknown key", "margin_m");
    let remedy = &issues("margin_m = 1", "margins_m = 1")[0].issue.remedy;
    assert!(remedy.starts_with("did you mean `margin_m`: Distance that the planner adds"), "{remedy}");
}

#[test]
fn a_misspelt_required_key_is_one_issue() {
    assert_issue("mass_kg", "mass", ("models.fixed-wing.glider.mass", 13, 1), "an unknown key", "mass_kg");
}

#[test]
fn an_unknown_key_without_similar_names_is_rejected() {
    assert_issue("[fleet]", "[fleet]\ncolour = 1", ("fleet.colour", 45, 1), "an unknown key", "simultaneous_arrival");
}

#[test]
fn a_missing_key_is_reported_at_its_table_with_its_documentation() {
    assert_issue("radius_m = 50\n", "", ("world.cylinders[0].radius_m", 7, 1), "nothing", "a number");
    let remedy = &issues("radius_m = 50\n", "")[0].issue.remedy;
    assert_eq!(remedy, "add `radius_m`: Radius, m, > 0.");
    assert_issue("name = \"minimal\"\n", "", ("name", 1, 1), "nothing", "text in quotes");
}

#[test]
fn values_of_the_wrong_type_are_reported() {
    assert_issue("radius_m = 50", "radius_m = '50'", ("world.cylinders[0].radius_m", 10, 12), "text", "a number");
    assert_issue("intervals = 20", "intervals = 2.5", ("planner.intervals", 49, 13), "2.5", "a whole number");
    assert_issue("intervals = 20", "intervals = -2", ("planner.intervals", 49, 13), "-2", "0 or more");
    assert_issue("[fleet]", "[fleet]\nsimultaneous_arrival = 1", ("fleet.simultaneous_arrival", 45, 24), "1", "true");
    assert_issue("[0, 0]", "[0, 0, 0]", ("world.cylinders[0].center_m", 9, 12), "3 values", "2 numbers in brackets");
    assert_issue("[0, 0]", "[0]", ("world.cylinders[0].center_m", 9, 12), "1 values", "2 numbers in brackets");
    assert_issue("[0, 0]", "0", ("world.cylinders[0].center_m", 9, 12), "the whole number 0", "2 numbers in brackets");
    assert_issue("[0, 0]", "[0, true]", ("world.cylinders[0].center_m[1]", 9, 16), "true", "a number");
    assert_issue(
        "tracker = { natural_frequency_radps = 0.5, damping_ratio = 1 }",
        "tracker = 3",
        ("simulation.tracker", 60, 11),
        "the whole number 3",
        "a table",
    );
    assert_issue(
        "description = \"Two gliders pass one pillar.\"",
        "description = 1979-05-27",
        ("description", 2, 15),
        "a date",
        "text in quotes",
    );
}

#[test]
fn an_unknown_choice_is_rejected_with_a_suggestion() {
    let misspelt = "name = \"any\"\ntranscription = \"shoting\"";
    assert_issue(
        "name = \"any\"",
        misspelt,
        ("planner.transcription", 49, 17),
        "shoting",
        "\"trapezoid\" or \"shooting\"",
    );
    assert_eq!(issues("name = \"any\"", misspelt)[0].issue.remedy, "did you mean \"shooting\"?");
}

#[test]
fn numbers_that_are_not_finite_are_rejected_everywhere() {
    assert_issue("radius_m = 50", "radius_m = nan", ("world.cylinders[0].radius_m", 10, 12), "nan", "a finite number");
    assert_issue("[1, 0, 0]", "[1, -inf, 0]", ("simulation.wind.mean_mps[1]", 61, 25), "-inf", "a finite number");
    assert_issue("step_s = 0.01", "step_s = 1e999", ("simulation.step_s", 57, 10), "1e999", "a finite number");
    assert_issue(
        "n_y = [-0.4, 0.4]",
        "n_y = [-0.4, inf]",
        ("models.fixed-wing.glider.limits.n_y[1]", 21, 14),
        "inf",
        "a finite number",
    );
}

#[test]
fn issues_of_every_kind_are_reported_together_in_the_order_of_the_file() {
    let text = TEXT.replace("radius_m = 50", "radius_m = -50").replace("margin_m = 1", "margins_m = 1");
    let text = text.replace("step_s = 0.01", "step_s = nan").replace("goal_m = 5", "goal_m = 0");
    let error = scenarios::parse("minimal.toml", &text).unwrap_err();
    let fields: Vec<&str> = error.issues().iter().map(|issue| issue.issue.field.as_str()).collect();
    assert_eq!(fields, ["world.cylinders[0].radius_m", "planner.margins_m", "simulation.step_s", "verdict.goal_m"]);
}

#[test]
fn each_issue_has_a_line_with_file_line_and_column() {
    let error = load_changed("radius_m = 50", "radius_m = -50").unwrap_err();
    let expected = "minimal.toml:10:12: world.cylinders[0].radius_m: found -50, expected a number greater than 0";
    assert_eq!(error.lines(), [expected]);
}

#[test]
fn the_rendered_report_shows_the_place_in_the_file() {
    let error = load_changed("margin_m = 1", "margins_m = 1").unwrap_err();
    let mut page = String::new();
    miette::GraphicalReportHandler::new_themed(miette::GraphicalTheme::unicode_nocolor())
        .render_report(&mut page, &error)
        .unwrap();
    for part in [
        "minimal.toml is not a valid scenario: 1 error",
        "minimal.toml:50:1",
        "margins_m = 1",
        "did you mean `margin_m`",
    ] {
        assert!(page.contains(part), "`{part}` is missing in\n{page}");
    }
}

#[test]
fn an_unreadable_file_is_named() {
    let error = scenarios::load(std::path::Path::new("no/such/file.toml")).unwrap_err();
    assert!(error.to_string().starts_with("no/such/file.toml: "), "{error}");
}

#[test]
fn later_issues_are_located_in_the_file() {
    let source = scenarios::ScenarioFile::new("minimal.toml", TEXT);
    let issue = scenarios::Issue::new("planner.name", "\"any\"", "the name of a planner");
    assert_eq!(
        source.error(vec![issue]).lines(),
        ["minimal.toml:48:8: planner.name: found \"any\", expected the name of a planner"]
    );
}
