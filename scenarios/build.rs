//! Lists the shipped scenarios and the files that they refer to, so that the program holds them: tables of paths and contents
//! for `src/shipped.rs`.

use std::path::{Path, PathBuf};
use std::{env, fs};

/// Folders of scenario files, beside this script.
const FOLDERS: [&str; 3] = ["fixed-wing", "multirotor", "slung"];

/// Extensions of the files that scenarios refer to.
const ATTACHED: [&str; 4] = ["stl", "obj", "asc", "geojson"];

fn main() {
    let root = PathBuf::from(env::var("CARGO_MANIFEST_DIR").expect("set by Cargo"));
    write_table("shipped.rs", &rows(&root, &["toml"], "include_str"));
    write_table("attached.rs", &rows(&root, &ATTACHED, "include_bytes"));
}

fn write_table(name: &str, rows: &[String]) {
    let table = format!("&[\n{}]\n", rows.concat());
    let out = PathBuf::from(env::var("OUT_DIR").expect("set by Cargo")).join(name);
    fs::write(out, table).expect("the output folder can be written to");
}

/// One row per file with one of the extensions, sorted by path.
fn rows(root: &Path, extensions: &[&str], include: &str) -> Vec<String> {
    let in_folder = |folder: &&str| {
        println!("cargo::rerun-if-changed={folder}");
        let entries = fs::read_dir(root.join(folder)).expect("a folder of scenarios");
        let files = entries.map(|entry| entry.expect("a readable folder").path());
        let is_wanted =
            |file: &PathBuf| file.extension().is_some_and(|it| extensions.iter().any(|wanted| it == *wanted));
        let row = |file: PathBuf| {
            let name = file.file_name().expect("a file").to_string_lossy().into_owned();
            format!("    ({:?}, {include}!({:?})),\n", format!("{folder}/{name}"), file)
        };
        files.filter(is_wanted).map(row).collect::<Vec<_>>()
    };
    let mut rows: Vec<String> = FOLDERS.iter().flat_map(in_folder).collect();
    rows.sort_unstable();
    rows
}
