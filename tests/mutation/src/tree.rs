//! A copy of the repository whose judge holds all mutants.

use std::collections::BTreeSet;
use std::ops::Range;
use std::path::{Path, PathBuf};
use std::process::{Command, Stdio};
use std::{fs, io};

use serde::Deserialize;

use crate::mutate::{Mutant, Rendered, mutants};

/// The module that says which mutant is in force.
const MODULE: &str = include_str!("mutant.rs.in");

/// The copy.
pub struct Tree {
    /// Its folder.
    pub root: PathBuf,
    files: Vec<File>,
    /// Mutants that do not compile.
    refused: BTreeSet<usize>,
}

struct File {
    path: String,
    text: String,
    mutants: Vec<Mutant>,
    /// Number of its first mutant.
    first: usize,
}

#[derive(Deserialize)]
struct Message {
    message: Option<Diagnostic>,
    executable: Option<PathBuf>,
    target: Option<Target>,
}

#[derive(Deserialize)]
struct Diagnostic {
    level: String,
    spans: Vec<DiagnosticSpan>,
    rendered: Option<String>,
}

#[derive(Deserialize)]
struct DiagnosticSpan {
    file_name: String,
    byte_start: usize,
    byte_end: usize,
    is_primary: bool,
}

#[derive(Deserialize)]
struct Target {
    name: String,
    kind: Vec<String>,
}

/// An executable with tests, or the command itself.
pub struct Executable {
    /// `lib`, `judge`, `harness`.
    pub name: String,
    /// The file.
    pub path: PathBuf,
    /// Whether it is the command.
    pub is_command: bool,
}

impl Tree {
    /// Copies what git tracks below `repository` to `root` and writes the mutants of the files below `places` into it.
    ///
    /// # Errors
    ///
    /// A file cannot be read, written or parsed.
    pub fn new(repository: &Path, root: &Path, places: &[String]) -> io::Result<Self> {
        let tracked = tracked(repository)?;
        for path in &tracked {
            copy(&repository.join(path), &root.join(path))?;
        }
        let mut files = Vec::new();
        let mut first = 0;
        for path in tracked.into_iter().filter(|path| is_mutated(path, places)) {
            let text = fs::read_to_string(repository.join(&path))?;
            let mutants = mutants(&text).map_err(|error| io::Error::other(format!("{path}: {error}")))?;
            let count = mutants.len();
            files.push(File { path, text, mutants, first });
            first += count;
        }
        let library = fs::read_to_string(repository.join("src/lib.rs"))?;
        fs::write(root.join("src/lib.rs"), format!("{library}\n/// Which mutant is in force.\npub mod mutant;\n"))?;
        fs::write(root.join("src/mutant.rs"), MODULE.replace("@COUNT@", &first.max(1).to_string()))?;
        Ok(Self { root: root.to_owned(), files, refused: BTreeSet::new() })
    }

    /// Every mutant that compiles, with its number and file.
    pub fn mutants(&self) -> impl Iterator<Item = (usize, &str, &Mutant)> {
        self.files
            .iter()
            .flat_map(|file| {
                file.mutants.iter().enumerate().map(|(index, mutant)| (file.first + index, file.path.as_str(), mutant))
            })
            .filter(|(id, ..)| !self.refused.contains(id))
    }

    /// Number of mutants that do not compile.
    pub fn refused(&self) -> usize {
        self.refused.len()
    }

    /// Leaves out mutants until all compile.
    ///
    /// # Errors
    ///
    /// The source does not compile for another reason.
    pub fn settle(&mut self, cargo: &[String]) -> io::Result<()> {
        loop {
            let rendered: Vec<Rendered> = self.files.iter().map(|file| self.render(file)).collect();
            for (file, rendered) in self.files.iter().zip(&rendered) {
                fs::write(self.root.join(&file.path), &rendered.text)?;
            }
            let errors: Vec<Diagnostic> =
                self.cargo(&["check", "--lib"], cargo)?.into_iter().filter_map(Message::error).collect();
            if errors.is_empty() {
                return Ok(());
            }
            let before = self.refused.len();
            let guilty: Vec<usize> = errors.iter().flat_map(|error| self.guilty(error, &rendered)).collect();
            self.refused.extend(guilty);
            if self.refused.len() == before {
                let text: Vec<String> = errors.into_iter().filter_map(|error| error.rendered).collect();
                return Err(io::Error::other(text.join("\n")));
            }
        }
    }

    /// Builds the tests of the library, those of these names, and the command.
    ///
    /// # Errors
    ///
    /// They do not compile.
    pub fn build(&self, tests: &[String], cargo: &[String]) -> io::Result<Vec<Executable>> {
        let mut arguments = vec!["test", "--no-run", "--lib"];
        arguments.extend(tests.iter().flat_map(|test| ["--test", test.as_str()]));
        let mut messages = self.cargo(&arguments, cargo)?;
        messages.extend(self.cargo(&["build", "--bins"], cargo)?);
        let executable = |message: Message| {
            let (path, target) = (message.executable?, message.target?);
            let is_command = target.kind.iter().any(|kind| kind == "bin");
            Some(Executable { name: target.name, path, is_command })
        };
        Ok(messages.into_iter().filter_map(executable).collect())
    }

    fn render(&self, file: &File) -> Rendered {
        let numbered = file.mutants.iter().enumerate().map(|(index, mutant)| (file.first + index, mutant));
        let kept: Vec<(usize, &Mutant)> = numbered.filter(|(id, _)| !self.refused.contains(id)).collect();
        Rendered::new(&file.text, &kept)
    }

    /// The mutants at which an error points.
    fn guilty<'a>(&self, error: &Diagnostic, rendered: &'a [Rendered]) -> Vec<usize> {
        let at = |span: &DiagnosticSpan| -> Option<&'a [usize]> {
            let index = self.files.iter().position(|file| Path::new(&span.file_name).ends_with(&file.path))?;
            let part: Range<usize> = span.byte_start..span.byte_end;
            Some(rendered[index].enclosing(&part))
        };
        let primary = error.spans.iter().filter(|span| span.is_primary);
        primary.filter_map(at).flatten().copied().collect()
    }

    fn cargo(&self, arguments: &[&str], more: &[String]) -> io::Result<Vec<Message>> {
        let cargo = std::env::var("CARGO").unwrap_or_else(|_| "cargo".into());
        let mut command = Command::new(cargo);
        command.current_dir(&self.root).args(arguments).args(["--release", "--message-format=json"]).args(more);
        let output = command.stderr(Stdio::inherit()).output()?;
        let lines = String::from_utf8_lossy(&output.stdout).into_owned();
        let messages: Vec<Message> = lines.lines().filter_map(|line| serde_json::from_str(line).ok()).collect();
        if !output.status.success() && !messages.iter().any(Message::is_error) {
            return Err(io::Error::other(format!("cargo {} failed", arguments.join(" "))));
        }
        Ok(messages)
    }
}

impl Message {
    fn is_error(&self) -> bool {
        self.message.as_ref().is_some_and(|message| message.level == "error" && !message.spans.is_empty())
    }

    fn error(self) -> Option<Diagnostic> {
        self.is_error().then_some(self.message)?
    }
}

fn tracked(repository: &Path) -> io::Result<Vec<String>> {
    let output = Command::new("git").current_dir(repository).arg("ls-files").output()?;
    Ok(String::from_utf8_lossy(&output.stdout).lines().map(str::to_owned).collect())
}

fn is_mutated(path: &str, places: &[String]) -> bool {
    let is_test = path.ends_with("tests.rs") || path.contains("/tests/") || path.ends_with("/random.rs");
    path.ends_with(".rs") && !is_test && places.iter().any(|place| path.starts_with(place.as_str()))
}

/// Copies a file unless the copy is the same already, so that nothing is built again without need.
fn copy(from: &Path, to: &Path) -> io::Result<()> {
    let content = fs::read(from)?;
    if fs::read(to).is_ok_and(|there| there == content) {
        return Ok(());
    }
    fs::create_dir_all(to.parent().unwrap_or(to))?;
    fs::write(to, content)
}
