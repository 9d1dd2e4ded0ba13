//! JSON documents.

use scenarios::PlanStatus;
use scenarios::plan_input::parse_json;

use super::{assert_rejected, fixed_wings, scenario};

const JSON: &str = r#"{"status": "solved", "trajectories": [
  {"vehicle": "uav-1", "times_s": [0, 30], "x_m": [0, 1000], "y_m": [-100, -100], "z_m": [400, 400]},
  {"vehicle": "uav-2", "times_s": [0, 30], "x_m": [0, 1000], "y_m": [100, 100], "z_m": [400, 400]}]}"#;

#[track_caller]
fn assert_json_rejected(old: &str, new: &str, parts: &[&str]) {
    assert!(JSON.contains(old), "the document has no `{old}`");
    assert_rejected(parse_json("plan.json", &JSON.replacen(old, new, 1), &scenario()), parts);
}

#[test]
fn json_with_columns_is_read() {
    let (header, trajectories) = parse_json("plan.json", JSON, &scenario()).unwrap();
    assert_eq!(header.status, Some(PlanStatus::Solved));
    assert_eq!(fixed_wings(trajectories)[1].positions_m, [[0.0, 100.0, 400.0], [1000.0, 100.0, 400.0]]);
}

#[test]
fn wrong_json_is_rejected_with_the_field() {
    assert_json_rejected("[0, 30]", "[0, NaN]", &["plan.json:2:", "JSON syntax", "JSON has no NaN"]);
    assert_json_rejected("[0, 30]", "[0, null]", &["trajectories[0] node 1: t_s of uav-1: found NaN"]);
    assert_json_rejected("[0, 30]", "[0]", &["trajectories[0].x_m: found 2 values, expected 1"]);
    assert_json_rejected("[0, 30]", "{}", &["trajectories[0].times_s: found an object"]);
    assert_json_rejected("\"solved\"", "\"splendid\"", &["status: found the text \"splendid\"", "no-plan"]);
    assert_json_rejected("\"status\"", "\"state\"", &["state: found an unknown key", "did you mean `status`?"]);
    assert_json_rejected(
        "\"status\"",
        "\"scenario\": \"other\", \"status\"",
        &["scenario: found \"other\"", "\"pair\""],
    );
    assert_json_rejected("\"status\"", "\"schema\": 2, \"status\"", &["schema: found 2"]);
    let negative = "\"timings\": {\"wall_s\": 1, \"distributed_s\": -2}, \"status\"";
    assert_json_rejected("\"status\"", negative, &["timings.distributed_s: found -2 s, expected 0 s or more"]);
    assert_json_rejected("\"vehicle\": \"uav-1\", ", "", &["trajectories[0].vehicle: found nothing"]);
    assert_json_rejected("\"status\"", "\"status\": \"no-plan\", \"status\"", &["the key `status` twice"]);
    assert_json_rejected("\"x_m\"", "\"x_m\": [5, 6], \"x_m\"", &["plan.json:2:", "the key `x_m` twice in one object"]);
    assert_json_rejected(
        "\"x_m\"",
        "\"t_s\": [0, 60], \"x_m\"",
        &["trajectories[0].t_s: found the times a second time"],
    );
    let states = "\"states\": [{\"x_m\": 5}, {\"x_m\": 6}], \"x_m\"";
    assert_json_rejected("\"x_m\"", states, &["trajectories[0].x_m: found the values a second time"]);
    for text in ["", "[]", "3", "{", "{}"] {
        assert!(parse_json("plan.json", text, &scenario()).is_err(), "{text}");
    }
}
