//! Atomic file output.
//!
//! Files are written under a temporary name in the same folder and renamed when they are complete, so that an
//! interrupted run never leaves a partial file under the name of a result. Temporary files of killed runs are removed by
//! the next run.

mod stale_files;

use std::error;
use std::fs::{self, File};
use std::io::{self, BufWriter, Write};
use std::path::Path;

use serde::Serialize;
use tempfile::NamedTempFile;

use crate::error::Error;
use crate::interrupt::RemoveOnInterrupt;

/// Name of the file that holds the scene of a flight: what the report page draws, and what a later recording shows as a
/// ghost.
pub const SCENE_FILE: &str = "scene.json";

/// An error of whichever library writes the file.
type WriteError = Box<dyn error::Error + Send + Sync>;

/// Calls `write` with a temporary path, and renames that file to `path` when it is complete.
///
/// # Errors
///
/// [`Error::Write`] if `write` fails or the file cannot be renamed; an existing file at `path` is then left as it was.
pub fn replace_file(path: &Path, write: impl FnOnce(&Path) -> Result<(), WriteError>) -> Result<(), Error> {
    write_and_rename(path, write).map_err(|reason| Error::Write { path: path.to_owned(), reason })
}

/// [`replace_file`] for content that is written to a buffered stream.
///
/// # Errors
///
/// As [`replace_file`].
pub fn write_file(path: &Path, content: impl FnOnce(&mut dyn Write) -> io::Result<()>) -> Result<(), Error> {
    replace_file(path, |partial| {
        let mut writer = BufWriter::new(File::create(partial)?);
        content(&mut writer)?;
        Ok(writer.flush()?)
    })
}

/// [`replace_file`] for `value` as indented JSON.
///
/// # Errors
///
/// As [`replace_file`].
pub fn write_json(path: &Path, value: &impl Serialize) -> Result<(), Error> {
    write_file(path, |writer| {
        serde_json::to_writer_pretty(&mut *writer, value)?;
        writeln!(writer)
    })
}

/// Creates a folder and its parents, and removes temporary files that killed runs left in it.
///
/// # Errors
///
/// [`Error::Write`] if the folder cannot be created.
pub fn create_folder(path: &Path) -> Result<(), Error> {
    fs::create_dir_all(path).map_err(|reason| Error::Write { path: path.to_owned(), reason: reason.into() })?;
    stale_files::remove(path);
    Ok(())
}

/// Removes a result of an earlier run, if it exists.
///
/// # Errors
///
/// [`Error::Write`] if the file exists and cannot be removed.
pub fn remove_stale(path: &Path) -> Result<(), Error> {
    match fs::remove_file(path) {
        Err(reason) if reason.kind() != io::ErrorKind::NotFound => {
            Err(Error::Write { path: path.to_owned(), reason: reason.into() })
        }
        _ => Ok(()),
    }
}

fn write_and_rename(path: &Path, write: impl FnOnce(&Path) -> Result<(), WriteError>) -> Result<(), WriteError> {
    let folder = path.parent().filter(|folder| !folder.as_os_str().is_empty()).unwrap_or(Path::new("."));
    let partial = temporary_file(folder)?.into_temp_path(); // removed when dropped
    let _guard = RemoveOnInterrupt::new(&partial);
    write(&partial)?;
    Ok(partial.persist(path)?)
}

/// A temporary file whose name identifies this process, readable by everyone whom the umask allows (temporary files are
/// private by default, and the file becomes a result).
fn temporary_file(folder: &Path) -> io::Result<NamedTempFile> {
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
    fn a_failed_write_leaves_the_old_file_and_no_temporary_file() {
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
    fn the_error_names_a_missing_folder() {
        let folder = tempfile::tempdir().unwrap();
        let path = folder.path().join("missing/report.json");
        let error = write_file(&path, |_| Ok(())).unwrap_err();
        assert!(error.to_string().contains("missing/report.json"), "{error}");
    }
}
