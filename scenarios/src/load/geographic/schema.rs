//! The keys of positions on the Earth in the JSON Schema of scenario files.

use serde_json::{Value, json};

use super::places::{PLACES, Place, Shape};

const LATITUDE: &str = "Latitude, WGS 84, deg: in place of x_m and y_m, with `longitude_deg`. Needs `world.origin`.";
const LONGITUDE: &str = "Longitude, WGS 84, deg.";
const ALTITUDE: &str =
    "Altitude above mean sea level (AMSL), m: with latitude and longitude, in place of the height above the origin.";
const UP: &str = "Height above the origin along the z axis, m: with latitude and longitude, in place of `altitude_m`.";
const BAND: &str =
    "Lowest and highest altitude above mean sea level (AMSL), m, in place of `z_m`. Needs `world.origin`.";
const FILE: &str =
    "A GeoJSON file with the polygon, relative to the folder of the scenario file. Needs `world.origin`.";
const FEATURE: &str = "Name of the feature of the file, if it has several: its property `name`, or its `id`.";

/// Adds them to the schema that is generated from the types.
pub(crate) fn with_geographic_keys(mut schema: Value) -> Value {
    for place in &PLACES {
        extend(&mut schema["$defs"][place.definition], place);
    }
    schema
}

fn extend(definition: &mut Value, place: &Place) {
    let of_metres = definition["properties"][place.metres()]["description"].as_str().unwrap_or_default().to_owned();
    require_one_of(definition, &ways(place));
    for (key, property) in properties(place, &of_metres) {
        definition["properties"][key] = property;
    }
}

/// The keys that are added, and their schemas.
fn properties(place: &Place, of_metres: &str) -> Vec<(String, Value)> {
    let (degrees, metres) = (place.degrees(), place.metres());
    let in_degrees = |schema: Value| {
        let what = "(latitude, longitude), WGS 84, deg, in place of";
        documented(schema, &format!("Position {what} `{metres}`. Needs `world.origin`. {of_metres}"))
    };
    let pairs = json!({ "type": "array", "items": numbers(2) });
    let two_pairs = json!({ "type": "array", "items": numbers(2), "minItems": 2, "maxItems": 2 });
    let mut added = match place.shape {
        Shape::Point => vec![
            ("latitude_deg", number(LATITUDE)),
            ("longitude_deg", number(LONGITUDE)),
            ("altitude_m", number(ALTITUDE)),
        ],
        Shape::Pair => vec![(degrees.as_str(), in_degrees(numbers(2)))],
        Shape::Pairs => vec![(degrees.as_str(), in_degrees(pairs))],
        Shape::Triple => {
            vec![(degrees.as_str(), in_degrees(numbers(2))), ("altitude_m", number(ALTITUDE)), ("z_m", number(UP))]
        }
        Shape::Triples => vec![
            (degrees.as_str(), in_degrees(two_pairs)),
            ("altitude_m", documented(numbers(2), ALTITUDE)),
            ("z_m", documented(numbers(2), UP)),
        ],
        Shape::Polygons => {
            vec![(degrees.as_str(), in_degrees(pairs)), ("file", text(FILE)), ("feature", text(FEATURE))]
        }
    };
    if place.has_band {
        added.push(("altitude_m", documented(numbers(2), BAND)));
    }
    added.into_iter().map(|(key, property)| (key.to_owned(), property)).collect()
}

/// The ways to give a position, each by its keys; the first is that in metres.
fn ways(place: &Place) -> Vec<Vec<String>> {
    let (degrees, metres) = (place.degrees(), place.metres());
    let ways: Vec<Vec<&str>> = match place.shape {
        Shape::Point => vec![
            vec!["x_m", "y_m", "z_m"],
            vec!["latitude_deg", "longitude_deg", "altitude_m"],
            vec!["latitude_deg", "longitude_deg", "z_m"],
        ],
        Shape::Pair | Shape::Pairs => vec![vec![&metres], vec![&degrees]],
        Shape::Triple | Shape::Triples => {
            vec![vec![&metres], vec![&degrees, "altitude_m"], vec![&degrees, "z_m"]]
        }
        Shape::Polygons => vec![vec![&metres], vec![&degrees], vec!["file"]],
    };
    ways.into_iter().map(|keys| keys.into_iter().map(str::to_owned).collect()).collect()
}

/// What was required, if it is a position, becomes one of several ways to give it.
fn require_one_of(definition: &mut Value, ways: &[Vec<String>]) {
    let Some(required) = definition["required"].as_array_mut() else { return };
    let count = required.len();
    required.retain(|key| !ways[0].iter().any(|it| key == it));
    if required.len() == count {
        return;
    }
    let is_empty = required.is_empty();
    let table = definition.as_object_mut().expect("a schema of a table");
    if is_empty {
        table.remove("required");
    }
    let ways: Vec<Value> = ways.iter().map(|keys| json!({ "required": keys })).collect();
    table.insert("anyOf".into(), ways.into());
}

fn number(description: &str) -> Value {
    json!({ "type": "number", "format": "double", "description": description })
}

fn text(description: &str) -> Value {
    json!({ "type": "string", "description": description })
}

fn numbers(length: usize) -> Value {
    json!({ "type": "array", "items": { "type": "number", "format": "double" }, "minItems": length, "maxItems": length })
}

fn documented(mut schema: Value, description: &str) -> Value {
    schema["description"] = description.into();
    schema
}
