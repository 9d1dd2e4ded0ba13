//! A command with a question, a time limit, and no way to outlive it.

use std::io::{Read, Write};
use std::path::{Path, PathBuf};
use std::process::{Child, Command, ExitStatus, Stdio};
use std::sync::mpsc::{Receiver, channel};
use std::thread;
use std::time::{Duration, Instant};

use super::group;

/// Longest output that is read, bytes; of a longer standard error the beginning is kept.
const MOST_OUTPUT: u64 = 256 << 20;
/// Longest log that is kept, bytes.
pub(super) const MOST_LOG: u64 = 4 << 20;
/// Time between two looks at a command that is still running.
const LOOK: Duration = Duration::from_millis(2);
/// Time that the pipes of an ended command have to run dry: a process that left its group may hold them open for ever.
pub(super) const DRAIN: Duration = Duration::from_secs(2);

/// What became of a command.
pub(super) struct Ended {
    /// Its standard output, or why there is none to rely on.
    pub output: Result<String, String>,
    /// Its standard error.
    pub log: String,
    /// How long it ran.
    pub wall: Duration,
}

/// Runs `command` in `folder` with `question` on its standard input, for `time_limit` at most. When this returns, neither
/// the command nor anything that it started in its process group is running any more.
pub(super) fn run(command: &[String], folder: &Path, question: Vec<u8>, time_limit: Duration) -> Ended {
    let began = Instant::now();
    let mut child = match spawn(command, folder) {
        Ok(child) => child,
        Err(reason) => {
            let output = Err(format!("cannot start `{}`: {reason}", command.join(" ")));
            return Ended { output, log: String::new(), wall: began.elapsed() };
        }
    };
    let guard = group::Guard::of(&child);
    feed(&mut child, question);
    let output = drain(child.stdout.take(), MOST_OUTPUT);
    let log = drain(child.stderr.take(), MOST_LOG);
    let status = wait(&mut child, &guard, began, time_limit);
    let wall = began.elapsed();
    let log = String::from_utf8_lossy(&log.recv_timeout(DRAIN).unwrap_or_default()).into_owned();
    let output = match verdict(status, time_limit) {
        Some(reason) => Err(with_last_words(reason, &log)),
        None => text(&output.recv_timeout(DRAIN).unwrap_or_default()),
    };
    Ended { output, log, wall }
}

/// Starts a command, all three pipes ours, in a process group of its own.
pub(super) fn spawn(command: &[String], folder: &Path) -> std::io::Result<Child> {
    let program = command.first().cloned().unwrap_or_default();
    // a program beside the scenario file is found there, one without a folder on the PATH
    let is_path = program.contains(std::path::MAIN_SEPARATOR);
    let program = if is_path { folder.canonicalize()?.join(program) } else { PathBuf::from(program) };
    let mut process = Command::new(program);
    process.args(command.iter().skip(1)).current_dir(folder);
    process.stdin(Stdio::piped()).stdout(Stdio::piped()).stderr(Stdio::piped());
    group::apart(&mut process);
    process.spawn()
}

/// Writes the question from a thread of its own: a command that never reads must not block us.
fn feed(child: &mut Child, question: Vec<u8>) {
    if let Some(mut stdin) = child.stdin.take() {
        // a command that does not want the question has ended, or will answer nonsense: both are seen elsewhere
        thread::spawn(move || drop(stdin.write_all(&question)));
    }
}

/// Everything that a pipe brings, `most` bytes of it at most, once it is closed. What comes after that is thrown away.
pub(super) fn drain(pipe: Option<impl Read + Send + 'static>, most: u64) -> Receiver<Vec<u8>> {
    let (sender, receiver) = channel();
    thread::spawn(move || {
        let mut bytes = Vec::new();
        if let Some(mut pipe) = pipe {
            let _ = pipe.by_ref().take(most + 1).read_to_end(&mut bytes);
            let _ = std::io::copy(&mut pipe, &mut std::io::sink());
        }
        let _ = sender.send(bytes);
    });
    receiver
}

/// The command's exit status; `None` if it had to be ended. Its process group is ended in any case.
fn wait(
    child: &mut Child,
    guard: &group::Guard,
    began: Instant,
    limit: Duration,
) -> Option<std::io::Result<ExitStatus>> {
    let in_time = loop {
        if guard.has_exited(child) {
            break true;
        }
        if began.elapsed() >= limit {
            break false;
        }
        thread::sleep(LOOK);
    };
    guard.end(child);
    let status = child.wait();
    in_time.then_some(status)
}

/// Why the output of a command that ended like this is not worth reading, if it is not.
fn verdict(status: Option<std::io::Result<ExitStatus>>, limit: Duration) -> Option<String> {
    match status {
        None => Some(format!("it took longer than its limit of {} s and was ended", limit.as_secs_f64())),
        Some(Err(error)) => Some(format!("its end could not be awaited: {error}")),
        Some(Ok(status)) if status.success() => None,
        Some(Ok(status)) => Some(match status.code() {
            Some(code) => format!("it ended with exit code {code}"),
            None => format!("it crashed ({status})"),
        }),
    }
}

fn text(output: &[u8]) -> Result<String, String> {
    if output.len() as u64 > MOST_OUTPUT {
        return Err(format!("it wrote more than {} MiB", MOST_OUTPUT >> 20));
    }
    String::from_utf8(output.to_vec()).map_err(|_| "its reply is no text (UTF-8)".to_owned())
}

/// The reason, with the last line of the log: that of an exception says most.
fn with_last_words(reason: String, log: &str) -> String {
    match log.lines().rev().map(str::trim).find(|line| !line.is_empty()) {
        Some(line) => format!("{reason}; the last line in planner.log: {}", line.chars().take(200).collect::<String>()),
        None => reason,
    }
}
