use crate::Scenario;
use crate::requirement::Requirement;

fn fleet() -> Scenario {
    crate::load("shipped:rendezvous-2".as_ref()).expect("a shipped scenario")
}

fn error(formula: &str) -> String {
    formula_error(formula).to_string()
}

fn formula_error(formula: &str) -> super::FormulaError {
    let requirement = Requirement {
        name: "r".into(),
        formula: formula.into(),
        description: String::new(),
        advisory: false,
        applies_to: super::AppliesTo::Both,
    };
    requirement.formula(&fleet()).expect_err("no formula")
}

fn is_formula(formula: &str) -> bool {
    let text = fleet().to_toml() + &format!("\n[[requirements]]\nname = \"r\"\nformula = \"{formula}\"\n");
    crate::parse("rendezvous-2.toml", &text).is_ok()
}

#[test]
fn formulas_of_every_operator_are_read() {
    for formula in [
        "always altitude > 50 m",
        "for all pairs a, b: always (distance(a, b) > 200 m or eventually [0 s, 5 s] distance(a, b) > 200 m)",
        "for all a: for some b: not (time < 3 s until[1 s, 2.5e0 min] speed(a) >= -2 * speed(b) + 10 kt)",
        "always (abs(flight_path) < 20 deg implies min(speed, 3 m/s, ground_speed) <= max(climb_rate, 1 m / 2 s))",
        "eventually horizontal_distance('uav-1', vehicles) < 0.5 nmi and time_left ≥ 1 ms",
        "always heading_from(90 deg) < 45 deg until distance(point(1 m, -2 m, 3 ft)) < 100 m",
    ] {
        assert!(is_formula(formula), "{formula}");
    }
}

#[test]
fn errors_name_place_and_remedy() {
    for (formula, wanted) in [
        ("always altitude > 50 s", "at byte 18: found `50 s`, expected a quantity in m"),
        ("always altitude + 3 s > 50 m", "at byte 18: found `3 s`, expected a quantity in m"),
        ("always altitud > 50 m", "at byte 7: found `altitud`, expected a signal or a function"),
        ("always altitude", "at byte 7: found `altitude`, expected something that is true or false"),
        ("always altitude >", "at byte 17: found the end of the formula, expected a signal, a number"),
        ("always [0 s, 10] altitude > 1 m", "at byte 13: found `10`, expected a time with its unit"),
        ("always [0 s 10 s] altitude > 1 m", "at byte 12: found `10`"),
        ("altitude > 3 m altitude", "at byte 15: found `altitude`, expected an operator or the end"),
        ("distance(uav-9) > 3 m", "at byte 9: found `uav-9`, expected an obstacle, a vehicle"),
        ("for all a: altitude > 3 m", "at byte 11: found `altitude`, expected a vehicle: with quantifiers"),
        ("always for all a: altitude(a) > 3 m", "expected quantifiers only at the beginning"),
        ("height > 3 m", "expected a scenario with `world.ground_m`"),
        ("inside(nowhere) > 0 m", "expected a geofence"),
    ] {
        let found = error(formula);
        assert!(found.contains(wanted), "{formula}: {found}");
    }
    assert!(error(&"(".repeat(40)).contains("32 parentheses"));
    for (formula, remedy) in [
        ("ALWAYS altitude > 3 m", "write `always`"),
        ("always altitude == 3 m", "abs(a - b) < tolerance"),
        ("always 1 m < altitude < 3 m", "compare two at a time"),
        ("always altitude > 3 furlong", "these are known: m/s^2"),
    ] {
        let found = formula_error(formula).remedy;
        assert!(found.contains(remedy), "{formula}: {found}");
    }
}

#[test]
fn errors_are_placed_in_the_line_of_the_file() {
    let text = fleet().to_toml() + "\n[[requirements]]\nname = \"low\"\nformula = \"always altitude > 50 s\"\n";
    let error = crate::parse("rendezvous-2.toml", &text).unwrap_err();
    let line = text.lines().count();
    assert_eq!(error.lines().len(), 1, "{:?}", error.lines());
    // `formula = "` has 11 characters, the formula 18 before `50 s`.
    assert!(
        error.lines()[0].starts_with(&format!("rendezvous-2.toml:{line}:30: requirements[0].formula: found `50 s`"))
    );
}

#[test]
fn names_of_requirements_and_of_their_checks_are_checked() {
    let with = |entries: &str| crate::parse("rendezvous-2.toml", &(fleet().to_toml() + entries));
    let twice = "\n[[requirements]]\nname = \"r\"\nformula = \"time < 9 s\"\n".repeat(2);
    assert!(with(&twice).unwrap_err().lines()[0].contains("a unique name"));
    let mut scenario = with(&twice[..twice.len() / 2]).unwrap();
    scenario.verdict.advisory = vec!["flight.requirement.r".into()];
    assert!(crate::validate(&scenario).is_empty());
    scenario.verdict.advisory = vec!["flight.requirement.s".into()];
    assert_eq!(crate::validate(&scenario)[0].remedy, "did you mean \"flight.requirement.r\"?");
}
