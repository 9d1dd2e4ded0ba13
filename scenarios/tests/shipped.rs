//! The shipped scenario files.

use std::path::Path;

#[test]
fn every_shipped_scenario_loads() {
    let folder = Path::new(env!("CARGO_MANIFEST_DIR"));
    let files = scenarios::find(&[folder]).unwrap();
    let issues: Vec<String> =
        files.iter().filter_map(|file| scenarios::load(file).err()).flat_map(|error| error.lines()).collect();
    assert!(issues.is_empty(), "{}", issues.join("\n"));
}

#[test]
fn a_scenario_written_as_toml_loads_unchanged() {
    let folder = Path::new(env!("CARGO_MANIFEST_DIR"));
    let copies = tempfile::tempdir().unwrap();
    for file in scenarios::find(&[folder]).unwrap() {
        let scenario = scenarios::load(&file).unwrap();
        let copy = copies.path().join(file.file_name().unwrap());
        std::fs::write(&copy, scenario.to_toml()).unwrap();
        assert_eq!(scenarios::load(&copy).unwrap(), scenario);
    }
}
