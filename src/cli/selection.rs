use std::path::{Path, PathBuf};

use clap::Args;
use glob::Pattern;
use scenarios::{Scenario, shipped};

use crate::error::Error;

/// Folder of scenarios in a checkout of the repository.
const FOLDER: &str = "scenarios";

/// The selected scenarios.
#[derive(Args, Debug)]
pub struct Selection {
    /// Scenario files, or folders that are searched recursively for *.toml; `shipped:` are the scenarios that are part of
    /// the program, `shipped:NAME` is one of them [default: the folder scenarios if there is one, else shipped:]
    #[arg(value_name = "PATH")]
    paths: Vec<PathBuf>,
    /// Select scenarios with this tag; repeat the option to allow several tags
    #[arg(short, long = "tag", value_name = "TAG")]
    tags: Vec<String>,
    /// Select scenarios whose name matches, with the wildcards * and ?; repeat the option to allow several patterns
    #[arg(short, long = "name", value_name = "GLOB")]
    names: Vec<Pattern>,
}

impl Selection {
    /// The files whose names match, sorted.
    pub fn files(&self) -> Result<Vec<PathBuf>, Error> {
        let mut files =
            if self.paths.is_empty() { scenarios::find(&[default_path()]) } else { scenarios::find(&self.paths) }?;
        let matches = |name: &str| self.names.is_empty() || self.names.iter().any(|glob| glob.matches(name));
        files.retain(|file| matches(&file.file_stem().unwrap_or_default().to_string_lossy()));
        if files.is_empty() { Err(self.nothing()) } else { Ok(files) }
    }

    /// Whether the scenario has one of the tags.
    pub fn is_wanted(&self, scenario: &Scenario) -> bool {
        self.tags.is_empty() || self.tags.iter().any(|tag| scenario.tags.contains(tag))
    }

    /// The error if no scenario is selected: an empty run must not succeed.
    pub fn nothing(&self) -> Error {
        let words = [("--tag", self.tags.clone()), ("--name", self.names.iter().map(Pattern::to_string).collect())];
        let given = words.into_iter().flat_map(|(option, values)| {
            values.into_iter().map(move |value| format!("{option} {value}")).collect::<Vec<_>>()
        });
        Error::NothingSelected { options: given.collect::<Vec<_>>().join(" ") }
    }
}

/// Where scenarios are searched unless the command line names a place.
fn default_path() -> &'static str {
    if Path::new(FOLDER).is_dir() { FOLDER } else { shipped::PREFIX }
}
