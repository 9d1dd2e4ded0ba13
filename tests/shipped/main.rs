//! The shipped scenarios and planners, from file to verdict.

mod between_nodes;
mod conformance;
mod geometry;
mod multirotor;
mod own_plans;
mod trapezoid;
mod verdicts;

use std::path::{Path, PathBuf};

use scenarios::Scenario;

/// Every shipped scenario of fixed wings, with its file.
fn shipped() -> Vec<(PathBuf, Scenario)> {
    shipped_in("scenarios/fixed-wing")
}

/// Every shipped scenario in a folder, with its file.
fn shipped_in(folder: &str) -> Vec<(PathBuf, Scenario)> {
    let folder = Path::new(env!("CARGO_MANIFEST_DIR")).join(folder);
    let paths = scenarios::find(&[folder]).expect("the shipped scenarios are there");
    let load = |path: PathBuf| {
        let scenario = scenarios::load(&path).expect("a shipped scenario is valid");
        (path, scenario)
    };
    paths.into_iter().map(load).collect()
}

/// One shipped scenario by its name.
fn named(name: &str) -> Scenario {
    shipped().into_iter().find(|(_, scenario)| scenario.name == name).expect("a shipped scenario").1
}
