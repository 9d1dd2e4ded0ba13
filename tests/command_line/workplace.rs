//! A folder of its own for a test, and the command run in it.

use std::fs;
use std::io::Write;
use std::path::{Path, PathBuf};
use std::process::{Command, Output};

/// The smallest fleet. It is planned quickly.
pub const PAIR: &str = include_str!("../scenarios/pair.toml");

/// [`PAIR`], planned by multiple shooting: its nodes satisfy the equations of motion, unlike those of the trapezoid rule.
pub fn shooting_pair() -> String {
    PAIR.replace("intervals = 20", "intervals = 20\ntranscription = \"shooting\"")
}

/// A temporary folder with scenario files, which is removed on drop.
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
        // The tests may run in a workflow, whose job summary they must not change.
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

/// Whether there is a Python with these modules. Without it a test is skipped with a line on standard error; where the
/// environment variable `CI` is set, it fails.
#[track_caller]
pub fn has_python(modules: &str) -> bool {
    has_program("python3", &["-c", &format!("import {modules}")], &format!("python3 with the modules {modules}"))
}

/// Whether there is a C++ compiler. Without it a test is skipped like one without [Python](has_python).
#[track_caller]
pub fn has_cpp_compiler() -> bool {
    has_program("c++", &["--version"], "c++, a C++ compiler")
}

#[track_caller]
fn has_program(program: &str, arguments: &[&str], what: &str) -> bool {
    let found = Command::new(program).args(arguments).output().is_ok_and(|output| output.status.success());
    if !found {
        skip_without(what);
    }
    found
}

/// Reports on standard error that a test is skipped because this machine lacks `what`; where the environment variable `CI` is
/// set, the test fails instead.
#[track_caller]
pub fn skip_without(what: &str) {
    assert!(std::env::var_os("CI").is_none(), "this test needs {what}");
    // Not `eprintln!`, which the test runner captures.
    let caller = std::panic::Location::caller();
    let mut standard_error = std::io::stderr();
    writeln!(standard_error, "SKIPPED {caller}: it needs {what}").unwrap();
}
