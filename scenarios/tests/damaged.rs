//! Damaged files never cause a panic, and those that are accepted satisfy all guarantees.

mod damage;

use damage::copies_of;
use scenarios::plan_input::{ImportedTrajectory, parse_csv, parse_json};
use scenarios::{parse, validate};

const PAIR: &str = include_str!("../../tests/scenarios/pair.toml");
const ROUNDS: usize = 4000;
/// One trajectory per vehicle, at least two rows each, all numbers finite, times from 0 and increasing.
fn assert_valid(trajectories: &[ImportedTrajectory], text: &str) {
    assert_eq!(trajectories.len(), 2, "{text}");
    for trajectory in trajectories {
        let ImportedTrajectory::Partial(trajectory) = trajectory else { panic!("not of a fixed wing: {text}") };
        let times_s = &trajectory.times_s;
        assert!(times_s.len() >= 2 && times_s[0].abs() <= 1e-9, "{text}");
        assert!(times_s.windows(2).all(|pair| pair[0] < pair[1]), "{text}");
        let states = trajectory.states.iter().flatten().flat_map(|state| state.to_array());
        let controls = trajectory.controls.iter().flatten().flat_map(|control| control.to_array());
        let numbers = trajectory.positions_m.iter().flatten().copied().chain(states).chain(controls);
        assert!(numbers.chain(times_s.iter().copied()).all(f64::is_finite), "{text}");
        let lengths = [trajectory.positions_m.len(), trajectory.states.as_ref().map_or(times_s.len(), Vec::len)];
        assert!(lengths.iter().all(|length| *length == times_s.len()), "{text}");
    }
}

#[test]
fn damaged_scenarios_are_rejected_or_valid() {
    let mut rejected = 0;
    for text in copies_of(PAIR, ROUNDS) {
        match parse("pair.toml", &text) {
            Err(error) => {
                assert!(!error.lines().is_empty(), "rejected without a reason:\n{text}");
                rejected += 1;
            }
            Ok(scenario) => assert_eq!(validate(&scenario), [], "{text}"),
        }
    }
    assert!(rejected > ROUNDS / 4, "only {rejected} were rejected");
}

#[test]
fn damaged_tables_are_rejected_or_valid() {
    let scenario = parse("pair.toml", PAIR).unwrap();
    let row = |who: (&str, i32), t: i32| format!("{},{t},{},{},400,35,0,0,0,0,1\n", who.0, 35 * t, who.1);
    let rows = [("uav-1", -100), ("uav-2", 100)].into_iter().flat_map(|who| (0..6).map(move |t| row(who, t)));
    let header = "vehicle,t_s,x_m,y_m,z_m,speed_mps,heading_rad,flight_path_rad,n_x,n_y,n_z\n";
    let mut rejected = 0;
    for text in copies_of(&(header.to_owned() + &rows.collect::<String>()), ROUNDS) {
        match parse_csv("plan.csv", &text, &scenario) {
            Err(error) => rejected += usize::from(!error.lines().is_empty()),
            Ok((_, trajectories)) => assert_valid(&trajectories, &text),
        }
    }
    assert!(rejected > ROUNDS / 4, "only {rejected} were rejected with a reason");
}

#[test]
fn damaged_documents_are_rejected_or_valid() {
    let scenario = parse("pair.toml", PAIR).unwrap();
    let document = r#"{"status": "solved", "objective": 30, "timings": {"wall_s": 1, "distributed_s": 1}, "trajectories": [
        {"vehicle": "uav-1", "times_s": [0, 30], "states": [
            {"x_m": 0, "y_m": -100, "z_m": 400, "speed_mps": 35, "heading_rad": 0, "flight_path_rad": 0},
            {"x_m": 1000, "y_m": -100, "z_m": 400, "speed_mps": 35, "heading_rad": 0, "flight_path_rad": 0}]},
        {"vehicle": "uav-2", "t_s": [0, 30], "x_m": [0, 1000], "y_m": [100, 100], "z_m": [400, 400]}]}"#;
    let mut rejected = 0;
    for text in copies_of(document, ROUNDS) {
        match parse_json("plan.json", &text, &scenario) {
            Err(error) => rejected += usize::from(!error.lines().is_empty()),
            Ok((header, trajectories)) if trajectories.is_empty() => {
                assert_eq!(header.status, Some(scenarios::PlanStatus::NoPlan), "{text}");
            }
            Ok((_, trajectories)) => assert_valid(&trajectories, &text),
        }
    }
    assert!(rejected > ROUNDS / 2, "only {rejected} were rejected with a reason");
}
