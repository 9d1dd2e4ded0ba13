//! Files and standard output.
//!
//! A file appears under its name only when it is complete: it is written beside it under a temporary name and renamed, so
//! that a killed run leaves no half file behind under the name of a result. What it does leave, the next run removes.

mod stale_files;

use std::error;
use std::fs::{self, File};
use std::io::{self, BufWriter, Write};
use std::path::Path;

use serde::Serialize;
use tempfile::NamedTempFile;

use crate::error::Error;
use crate::interrupt::Partial;

/// What may go wrong while a file is written by somebody else's library.
type Failure = Box<dyn error::Error + Send + Sync>;

/// Lets `write` write a file of its own, which becomes `path` once it is complete.
pub fn replace_file(path: &Path, write: impl FnOnce(&Path) -> Result<(), Failure>) -> Result<(), Error> {
    complete(path, write).map_err(|reason| Error::Write { path: path.to_owned(), reason })
}

/// Writes a file by `content`, all or nothing.
pub fn write_file(path: &Path, content: impl FnOnce(&mut dyn Write) -> io::Result<()>) -> Result<(), Error> {
    replace_file(path, |partial| {
        let mut writer = BufWriter::new(File::create(partial)?);
        content(&mut writer)?;
        Ok(writer.flush()?)
    })
}

/// Writes `value` as indented JSON, all or nothing.
pub fn write_json(path: &Path, value: &impl Serialize) -> Result<(), Error> {
    write_file(path, |writer| {
        serde_json::to_writer_pretty(&mut *writer, value)?;
        writeln!(writer)
    })
}

/// Makes a folder and those above it, and rids it of what killed runs left in it.
pub fn create_folder(path: &Path) -> Result<(), Error> {
    fs::create_dir_all(path).map_err(|reason| Error::Write { path: path.to_owned(), reason: reason.into() })?;
    stale_files::remove(path);
    Ok(())
}

/// Removes a result of an earlier run, if there is one.
pub fn remove_stale(path: &Path) -> Result<(), Error> {
    match fs::remove_file(path) {
        Err(reason) if reason.kind() != io::ErrorKind::NotFound => {
            Err(Error::Write { path: path.to_owned(), reason: reason.into() })
        }
        _ => Ok(()),
    }
}

/// Prints to standard output, with colours where the terminal has them and `NO_COLOR` does not forbid them. A reader who
/// has gone (`harness list | head`) is no error.
pub fn print(text: &str) -> Result<(), Error> {
    match writeln!(anstream::stdout().lock(), "{text}") {
        Err(error) if error.kind() != io::ErrorKind::BrokenPipe => Err(error.into()),
        _ => Ok(()),
    }
}

/// Tells the user something on standard error. If nobody listens any more (`harness run 2>&1 | head`), that is no reason
/// to stop, and there is nobody to tell.
pub fn tell(text: &str) {
    let _ = writeln!(io::stderr().lock(), "{text}");
}

fn complete(path: &Path, write: impl FnOnce(&Path) -> Result<(), Failure>) -> Result<(), Failure> {
    let folder = path.parent().filter(|folder| !folder.as_os_str().is_empty()).unwrap_or(Path::new("."));
    let partial = new_file(folder)?.into_temp_path(); // removed when it is dropped
    let _with_us = Partial::new(&partial);
    write(&partial)?;
    Ok(partial.persist(path)?)
}

/// A file for everybody to read, as far as the user's umask lets them (temporary files are private by default). Its name
/// tells whose it is.
fn new_file(folder: &Path) -> io::Result<NamedTempFile> {
    let prefix = stale_files::prefix();
    let mut file = tempfile::Builder::new();
    file.prefix(&prefix);
    #[cfg(unix)]
    file.permissions(std::os::unix::fs::PermissionsExt::from_mode(0o666));
    file.tempfile_in(folder)
}

#[cfg(test)]
mod tests {
    use std::fs;
    use std::io;

    use super::write_file;

    #[test]
    fn a_writer_that_fails_half_way_leaves_the_old_file_and_nothing_else() {
        let folder = tempfile::tempdir().unwrap();
        let path = folder.path().join("report.json");
        fs::write(&path, "old").unwrap();
        let failed = write_file(&path, |writer| {
            writer.write_all(b"half of the ne")?;
            Err(io::Error::other("disk full"))
        });
        assert!(failed.is_err());
        assert_eq!(fs::read_to_string(&path).unwrap(), "old");
        assert_eq!(fs::read_dir(folder.path()).unwrap().count(), 1);
    }

    #[test]
    fn a_folder_that_is_missing_is_named_in_the_error() {
        let folder = tempfile::tempdir().unwrap();
        let path = folder.path().join("missing/report.json");
        let error = write_file(&path, |_| Ok(())).unwrap_err();
        assert!(error.to_string().contains("missing/report.json"), "{error}");
    }
}
