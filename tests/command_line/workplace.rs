//! A folder of its own for a test, and the command run in it.

use std::fs;
use std::path::{Path, PathBuf};
use std::process::{Command, Output};

/// The smallest fleet; valid and quickly planned.
pub const PAIR: &str = include_str!("../scenarios/pair.toml");

/// [`PAIR`], planned by multiple shooting: its nodes are those of a motion. (Those of the trapezoid rule are not quite.)
pub fn shooting_pair() -> String {
    PAIR.replace("intervals = 20", "intervals = 20\ntranscription = \"shooting\"")
}

/// A temporary folder with scenario files in it; it goes when this is dropped.
pub struct Workplace {
    folder: tempfile::TempDir,
}

impl Workplace {
    /// A folder with these files: name and content.
    pub fn new(files: &[(&str, &str)]) -> Self {
        let workplace = Self { folder: tempfile::tempdir().unwrap() };
        for (name, content) in files {
            let path = workplace.path(name);
            fs::create_dir_all(path.parent().unwrap()).unwrap();
            fs::write(path, content).unwrap();
        }
        workplace
    }

    /// Path of a file in the folder.
    pub fn path(&self, name: impl AsRef<Path>) -> PathBuf {
        self.folder.path().join(name)
    }

    /// Runs `harness` in the folder.
    pub fn harness(&self, arguments: &[&str]) -> Output {
        let mut command = Command::new(env!("CARGO_BIN_EXE_harness"));
        // the tests may themselves run in a workflow, whose summary is none of theirs
        command.env_remove("GITHUB_ACTIONS").env_remove("GITHUB_STEP_SUMMARY");
        command.current_dir(self.folder.path()).args(arguments).output().unwrap()
    }

    /// A JSON file in the folder.
    pub fn json(&self, name: &str) -> serde_json::Value {
        let path = self.path(name);
        let text = fs::read_to_string(&path).unwrap_or_else(|error| panic!("{}: {error}", path.display()));
        serde_json::from_str(&text).unwrap()
    }

    /// Names of the files in a folder, sorted.
    pub fn files(&self, folder: &str) -> Vec<String> {
        let entries = fs::read_dir(self.path(folder)).unwrap();
        let mut names: Vec<String> = entries.map(|entry| entry.unwrap().file_name().into_string().unwrap()).collect();
        names.sort();
        names
    }
}

/// What a command printed to standard output.
pub fn stdout(output: &Output) -> String {
    String::from_utf8(output.stdout.clone()).unwrap()
}

/// What a command printed to standard error.
pub fn stderr(output: &Output) -> String {
    String::from_utf8(output.stderr.clone()).unwrap()
}

/// Exit code.
pub fn code(output: &Output) -> i32 {
    output.status.code().expect("the command was not killed")
}
