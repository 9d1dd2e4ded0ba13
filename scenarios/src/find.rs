use std::collections::{BTreeMap, BTreeSet};
use std::path::{Path, PathBuf};

use miette::Diagnostic;
use thiserror::Error;

use crate::shipped::{self, ShippedFile};

/// Why the scenario files could not be listed.
#[derive(Debug, Error, Diagnostic)]
pub enum FindError {
    /// A path that does not exist or cannot be read.
    #[error("{}: {reason}", path.display())]
    #[diagnostic(help("give a scenario file, or a folder that contains scenario files"))]
    Read {
        /// The path.
        path: PathBuf,
        /// The error of the operating system.
        reason: std::io::Error,
    },
    /// A request for shipped scenarios that matches none.
    #[error("{}: found no shipped scenario or folder of this name{}", path.display(), did_you_mean(*closest))]
    #[diagnostic(help("`harness list shipped:` lists the shipped scenarios"))]
    NoShipped {
        /// What was asked for, with the prefix.
        path: PathBuf,
        /// The closest name.
        closest: Option<&'static str>,
    },
    /// A folder without scenario files.
    #[error("{}: found no scenario file (*.toml) in or below this folder", path.display())]
    #[diagnostic(help("give a scenario file, or a folder that contains scenario files"))]
    Empty {
        /// The folder.
        path: PathBuf,
    },
    /// Two files with the same name, whose results would be written to the same place.
    #[error("two scenarios are named `{name}`: {} and {}", first.display(), second.display())]
    #[diagnostic(help("rename one of the files, and change its `name` accordingly"))]
    SameName {
        /// The name.
        name: String,
        /// One file.
        first: PathBuf,
        /// The other.
        second: PathBuf,
    },
}

fn did_you_mean(closest: Option<&str>) -> String {
    closest.map_or_else(String::new, |closest| format!("; did you mean `shipped:{closest}`?"))
}

/// All scenario files that `paths` denote, without duplicates, sorted by folder and name.
///
/// A file denotes itself. A folder denotes every `*.toml` in or below it, except `Cargo.toml` and except files and
/// folders whose names begin with a dot. `shipped:` denotes the [`shipped`] scenarios, `shipped:NAME` one of them.
///
/// # Errors
///
/// A path cannot be read, a folder contains no scenario file, or two files have the same name.
pub fn find(paths: &[impl AsRef<Path>]) -> Result<Vec<PathBuf>, FindError> {
    let mut files = Vec::new();
    for path in paths {
        collect(path.as_ref(), &mut files)?;
    }
    files.sort_by(|a, b| (a.parent(), a.file_stem()).cmp(&(b.parent(), b.file_stem())));
    let mut seen = BTreeSet::new();
    files.retain(|file| seen.insert(file.canonicalize().unwrap_or_else(|_| file.clone())));
    unique_names(&files)?;
    Ok(files)
}

fn collect(path: &Path, files: &mut Vec<PathBuf>) -> Result<(), FindError> {
    if let Some(request) = shipped::request(path) {
        let selected = shipped::select(request);
        let selected = selected.map_err(|closest| FindError::NoShipped { path: path.to_owned(), closest })?;
        files.extend(selected.iter().map(ShippedFile::to_path));
        return Ok(());
    }
    let metadata = std::fs::metadata(path).map_err(|reason| FindError::Read { path: path.to_owned(), reason })?;
    if !metadata.is_dir() {
        files.push(path.to_owned());
        return Ok(());
    }
    let before = files.len();
    walk(path, files)?;
    if files.len() == before { Err(FindError::Empty { path: path.to_owned() }) } else { Ok(()) }
}

fn walk(folder: &Path, files: &mut Vec<PathBuf>) -> Result<(), FindError> {
    let unreadable = |reason| FindError::Read { path: folder.to_owned(), reason };
    for entry in std::fs::read_dir(folder).map_err(unreadable)? {
        let entry = entry.map_err(unreadable)?;
        let path = entry.path();
        if entry.file_name().to_string_lossy().starts_with('.') {
            continue;
        }
        if entry.file_type().map_err(unreadable)?.is_dir() {
            walk(&path, files)?;
        } else if path.extension().is_some_and(|extension| extension == "toml") && !path.ends_with("Cargo.toml") {
            files.push(path);
        }
    }
    Ok(())
}

fn unique_names(files: &[PathBuf]) -> Result<(), FindError> {
    let mut by_name = BTreeMap::new();
    for file in files {
        let name = file.file_stem().unwrap_or_default().to_string_lossy().into_owned();
        if let Some(first) = by_name.insert(name.clone(), file) {
            return Err(FindError::SameName { name, first: first.clone(), second: file.clone() });
        }
    }
    Ok(())
}

#[cfg(test)]
mod tests {
    use std::path::Path;

    use super::{FindError, find};

    fn folder_with(files: &[&str]) -> tempfile::TempDir {
        let folder = tempfile::tempdir().unwrap();
        for file in files {
            let path = folder.path().join(file);
            std::fs::create_dir_all(path.parent().unwrap()).unwrap();
            std::fs::write(path, "").unwrap();
        }
        folder
    }

    #[test]
    fn folders_are_searched_recursively_and_files_are_sorted() {
        let folder = folder_with(&["b/two.toml", "a/deep/one.toml", "Cargo.toml", "notes.md", ".hidden/no.toml"]);
        let found = find(&[folder.path()]).unwrap();
        let found: Vec<_> = found.iter().map(|file| file.strip_prefix(folder.path()).unwrap()).collect();
        assert_eq!(found, [Path::new("a/deep/one.toml"), Path::new("b/two.toml")]);
    }

    #[test]
    fn a_name_sorts_before_longer_names_that_begin_with_it() {
        let folder = folder_with(&["fleet-7-wind.toml", "fleet-7.toml"]);
        let found = find(&[folder.path()]).unwrap();
        let names: Vec<_> = found.iter().map(|file| file.file_name().unwrap()).collect();
        assert_eq!(names, ["fleet-7.toml", "fleet-7-wind.toml"]);
    }

    #[test]
    fn a_file_given_twice_is_listed_once() {
        let folder = folder_with(&["a/one.toml"]);
        let paths = [folder.path().join("a/one.toml"), folder.path().to_owned(), folder.path().join("a/../a/one.toml")];
        assert_eq!(find(&paths).unwrap().len(), 1);
    }

    #[test]
    fn two_files_with_the_same_name_are_rejected() {
        let folder = folder_with(&["a/one.toml", "b/one.toml"]);
        assert!(matches!(find(&[folder.path()]), Err(FindError::SameName { name, .. }) if name == "one"));
    }

    #[test]
    fn shipped_scenarios_need_no_folder() {
        let one = find(&["shipped:rendezvous-7"]).unwrap();
        assert_eq!(one, [Path::new("shipped:fixed-wing/rendezvous-7.toml")]);
        assert!(find(&["shipped:"]).unwrap().len() > 40);
        let error = find(&["shipped:rendezvous7"]).unwrap_err().to_string();
        assert!(error.contains("did you mean `shipped:rendezvous-7`?"), "{error}");
    }

    #[test]
    fn an_empty_folder_is_an_error_that_names_the_path() {
        let folder = folder_with(&["notes.md"]);
        assert!(matches!(find(&[folder.path()]), Err(FindError::Empty { path }) if path == folder.path()));
        let missing = folder.path().join("missing.toml");
        assert!(matches!(find(&[&missing]), Err(FindError::Read { path, .. }) if path == missing));
    }
}
