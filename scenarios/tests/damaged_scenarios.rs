//! Damaged scenarios of all families and damaged formulas never cause a panic; what is accepted is valid.
//! `FUZZ_ROUNDS=1000000` asks for a million copies of each.

mod damage;

use damage::copies_of;
use scenarios::requirement::{AppliesTo, Requirement};
use scenarios::{Scenario, parse, validate};

const ROUNDS: usize = 400;
/// A fleet with what no shipped scenario has: geofences, requirements, sensors, wind.
const PAIR: &str = include_str!("../../tests/scenarios/pair.toml");
const MORE: &str = r#"
[[world.geofences]]
name = "site"
kind = "stay-in"
polygon_m = [[-2000.0, -2000.0], [2000.0, -2000.0], [1500.0, 500.0], [2000.0, 2000.0], [-2000.0, 2000.0]]

[[world.geofences]]
name = "tower"
kind = "keep-out"
polygon_m = [[-2000.0, 1800.0], [-1900.0, 1800.0], [-1900.0, 1900.0]]
z_m = [0.0, 120.0]

[[requirements]]
name = "low-pass"
formula = "for all pairs a, b: always (distance(a, b) < 300 m implies eventually [0 s, 5 s] altitude(a) > 50 m)"
description = "Stay above small arms fire."
advisory = true
applies_to = "flight"
"#;
const SHIPPED: [(&str, &str); 3] = [
    ("gate.toml", include_str!("../slung/gate.toml")),
    ("corridor-moving.toml", include_str!("../multirotor/corridor-moving.toml")),
    ("rendezvous-7-wind.toml", include_str!("../fixed-wing/rendezvous-7-wind.toml")),
];
const FORMULAS: [&str; 6] = [
    "for all pairs a, b: always (time_left > 5 s implies eventually [0 s, 5 s] distance(a, b) > 200 m)",
    "altitude(uav-1) > 90 m until [2 s, 8 s] (bank(uav-1) < 40 deg until [0 s, 5 s] altitude(uav-1) > 120 m)",
    "not (max(altitude(uav-1), 3 ft, 2 * north(uav-2) / 4) > abs(east(uav-1) - 1 nmi) or time > 2 min)",
    "always [10 s, 600 s] inside(uav-1, site) > 0 m",
    "for some a: always heading_from(a, 90 deg) > 60 deg and speed(a) * 3 s >= 1 km",
    "((((((always (always (eventually (not (not (altitude(uav-1) > 1 m)))))))))))",
];

fn rounds() -> usize {
    std::env::var("FUZZ_ROUNDS").ok().and_then(|rounds| rounds.parse().ok()).unwrap_or(ROUNDS)
}

fn rich() -> String {
    format!("{PAIR}\n{MORE}")
}

#[test]
fn damaged_scenarios_of_all_families_are_rejected_or_valid() {
    let rich = rich();
    for (name, original) in [("pair.toml", rich.as_str())].into_iter().chain(SHIPPED) {
        parse(name, original).unwrap_or_else(|error| panic!("{name}: {error}"));
        let (mut rejected, mut accepted) = (0, 0);
        for text in copies_of(original, rounds()) {
            match parse(name, &text) {
                Err(error) => {
                    assert!(!error.lines().is_empty(), "rejected without a reason:\n{text}");
                    rejected += 1;
                }
                Ok(scenario) => {
                    assert_eq!(validate(&scenario), [], "{text}");
                    accepted += 1;
                }
            }
        }
        println!("{name}: {rejected} rejected, {accepted} accepted");
        assert!(rejected > rounds() / 4 && accepted > 0, "{name}: {rejected} rejected, {accepted} accepted");
    }
}

#[test]
fn damaged_formulas_are_rejected_with_a_place_in_their_text_or_have_predicates() {
    let scenario: Scenario = parse("pair.toml", &rich()).unwrap();
    for original in FORMULAS {
        assert!(requirement(original.to_owned()).formula(&scenario).is_ok(), "{original}");
        let (mut rejected, mut accepted) = (0, 0);
        for text in copies_of(original, 20 * rounds()) {
            let requirement = requirement(text);
            match requirement.formula(&scenario) {
                Err(error) => {
                    assert!(error.span.end <= requirement.formula.len(), "{error:?}: {}", requirement.formula);
                    assert!(!error.found.is_empty() && !error.expected.is_empty(), "{error:?}");
                    rejected += 1;
                }
                Ok(formula) => {
                    assert!(!formula.predicates.is_empty(), "{}", requirement.formula);
                    accepted += 1;
                }
            }
        }
        println!("{rejected} rejected, {accepted} accepted: {original}");
        assert!(rejected > rounds() && accepted > 0, "{rejected} rejected, {accepted} accepted: {original}");
    }
}

fn requirement(formula: String) -> Requirement {
    Requirement { name: "r".into(), formula, description: String::new(), advisory: false, applies_to: AppliesTo::Both }
}

#[test]
fn formulas_that_nest_deeply_are_rejected_and_not_followed() {
    let scenario: Scenario = parse("pair.toml", &rich()).unwrap();
    for (open, close) in [("(", ")"), ("not ", ""), ("always ", ""), ("always [0 s, 1 s] (", ")"), ("abs(", ")")] {
        let nested = |depth: usize| format!("{}altitude(uav-1) > 1 m{}", open.repeat(depth), close.repeat(depth));
        assert!(requirement(nested(100_000)).formula(&scenario).is_err(), "{open}");
    }
}

#[test]
fn brackets_are_read_once_whatever_they_are_around() {
    let scenario: Scenario = parse("pair.toml", &rich()).unwrap();
    let (open, close) = ("(".repeat(30), ")".repeat(30));
    for formula in [
        format!("{open}altitude(uav-1) > 1 m{close}"),
        format!("{open}altitude(uav-1){close} > 1 m"),
        format!("{open}altitude(uav-1){close} > {open}1 m{close}"),
        format!("{open}1 m + (altitude(uav-1) > 1 m){close}"),
        format!("{open}altitude(uav-1) > 1 m and{close}"),
    ] {
        let is_formula = !formula.contains("and") && !formula.contains('+');
        assert_eq!(requirement(formula.clone()).formula(&scenario).is_ok(), is_formula, "{formula}");
    }
}
