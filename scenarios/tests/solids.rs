//! Obstacles of any shape in scenario files, and the files of meshes and terrain beside them.

#[expect(dead_code, reason = "changed copies are for other tests")]
mod minimal;

use std::path::Path;

use minimal::TEXT;
use scenarios::{LoadError, Scenario};

/// A cube of 100 m with a corner at the origin, as OBJ.
const CUBE: &str = "v 0 0 0\nv 100 0 0\nv 100 100 0\nv 0 100 0\nv 0 0 100\nv 100 0 100\nv 100 100 100\nv 0 100 100\n\
    f 1 4 3 2\nf 5 6 7 8\nf 1 2 6 5\nf 2 3 7 6\nf 3 4 8 7\nf 1 5 8 4\n";

/// Loads the minimal scenario with `entries`, from a folder with these files.
fn load(entries: &str, files: &[(&str, &str)]) -> Result<Scenario, LoadError> {
    let folder = tempfile::tempdir().unwrap();
    for (name, content) in files {
        std::fs::write(folder.path().join(name), content).unwrap();
    }
    load_in(folder.path(), entries)
}

fn load_in(folder: &Path, entries: &str) -> Result<Scenario, LoadError> {
    let file = folder.join("minimal.toml");
    std::fs::write(&file, format!("{TEXT}\n{entries}\n")).unwrap();
    scenarios::load(&file)
}

fn mesh(fields: &str) -> String {
    format!("[[world.meshes]]\nname = \"house\"\nfile = \"house.obj\"\noffset_m = [200, 300, 500]\n{fields}\n")
}

fn assert_issue(result: Result<Scenario, LoadError>, field: &str, parts: &[&str]) {
    let lines = result.expect_err("it should be refused").lines();
    let is_it = |line: &&String| line.contains(field) && parts.iter().all(|part| line.contains(part));
    assert!(lines.iter().any(|line| is_it(&line)), "{field} {parts:?}: {lines:#?}");
}

#[test]
fn a_mesh_is_read_from_beside_the_scenario_and_written_with_its_full_path() {
    let folder = tempfile::tempdir().unwrap();
    std::fs::write(folder.path().join("house.obj"), CUBE).unwrap();
    let scenario = load_in(folder.path(), &mesh("rotation_deg = [0, 0, 90]")).unwrap();
    let solids = scenario.world.solids();
    // Turned by 90°, x goes north and y west.
    assert!((solids[0].signed_distance_m([150.0, 350.0, 550.0]) + 50.0).abs() < 1e-9);
    assert!(
        scenario.world.meshes[0].file.ends_with("house.obj") && Path::new(&scenario.world.meshes[0].file).is_absolute()
    );
    let elsewhere = scenarios::parse("minimal.toml", &scenario.to_toml()).unwrap();
    assert_eq!((&elsewhere, elsewhere.world.solids().len()), (&scenario, 1));
}

#[test]
fn files_that_cannot_be_used_are_refused_with_a_remedy() {
    let refused = |fields: &str, content: &str, parts: &[&str]| {
        assert_issue(load(&mesh(fields), &[("house.obj", content)]), "world.meshes[0]", parts);
    };
    assert_issue(load(&mesh(""), &[("hause.obj", CUBE)]), "world.meshes[0].file", &["house.obj", "No such file"]);
    refused("", "", &["no face"]);
    refused("", &CUBE[..40], &["no face"]);
    refused("", &CUBE.replace("v 100 0 0", "v nan 0 0"), &["house.obj:2", "`nan`"]);
    refused("", &CUBE.replace("f 5 6 7 8", "f 5 6 7 80"), &["house.obj:10", "`80`"]);
    refused("scale = 1000", CUBE, &["scale", "100000.000 m"]);
    refused("scale = 0", CUBE, &["scale", "greater than 0"]);
    refused("scale = 1e-3\nunit = \"mm\"", CUBE, &["unit"]);
    assert_issue(
        load(&mesh("").replace("200, 300", "90000, 300"), &[("house.obj", CUBE)]),
        "world.meshes[0].offset_m",
        &["reaches into the map"],
    );
    assert_issue(
        load(&mesh("").replace("house.obj", "house.ply"), &[("house.ply", CUBE)]),
        "world.meshes[0].file",
        &[".ply"],
    );
}

#[test]
fn names_of_all_shapes_are_unique_and_none_of_them_is_hidden() {
    let ball = |name: &str| format!("[[world.spheres]]\nname = \"{name}\"\ncenter_m = [300, 300, 700]\nradius_m = 5\n");
    assert!(load(&ball("balloon"), &[]).is_ok());
    assert_issue(load(&ball("pillar"), &[]), "world.spheres[0].name", &["unique", "world.cylinders"]);
    assert_issue(load(&(ball("a") + &ball("a")), &[]), "world.spheres[1].name", &["unique"]);
    assert_issue(load(&ball("b").replace("= 5", "= -5"), &[]), "world.spheres[0].radius_m", &["greater than 0"]);
    let capsule = "[[world.capsules]]\nname = \"mast\"\nends_m = [[300, 300, 0], [300, 300, 90]]\nradius_m = 0\n";
    assert_issue(load(capsule, &[]), "world.capsules[0].radius_m", &["greater than 0"]);
    let cuboid = "[[world.cuboids]]\nname = \"crate\"\ncenter_m = [300, 300, 0]\nsize_m = [1, 0, 1]\n";
    assert_issue(load(cuboid, &[]), "world.cuboids[0].size_m[1]", &["greater than 0"]);
}

#[test]
fn a_vehicle_inside_or_too_near_is_refused() {
    let scenario = load("", &[]).unwrap();
    let [x, y, z] = scenario.vehicles[0].start.position_m();
    let at = |offset_m: [f64; 3]| mesh("").replace("[200, 300, 500]", &format!("{offset_m:?}"));
    let inside = load(&at([x - 50.0, y - 50.0, z - 50.0]), &[("house.obj", CUBE)]);
    assert_issue(inside, "vehicles[0].start", &["inside `house`"]);
    // Without its last side it has no inside, but the start is enclosed.
    let open = load(&at([x - 50.0, y - 50.0, z - 50.0]), &[("house.obj", &CUBE[..CUBE.len() - 10])]);
    assert_issue(open, "vehicles[0].start", &["inside `house`"]);
    let near = load(&at([x + 0.1, y - 50.0, z - 50.0]), &[("house.obj", CUBE)]);
    assert_issue(near, "vehicles[0].start", &["0.100 m from `house`"]);
}

#[test]
fn terrain_covers_the_map() {
    let map = load("", &[]).unwrap().world.map;
    let grid = |value: &str, cells: f64| {
        let width_m = map.x_m.width().max(map.y_m.width());
        let (x, y) = (map.x_m.min, map.y_m.min);
        let row = format!("{value} 1 2 3 4\n");
        let rows = row.repeat(5);
        format!("ncols 5\nnrows 5\nxllcenter {x}\nyllcenter {y}\ncellsize {}\nnodata_value -1\n{rows}", width_m / cells)
    };
    let entry = "[world.terrain]\nfile = \"hills.asc\"\n";
    let scenario = load(entry, &[("hills.asc", &grid("0", 4.0))]).unwrap();
    assert_eq!(scenario.world.solids()[0].name(), "terrain");
    assert_issue(load(entry, &[("hills.asc", &grid("0", 5.0))]), "world.terrain.offset_m", &["for the whole map"]);
    assert_issue(load(entry, &[("hills.asc", &grid("-1", 4.0))]), "world.terrain.file", &["no height at"]);
    assert_issue(load(entry, &[("hills.asc", "ncols 5\n")]), "world.terrain.file", &["nrows"]);
    let high = load(entry, &[("hills.asc", &grid("9000", 4.0))]);
    assert_issue(high, "vehicles[", &["below `terrain`"]);
}

/// A scenario that was deserialised without its files: its obstacles are there, and nobody may fly as if they were not.
#[test]
#[should_panic(expected = "files that have not been read: house.obj")]
fn an_obstacle_whose_file_has_not_been_read_is_not_missing_in_silence() {
    let text = format!("{TEXT}\n{}\n", mesh(""));
    let scenario: Scenario = toml::from_str(&text).expect("the form of a scenario");
    scenario.world.solids();
}

#[test]
fn a_file_that_cannot_be_read_is_one_issue() {
    let lines = load(&mesh(""), &[]).expect_err("there is no such file").lines();
    assert_eq!(lines.len(), 1, "{lines:#?}");
}
