//! `harness new` and `harness request`: the first steps of a user.

use crate::workplace::{Workplace, code, stderr, stdout};

#[test]
fn a_new_scenario_of_every_family_passes() {
    let workplace = Workplace::new(&[]);
    for family in ["fixed-wing", "multirotor", "slung-load"] {
        let file = format!("first-{family}.toml");
        let output = workplace.harness(&["new", family, &file]);
        assert_eq!((code(&output), stdout(&output).trim()), (0, file.as_str()), "{}", stderr(&output));
        let output = workplace.harness(&["run", &file, "--record", "none"]);
        assert_eq!(code(&output), 0, "{}{}", stdout(&output), stderr(&output));
        let again = workplace.harness(&["new", family, &file]);
        assert!(code(&again) == 2 && stderr(&again).contains("exists already"), "{}", stderr(&again));
    }
}

#[test]
fn the_request_is_that_of_an_external_planner() {
    let workplace = Workplace::new(&[]);
    workplace.harness(&["new", "multirotor", "room.toml"]);
    let output = workplace.harness(&["request", "room.toml", "--seed", "7"]);
    assert_eq!(code(&output), 0, "{}", stderr(&output));
    let request: serde_json::Value = serde_json::from_str(&stdout(&output)).unwrap();
    assert_eq!((&request["request"], &request["seed"]), (&"plan".into(), &7.into()));
    assert_eq!(request["vehicles"][0]["name"], "uav-1");
    assert_eq!(request["world"]["prisms"][0]["name"], "wall");
}
