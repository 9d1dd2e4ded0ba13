//! Standard output and standard error.

use std::io::{self, Write};

use crate::error::Error;

/// Prints a line to standard output. Colours are stripped where the terminal lacks them or `NO_COLOR` is set.
///
/// A reader that has closed the pipe (`harness list | head`) is not an error.
///
/// # Errors
///
/// [`Error::Output`] if standard output cannot be written to for any other reason.
pub fn print(text: &str) -> Result<(), Error> {
    match writeln!(anstream::stdout().lock(), "{text}") {
        Err(error) if error.kind() != io::ErrorKind::BrokenPipe => Err(error.into()),
        _ => Ok(()),
    }
}

/// Prints a line to standard error. Failures are ignored: there is no stream left on which to report them.
pub fn eprint(text: &str) {
    let _ = writeln!(io::stderr().lock(), "{text}");
}

/// Prints an error with its source line and its help to standard error.
pub fn print_error(error: Error) {
    eprint(&format!("{:?}", miette::Report::new(error)));
}
