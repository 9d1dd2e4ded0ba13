//! Edge cases of scenario files: empty, duplicate, too long, not plain text, too large, too small, not a number.

mod minimal;

use minimal::{TEXT, assert_issue, load_changed};
use scenarios::parse;

/// The lines of the issues of a text.
fn issue_lines(text: &str) -> Vec<String> {
    parse("minimal.toml", text).expect_err("the text should be rejected").lines()
}

#[test]
fn names_have_a_maximum_length() {
    let [fits, too_long] = [64, 65].map(|length| "x".repeat(length));
    assert!(parse("minimal.toml", &TEXT.replace("uav-1", &fits)).is_ok());
    assert!(parse("minimal.toml", &TEXT.replace("pillar", &fits)).is_ok());
    assert!(parse("minimal.toml", &TEXT.replace("glider", &fits)).is_ok());
    assert!(parse(&format!("{fits}.toml"), &TEXT.replace("\"minimal\"", &format!("\"{fits}\""))).is_ok());
    for name in ["uav-1", "pillar", "glider"] {
        let lines = issue_lines(&TEXT.replace(name, &too_long));
        assert!(lines.iter().any(|line| line.contains("at most 64 characters")), "{name}: {lines:?}");
    }
    let error = parse(&format!("{too_long}.toml"), &TEXT.replace("\"minimal\"", &format!("\"{too_long}\"")));
    assert!(error.unwrap_err().lines()[0].contains("a name of 65 characters"));
}

#[test]
fn names_are_plain_text() {
    for name in ["uav 1", "uav,1", "ünal", "無人機", "a/b", "..", "uav\\n", "🛩", "\\u0000", " "] {
        let lines = issue_lines(&TEXT.replace("\"uav-1\"", &format!("\"{name}\"")));
        assert!(lines.iter().any(|line| line.contains("vehicles[0].name")), "{name}: {lines:?}");
    }
    // Descriptions may contain any text.
    assert!(parse("minimal.toml", &TEXT.replace("Two gliders", "Zwei Gleiter, 二機 🛩")).is_ok());
}

#[test]
fn optional_lists_may_be_empty() {
    let without = |table: &str| {
        let from = TEXT.find(table).expect("the table is there");
        let to = TEXT[from + 1..].find("\n[").map_or(TEXT.len(), |at| from + 2 + at);
        format!("{}{}", &TEXT[..from], &TEXT[to..])
    };
    assert!(parse("minimal.toml", &without("[[world.cylinders]]")).is_ok());
    let one = without("[[vehicles]]");
    assert!(parse("minimal.toml", &one).is_ok(), "a fleet of one");
    let from = one.find("[[vehicles]]").unwrap();
    let to = from + one[from..].find("[fleet]").unwrap();
    let none = format!("vehicles = []\n{}{}", &one[..from], &one[to..]);
    assert!(issue_lines(&none).iter().any(|line| line.contains("vehicles")), "{:?}", issue_lines(&none));
    assert!(parse("minimal.toml", &format!("tags = []\n{TEXT}")).is_ok());
    assert!(!issue_lines("").is_empty());
}

#[test]
fn duplicate_names_are_reported_with_both_places() {
    let lines = issue_lines(&TEXT.replace("\"uav-2\"", "\"uav-1\""));
    let [line] = lines.as_slice() else { panic!("{lines:?}") };
    assert!(line.contains("vehicles[1].name") && line.contains("vehicles[0] has"), "{line}");
}

#[test]
fn numbers_that_are_not_finite_are_rejected_everywhere() {
    let mut places = 0;
    for (at, _) in TEXT.match_indices(" = ") {
        let rest = &TEXT[at + 3..];
        let end = rest.find(['\n', ',', '}', ' ']).unwrap();
        if rest[..end].parse::<f64>().is_err() {
            continue;
        }
        places += 1;
        for value in ["nan", "inf", "-inf", "+nan"] {
            let text = format!("{}{value}{}", &TEXT[..at + 3], &rest[end..]);
            assert!(
                !issue_lines(&text).is_empty(),
                "{value} in place of {}",
                &TEXT[at.saturating_sub(20)..at + 3 + end]
            );
        }
    }
    assert!(places > 30, "{places}");
}

#[test]
fn numbers_out_of_range_are_rejected_everywhere() {
    let place = ("world.cylinders[0].radius_m", 10, 12);
    assert_issue("radius_m = 50", "radius_m = 1e-300", place, "1e-300", "in magnitude");
    for (old, beyond) in [
        ("center_m = [0, 0]", "center_m = [1e300, 0]"),
        ("radius_m = 50", "radius_m = 1_0e299"),
        ("mass_kg = 10", "mass_kg = 5e-324"),
        ("x_m = -900", "x_m = -1.7976931348623157e308"),
    ] {
        let lines = issue_lines(&TEXT.replace(old, beyond));
        assert!(lines.iter().any(|line| line.contains("in magnitude")), "{beyond}: {lines:?}");
    }
}

#[test]
fn thousands_of_obstacles_load() {
    let mut text = TEXT.to_owned();
    for index in 0..20_000 {
        let (x_m, y_m) = (index % 190 * 10 - 900, 300 + index / 190);
        text += &format!("\n[[world.cylinders]]\nname = \"tree-{index}\"\ncenter_m = [{x_m}, {y_m}]\nradius_m = 0.1\n");
    }
    let scenario = parse("minimal.toml", &text).expect("many trees");
    assert_eq!(scenario.world.cylinders.len(), 20_001);
}

#[test]
fn wind_may_be_zero() {
    let windy = "mean_mps = [1, 0, 0], gusts = { wind_at_20ft_mps = 5, sigma_aloft_mps = 1 }";
    let calm = "mean_mps = [0, 0, 0], gusts = { wind_at_20ft_mps = 0, sigma_aloft_mps = 0 }";
    assert!(load_changed(windy, calm).is_ok());
}

#[test]
fn the_number_of_steps_has_a_maximum() {
    for (step_s, most_s) in [("1e-9", "100"), ("0.01", "1e9"), ("1e-12", "1e12")] {
        let simulation = format!("step_s = {step_s}\nmax_duration_s = {most_s}");
        let lines = issue_lines(&TEXT.replace("step_s = 0.01\nmax_duration_s = 100", &simulation));
        assert!(lines.iter().any(|line| line.contains("steps")), "{step_s}, {most_s}: {lines:?}");
    }
}

/// Scripts write rounding, such as that of an arc tangent, in place of 0.
#[test]
fn tiny_coordinates_and_angles_are_as_good_as_zero() {
    for (old, tiny) in [
        ("center_m = [0, 0]", "center_m = [-5.8e-14, 1e-300]"),
        ("y_m = 200", "y_m = 200, heading_deg = -5.8e-14"),
        ("y_m = 200", "y_m = 200, flight_path_deg = 5e-324"),
    ] {
        assert!(TEXT.contains(old), "{old}");
        assert!(scenarios::parse("minimal.toml", &TEXT.replacen(old, tiny, 1)).is_ok(), "{tiny}");
    }
}
