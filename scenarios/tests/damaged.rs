//! Damaged files never cause a panic, and those that are accepted satisfy all guarantees.

mod damage;

use damage::copies_of;
use scenarios::plan_input::{ImportedTrajectory, parse_csv, parse_json};
use scenarios::{Scenario, parse, validate};

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

/// Tables of other tools, polynomial pieces and splines. `FUZZ_ROUNDS=1000000` asks for a million copies of each.
#[test]
fn damaged_plans_of_other_tools_are_rejected_or_valid() {
    let rounds = std::env::var("FUZZ_ROUNDS").ok().and_then(|rounds| rounds.parse().ok()).unwrap_or(ROUNDS);
    let scenario = parse("hoverer.toml", include_str!("../../tests/scenarios/hoverer.toml")).unwrap();
    for original in OTHER_TOOLS {
        assert_valid_multirotor(&read(original, &scenario).expect("the original is a plan"), original);
        let (mut rejected, mut accepted) = (0, 0);
        for text in copies_of(original, rounds) {
            match read(&text, &scenario) {
                Ok(trajectories) if trajectories.is_empty() => {}
                Ok(trajectories) => {
                    assert_valid_multirotor(&trajectories, &text);
                    accepted += 1;
                }
                Err(lines) => {
                    assert!(!lines.is_empty(), "rejected without a reason:\n{text}");
                    rejected += 1;
                }
            }
        }
        println!("{rejected} rejected, {accepted} accepted of {rounds} copies of {original:?}");
        assert!(rejected > rounds / 10 && accepted > 0, "{rejected} rejected, {accepted} accepted:\n{original}");
    }
}

/// Originals: dialects of tables, pieces, and the three forms of curves in JSON.
const OTHER_TOOLS: [&str; 7] = [
    ",t,x,y,z,vx,vy,vz,ax,phase\n0,0,0,0,2,0,0,0,9,climb\n1,2,1,0,2,0,0,0,,turn\n2,3,2,0,2,0,0,0,,end\n",
    "# by hand\n# time[ms] pos_x[cm] y z\n0 0 0 2\n500 20 0 2\n1000 60 0 2\n",
    "1403636579.5 0 0 2 0 0 0 1\n1403636580.0 0.25 0 2 0 0 0 1\n1403636581.0 1 0 2 0 0 0 1\n",
    "duration,x^0,x^1,x^2,y^0,z^0,yaw^0,\n1.000000,0.000000,0.000000,1.000000,0.000000,2.000000,0.000000,\n\
     2.000000,1.000000,2.000000,0.000000,0.000000,2.000000,0.000000,\n",
    r#"{"trajectories": [{"vehicle": "uav-1", "polynomials": [{"duration_s": 1, "x": [0, 0, 1], "y": [], "z": [2]}]}]}"#,
    r#"{"trajectories": [{"vehicle": "uav-1", "bezier": [{"duration_s": 1, "points_m": [[0,0,2],[0,0,2],[1,0,2]]}]}]}"#,
    r#"{"trajectories": [{"vehicle": "uav-1", "b_spline": {"degree": 2, "knots_s": [0,0,0,1,1,3,3,3],
        "points_m": [[0,0,2],[0,0,2],[1,0,2],[3,0,2],[5,0,2]]}}]}"#,
];

fn read(text: &str, scenario: &Scenario) -> Result<Vec<ImportedTrajectory>, Vec<String>> {
    let is_json = text.trim_start().starts_with('{');
    let read = if is_json { parse_json("plan.json", text, scenario) } else { parse_csv("plan.csv", text, scenario) };
    read.map(|(_, trajectories)| trajectories).map_err(|error| error.lines())
}

/// Finite, from time 0 on, and in the order of time, also as the cubics that the judge sees.
fn assert_valid_multirotor(trajectories: &[ImportedTrajectory], text: &str) {
    let [trajectory] = trajectories else { panic!("one vehicle:\n{text}") };
    let (times_s, numbers): (Vec<f64>, Vec<f64>) = match trajectory {
        ImportedTrajectory::Complete(trajectory) => (trajectory.times_s().to_vec(), trajectory.nodes().numbers()),
        ImportedTrajectory::Positions(positions) => {
            assert!(positions.times_s.windows(2).all(|pair| pair[0] < pair[1]), "{text}");
            (positions.times_s.clone(), positions.positions_m.concat())
        }
        ImportedTrajectory::Curve(curve) => {
            let (nodes, error) = curve.cubics(1e-3);
            assert!(error.position_m >= 0.0 && error.acceleration_mps2 >= 0.0, "{text}");
            let numbers = nodes.iter().flat_map(|node| node.position_m);
            (nodes.iter().map(|node| node.t_s).collect(), numbers.collect())
        }
        ImportedTrajectory::Partial(_) => panic!("of a multirotor:\n{text}"),
    };
    assert!(times_s.len() >= 2 && times_s[0].abs() <= 1e-9, "{text}");
    assert!(times_s.windows(2).all(|pair| pair[0] <= pair[1]), "{text}");
    assert!(times_s.iter().chain(&numbers).all(|number| number.is_finite()), "{text}");
}
