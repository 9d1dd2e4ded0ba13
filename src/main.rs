//! The command `harness`.

use std::process::ExitCode;

use clap::Parser;
use harness::cli::Cli;
use harness::error::Exit;

fn main() -> ExitCode {
    harness::interrupt::watch();
    match Cli::parse().execute() {
        Ok(exit) => exit.into(),
        Err(error) => {
            harness::console::print_error(error);
            Exit::BadInput.into()
        }
    }
}
