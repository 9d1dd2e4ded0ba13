//! The scenario files of this folder.

use std::path::Path;

#[test]
fn every_shipped_scenario_loads() {
    let folder = Path::new(env!("CARGO_MANIFEST_DIR"));
    let files = scenarios::find(&[folder]).unwrap();
    let faults: Vec<String> =
        files.iter().filter_map(|file| scenarios::load(file).err()).flat_map(|error| error.lines()).collect();
    assert!(faults.is_empty(), "{}", faults.join("\n"));
}
