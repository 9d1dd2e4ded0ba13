//! Tables as people write them.

use scenarios::multirotor::{Positions, Trajectory};
use scenarios::plan_input::names::{self, ColumnMap};
use scenarios::plan_input::{ImportedTrajectory, PlanHeader, parse_csv, read_with};
use scenarios::{Scenario, parse};

use crate::{assert_rejected, complete, scenario, trajectories};

const HOVERER: &str = include_str!("../../../tests/scenarios/hoverer.toml");

pub fn hoverer() -> Scenario {
    parse("hoverer.toml", HOVERER).expect("a valid scenario")
}

#[track_caller]
fn multirotor(text: &str) -> (PlanHeader, Trajectory) {
    let (header, mut tracks) =
        parse_csv("plan.csv", text, &hoverer()).unwrap_or_else(|error| panic!("{:#?}", error.lines()));
    let Some(ImportedTrajectory::Complete(trajectory)) = tracks.pop() else { panic!("not complete") };
    (header, trajectory.multirotor().clone())
}

#[track_caller]
fn positions(text: &str) -> (PlanHeader, Positions) {
    let (header, mut tracks) =
        parse_csv("plan.csv", text, &hoverer()).unwrap_or_else(|error| panic!("{:#?}", error.lines()));
    let Some(ImportedTrajectory::Positions(positions)) = tracks.pop() else { panic!("not by positions") };
    (header, positions)
}

/// The same two rows, in the dialects of several tools.
#[test]
fn dialects_are_the_same_plan() {
    let plain = multirotor("t_s,x_m,y_m,z_m,vx_mps,vy_mps,vz_mps\n0,0,0,2,0,0,0\n2,1.5,-0.3,2,0.5,0,0\n").1;
    for text in [
        "t,x,y,z,vx,vy,vz\n0,0,0,2,0,0,0\n2,1.5,-0.3,2,0.5,0,0\n",
        "Time;PX;PY;PZ;VX;VY;VZ\n0;0;0;2;0;0;0\n2;1.5;-0.3;2;0.5;0;0\n",
        "t\tpos_x\tpos_y\tpos_z\tvel_x\tvel_y\tvel_z\n0\t0\t0\t2\t0\t0\t0\n2\t1.5\t-0.3\t2\t0.5\t0\t0\n",
        "# t x y z vx vy vz\n0.0 0  0   2 0 0 0\n2.0 1.5 -0.3 2 0.5 0 0\n",
        "# a flight\n\"time\",\"x\",\"y\",\"z\",\"vx\",\"vy\",\"vz\"\n# first\n0,0,0,2,0,0,0\n\n2,1.5,-0.3,2,0.5,0,0\n",
        "t,pose.position.x,pose.position.y,pose.position.z,vx,vy,vz\n0,0,0,2,0,0,0\n2,1.5,-0.3,2,0.5,0,0\n",
        "time[ms],x[cm],y[mm],z,vx,vy,vz\n0,0,0,2,0,0,0\n2000,150,-300,2,0.5,0,0\n",
    ] {
        assert_eq!(multirotor(text).1, plain, "{text}");
    }
}

#[test]
fn other_columns_are_not_used_and_named() {
    // As pandas writes it, with an index, and with accelerations and a text.
    let text = ",t,x,y,z,vx,vy,vz,ax,phase\n0,0,0,0,2,0,0,0,9,climb\n1,2,1,0,2,0,0,0,,turn\n";
    let (header, trajectory) = multirotor(text);
    assert_eq!(trajectory.times_s, [0.0, 2.0]);
    assert_eq!(header.remarks, ["columns not used: ax, phase"]);
}

#[test]
fn the_tum_format_is_read_from_its_first_stamp() {
    let text = "1403636579.5 0 0 2 0 0 0 1\n1403636580.0 0.25 0 2 0 0 0 1\n1403636581.0 1 0 2 0 0 0 1\n";
    let (header, positions) = positions(text);
    assert_eq!(positions.times_s, [0.0, 0.5, 1.5]);
    assert_eq!(positions.positions_m[2], [1.0, 0.0, 2.0]);
    assert!(header.remarks.iter().any(|remark| remark.contains("1403636579.5 s")), "{:?}", header.remarks);
}

#[test]
fn positions_alone_are_enough_but_not_two_at_a_time() {
    assert_eq!(positions("t,x,y,z\n0,0,0,2\n1,1,0,2\n").1.positions_m.len(), 2);
    let twice = parse_csv("plan.csv", "t,x,y,z\n0,0,0,2\n1,1,0,2\n1,2,0,2\n", &hoverer());
    assert_rejected(twice, &["plan.csv:4", "each time once"]);
    let half = parse_csv("plan.csv", "t,x,y,z,vx\n0,0,0,2,0\n1,1,0,2,0\n", &hoverer()).unwrap_err();
    assert!(half.lines()[0].contains("vx_mps, vy_mps, vz_mps together"), "{:?}", half.lines());
}

#[test]
fn columns_are_named_by_the_user() {
    let folder = tempfile::tempdir().unwrap();
    let file = folder.path().join("log.txt");
    std::fs::write(&file, "when e n alt\n0 0 0 6.561679790026246\n1000 1 0 6.561679790026246\n").unwrap();
    let map = |text: &str| ColumnMap::parse(text).unwrap();
    let named = map("when[ms]=t_s, e=x_m, n=y_m, alt[ft]=z_m");
    let (_, tracks) = read_with(&file, &hoverer(), &named).unwrap_or_else(|error| panic!("{:#?}", error.lines()));
    let [ImportedTrajectory::Positions(positions)] = tracks.as_slice() else { panic!("not by positions") };
    assert_eq!(positions.times_s, [0.0, 1.0]);
    assert!((positions.positions_m[1][2] - 2.0).abs() < 1e-12);
    assert_rejected(read_with(&file, &hoverer(), &map("whem[ms]=t_s")), &["`whem`", "did you mean `when`?"]);
}

#[test]
fn ambiguous_and_misspelt_columns_are_refused() {
    let rejected = |text: &str, parts: &[&str]| assert_rejected(parse_csv("plan.csv", text, &hoverer()), parts);
    rejected("t,x,pos_x,y,z\n0,0,0,0,2\n1,1,1,0,2\n", &["`x` and `pos_x`, which mean the same", "--columns"]);
    rejected("t,x[kg],y,z\n0,0,0,2\n1,1,0,2\n", &["the unit `kg`", "one of m, km"]);
    rejected("0,0,0,2\n1,1,0,2\n", &["header: found a row of 4 values", "the TUM format"]);
    rejected("t,x,y,z\n0,0,0,2\n1,\"1,5\",0,2\n", &["plan.csv:3: x: found \"1,5\"", "a number with a decimal point"]);
}

/// What was understood before is understood alike.
#[test]
fn a_fixed_wing_s_table_may_have_other_separators() {
    assert_eq!(trajectories(&complete().replace(',', ";")), trajectories(&complete()));
    assert!(parse_csv("plan.csv", &complete(), &scenario()).unwrap().0.remarks.is_empty());
}

#[test]
fn stamps_and_geographic_positions_are_recognised() {
    let rejected = |text: &str, parts: &[&str]| assert_rejected(parse_csv("plan.csv", text, &hoverer()), parts);
    rejected("t,x,y,z\n1403636579,0,0,2\n1403636580,1,0,2\n", &["plan.csv:2", "seconds since 1970"]);
    rejected("t,x,y,z\n1403636579000000000,0,0,2\n1403636580000000000,1,0,2\n", &["nanoseconds since 1970"]);
    let far = HOVERER.replace("x_m = [-3, 9]", "x_m = [-3, 99]").replace("goal = { x_m = 6", "goal = { x_m = 60");
    let scenario = parse("hoverer.toml", &far).unwrap();
    let degrees = parse_csv("plan.csv", "t,x,y,z\n0,47.3977,8.5456,2\n9,47.3977,8.5464,2\n", &scenario);
    assert_rejected(degrees, &["latitude and longitude"]);
    // A start elsewhere is no reason to refuse a plan.
    assert!(parse_csv("plan.csv", "t,x,y,z\n0,5,8,2\n9,65,8,2\n", &scenario).is_ok());
}

/// The tables in the documentation are those of the code.
#[test]
fn the_documentation_lists_every_column_alias_and_unit() {
    let models = include_str!("../../../docs/models.md");
    let written = [
        &scenarios::fixed_wing::CSV_COLUMNS[..],
        &scenarios::multirotor::CSV_COLUMNS,
        &scenarios::slung_load::CSV_COLUMNS,
    ];
    for column in written.concat() {
        assert!(models.contains(&format!("`{column}`")), "{column}");
    }
    let plans = include_str!("../../../docs/plans.md");
    let likewise =
        |ours: &str| ours.starts_with('y') || ours.starts_with('z') || ours.starts_with("vy") || ours.starts_with("vz");
    for (ours, aliases) in names::ALIASES.iter().filter(|(ours, _)| !likewise(ours)) {
        let row = plans.lines().find(|line| line.starts_with(&format!("| `{ours}` |"))).expect("a row");
        let listed = row.split('|').nth(2).unwrap().split(';').next().unwrap();
        let listed: Vec<&str> = listed.split(',').map(|alias| alias.trim().trim_matches('`')).collect();
        assert_eq!(listed, *aliases, "{ours}");
    }
    let units =
        plans.lines().skip_while(|line| !line.starts_with("A unit may follow")).take(3).collect::<Vec<_>>().join(" ");
    for (unit, ..) in names::UNITS {
        assert!(units.split([' ', ',', ';', '.']).any(|word| word == unit), "{unit}");
    }
}
