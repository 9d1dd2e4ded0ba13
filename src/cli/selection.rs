use std::path::PathBuf;

use clap::Args;
use glob::Pattern;
use scenarios::Scenario;

use crate::error::Error;

/// The selected scenarios.
#[derive(Args, Debug)]
pub struct Selection {
    /// Scenario files, or folders that are searched recursively for *.toml
    #[arg(value_name = "PATH", default_value = "scenarios")]
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
        let mut files = scenarios::find(&self.paths)?;
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
