use std::path::PathBuf;

use clap::{Args, CommandFactory};
use clap_complete::Shell;

use super::Cli;
use crate::console;
use crate::error::{Error, Exit};
use crate::output;

/// Print shell completions
#[derive(Args, Debug)]
#[command(
    after_help = "Examples:\n  harness completions bash > ~/.local/share/bash-completion/completions/harness\n  \
                        harness completions zsh > ~/.zfunc/_harness\n  \
                        harness completions fish > ~/.config/fish/completions/harness.fish"
)]
pub struct Completions {
    /// The shell
    #[arg(value_enum)]
    shell: Shell,
}

impl Completions {
    /// Prints them.
    pub fn execute(&self) -> Result<Exit, Error> {
        let mut script = Vec::new();
        clap_complete::generate(self.shell, &mut Cli::command(), "harness", &mut script);
        console::print(String::from_utf8_lossy(&script).trim_end())?;
        Ok(Exit::Passed)
    }
}

/// Write man pages, one per command
#[derive(Args, Debug)]
#[command(after_help = "Examples:\n  harness man ~/.local/share/man/man1 && man harness-run")]
pub struct Man {
    /// Folder for the pages
    #[arg(value_name = "DIR", default_value = "man")]
    folder: PathBuf,
}

impl Man {
    /// Writes them.
    pub fn execute(&self) -> Result<Exit, Error> {
        output::create_folder(&self.folder)?;
        let unwritable = |reason: std::io::Error| Error::Write { path: self.folder.clone(), reason: reason.into() };
        clap_mangen::generate_to(Cli::command(), &self.folder).map_err(unwritable)?;
        Ok(Exit::Passed)
    }
}
