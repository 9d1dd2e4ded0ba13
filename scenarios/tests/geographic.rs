//! Positions in latitude, longitude and altitude: equal to those in metres, or refused with place and remedy.

use scenarios::{LoadError, LocatedIssue, Scenario, load, parse};

const ORIGIN: &str = "[world.origin]\nlatitude_deg = 47.26\nlongitude_deg = 11.39\naltitude_m = 570\n";
const OBSTACLES_M: &str = r#"
[[world.cylinders]]
name = "mast"
center_m = [100, 200]
radius_m = 2
[[world.prisms]]
name = "hall"
corners_m = [[50, 50], [80, 50], [80, 90]]
z_m = [0, 12]
[[world.spheres]]
name = "balloon"
center_m = [-100, 30, 60]
radius_m = 3
[[world.capsules]]
name = "cable"
ends_m = [[-50, -80, 20], [150, -80, 40]]
radius_m = 0.5
"#;
/// The same by `pymap3d.enu2geodetic`, altitudes of the obstacles above mean sea level.
const OBSTACLES_DEG: &str = r#"
[[world.cylinders]]
name = "mast"
center_deg = [47.261798782, 11.391321171]
radius_m = 2
[[world.prisms]]
name = "hall"
corners_deg = [[47.260449696, 11.390660569], [47.260449693, 11.391056910], [47.260809451, 11.391056917]]
z_m = [0, 12]
[[world.spheres]]
name = "balloon"
center_deg = [47.260269808, 11.388678880]
altitude_m = 630.000853
radius_m = 3
[[world.capsules]]
name = "cable"
ends_deg = [[47.259280484, 11.389339448], [47.259280471, 11.391981650]]
altitude_m = [590.000698, 610.002263]
radius_m = 0.5
"#;

fn scenario(world: &str, start: &str) -> String {
    format!(
        r#"
name = "place"
description = "Near Innsbruck"
[world]
map = {{ x_m = [-400, 400], y_m = [-300, 300], z_m = [0, 100] }}
{world}
[models.multirotor.quad]
mass_kg = 1.5
body_radius_m = 0.35
sensor_range_m = 8.0
limits = {{ speed_mps = 4.5, acceleration_mps2 = 5.0 }}
planning_limits = {{ speed_mps = 3.0, acceleration_mps2 = 3.0 }}
[[vehicles]]
name = "uav-1"
model = "quad"
start = {start}
goal = {{ x_m = 250, y_m = 0, z_m = 20 }}
[planner]
name = "rhc"
"#
    )
}

const START_M: &str = "{ x_m = -250, y_m = 0, z_m = 20 }";

fn issues(text: &str) -> Vec<LocatedIssue> {
    match parse("place.toml", text) {
        Ok(_) => panic!("accepted:\n{text}"),
        Err(LoadError::Invalid(invalid)) => invalid.issues,
        Err(other) => panic!("{other}"),
    }
}

/// Exactly one issue: its field, and what it says.
#[track_caller]
fn assert_issue(text: &str, field: &str, says: &[&str]) {
    let found = issues(text);
    assert_eq!(found.len(), 1, "{found:#?}");
    assert_eq!(found[0].issue.field, field);
    let line = text.lines().nth(found[0].line - 1).unwrap_or_default();
    let key = field.rsplit('.').next().unwrap().split('[').next().unwrap();
    assert!(line.contains(key), "{field} is not in line {}: {line}", found[0].line);
    let issue = format!("{}; {}", found[0].issue, found[0].issue.remedy);
    assert!(says.iter().all(|it| issue.contains(it)), "{issue}");
}

fn assert_near(a: &[f64], b: &[f64]) {
    assert_eq!(a.len(), b.len());
    assert!(a.iter().zip(b).all(|(a, b)| (a - b).abs() < 1e-3), "{a:?}, not {b:?}");
}

#[test]
fn positions_in_degrees_are_those_in_metres_to_a_millimetre() {
    let metres = parse("place.toml", &scenario(OBSTACLES_M, START_M)).unwrap().world;
    let degrees = parse("place.toml", &scenario(&format!("{ORIGIN}{OBSTACLES_DEG}"), START_M)).unwrap().world;
    assert_near(&degrees.cylinders[0].center_m, &metres.cylinders[0].center_m);
    assert_near(&degrees.prisms[0].corners_m.concat(), &metres.prisms[0].corners_m.concat());
    assert_near(&degrees.spheres[0].center_m, &metres.spheres[0].center_m);
    assert_near(&degrees.capsules[0].ends_m.concat(), &metres.capsules[0].ends_m.concat());
    assert_eq!(degrees.prisms[0].z_m, metres.prisms[0].z_m);
    assert_eq!(degrees.origin.map(|it| it.altitude_m), Some(570.0));
}

#[test]
fn a_start_is_given_by_its_altitude_or_by_its_height() {
    let at = |height: &str| {
        let start = format!("{{ latitude_deg = 47.261, longitude_deg = 11.388, {height} }}");
        let scenario: Scenario = parse("place.toml", &scenario(ORIGIN, &start)).unwrap();
        scenario.vehicles[0].start.position_m()
    };
    // By pymap3d; the Earth has curved away by 2 mm.
    assert_near(&at("altitude_m = 590"), &[-151.383645, 111.188159, 19.997237]);
    assert_near(&at("z_m = 20"), &[-151.383645, 111.188159, 20.0]);
}

/// What is written loads again without the file, and an external planner needs no geodesy.
#[test]
fn a_loaded_scenario_is_written_in_metres_with_its_origin() {
    let scenario = parse("place.toml", &scenario(&format!("{ORIGIN}{OBSTACLES_DEG}"), START_M)).unwrap();
    let written = scenario.to_toml();
    assert!(!written.contains("center_deg") && written.contains("[world.origin]"), "{written}");
    assert_eq!(parse("place.toml", &written).unwrap(), scenario);
}

#[test]
fn positions_that_cannot_be_meant_are_refused() {
    let start = |degrees: &str| scenario(ORIGIN, &format!("{{ {degrees}, altitude_m = 590 }}"));
    let field = "vehicles[0].start.latitude_deg";
    let given = "latitude_deg = 47.261, longitude_deg = 11.388";
    assert_issue(&scenario("", &format!("{{ {given}, z_m = 20 }}")), field, &["without an origin", "[world.origin]"]);
    assert_issue(&start("latitude_deg = 147.261, longitude_deg = 11.388"), field, &["[-90, 90] deg", "swapped"]);
    assert_issue(&start("latitude_deg = 11.388, longitude_deg = 47.261"), field, &["from the origin", "swapped"]);
    let far = &["167 km from the origin", "785 m at 100 km", "move the origin"];
    assert_issue(&start("latitude_deg = 48.761, longitude_deg = 11.388"), field, far);
    assert_issue(&start(&format!("{given}, x_m = 3")), field, &["both `latitude_deg` and `x_m`"]);
    let missing = issues(&start("latitude_deg = 47.261"));
    assert_eq!(missing[0].issue.field, "vehicles[0].start.longitude_deg", "{missing:#?}");
    let mast = ORIGIN.to_owned() + &OBSTACLES_DEG.replace("47.261798782", "\"north\"");
    let wrong = issues(&scenario(&mast, START_M));
    assert_eq!(wrong[0].issue.field, "world.cylinders[0].center_deg[0]", "{wrong:#?}");
    let origin = ORIGIN.replace("47.26", "97.26");
    assert_eq!(issues(&scenario(&origin, START_M))[0].issue.field, "world.origin.latitude_deg");
}

/// 20 km away the Earth has curved away by 31 m: a ceiling of a stay-in volume is lower there, that of a keep-out volume is not.
#[test]
fn bands_of_altitudes_err_to_the_safe_side() {
    let band = |kind: &str, south: f64| {
        let polygon_deg = format!("[[{south}, 11.38], [{south}, 11.4], [47.44, 11.39]]");
        let fence = format!("[[world.geofences]]\nname = \"zone\"\nkind = \"{kind}\"\npolygon_deg = {polygon_deg}\n");
        let world = format!("{ORIGIN}{fence}altitude_m = [600, 900]\n");
        let start = "{ x_m = -250, y_m = 0, z_m = 80 }";
        let text = scenario(&world, start).replace("z_m = 20", "z_m = 80");
        parse("place.toml", &text).unwrap().world.geofences[0].z_m.unwrap()
    };
    // By pymap3d, to a millimetre.
    assert_near(&<[f64; 2]>::from(band("stay-in", 47.25)), &[30.0, 298.563932]);
    assert_near(&<[f64; 2]>::from(band("keep-out", 47.27)), &[-1.437549, 330.0]);
}

mod files {
    use super::*;

    const SITE: &str = r#"{ "type": "FeatureCollection", "features": [
  { "type": "Feature", "properties": { "name": "tower" }, "geometry": { "type": "Point", "coordinates": [11.39, 47.26] } },
  { "type": "Feature", "properties": { "name": "site", "z_m": [0, 90] }, "geometry": { "type": "MultiPolygon", "coordinates": [
    [[[11.384, 47.257],
      [11.396, 47.257],
      [11.396, 47.263],
      [11.384, 47.263],
      [11.384, 47.257]],
     [[11.389, 47.261], [11.389, 47.262], [11.391, 47.262], [11.389, 47.261]]],
    [[[11.398, 47.257], [11.399, 47.257], [11.399, 47.258], [11.398, 47.257]]]] } },
  { "type": "Feature", "id": 7, "properties": null, "geometry": { "type": "Polygon", "coordinates": [
    [[11.392, 47.261], [11.393, 47.261], [11.393, 47.262], [11.392, 47.261]]] } } ] }"#;

    /// The scenario with a geofence from a file of this content.
    fn fenced(content: &str, keys: &str) -> Result<Scenario, LoadError> {
        let folder = tempfile::tempdir().unwrap();
        std::fs::write(folder.path().join("site.geojson"), content).unwrap();
        let fence = format!("[[world.geofences]]\nname = \"zone\"\nfile = \"site.geojson\"\n{keys}\n");
        let path = folder.path().join("place.toml");
        std::fs::write(&path, scenario(&format!("{ORIGIN}{fence}"), START_M)).unwrap();
        load(&path)
    }

    #[track_caller]
    fn assert_refused(content: &str, keys: &str, says: &[&str]) {
        match fenced(content, keys) {
            Ok(_) => panic!("accepted"),
            Err(LoadError::Invalid(invalid)) => {
                let [it] = invalid.issues.as_slice() else { panic!("{invalid:?}") };
                assert_eq!(it.issue.field, "world.geofences[0].file");
                let text = format!("{}; {}", it.issue, it.issue.remedy);
                assert!(says.iter().all(|it| text.contains(it)), "{text}");
            }
            Err(other) => panic!("{other}"),
        }
    }

    #[test]
    fn a_feature_with_a_hole_and_a_second_part_is_read() {
        let scenario = fenced(SITE, "kind = \"stay-in\"\nfeature = \"site\"").unwrap();
        let fence = &scenario.world.geofences[0];
        assert_eq!((fence.polygon_m.len(), fence.rings_m.len()), (4, 2));
        assert_eq!(fence.z_m, Some(scenarios::Range::new(0.0, 90.0)));
        // South-west corner and a point in the hole, by pymap3d.
        assert_near(&fence.polygon_m[0], &[-454.183718, -333.540026]);
        assert!(fence.margin_m([-30.0, 150.0, 20.0]) < 0.0 && fence.margin_m([-200.0, 0.0, 20.0]) > 0.0);
        assert!(fence.margin_m([640.0, -310.0, 20.0]) > 0.0, "the second part");
        let by_id = fenced(SITE, "kind = \"keep-out\"\nfeature = \"7\"\naltitude_m = [570, 600]").unwrap();
        assert_eq!(by_id.world.geofences[0].z_m.map(|it| it.max), Some(30.0));
    }

    #[test]
    fn files_that_cannot_be_meant_are_refused_with_line_and_remedy() {
        let stay_in = "kind = \"stay-in\"\nfeature = \"site\"";
        let one = "kind = \"stay-in\"";
        assert_refused(SITE, one, &["2 polygons", "site, 7"]);
        assert_refused(SITE, "kind = \"stay-in\"\nfeature = \"sitee\"", &["did you mean \"site\"?"]);
        assert_refused(&SITE[..200], stay_in, &["site.geojson:3", "GeoJSON"]);
        assert_refused("", stay_in, &["the file is empty"]);
        assert_refused("{ \"type\": \"Point\", \"coordinates\": [11, 47] }", one, &["no polygon"]);
        let swapped = SITE.replace("[11.396, 47.263]", "[47.263, 11.396]");
        assert_refused(&swapped, stay_in, &["site.geojson:6", "longitude in GeoJSON"]);
        let out_of_range = SITE.replace("[11.396, 47.263]", "[11.396, 147.263]");
        assert_refused(&out_of_range, stay_in, &["site.geojson:6", "[-90, 90] deg"]);
        let open = SITE.replace("[11.384, 47.257]],", "[11.385, 47.257]],");
        assert_refused(&open, stay_in, &["site.geojson:8", "not closed", "repeat the first position"]);
        let text = SITE.replace("[11.396, 47.263]", "[\"11.396\", 47.263]");
        assert_refused(&text, stay_in, &["site.geojson:6", "two numbers"]);
        let crossed =
            SITE.replace("[11.396, 47.263]", "[11.384, 47.2601]").replace("[11.384, 47.263]", "[11.396, 47.263]");
        assert_refused(&crossed, stay_in, &["site.geojson:4", "cross"]);
        let outside = SITE.replace("[11.389, 47.261], [11.389, 47.262]", "[11.369, 47.261], [11.369, 47.262]");
        assert!(fenced(&outside, stay_in).is_err());
        assert_refused(&SITE.replace("z_m", "ceiling_ft"), stay_in, &["`ceiling_ft`", "altitude_m"]);
        assert_refused(&SITE.replace("[0, 90]", "[90, 0]"), stay_in, &["[90,0]", "the lower one first"]);
        assert_refused(SITE, &format!("{stay_in}\nz_m = [0, 50]"), &["another in the geofence file"]);
        let lambert = SITE.replacen("{", "{ \"crs\": { \"properties\": { \"name\": \"EPSG:31287\" } },", 1);
        assert_refused(&lambert, stay_in, &["EPSG:31287", "WGS 84"]);
    }

    #[test]
    fn a_missing_file_is_named() {
        let text = scenario(
            &format!("{ORIGIN}[[world.geofences]]\nname = \"zone\"\nkind = \"stay-in\"\nfile = \"nowhere.geojson\"\n"),
            START_M,
        );
        assert_issue(&text, "world.geofences[0].file", &["nowhere.geojson", "relative to the folder"]);
    }
}
