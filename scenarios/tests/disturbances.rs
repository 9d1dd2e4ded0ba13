//! Disturbances that could not act, or would fall between two steps of the simulator, are refused.

mod minimal;

use minimal::{assert_issue, load_changed};
use scenarios::LocatedIssue;

const RECTANGLE: &str = include_str!("../slung/rectangle.toml");
const RECTANGLE_WIND: &str = include_str!("../slung/rectangle-wind.toml");
const PAPER_MAP_GUSTS: &str = include_str!("../multirotor/paper-map-gusts.toml");

const GUSTS: &str = "gusts = { wind_at_20ft_mps = 5, sigma_aloft_mps = 1 }";

fn pulses(duration_s: f64) -> String {
    format!("pulses = [{{ start_s = 1, duration_s = {duration_s}, peak_mps = [0, 5, 0] }}]")
}

#[test]
fn a_single_gust_lasts_four_steps_or_more() {
    let (field, line) = ("simulation.wind.pulses[0].duration_s", 61);
    assert_issue(
        GUSTS,
        &pulses(0.039),
        (field, line, 70),
        "0.039 s, at a time step of 0.01 s",
        "at least 4 time steps",
    );
    let error = load_changed(GUSTS, &pulses(0.01)).unwrap_err();
    assert!(error.issues()[0].issue.remedy.contains("simulation.step_s to at most 0.0025 s"), "{error}");
    for duration_s in [0.04, 0.1 * 0.4, 1.5] {
        assert!(load_changed(GUSTS, &pulses(duration_s)).is_ok(), "{duration_s}");
    }
}

#[test]
fn a_delay_is_not_rounded_to_nothing() {
    let noise = "sensors = { position_noise_m = 0.1,";
    let delayed = |delay_s: f64| format!("{noise} delay_s = {delay_s},");
    let field = ("simulation.sensors.delay_s", 62, 47);
    assert_issue(noise, &delayed(0.004), field, "0.004 s, less than half a time step", "not rounded to nothing");
    assert!([0.0, 0.005, 0.03].iter().all(|delay_s| load_changed(noise, &delayed(*delay_s)).is_ok()));
}

#[test]
fn noise_and_mismatch_that_a_family_has_no_use_for_are_refused() {
    let noise = "velocity_noise_mps = 0.1";
    for (key, expected) in [
        ("attitude_noise_deg", "attitude"),
        ("rate_noise_degps", "attitude"),
        ("load_position_noise_m", "load"),
        ("load_velocity_noise_mps", "load"),
        ("sighting_position_noise_m", "multirotors"),
        ("sighting_velocity_noise_mps", "multirotors"),
    ] {
        let field = format!("simulation.sensors.{key}");
        assert_issue(noise, &format!("{key} = 0.3"), (&field, 62, 40 + key.len()), "0.3", expected);
    }
    let field = ("simulation.mismatch.load_mass_ratio", 63, 32);
    assert_issue("mass_ratio = 1.1", "load_mass_ratio = 1.2", field, "1.2", "no vehicle carries a load");
}

/// The single issue of a changed scenario file.
fn issue(name: &str, text: &str, [old, new]: [&str; 2]) -> LocatedIssue {
    assert!(text.contains(old), "{name} has no `{old}`");
    let error = scenarios::parse(name, &text.replace(old, new)).expect_err("the change should have been refused");
    let [issue] = error.issues() else { panic!("expected one issue: {error}") };
    issue.clone()
}

#[test]
fn wind_needs_a_vehicle_with_drag() {
    let drag_area = RECTANGLE_WIND.lines().find(|line| line.starts_with("drag_area_m2")).unwrap();
    let load_drag_area = RECTANGLE_WIND.lines().find(|line| line.starts_with("load_drag_area_m2")).unwrap();
    for line in [drag_area, load_drag_area] {
        assert!(scenarios::parse("rectangle-wind.toml", &RECTANGLE_WIND.replace(line, "")).is_ok(), "one is enough");
    }
    let without = RECTANGLE_WIND.replace(load_drag_area, "");
    let found = issue("rectangle-wind.toml", &without, [drag_area, ""]);
    assert_eq!(found.issue.field, "simulation.wind");
    assert!(found.issue.expected.contains("drag_area_m2 or load_drag_area_m2"), "{found}");
    let found = issue("paper-map-gusts.toml", PAPER_MAP_GUSTS, ["drag_area_m2 = 0.03", ""]);
    assert!(found.issue.found.contains("`uav-1`") && found.issue.expected.contains("models.multirotor."), "{found}");

    let scenario = scenarios::parse("rectangle.toml", RECTANGLE).expect("no wind, no drag");
    assert!(scenarios::wind_without_effect(&scenario).is_some());
}

#[test]
fn wind_that_does_not_blow_needs_no_drag() {
    let calm = format!("{RECTANGLE}\n[simulation.wind]\nmean_mps = [0, 0, 0]\n");
    assert!(scenarios::parse("rectangle.toml", &calm).is_ok());
    let breeze = calm.replace("[0, 0, 0]", "[0, 0.1, 0]");
    assert!(scenarios::parse("rectangle.toml", &breeze).is_err());
}
