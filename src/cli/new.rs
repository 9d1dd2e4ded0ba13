use std::path::{Path, PathBuf};

use clap::{Args, ValueEnum};

use crate::console;
use crate::error::{Error, Exit};
use crate::output;

/// Write a commented scenario to start from
///
/// The scenario passes with the planner that it names.
#[derive(Args, Debug)]
#[command(after_help = EXAMPLES)]
pub struct New {
    /// The kind of vehicle
    #[arg(value_enum)]
    family: Template,
    /// The file to write, which must not exist; `-` prints it [default: FAMILY.toml]
    #[arg(value_name = "FILE")]
    file: Option<PathBuf>,
}

const EXAMPLES: &str = "\
Examples:
  harness new multirotor                   write multirotor.toml
  harness new fixed-wing mine/first.toml   write a file of that name, and name the scenario after it
  harness run multirotor.toml              run it";

/// The families, by their keys.
#[derive(Clone, Copy, Debug, ValueEnum)]
enum Template {
    /// A fixed-wing point mass
    FixedWing,
    /// A multirotor without a load
    Multirotor,
    /// A quadrotor with a load on a cable
    SlungLoad,
}

impl New {
    /// Writes or prints the scenario.
    pub fn execute(&self) -> Result<Exit, Error> {
        let (text, default) = self.family.text();
        let file = self.file.clone().unwrap_or_else(|| PathBuf::from(default));
        if file == Path::new("-") {
            return console::print(text.replace("NAME", "new").trim_end()).map(|()| Exit::Passed);
        }
        if file.exists() {
            return Err(Error::FileExists { path: file });
        }
        let name = file.file_stem().unwrap_or_default().to_string_lossy();
        let text = text.replace("NAME", &name);
        scenarios::parse(&file.display().to_string(), &text)?;
        output::write_file(&file, |writer| writer.write_all(text.as_bytes()))?;
        console::print(&file.display().to_string())?;
        Ok(Exit::Passed)
    }
}

impl Template {
    /// The scenario, and the default name of its file.
    fn text(self) -> (&'static str, &'static str) {
        match self {
            Self::FixedWing => (include_str!("templates/fixed-wing.toml"), "fixed-wing.toml"),
            Self::Multirotor => (include_str!("templates/multirotor.toml"), "multirotor.toml"),
            Self::SlungLoad => (include_str!("templates/slung-load.toml"), "slung-load.toml"),
        }
    }
}
