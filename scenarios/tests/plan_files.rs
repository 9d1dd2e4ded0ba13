//! Plans from elsewhere: what is read, and what is refused with which words.

use std::path::Path;

use scenarios::fixed_wing::PartialTrajectory;
use scenarios::plan_input::{ImportedTrajectory, PlanError, PlanHeader, parse_csv, parse_json, read};
use scenarios::{Interpolation, Plan, Scenario, parse, slung_load};

const PAIR: &str = include_str!("../../tests/scenarios/pair.toml");
const HEADER: &str = "vehicle,t_s,x_m,y_m,z_m,speed_mps,heading_rad,flight_path_rad,n_x,n_y,n_z\n";

fn scenario() -> Scenario {
    parse("pair.toml", PAIR).expect("the smallest fleet")
}

/// Both aircraft straight ahead at 35 m/s, a row per second, with a line changed by `change`.
fn csv(change: impl Fn(String) -> Vec<String>) -> String {
    let row = |(name, y): (&str, i32), t: i32| format!("{name},{t},{},{y},400,35,0,0,0,0,1", 35 * t);
    let rows = [("uav-1", -100), ("uav-2", 100)].into_iter().flat_map(|who| (0..30).map(move |t| row(who, t)));
    HEADER.to_owned() + &rows.flat_map(change).map(|line| line + "\n").collect::<String>()
}

fn whole() -> String {
    csv(|line| vec![line])
}

fn tracks(text: &str) -> Vec<PartialTrajectory> {
    fixed_wings(parse_csv("plan.csv", text, &scenario()).expect("a plan").1)
}

fn fixed_wings(tracks: Vec<ImportedTrajectory>) -> Vec<PartialTrajectory> {
    let fixed_wing = |track| match track {
        ImportedTrajectory::Partial(track) => track,
        _ => panic!("no other family was asked for"),
    };
    tracks.into_iter().map(fixed_wing).collect()
}

/// Asserts that the text is refused for a single issue, and that its line says all of `parts`.
#[track_caller]
fn assert_refused(result: Result<(PlanHeader, Vec<ImportedTrajectory>), PlanError>, parts: &[&str]) {
    let lines = result.expect_err("it should have been refused").lines();
    let [line] = lines.as_slice() else { panic!("expected one issue, found {lines:#?}") };
    for part in parts {
        assert!(line.contains(part), "`{part}` is missing in: {line}");
    }
}

#[track_caller]
fn assert_csv_refused(text: &str, parts: &[&str]) {
    assert_refused(parse_csv("plan.csv", text, &scenario()), parts);
}

#[test]
fn a_whole_plan_is_read_in_any_order_of_rows_and_columns() {
    let expected = tracks(&whole());
    assert_eq!((expected.len(), expected[1].times_s.len()), (2, 30));
    assert_eq!(expected[1].positions_m[29], [1015.0, 100.0, 400.0]);
    assert!(expected[0].states.is_some() && expected[0].controls.is_some());
    // by time instead of by vehicle, columns from last to first, spaces, NumPy's mark before the header, a BOM
    let text = whole();
    let mut lines: Vec<&str> = text.lines().skip(1).collect();
    lines.sort_by_key(|line| line.split(',').nth(1).unwrap().parse::<i32>().unwrap());
    let turned = |line: &str| line.split(',').rev().collect::<Vec<_>>().join(" , ");
    let body: String = lines.iter().map(|line| turned(line) + "\r\n").collect();
    assert_eq!(tracks(&format!("# {}\r\n{body}", turned(HEADER.trim()))), expected);
}

#[test]
fn what_is_missing_is_left_for_others_to_fill_in() {
    let keep = |n: usize| {
        whole().lines().map(|line| line.split(',').take(n).collect::<Vec<_>>().join(",") + "\n").collect::<String>()
    };
    let (states, positions) = (tracks(&keep(8)), tracks(&keep(5)));
    assert!(states[0].states.is_some() && states[0].controls.is_none());
    assert!(positions[0].states.is_none() && positions[0].controls.is_none());
}

#[test]
fn degrees_and_cartesian_velocities_are_understood() {
    let degrees = whole().replace("heading_rad", "heading_deg").replace(",35,0,0,", ",35,360,0,");
    let heading_rad = tracks(&degrees)[0].states.as_ref().unwrap()[7].heading_rad;
    assert!((heading_rad - std::f64::consts::TAU).abs() < 1e-12);
    let cartesian = whole().replace("speed_mps,heading_rad,flight_path_rad", "vx_mps,vy_mps,vz_mps");
    assert_eq!(tracks(&cartesian), tracks(&whole()));
}

#[test]
fn headings_do_not_jump_by_a_turn() {
    let text = csv(|line| {
        vec![if line.contains(",7,") { line.replace(",35,0,0,", ",35,6.283185307179586,0,") } else { line }]
    });
    assert!(tracks(&text)[0].states.as_ref().unwrap().iter().all(|state| state.heading_rad.abs() < 1e-12));
}

#[test]
fn the_only_vehicle_needs_no_name() {
    let second = PAIR.find("[[vehicles]]\nname = \"uav-2\"").unwrap();
    let end = PAIR.find("[fleet]").unwrap();
    let alone = PAIR[..second].to_owned() + &PAIR[end..];
    let scenario = parse("pair.toml", &alone).unwrap();
    let nameless: String = whole()
        .lines()
        .filter(|line| !line.starts_with("uav-2"))
        .map(|line| line.split_once(',').unwrap().1.to_owned() + "\n")
        .collect();
    assert_eq!(fixed_wings(parse_csv("plan.csv", &nameless, &scenario).unwrap().1)[0].vehicle, "uav-1");
    assert_csv_refused(&nameless, &["plan.csv:1: header", "a column `vehicle`"]);
}

#[test]
fn names_that_are_wrong_are_pointed_to() {
    let renamed = whole().replace("uav-2", "uav-3");
    let lines = parse_csv("plan.csv", &renamed, &scenario()).unwrap_err().lines();
    assert_eq!(lines.len(), 2, "{lines:#?}");
    assert!(
        lines[0].starts_with("plan.csv:32: vehicle: found \"uav-3\"") && lines[0].contains("did you mean"),
        "{lines:#?}"
    );
    assert!(lines[1].contains("no row of `uav-2`"), "{lines:#?}");
    assert_csv_refused(
        &csv(|line| if line.starts_with("uav-2") { vec![] } else { vec![line] }),
        &["no row of `uav-2`"],
    );
}

#[test]
fn columns_that_are_wrong_are_named() {
    let both =
        |old: &str, new: &str| parse_csv("plan.csv", &whole().replace(old, new), &scenario()).unwrap_err().lines();
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
    assert_csv_refused(&whole().replace("n_y", "n_x"), &["plan.csv:1: header: found two columns named `n_x`"]);
    assert_csv_refused(&whole().replace("t_s", "time"), &["a column `t_s`"]);
    assert_csv_refused(&whole().replace(',', ";"), &["separated by semicolons"]);
    assert_csv_refused("", &["plan.csv:1: header"]);
}

#[test]
fn cells_that_are_no_numbers_are_pointed_to() {
    let at_seven = |new: &'static str| csv(move |line| vec![line.replace("uav-2,7,245,", new)]);
    assert_csv_refused(&at_seven("uav-2,7,east,"), &["plan.csv:39: x_m: found \"east\", expected a number"]);
    assert_csv_refused(&at_seven("uav-2,7,,"), &["plan.csv:39: x_m: found nothing"]);
    assert_csv_refused(&at_seven("uav-2,7,nan,"), &["plan.csv:39: x_m of uav-2: found NaN, expected a finite number"]);
    assert_csv_refused(&at_seven("uav-2,7,1e999,"), &["plan.csv:39", "found inf"]);
    assert_csv_refused(&at_seven("uav-2,7,"), &["plan.csv:39: line: found 10 values, expected 11"]);
    assert_csv_refused(&at_seven("uav-2,7,245,0,"), &["plan.csv:39: line: found 12 values"]);
}

#[test]
fn times_that_are_wrong_are_pointed_to() {
    let changed = |old: &'static str, new: &'static str| csv(move |line| vec![line.replace(old, new)]);
    assert_csv_refused(
        &changed("uav-1,7,", "uav-1,6,"),
        &["plan.csv:9: t_s of uav-1: found 6 s after 6 s", "remove one"],
    );
    assert_csv_refused(&changed("uav-1,7,", "uav-1,5.5,"), &["plan.csv:9", "found 5.5 s after 6 s", "sort the rows"]);
    assert_csv_refused(&changed("uav-1,0,", "uav-1,0.5,"), &["plan.csv:2", "0.5 s in the first row", "from the start"]);
    let gap = csv(|line| {
        let t: i32 = line.split(',').nth(1).unwrap().parse().unwrap();
        if line.starts_with("uav-1") && (5..28).contains(&t) { vec![] } else { vec![line] }
    });
    assert_csv_refused(&gap, &["plan.csv:7", "a gap from 4 s to 28 s, where rows are 1 s apart"]);
    assert_csv_refused(&changed("uav-2,29,", "uav-2,1e7,"), &["a gap from 28 s"]);
    let one = csv(|line| if line.contains("uav-1,0,") || line.starts_with("uav-2") { vec![line] } else { vec![] });
    assert_csv_refused(&one, &["rows of uav-1: found 1, expected 2 or more"]);
}

#[test]
fn times_far_beyond_the_simulation_are_refused() {
    let slow = csv(|line| {
        let cells: Vec<&str> = line.split(',').collect();
        let t: f64 = cells[1].parse().unwrap();
        vec![format!("{},{},{}", cells[0], t * 1000.0, cells[2..].join(","))]
    });
    let lines = parse_csv("plan.csv", &slow, &scenario()).unwrap_err().lines();
    assert!(lines.iter().all(|line| line.contains("t_s of uav-") && line.contains("milliseconds")), "{lines:#?}");
}

/// Whole numbers of a column, changed in every row.
fn scaled(column: usize, change: impl Fn(f64) -> f64) -> String {
    csv(|line| {
        let mut cells: Vec<String> = line.split(',').map(str::to_owned).collect();
        cells[column] = change(cells[column].parse().unwrap()).to_string();
        vec![cells.join(",")]
    })
}

#[test]
fn units_and_frames_that_cannot_be_meant_are_recognised() {
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
    // a plan that is only wrong is not suspected of anything: that is for the judge
    assert_eq!(tracks(&scaled(3, |y| y + 30.0)).len(), 2);
    assert_eq!(tracks(&scaled(5, |v| v * 1.2)).len(), 2);
}

const JSON: &str = r#"{"status": "solved", "trajectories": [
  {"vehicle": "uav-1", "times_s": [0, 30], "x_m": [0, 1000], "y_m": [-100, -100], "z_m": [400, 400]},
  {"vehicle": "uav-2", "times_s": [0, 30], "x_m": [0, 1000], "y_m": [100, 100], "z_m": [400, 400]}]}"#;

#[track_caller]
fn assert_json_refused(old: &str, new: &str, parts: &[&str]) {
    assert!(JSON.contains(old), "the document has no `{old}`");
    assert_refused(parse_json("plan.json", &JSON.replacen(old, new, 1), &scenario()), parts);
}

#[test]
fn json_with_columns_is_read() {
    let (header, tracks) = parse_json("plan.json", JSON, &scenario()).unwrap();
    assert_eq!(header.status, Some(scenarios::PlanStatus::Solved));
    assert_eq!(fixed_wings(tracks)[1].positions_m, [[0.0, 100.0, 400.0], [1000.0, 100.0, 400.0]]);
}

#[test]
fn json_that_is_wrong_is_refused_with_the_field() {
    assert_json_refused("[0, 30]", "[0, NaN]", &["plan.json:2:", "JSON syntax", "JSON has no NaN"]);
    assert_json_refused("[0, 30]", "[0, null]", &["trajectories[0] node 1: t_s of uav-1: found NaN"]);
    assert_json_refused("[0, 30]", "[0]", &["trajectories[0].x_m: found 2 values, expected 1"]);
    assert_json_refused("[0, 30]", "{}", &["trajectories[0].times_s: found an object"]);
    assert_json_refused("\"solved\"", "\"splendid\"", &["status: found the text \"splendid\"", "no-plan"]);
    assert_json_refused("\"status\"", "\"state\"", &["state: found an unknown key", "did you mean `status`?"]);
    assert_json_refused(
        "\"status\"",
        "\"scenario\": \"other\", \"status\"",
        &["scenario: found \"other\"", "\"pair\""],
    );
    assert_json_refused("\"status\"", "\"schema\": 2, \"status\"", &["schema: found 2"]);
    assert_json_refused("\"vehicle\": \"uav-1\", ", "", &["trajectories[0].vehicle: found nothing"]);
    for text in ["", "[]", "3", "{", "{}"] {
        assert!(parse_json("plan.json", text, &scenario()).is_err(), "{text}");
    }
}

#[test]
fn files_that_are_no_plan_files_are_refused() {
    let folder = tempfile::tempdir().unwrap();
    let message = |name: &str, content: &[u8]| {
        let path = folder.path().join(name);
        std::fs::write(&path, content).unwrap();
        read(&path, &scenario()).unwrap_err().lines().join("\n")
    };
    assert!(message("plan.txt", b"").contains("ends in .csv, .json or .parquet"));
    assert!(message("plan.csv", &[0xff, 0xfe, 0x00]).contains("plan.csv:1"));
    assert!(message("plan.parquet", b"PAR1 and nothing else").contains("plan.parquet"));
    assert!(read(Path::new("missing.csv"), &scenario()).unwrap_err().to_string().contains("missing.csv"));
}

/// A plan of a quadrotor with a load: two nodes share a time, at which the cable becomes taut.
fn slung_plan() -> (Scenario, Plan) {
    let path = Path::new(env!("CARGO_MANIFEST_DIR")).join("slung/rectangle.toml");
    let scenario = scenarios::load(&path).expect("a shipped scenario");
    let vehicle = &scenario.vehicles[0];
    let start = slung_load::State::at(&vehicle.start, scenario.slung_load_model(vehicle).cable_length_m);
    let moved = |by: f64| slung_load::State::from_array(start.to_array().map(|value| value + by));
    let trajectory = slung_load::Trajectory {
        vehicle: vehicle.name.clone(),
        interpolation: Interpolation::FirstOrderHold,
        times_s: vec![0.0, 0.1 + 0.2, 0.1 + 0.2, 1.0],
        states: [0.0, 0.1, 0.2, 1.0 / 3.0].map(moved).to_vec(),
        controls: [1.0, 2.0, 2.5, 3.0].map(|f| slung_load::Control { thrust_n: [f, f, 2.0 * f, f / 3.0] }).to_vec(),
        cable: vec![
            slung_load::Cable::Slack,
            slung_load::Cable::Slack,
            slung_load::Cable::Taut,
            slung_load::Cable::Taut,
        ],
        planner_nodes: vec![0, 3],
    };
    let plan = Plan { objective: Some(3.0), ..Plan::new(&scenario.name, "by-hand", 0, vec![trajectory.into()]) };
    (scenario, plan)
}

#[test]
fn a_plan_with_a_load_reads_back_as_it_was() {
    let (scenario, plan) = slung_plan();
    let (mut json, mut csv) = (Vec::new(), Vec::new());
    plan.write_json(&mut json).unwrap();
    plan.write_csv(&mut csv).unwrap();
    let [json, csv] = [json, csv].map(|bytes| String::from_utf8(bytes).unwrap());
    let whole = plan.trajectories[0].slung_load().clone();
    let (_, tracks) = parse_json("plan.json", &json, &scenario).unwrap();
    assert_eq!(tracks, [ImportedTrajectory::Complete(whole.clone().into())]);
    // a table does not say at which nodes the planner looked
    let (_, tracks) = parse_csv("plan.csv", &csv, &scenario).unwrap();
    assert_eq!(
        tracks,
        [ImportedTrajectory::Complete(slung_load::Trajectory { planner_nodes: Vec::new(), ..whole }.into())]
    );
}

#[test]
fn a_plan_with_a_load_must_be_whole() {
    let (scenario, plan) = slung_plan();
    let mut csv = Vec::new();
    plan.write_csv(&mut csv).unwrap();
    let csv = String::from_utf8(csv).unwrap();
    let without_words = csv.replacen("slack", "loose", 1);
    let refused = parse_csv("plan.csv", &without_words, &scenario);
    assert_refused(refused, &["plan.csv:2: cable: found \"loose\", expected `slack` or `taut`"]);
    let cut = |line: &str| line.rsplit_once(',').unwrap().0.to_owned() + "\n";
    let refused = parse_csv("plan.csv", &csv.lines().map(cut).collect::<String>(), &scenario);
    assert_refused(refused, &["cable of", "found nothing, expected a column of this name"]);
}

#[cfg(feature = "parquet")]
mod parquet_files {
    use std::path::Path;
    use std::sync::Arc;

    use parquet::data_type::{ByteArray, ByteArrayType, DoubleType};
    use parquet::file::writer::SerializedFileWriter;
    use parquet::schema::parser::parse_message_type;
    use scenarios::plan_input::read;

    use super::{fixed_wings, scenario, tracks, whole};

    /// The rows of a CSV text as a Parquet file, as other programs write them: names as text, numbers as doubles.
    fn write(path: &Path, text: &str) {
        let columns: Vec<&str> = text.lines().next().unwrap().split(',').collect();
        let kind = |name: &&str| match **name == *"vehicle" {
            true => "required binary vehicle (utf8);".to_owned(),
            false => format!("required double {name};"),
        };
        let schema = format!("message plan {{ {} }}", columns.iter().map(kind).collect::<String>());
        let schema = Arc::new(parse_message_type(&schema).unwrap());
        let file = std::fs::File::create(path).unwrap();
        let mut writer = SerializedFileWriter::new(file, schema, Arc::default()).unwrap();
        let mut group = writer.next_row_group().unwrap();
        for (index, name) in columns.iter().enumerate() {
            let cells = || text.lines().skip(1).map(|line| line.split(',').nth(index).unwrap());
            let mut column = group.next_column().unwrap().unwrap();
            if *name == "vehicle" {
                let names: Vec<ByteArray> = cells().map(ByteArray::from).collect();
                column.typed::<ByteArrayType>().write_batch(&names, None, None).unwrap();
            } else {
                let numbers: Vec<f64> = cells().map(|cell| cell.parse().unwrap()).collect();
                column.typed::<DoubleType>().write_batch(&numbers, None, None).unwrap();
            }
            column.close().unwrap();
        }
        group.close().unwrap();
        writer.close().unwrap();
    }

    #[test]
    fn a_table_is_the_same_as_parquet_and_as_text() {
        let folder = tempfile::tempdir().unwrap();
        let path = folder.path().join("plan.parquet");
        write(&path, &whole());
        assert_eq!(fixed_wings(read(&path, &scenario()).unwrap().1), tracks(&whole()));
    }

    #[test]
    fn what_is_wrong_is_pointed_to_by_its_row() {
        let folder = tempfile::tempdir().unwrap();
        let path = folder.path().join("plan.parquet");
        write(&path, &whole().replace("uav-2,7,245,", "uav-2,7,nan,"));
        let lines = read(&path, &scenario()).unwrap_err().lines();
        assert_eq!(lines.len(), 1, "{lines:#?}");
        assert!(lines[0].contains("plan.parquet, row 38: x_m of uav-2: found NaN"), "{lines:#?}");
    }

    /// Bytes changed and the end cut off: never a panic, and what is read is still a table of this scenario.
    #[test]
    fn damaged_files_are_refused_or_sound() {
        let folder = tempfile::tempdir().unwrap();
        let path = folder.path().join("plan.parquet");
        write(&path, &whole());
        let sound = std::fs::read(&path).unwrap();
        let mut rng = scenarios::stream(0, "damage");
        let mut below = |n: usize| (rand::Rng::next_u64(&mut rng) % n as u64) as usize;
        let mut refused = 0;
        for round in 0..600 {
            let mut bytes = sound.clone();
            for _ in 0..=below(6) {
                let at = below(bytes.len());
                bytes[at] = below(256) as u8;
            }
            if round % 5 == 0 {
                bytes.truncate(below(sound.len()));
            }
            std::fs::write(&path, bytes).unwrap();
            match read(&path, &scenario()) {
                Err(error) => refused += usize::from(!error.lines().is_empty()),
                Ok((_, tracks)) => {
                    let tracks = fixed_wings(tracks);
                    assert!(tracks.iter().flat_map(|track| &track.times_s).all(|t_s| t_s.is_finite()));
                }
            }
        }
        assert!(refused > 200, "only {refused} of 600 were refused");
    }
}
