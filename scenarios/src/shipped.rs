//! The shipped scenarios, which are part of the program: they need no checkout of the repository.
//!
//! Wherever a scenario file is expected, `shipped:rendezvous-7` names one of them, and `shipped:` all of them.

use std::path::{Path, PathBuf};

use crate::closest_name;

/// What a path to shipped scenarios begins with.
pub const PREFIX: &str = "shipped:";

/// Paths below the folder `scenarios`, sorted, and texts.
const FILES: &[(&str, &str)] = include!(concat!(env!("OUT_DIR"), "/shipped.rs"));

/// The files beside them, such as meshes: paths below the folder `scenarios`, sorted, and contents.
const ATTACHED: &[(&str, &[u8])] = include!(concat!(env!("OUT_DIR"), "/attached.rs"));

/// A shipped scenario file.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct ShippedFile {
    /// Path below the folder `scenarios` of the repository: `fixed-wing/rendezvous-7.toml`.
    pub path: &'static str,
    /// Content, TOML.
    pub text: &'static str,
}

impl ShippedFile {
    /// Name of the scenario.
    pub fn name(&self) -> &'static str {
        let file = self.path.rsplit_once('/').map_or(self.path, |(_, file)| file);
        file.strip_suffix(".toml").unwrap_or(file)
    }

    /// The path by which it is loaded: `shipped:fixed-wing/rendezvous-7.toml`.
    pub fn to_path(&self) -> PathBuf {
        PathBuf::from(format!("{PREFIX}{}", self.path))
    }
}

/// All shipped scenario files, sorted by path.
pub fn all() -> impl Iterator<Item = ShippedFile> {
    FILES.iter().map(|(path, text)| ShippedFile { path, text })
}

/// The content of a file beside the shipped scenarios, by its path below their folder: `multirotor/house.stl`.
pub fn attached(path: &str) -> Option<&'static [u8]> {
    ATTACHED.iter().find(|(attached, _)| *attached == path).map(|(_, content)| *content)
}

/// What comes after `shipped:` in a path; `None` for other paths.
pub fn request(path: &Path) -> Option<&str> {
    path.to_str()?.strip_prefix(PREFIX)
}

/// The shipped files that are asked for: all of them, those of a folder, or one by its path or name.
///
/// # Errors
///
/// There is none; the closest name, if there is one.
pub fn select(request: &str) -> Result<Vec<ShippedFile>, Option<&'static str>> {
    let folder = request.trim_end_matches('/');
    let is_wanted = |file: &ShippedFile| {
        let own_folder = file.path.rsplit_once('/').map_or("", |(folder, _)| folder);
        request.is_empty() || [own_folder, file.path, file.name()].contains(&folder)
    };
    let files: Vec<ShippedFile> = all().filter(is_wanted).collect();
    if files.is_empty() { Err(closest_name(folder, all().map(|file| file.name()))) } else { Ok(files) }
}

#[cfg(test)]
mod tests {
    use super::{all, request, select};

    #[test]
    fn a_scenario_is_found_by_name_path_and_folder() {
        let paths = |request| select(request).unwrap().iter().map(|file| file.path).collect::<Vec<_>>();
        assert_eq!(paths("rendezvous-7"), ["fixed-wing/rendezvous-7.toml"]);
        assert_eq!(paths("slung/gate.toml"), ["slung/gate.toml"]);
        assert!(paths("multirotor").len() > 5 && paths("multirotor/") == paths("multirotor"));
        assert_eq!(paths("").len(), all().count());
        assert_eq!(select("rendezvous7"), Err(Some("rendezvous-7")));
    }

    #[test]
    fn only_the_prefix_asks_for_a_shipped_one() {
        assert_eq!(request("shipped:trap".as_ref()), Some("trap"));
        assert_eq!(request("scenarios/multirotor/trap.toml".as_ref()), None);
    }

    #[test]
    fn every_shipped_text_is_the_scenario_of_its_name() {
        for file in all() {
            let scenario = crate::load(&file.to_path()).unwrap_or_else(|error| panic!("{}: {error}", file.path));
            assert_eq!(scenario.name, file.name());
            let by_name = crate::load(format!("shipped:{}", file.name()).as_ref());
            assert_eq!(by_name.unwrap_or_else(|error| panic!("{}: {error}", file.name())), scenario);
        }
    }
}
