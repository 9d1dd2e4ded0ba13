//! Import of plan files: what is accepted, and the messages for what is rejected.

mod curves;
mod json;
#[cfg(feature = "parquet")]
mod parquet;
mod slung_load;
mod tables;

use std::path::Path;

use scenarios::fixed_wing::PartialTrajectory;
use scenarios::plan_input::{ImportedTrajectory, PlanError, PlanHeader, parse_csv, read};
use scenarios::{Scenario, parse};

const PAIR: &str = include_str!("../../../tests/scenarios/pair.toml");
const HEADER: &str = "vehicle,t_s,x_m,y_m,z_m,speed_mps,heading_rad,flight_path_rad,n_x,n_y,n_z\n";

fn scenario() -> Scenario {
    parse("pair.toml", PAIR).expect("a valid scenario")
}

/// Both aircraft straight ahead at 35 m/s, one row per second, each line mapped by `change`.
fn csv(change: impl Fn(String) -> Vec<String>) -> String {
    let row = |(name, y): (&str, i32), t: i32| format!("{name},{t},{},{y},400,35,0,0,0,0,1", 35 * t);
    let rows = [("uav-1", -100), ("uav-2", 100)].into_iter().flat_map(|who| (0..30).map(move |t| row(who, t)));
    HEADER.to_owned() + &rows.flat_map(change).map(|line| line + "\n").collect::<String>()
}

fn complete() -> String {
    csv(|line| vec![line])
}

fn trajectories(text: &str) -> Vec<PartialTrajectory> {
    fixed_wings(parse_csv("plan.csv", text, &scenario()).expect("a plan").1)
}

fn fixed_wings(trajectories: Vec<ImportedTrajectory>) -> Vec<PartialTrajectory> {
    let fixed_wing = |trajectory| match trajectory {
        ImportedTrajectory::Partial(trajectory) => trajectory,
        _ => panic!("not of a fixed wing"),
    };
    trajectories.into_iter().map(fixed_wing).collect()
}

/// Asserts that the text is rejected for a single issue whose line contains all of `parts`.
#[track_caller]
fn assert_rejected(result: Result<(PlanHeader, Vec<ImportedTrajectory>), PlanError>, parts: &[&str]) {
    let lines = result.expect_err("it should have been rejected").lines();
    let [line] = lines.as_slice() else { panic!("expected one issue, found {lines:#?}") };
    for part in parts {
        assert!(line.contains(part), "`{part}` is missing in: {line}");
    }
}

#[track_caller]
fn assert_csv_rejected(text: &str, parts: &[&str]) {
    assert_rejected(parse_csv("plan.csv", text, &scenario()), parts);
}

#[test]
fn a_complete_plan_is_read_in_any_order_of_rows_and_columns() {
    let expected = trajectories(&complete());
    assert_eq!((expected.len(), expected[1].times_s.len()), (2, 30));
    assert_eq!(expected[1].positions_m[29], [1015.0, 100.0, 400.0]);
    assert!(expected[0].states.is_some() && expected[0].controls.is_some());
    // Sorted by time instead of by vehicle, columns reversed, spaces, and NumPy's mark before the header.
    let text = complete();
    let mut lines: Vec<&str> = text.lines().skip(1).collect();
    lines.sort_by_key(|line| line.split(',').nth(1).unwrap().parse::<i32>().unwrap());
    let turned = |line: &str| line.split(',').rev().collect::<Vec<_>>().join(" , ");
    let body: String = lines.iter().map(|line| turned(line) + "\r\n").collect();
    assert_eq!(trajectories(&format!("# {}\r\n{body}", turned(HEADER.trim()))), expected);
}

#[test]
fn velocities_and_controls_are_optional() {
    let keep = |n: usize| {
        complete().lines().map(|line| line.split(',').take(n).collect::<Vec<_>>().join(",") + "\n").collect::<String>()
    };
    let (states, positions) = (trajectories(&keep(8)), trajectories(&keep(5)));
    assert!(states[0].states.is_some() && states[0].controls.is_none());
    assert!(positions[0].states.is_none() && positions[0].controls.is_none());
}

#[test]
fn degrees_and_cartesian_velocities_are_converted() {
    let degrees = complete().replace("heading_rad", "heading_deg").replace(",35,0,0,", ",35,360,0,");
    let heading_rad = trajectories(&degrees)[0].states.as_ref().unwrap()[7].heading_rad;
    assert!((heading_rad - std::f64::consts::TAU).abs() < 1e-12);
    let cartesian = complete().replace("speed_mps,heading_rad,flight_path_rad", "vx_mps,vy_mps,vz_mps");
    assert_eq!(trajectories(&cartesian), trajectories(&complete()));
}

#[test]
fn headings_are_unwrapped() {
    let text = csv(|line| {
        vec![if line.contains(",7,") { line.replace(",35,0,0,", ",35,6.283185307179586,0,") } else { line }]
    });
    assert!(trajectories(&text)[0].states.as_ref().unwrap().iter().all(|state| state.heading_rad.abs() < 1e-12));
}

#[test]
fn a_single_vehicle_needs_no_name() {
    let second = PAIR.find("[[vehicles]]\nname = \"uav-2\"").unwrap();
    let end = PAIR.find("[fleet]").unwrap();
    let alone = PAIR[..second].to_owned() + &PAIR[end..];
    let scenario = parse("pair.toml", &alone).unwrap();
    let nameless: String = complete()
        .lines()
        .filter(|line| !line.starts_with("uav-2"))
        .map(|line| line.split_once(',').unwrap().1.to_owned() + "\n")
        .collect();
    assert_eq!(fixed_wings(parse_csv("plan.csv", &nameless, &scenario).unwrap().1)[0].vehicle, "uav-1");
    assert_csv_rejected(&nameless, &["plan.csv:1: header", "a column `vehicle`"]);
}

#[test]
fn wrong_names_are_located() {
    let renamed = complete().replace("uav-2", "uav-3");
    let lines = parse_csv("plan.csv", &renamed, &scenario()).unwrap_err().lines();
    assert_eq!(lines.len(), 2, "{lines:#?}");
    assert!(
        lines[0].starts_with("plan.csv:32: vehicle: found \"uav-3\"") && lines[0].contains("did you mean"),
        "{lines:#?}"
    );
    assert!(lines[1].contains("no row of `uav-2`"), "{lines:#?}");
    assert_csv_rejected(
        &csv(|line| if line.starts_with("uav-2") { vec![] } else { vec![line] }),
        &["no row of `uav-2`"],
    );
}

#[test]
fn wrong_columns_are_named() {
    let both =
        |old: &str, new: &str| parse_csv("plan.csv", &complete().replace(old, new), &scenario()).unwrap_err().lines();
    let unknown = both("speed_mps", "speed_kmh");
    assert!(
        unknown[0].contains("speed_kmh of uav-1: found an unknown column") && unknown[0].contains("speed_mps"),
        "{unknown:#?}"
    );
    let missing = both("z_m", "n_x2");
    assert!(missing.iter().any(|line| line.contains("z_m of uav-1: found nothing")), "{missing:#?}");
    let half = both("n_y", "heading_deg");
    assert!(half.iter().any(|line| line.contains("heading_rad") && line.contains("twice")), "{half:#?}");
    assert!(
        half.iter().any(|line| line.contains("n_y of uav-1: found nothing, expected n_x, n_y, n_z together")),
        "{half:#?}"
    );
    assert_csv_rejected(&complete().replace("n_y", "n_x"), &["plan.csv:1: header: found two columns named `n_x`"]);
    assert_csv_rejected(&complete().replace("t_s", "when"), &["a column `t_s`", "--columns"]);
    assert_csv_rejected("", &["plan.csv:1: header"]);
}

#[test]
fn cells_that_are_not_numbers_are_located() {
    let at_seven = |new: &'static str| csv(move |line| vec![line.replace("uav-2,7,245,", new)]);
    assert_csv_rejected(&at_seven("uav-2,7,east,"), &["plan.csv:39: x_m: found \"east\", expected a number"]);
    assert_csv_rejected(&at_seven("uav-2,7,,"), &["plan.csv:39: x_m: found nothing"]);
    assert_csv_rejected(&at_seven("uav-2,7,nan,"), &["plan.csv:39: x_m of uav-2: found NaN, expected a finite number"]);
    assert_csv_rejected(&at_seven("uav-2,7,1e999,"), &["plan.csv:39", "found inf"]);
    assert_csv_rejected(&at_seven("uav-2,7,"), &["plan.csv:39: line: found 10 values, expected 11"]);
    assert_csv_rejected(&at_seven("uav-2,7,245,0,"), &["plan.csv:39: line: found 12 values"]);
}

#[test]
fn wrong_times_are_located() {
    let changed = |old: &'static str, new: &'static str| csv(move |line| vec![line.replace(old, new)]);
    assert_csv_rejected(
        &changed("uav-1,7,", "uav-1,6,"),
        &["plan.csv:9: t_s of uav-1: found 6 s after 6 s", "remove one"],
    );
    assert_csv_rejected(&changed("uav-1,7,", "uav-1,5.5,"), &["plan.csv:9", "found 5.5 s after 6 s", "sort the rows"]);
    assert_csv_rejected(
        &changed("uav-1,0,", "uav-1,0.5,"),
        &["plan.csv:2", "0.5 s in the first row", "from the start"],
    );
    assert_csv_rejected(&changed("uav-2,29,", "uav-2,1e7,"), &["10000000 s at the end", "milliseconds"]);
    let one = csv(|line| if line.contains("uav-1,0,") || line.starts_with("uav-2") { vec![line] } else { vec![] });
    assert_csv_rejected(&one, &["rows of uav-1: found 1, expected 2 or more"]);
}

/// What happens in a gap is bounded by the judge, where the rows do not determine the motion.
#[test]
fn a_fixed_wing_s_rows_may_have_gaps() {
    let gap = csv(|line| {
        let t: i32 = line.split(',').nth(1).unwrap().parse().unwrap();
        if line.starts_with("uav-1") && (5..28).contains(&t) { vec![] } else { vec![line] }
    });
    assert!(parse_csv("plan.csv", &gap, &scenario()).is_ok());
}

#[test]
fn times_far_beyond_the_simulation_are_rejected() {
    let slow = csv(|line| {
        let cells: Vec<&str> = line.split(',').collect();
        let t: f64 = cells[1].parse().unwrap();
        vec![format!("{},{},{}", cells[0], t * 1000.0, cells[2..].join(","))]
    });
    let lines = parse_csv("plan.csv", &slow, &scenario()).unwrap_err().lines();
    assert!(lines.iter().all(|line| line.contains("t_s of uav-") && line.contains("milliseconds")), "{lines:#?}");
}

/// The complete plan with a column mapped by `change`.
fn scaled(column: usize, change: impl Fn(f64) -> f64) -> String {
    csv(|line| {
        let mut cells: Vec<String> = line.split(',').map(str::to_owned).collect();
        cells[column] = change(cells[column].parse().unwrap()).to_string();
        vec![cells.join(",")]
    })
}

#[test]
fn wrong_units_and_frames_are_recognised() {
    let suspected = |text: &str| parse_csv("plan.csv", text, &scenario()).expect_err("suspicious").lines().join("\n");
    assert!(suspected(&scaled(5, |v| v * 3.6)).contains("looks like speeds in km/h"));
    assert!(suspected(&scaled(5, |v| v * 3600.0 / 1852.0)).contains("looks like speeds in knots"));
    assert!(suspected(&scaled(7, |_| 10.0)).contains("name the column `flight_path_deg`"));
    assert!(suspected(&scaled(6, |_| std::f64::consts::FRAC_PI_2)).contains("compass bearings"));
    let everywhere = |factor: f64| {
        csv(|line| {
            let mut cells: Vec<String> = line.split(',').map(str::to_owned).collect();
            for cell in &mut cells[2..5] {
                *cell = (cell.parse::<f64>().unwrap() * factor).to_string();
            }
            vec![cells.join(",")]
        })
    };
    assert!(suspected(&everywhere(1e-3)).contains("start in kilometres"));
    assert!(suspected(&everywhere(1.0 / 0.3048)).contains("start in feet"));
    let north_east_down = csv(|line| {
        let mut cells: Vec<String> = line.split(',').map(str::to_owned).collect();
        cells.swap(2, 3);
        cells[4] = format!("-{}", cells[4]);
        vec![cells.join(",")]
    });
    assert!(suspected(&north_east_down).contains("start north-east-down"));
    // Other errors are left to the judge.
    assert_eq!(trajectories(&scaled(3, |y| y + 30.0)).len(), 2);
    assert_eq!(trajectories(&scaled(5, |v| v * 1.2)).len(), 2);
}

#[test]
fn files_that_are_not_plan_files_are_rejected() {
    let folder = tempfile::tempdir().unwrap();
    let message = |name: &str, content: &[u8]| {
        let path = folder.path().join(name);
        std::fs::write(&path, content).unwrap();
        read(&path, &scenario()).unwrap_err().lines().join("\n")
    };
    assert!(message("plan.doc", b"").contains("ends in .csv, .json or .parquet"));
    assert!(message("plan.csv", &[0xff, 0xfe, 0x00]).contains("plan.csv:1"));
    assert!(message("plan.parquet", b"PAR1 and nothing else").contains("plan.parquet"));
    assert!(read(Path::new("missing.csv"), &scenario()).unwrap_err().to_string().contains("missing.csv"));
}
