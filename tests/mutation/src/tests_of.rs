//! The tests: which there are, how long each takes, and which mutants it reaches.

use std::collections::HashSet;
use std::path::{Path, PathBuf};
use std::process::{Command, Stdio};
use std::time::{Duration, Instant};
use std::{fs, io};

use wait_timeout::ChildExt;

use crate::tree::Executable;

/// One test, which runs as a process of its own.
pub struct Test {
    /// For people: `judge::edges`.
    pub name: String,
    path: PathBuf,
    arguments: Vec<String>,
    folder: PathBuf,
    /// How long it takes without a mutant.
    pub duration: Duration,
    reached: HashSet<usize>,
}

/// What became of a run.
pub enum Outcome {
    /// Nothing was noticed.
    Passed,
    /// The test failed.
    Failed,
    /// It did not end.
    TimedOut,
}

impl Test {
    /// Every test of these executables whose name has one of the `prefixes`; of the command its own self-test.
    ///
    /// # Errors
    ///
    /// An executable cannot be run.
    pub fn all(executables: &[Executable], folder: &Path, prefixes: &[String]) -> io::Result<Vec<Self>> {
        let mut tests = Vec::new();
        for executable in executables {
            let test = |name: String, arguments: Vec<String>| Self {
                name: format!("{}::{name}", executable.name),
                path: executable.path.clone(),
                arguments,
                folder: folder.to_owned(),
                duration: Duration::ZERO,
                reached: HashSet::new(),
            };
            if executable.is_command {
                tests.push(test("selftest".into(), vec!["selftest".into()]));
                continue;
            }
            let output =
                Command::new(&executable.path).args(["--list", "--format", "terse"]).current_dir(folder).output()?;
            let listed = String::from_utf8_lossy(&output.stdout).into_owned();
            let names = listed.lines().filter_map(|line| line.strip_suffix(": test"));
            let is_library =
                executable.path.file_name().is_some_and(|name| name.to_string_lossy().starts_with("harness-"));
            let wanted =
                names.filter(|name| !is_library || prefixes.iter().any(|prefix| name.starts_with(prefix.as_str())));
            tests.extend(wanted.map(|name| test(name.to_owned(), vec!["--exact".into(), name.to_owned()])));
        }
        Ok(tests)
    }

    /// Runs it without a mutant. Returns whether it passes.
    ///
    /// # Errors
    ///
    /// It cannot be run.
    pub fn measure(&mut self, scratch: &Path, longest: Duration) -> io::Result<bool> {
        let coverage = scratch.join("coverage.txt");
        fs::write(&coverage, "")?;
        let begin = Instant::now();
        let outcome = self.run(&[("MUTANT_COVERAGE", &coverage.display().to_string())], longest)?;
        self.duration = begin.elapsed();
        self.reached = fs::read_to_string(&coverage)?.lines().filter_map(|line| line.parse().ok()).collect();
        Ok(matches!(outcome, Outcome::Passed))
    }

    /// Whether it comes past a mutant.
    pub fn reaches(&self, mutant: usize) -> bool {
        self.reached.contains(&mutant)
    }

    /// Runs it with a mutant.
    ///
    /// # Errors
    ///
    /// It cannot be run.
    pub fn with(&self, mutant: usize) -> io::Result<Outcome> {
        self.run(&[("MUTANT", &mutant.to_string())], self.duration * 4 + Duration::from_secs(5))
    }

    fn run(&self, variables: &[(&str, &str)], longest: Duration) -> io::Result<Outcome> {
        let mut command = Command::new(&self.path);
        command.args(&self.arguments).current_dir(&self.folder).envs(variables.iter().copied());
        let mut child = command.stdin(Stdio::null()).stdout(Stdio::null()).stderr(Stdio::null()).spawn()?;
        match child.wait_timeout(longest)? {
            Some(status) if status.success() => Ok(Outcome::Passed),
            Some(_) => Ok(Outcome::Failed),
            None => {
                child.kill()?;
                child.wait()?;
                Ok(Outcome::TimedOut)
            }
        }
    }
}
