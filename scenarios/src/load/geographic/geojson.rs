//! GeoJSON (RFC 7946): one feature with a polygon or several. Positions are longitude and latitude, WGS 84; altitudes in them are
//! not read.

use serde_json::Value;

use crate::geometry::FileError;

/// The area of a feature.
#[derive(Debug)]
pub(super) struct Area {
    /// Its boundaries, the first an outer one.
    pub rings: Vec<Ring>,
    /// The property `altitude_m`: lowest and highest altitude above mean sea level, m.
    pub altitude_m: Option<[f64; 2]>,
    /// The property `z_m`: lowest and highest height above the origin, m.
    pub z_m: Option<[f64; 2]>,
}

/// A closed boundary.
#[derive(Debug)]
pub(super) struct Ring {
    /// Lines in the file, and corners (latitude, longitude), deg, each once.
    pub corners: Vec<(usize, [f64; 2])>,
    pub is_hole: bool,
}

/// Parts of names of properties that seem to bound the altitude.
const BAND_WORDS: [&str; 7] = ["altitude", "height", "floor", "ceiling", "upper", "lower", "limit"];
const BAND: &str =
    "`altitude_m`: [lowest, highest], m above mean sea level, or `z_m`: [lowest, highest], m above the origin";

/// Reads the feature of this name, or the only one.
pub(super) fn read(content: &[u8], name: Option<&str>) -> Result<Area, FileError> {
    let text = std::str::from_utf8(content)
        .map_err(|_| error(None, "bytes that are not text", "GeoJSON in UTF-8", "export it as GeoJSON"))?;
    let document: Value = serde_json::from_str(text).map_err(|it| {
        let remedy = if text.is_empty() { "the file is empty" } else { "mend the file, or export it anew as GeoJSON" };
        error(Some(it.line()), &it.to_string(), "GeoJSON", remedy)
    })?;
    refuse_other_datum(&document)?;
    let features = features(&document);
    let feature = select(&features, name)?;
    let mut lines = lines_of_positions(text, feature.geometry_index).into_iter();
    let polygons = match feature.geometry["type"].as_str() {
        Some("Polygon") => vec![&feature.geometry["coordinates"]],
        _ => feature.geometry["coordinates"].as_array().into_iter().flatten().collect(),
    };
    let mut rings = Vec::new();
    for polygon in polygons {
        for (index, ring) in polygon.as_array().into_iter().flatten().enumerate() {
            rings.push(Ring { corners: corners(ring, &mut lines)?, is_hole: index > 0 });
        }
    }
    if rings.is_empty() {
        return Err(error(None, "a feature without coordinates", "a polygon", "draw the area and export it anew"));
    }
    let [altitude_m, z_m] = bands(feature.properties)?;
    Ok(Area { rings, altitude_m, z_m })
}

struct Feature<'a> {
    name: Option<String>,
    geometry: &'a Value,
    properties: &'a Value,
    /// Its place among all geometries of the file.
    geometry_index: usize,
}

/// The features with areas.
fn features(document: &Value) -> Vec<Feature<'_>> {
    let list = match document["type"].as_str() {
        Some("FeatureCollection") => document["features"].as_array().into_iter().flatten().collect(),
        _ => vec![document],
    };
    let has_coordinates = |it: &&Value| it["geometry"]["coordinates"].is_array() || it["coordinates"].is_array();
    list.into_iter()
        .filter(has_coordinates)
        .enumerate()
        .map(|(geometry_index, feature)| {
            let geometry = if feature["geometry"].is_object() { &feature["geometry"] } else { feature };
            let name = [&feature["properties"]["name"], &feature["id"]].into_iter().find_map(text_of);
            Feature { name, geometry, properties: &feature["properties"], geometry_index }
        })
        .filter(|it| matches!(it.geometry["type"].as_str(), Some("Polygon" | "MultiPolygon")))
        .collect()
}

fn text_of(value: &Value) -> Option<String> {
    value.as_str().map(str::to_owned).or_else(|| value.as_i64().map(|it| it.to_string()))
}

fn select<'f, 'a>(features: &'f [Feature<'a>], name: Option<&str>) -> Result<&'f Feature<'a>, FileError> {
    let names: Vec<&str> = features.iter().filter_map(|it| it.name.as_deref()).collect();
    let wanted: Vec<&Feature<'_>> = features.iter().filter(|it| name.is_none() || it.name.as_deref() == name).collect();
    match (wanted.as_slice(), name) {
        ([one], _) => Ok(one),
        ([], None) => Err(error(
            None,
            "no polygon",
            "a Feature or FeatureCollection with a Polygon or MultiPolygon",
            "draw the area as a polygon; lines and points are no areas",
        )),
        ([], Some(name)) => {
            let remedy = match crate::closest_name(name, names.iter().copied()) {
                Some(close) => format!("did you mean \"{close}\"?"),
                None => format!("`feature` is the property `name` or the `id` of a feature: {}", names.join(", ")),
            };
            Err(error(None, &format!("no polygon named \"{name}\""), "a feature of this name", &remedy))
        }
        (several, _) => Err(error(
            None,
            &format!("{} polygons", several.len()),
            "one, or `feature` with its name",
            &format!("add `feature`, one of {}; one geofence for each", names.join(", ")),
        )),
    }
}

/// Corners of a ring, which must return to its first one.
fn corners(ring: &Value, lines: &mut impl Iterator<Item = usize>) -> Result<Vec<(usize, [f64; 2])>, FileError> {
    let mut corners = Vec::new();
    for position in ring.as_array().into_iter().flatten() {
        let line = lines.next();
        let coordinate = |axis: usize| position[axis].as_f64();
        let (Some(longitude_deg), Some(latitude_deg)) = (coordinate(0), coordinate(1)) else {
            return Err(error(line, &position.to_string(), "a position [longitude, latitude]", "give two numbers"));
        };
        corners.push((line.unwrap_or(1), [latitude_deg, longitude_deg]));
    }
    match (corners.first().copied(), corners.last().copied()) {
        (Some((_, first)), Some((_, last))) if first == last && corners.len() >= 4 => {
            corners.pop();
            Ok(corners)
        }
        (_, last) => Err(error(
            last.map(|(line, _)| line),
            &format!("a ring of {} positions that is not closed", corners.len()),
            "at least four positions, the last equal to the first",
            "repeat the first position at the end of the ring",
        )),
    }
}

/// The properties `altitude_m` and `z_m`. Others that seem to bound the altitude are refused: ignoring them would change the
/// volume.
fn bands(properties: &Value) -> Result<[Option<[f64; 2]>; 2], FileError> {
    let known = ["altitude_m", "z_m"];
    let bands = known.map(|key| properties.get(key).filter(|it| !it.is_null()));
    if let [Some(_), Some(_)] = bands {
        return Err(error(None, "both `altitude_m` and `z_m`", "one of them", "remove one of the two properties"));
    }
    let names = properties.as_object().into_iter().flat_map(|it| it.keys());
    let mut names = names.filter(|name| !known.contains(&name.as_str()));
    if let Some(name) = names.find(|name| BAND_WORDS.iter().any(|word| name.to_lowercase().contains(word))) {
        let remedy = "rename the property, or remove it and give the band in the scenario";
        return Err(error(None, &format!("the property `{name}`"), &format!("a band of altitudes as {BAND}"), remedy));
    }
    let mut read = [None; 2];
    for ((band, value), key) in read.iter_mut().zip(bands).zip(known) {
        let Some(value) = value else { continue };
        let numbers: Option<[f64; 2]> = serde_json::from_value(value.clone()).ok();
        let Some(numbers) = numbers.filter(|[min, max]| min < max) else {
            return Err(error(None, &format!("`{key}`: {value}"), BAND, "give two numbers, the lower one first"));
        };
        *band = Some(numbers);
    }
    Ok(read)
}

/// Coordinates of another datum, which RFC 7946 no longer allows.
fn refuse_other_datum(document: &Value) -> Result<(), FileError> {
    let name = document["crs"]["properties"]["name"].as_str();
    match name.filter(|name| !name.ends_with("CRS84") && !name.ends_with("4326")) {
        None => Ok(()),
        Some(name) => Err(error(None, &format!("coordinates in {name}"), "WGS 84", "export it in WGS 84 (EPSG:4326)")),
    }
}

fn error(line: Option<usize>, found: &str, expected: &str, remedy: &str) -> FileError {
    FileError { line, found: found.to_owned(), expected: expected.to_owned(), remedy: remedy.to_owned() }
}

/// The lines of the positions of one geometry: of the arrays in its coordinates that hold no arrays.
fn lines_of_positions(text: &str, geometry_index: usize) -> Vec<usize> {
    let key = "\"coordinates\"";
    let Some((start, _)) = text.match_indices(key).nth(geometry_index) else { return Vec::new() };
    let mut line = text[..start].matches('\n').count() + 1;
    let (mut depth, mut lines, mut opened) = (0_usize, Vec::new(), None);
    for character in text[start + key.len()..].chars() {
        match character {
            '\n' => line += 1,
            '[' => {
                depth += 1;
                opened = Some(line);
            }
            ']' => {
                lines.extend(opened.take());
                depth = depth.saturating_sub(1);
                if depth == 0 {
                    break;
                }
            }
            _ => {}
        }
    }
    lines
}
