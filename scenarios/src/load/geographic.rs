//! Positions on the Earth. A scenario file may give them as latitude, longitude and altitude: they are converted to the world
//! frame once, before the scenario is built, so that nothing after that knows them.

mod geojson;
mod places;
mod polygons;
mod schema;

use std::path::Path;

use serde_json::{Map, Value};

use self::places::{PLACES, Place, Shape};
use crate::geodesy::{Geodetic, LocalFrame};
use crate::{Issue, Origin};

pub(crate) use schema::with_geographic_keys;

/// A table of the document.
type Table = Map<String, Value>;

/// Positions that are farther from the origin are refused: there the Earth has curved away from the plane of the map by 785 m.
const MAX_DISTANCE_M: f64 = 100e3;

/// Converts every position that is given in degrees. Returns what is wrong with them.
pub(super) fn to_world_frame(document: &mut Value, scenario_file: &Path) -> Vec<Issue> {
    let origin = document.pointer("/world/origin").and_then(|it| serde_json::from_value(it.clone()).ok());
    let converter = Converter { origin, frame: origin.map(|it: Origin| it.frame()), scenario_file };
    let mut issues = Vec::new();
    for place in &PLACES {
        let steps: Vec<&str> = place.path.split('.').collect();
        visit(document, &steps, "", &mut |table, field| {
            if let Err(issue) = converter.convert(place, table, field) {
                issues.push(issue);
            }
        });
    }
    issues
}

/// Calls `convert` with every table at a path, such as `vehicles[].start`, and with its field.
fn visit(value: &mut Value, path: &[&str], field: &str, convert: &mut impl FnMut(&mut Table, &str)) {
    let Some((step, rest)) = path.split_first() else {
        if let Some(table) = value.as_object_mut() {
            convert(table, field);
        }
        return;
    };
    let key = step.trim_end_matches("[]");
    let field = if field.is_empty() { key.to_owned() } else { format!("{field}.{key}") };
    match value.get_mut(key) {
        Some(Value::Array(list)) if step.ends_with("[]") => {
            list.iter_mut().enumerate().for_each(|(i, it)| visit(it, rest, &format!("{field}[{i}]"), convert));
        }
        Some(inner) => visit(inner, rest, &field, convert),
        None => {}
    }
}

struct Converter<'a> {
    origin: Option<Origin>,
    frame: Option<LocalFrame>,
    scenario_file: &'a Path,
}

/// How high a position is.
#[derive(Clone, Copy)]
enum Height {
    /// Above mean sea level, m.
    Altitude(f64),
    /// Above the origin, along the z axis, m.
    Up(f64),
}

impl Converter<'_> {
    /// Replaces the keys of one table. Values of a wrong type are left to the schema.
    fn convert(&self, place: &Place, table: &mut Table, field: &str) -> Result<(), Issue> {
        if let Some((degrees, metres)) = place.given_twice(table) {
            let found = format!("both `{degrees}` and `{metres}`");
            return Err(Issue::new(format!("{field}.{degrees}"), found, "one of them").remedy("remove one of the two"));
        }
        match place.shape {
            Shape::Point => self.point_of_table(table, field),
            Shape::Pair => self.pair(place, table, field),
            Shape::Triple => self.triple(place, table, field),
            Shape::Triples => self.triples(place, table, field),
            Shape::Pairs => self.pairs(place, table, field),
            Shape::Polygons => polygons::convert(self, place, table, field),
        }?;
        self.band(place, table, field)
    }

    fn point_of_table(&self, table: &mut Table, field: &str) -> Result<(), Issue> {
        let degrees = number(table, "latitude_deg").zip(number(table, "longitude_deg"));
        let Some(((latitude_deg, longitude_deg), height)) = degrees.zip(height(table)) else { return Ok(()) };
        let point_m = self.enu_m([latitude_deg, longitude_deg], height, &format!("{field}.latitude_deg"))?;
        ["latitude_deg", "longitude_deg", "altitude_m"].into_iter().for_each(|key| drop(table.remove(key)));
        for (key, value_m) in ["x_m", "y_m", "z_m"].into_iter().zip(point_m) {
            table.insert(key.to_owned(), value_m.into());
        }
        Ok(())
    }

    fn pair(&self, place: &Place, table: &mut Table, field: &str) -> Result<(), Issue> {
        let Some(degrees) = pair(table.get(&place.degrees())) else { return Ok(()) };
        let [x_m, y_m, _] = self.level_enu_m(degrees, &format!("{field}.{}", place.degrees()))?;
        place.replace(table, vec![x_m, y_m]);
        Ok(())
    }

    fn triple(&self, place: &Place, table: &mut Table, field: &str) -> Result<(), Issue> {
        let degrees = pair(table.get(&place.degrees()));
        let Some((degrees, height)) = degrees.zip(height(table)) else { return Ok(()) };
        let point_m = self.enu_m(degrees, height, &format!("{field}.{}", place.degrees()))?;
        ["altitude_m", "z_m"].into_iter().for_each(|key| drop(table.remove(key)));
        place.replace(table, point_m.to_vec());
        Ok(())
    }

    fn triples(&self, place: &Place, table: &mut Table, field: &str) -> Result<(), Issue> {
        let Some(degrees) = pairs(table.get(&place.degrees())) else { return Ok(()) };
        let altitudes = pair(table.get("altitude_m")).map(|it| it.map(Height::Altitude));
        let Some(heights) = altitudes.or_else(|| pair(table.get("z_m")).map(|it| it.map(Height::Up))) else {
            return Ok(());
        };
        let at = |(i, (degrees, height))| self.enu_m(degrees, height, &format!("{field}.{}[{i}]", place.degrees()));
        let points_m: Vec<[f64; 3]> = degrees.into_iter().zip(heights).enumerate().map(at).collect::<Result<_, _>>()?;
        ["altitude_m", "z_m"].into_iter().for_each(|key| drop(table.remove(key)));
        place.replace(table, points_m);
        Ok(())
    }

    fn pairs(&self, place: &Place, table: &mut Table, field: &str) -> Result<(), Issue> {
        let Some(degrees) = pairs(table.get(&place.degrees())) else { return Ok(()) };
        place.replace(table, self.ring_m(&degrees, &format!("{field}.{}", place.degrees()))?);
        Ok(())
    }

    /// Positions (x, y), m, of the corners of a polygon at the altitude of the origin.
    fn ring_m(&self, degrees: &[[f64; 2]], field: &str) -> Result<Vec<[f64; 2]>, Issue> {
        let corner = |(i, it): (usize, &[f64; 2])| self.level_enu_m(*it, &format!("{field}[{i}]"));
        degrees.iter().enumerate().map(|it| corner(it).map(|[x_m, y_m, _]| [x_m, y_m])).collect()
    }

    /// A band of altitudes becomes one of heights in the world frame. The Earth curves away from that frame, so that the band is
    /// widened for obstacles and keep-out volumes, and narrowed for stay-in volumes, by as much as it does within the outline.
    fn band(&self, place: &Place, table: &mut Table, field: &str) -> Result<(), Issue> {
        let Some([min_m, max_m]) = pair(table.get("altitude_m")).filter(|_| place.has_band) else { return Ok(()) };
        let field = format!("{field}.altitude_m");
        let (origin, frame) = self.origin.zip(self.frame).ok_or_else(|| no_origin(&field))?;
        let outline_m = place.outline_m(table);
        let lowest =
            |altitude_m: f64| outline_m.iter().map(|it| frame.up_m(*it, altitude_m)).fold(f64::INFINITY, f64::min);
        let highest = |altitude_m: f64| altitude_m - origin.altitude_m;
        let is_stay_in = table.get("kind").is_some_and(|kind| kind == "stay-in");
        let band_m = if is_stay_in { [highest(min_m), lowest(max_m)] } else { [lowest(min_m), highest(max_m)] };
        table.remove("altitude_m");
        table.insert("z_m".into(), band_m.to_vec().into());
        Ok(())
    }

    fn level_enu_m(&self, degrees: [f64; 2], field: &str) -> Result<[f64; 3], Issue> {
        let altitude_m = self.origin.map_or(0.0, |origin| origin.altitude_m);
        self.enu_m(degrees, Height::Altitude(altitude_m), field)
    }

    /// The position of a point, m, if it is one, and near the origin.
    fn enu_m(&self, degrees: [f64; 2], height: Height, field: &str) -> Result<[f64; 3], Issue> {
        let (origin, frame) = self.origin.zip(self.frame).ok_or_else(|| no_origin(field))?;
        on_earth(degrees, field)?;
        let [latitude_deg, longitude_deg] = degrees;
        let place = |degrees: [f64; 2]| match height {
            Height::Altitude(altitude_m) => {
                frame.enu_m(Geodetic { latitude_deg: degrees[0], longitude_deg: degrees[1], altitude_m })
            }
            Height::Up(up_m) => frame.enu_at_height_m(degrees, up_m),
        };
        let distance_m = |[x_m, y_m, z_m]: [f64; 3]| if z_m.abs() > 1e6 { f64::INFINITY } else { x_m.hypot(y_m) };
        let point_m = place(degrees);
        if distance_m(point_m) <= MAX_DISTANCE_M {
            return Ok(point_m);
        }
        let is_swapped = distance_m(place([longitude_deg, latitude_deg])) <= MAX_DISTANCE_M;
        Err(far_away(degrees, distance_m(point_m), &origin, is_swapped, field))
    }
}

/// What is wrong with an origin.
pub(crate) fn origin_issues(origin: &Origin) -> Option<Issue> {
    on_earth([origin.latitude_deg, origin.longitude_deg], "world.origin.latitude_deg").err()
}

fn on_earth([latitude_deg, longitude_deg]: [f64; 2], field: &str) -> Result<(), Issue> {
    let found = format!("latitude {latitude_deg} deg, longitude {longitude_deg} deg");
    let issue = Issue::new(field, found, "a latitude in [-90, 90] deg and a longitude in [-180, 180] deg");
    match (latitude_deg.abs() <= 90.0, longitude_deg.abs() <= 180.0) {
        (true, true) => Ok(()),
        (false, _) if longitude_deg.abs() <= 90.0 && latitude_deg.abs() <= 180.0 => {
            Err(issue.remedy("the two seem to be swapped: the latitude comes first"))
        }
        _ => Err(issue.remedy("give degrees, WGS 84, positive to the north and to the east")),
    }
}

fn no_origin(field: &str) -> Issue {
    Issue::new(field, "a position on the Earth in a world without an origin", "`world.origin`")
        .remedy("add [world.origin] with latitude_deg, longitude_deg and altitude_m: where (0, 0, 0) m of the map lies")
}

fn far_away(degrees: [f64; 2], distance_m: f64, origin: &Origin, is_swapped: bool, field: &str) -> Issue {
    let [latitude_deg, longitude_deg] = degrees;
    let km = if distance_m.is_finite() { format!("{:.0} km", distance_m / 1e3) } else { "thousands of km".into() };
    let found = format!("latitude {latitude_deg} deg, longitude {longitude_deg} deg, {km} from the origin");
    let expected = format!(
        "a point within {:.0} km of the origin, latitude {} deg, longitude {} deg: the world frame is flat, the Earth \
         curves away from it by 0.08 m at 1 km, 7.8 m at 10 km, 785 m at 100 km",
        MAX_DISTANCE_M / 1e3,
        origin.latitude_deg,
        origin.longitude_deg
    );
    let remedy = if is_swapped {
        "latitude and longitude seem to be swapped: the latitude comes first in scenario files, the longitude in GeoJSON"
    } else {
        "move the origin to the middle of the map"
    };
    Issue::new(field, found, expected).remedy(remedy)
}

fn number(table: &Table, key: &str) -> Option<f64> {
    table.get(key)?.as_f64()
}

fn height(table: &Table) -> Option<Height> {
    number(table, "altitude_m").map(Height::Altitude).or_else(|| number(table, "z_m").map(Height::Up))
}

fn pair(value: Option<&Value>) -> Option<[f64; 2]> {
    serde_json::from_value(value?.clone()).ok()
}

fn pairs(value: Option<&Value>) -> Option<Vec<[f64; 2]>> {
    serde_json::from_value(value?.clone()).ok()
}
