//! Polygons of geofences: in degrees, or from a GeoJSON file.

use super::geojson::{self, Area, Ring};
use super::places::Place;
use super::{Converter, Table, pairs};
use crate::Issue;
use crate::load::files::{self, Unread};
use crate::world::{is_inside, is_simple};

/// Replaces `polygon_deg`, or `file` and `feature`, by boundaries in metres. A file may give the band of altitudes, too.
pub(super) fn convert(converter: &Converter<'_>, place: &Place, table: &mut Table, field: &str) -> Result<(), Issue> {
    if let Some(degrees) = pairs(table.get(&place.degrees())) {
        place.replace(table, converter.ring_m(&degrees, &format!("{field}.{}", place.degrees()))?);
    }
    if let Some(file) = table.get("file").and_then(|it| it.as_str()).map(str::to_owned) {
        let feature = table.get("feature").and_then(|it| it.as_str()).map(str::to_owned);
        read(converter, table, (&file, feature.as_deref()), field)?;
        ["file", "feature"].into_iter().for_each(|key| drop(table.remove(key)));
    }
    Ok(())
}

fn read(
    converter: &Converter<'_>,
    table: &mut Table,
    (file, feature): (&str, Option<&str>),
    field: &str,
) -> Result<(), Issue> {
    let path = files::resolved(file, converter.scenario_file);
    let in_file = |unread: Unread| unread.issue("geofence file", &format!("{field}.file"));
    let content = files::content(&path).map_err(in_file)?;
    let malformed = |error| in_file(Unread::malformed(&path, error));
    let area = geojson::read(&content, feature).map_err(malformed)?;
    let at_line = |issue: Issue, line: usize| Issue {
        found: format!("{} in the geofence file {}:{line}", issue.found, path.display()),
        field: format!("{field}.file"),
        ..issue
    };
    let mut rings_m = Vec::new();
    for ring in &area.rings {
        let corner = |(line, degrees): &(usize, [f64; 2])| {
            converter.level_enu_m(*degrees, field).map(|[x_m, y_m, _]| [x_m, y_m]).map_err(|it| at_line(it, *line))
        };
        rings_m.push(ring.corners.iter().map(corner).collect::<Result<Vec<[f64; 2]>, Issue>>()?);
    }
    is_well_formed(&area, &rings_m).map_err(|(issue, line)| at_line(issue, line))?;
    for (key, band) in [("altitude_m", area.altitude_m), ("z_m", area.z_m)] {
        let Some(band) = band else { continue };
        if table.contains_key("altitude_m") || table.contains_key("z_m") {
            let found = "a band of altitudes in the scenario and another in the geofence file";
            let issue = Issue::new(format!("{field}.file"), found, "one of them");
            return Err(issue.remedy("remove it from the scenario, or from the properties of the feature"));
        }
        table.insert(key.into(), band.to_vec().into());
    }
    table.insert("polygon_m".into(), rings_m.remove(0).into());
    if !rings_m.is_empty() {
        table.insert("rings_m".into(), rings_m.into_iter().map(serde_json::Value::from).collect());
    }
    Ok(())
}

/// Rings must be simple; outer boundaries must be outside the others, and holes inside: only then is what is inside an odd number
/// of rings the area that the file means. Whether rings meet is checked with the scenario.
fn is_well_formed(area: &Area, rings_m: &[Vec<[f64; 2]>]) -> Result<(), (Issue, usize)> {
    for (index, (Ring { corners, is_hole }, ring_m)) in area.rings.iter().zip(rings_m).enumerate() {
        let line = corners.first().map_or(1, |(line, _)| *line);
        if !is_simple(ring_m) {
            let found = format!("a ring of {} corners whose edges cross, touch or fold back", ring_m.len());
            let issue =
                Issue::new("", found, "at least three corners of a simple polygon, in order, the first repeated");
            return Err((issue.remedy("list every corner once, in order along the boundary"), line));
        }
        let others = rings_m.iter().enumerate().filter(|(other, _)| *other != index).map(|(_, it)| it.as_slice());
        if is_inside(others, ring_m[0]) != *is_hole {
            let found = if *is_hole { "a hole that is not inside its polygon" } else { "a polygon inside another" };
            let issue = Issue::new("", found, "polygons that do not overlap, with their holes inside");
            return Err((issue.remedy("merge the polygons into one outline"), line));
        }
    }
    Ok(())
}
