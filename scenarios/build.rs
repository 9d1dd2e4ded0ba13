//! Lists the shipped scenarios, so that the program holds them: a table of paths and texts for `src/shipped.rs`.

use std::path::{Path, PathBuf};
use std::{env, fs};

/// Folders of scenario files, beside this script.
const FOLDERS: [&str; 3] = ["fixed-wing", "multirotor", "slung"];

fn main() {
    let root = PathBuf::from(env::var("CARGO_MANIFEST_DIR").expect("set by Cargo"));
    let mut rows: Vec<String> = FOLDERS.iter().flat_map(|folder| rows(&root, folder)).collect();
    rows.sort_unstable();
    let table = format!("&[\n{}]\n", rows.concat());
    let out = PathBuf::from(env::var("OUT_DIR").expect("set by Cargo")).join("shipped.rs");
    fs::write(out, table).expect("the output folder can be written to");
}

/// One row per scenario file of a folder.
fn rows(root: &Path, folder: &str) -> Vec<String> {
    println!("cargo::rerun-if-changed={folder}");
    let entries = fs::read_dir(root.join(folder)).expect("a folder of scenarios");
    let files = entries.map(|entry| entry.expect("a readable folder").path());
    let scenarios = files.filter(|file| file.extension().is_some_and(|extension| extension == "toml"));
    let row = |file: PathBuf| {
        let name = file.file_name().expect("a file").to_string_lossy().into_owned();
        format!("    ({:?}, include_str!({:?})),\n", format!("{folder}/{name}"), file)
    };
    scenarios.map(row).collect()
}
