//! Runs a command with a request and a time limit, and terminates everything that it started.

use std::io::{Read, Write};
use std::path::{Path, PathBuf};
use std::process::{Child, Command, ExitStatus, Stdio};
use std::sync::mpsc::{Receiver, channel};
use std::thread;
use std::time::{Duration, Instant};

use super::{PlannerFault, group};

/// Largest size of standard output, bytes.
const MAX_OUTPUT_BYTES: u64 = 256 << 20;
/// Largest size of the log, bytes; of a longer standard error the beginning is kept.
pub(super) const MAX_LOG_BYTES: u64 = 4 << 20;
/// Polling interval of a running command.
const POLL_INTERVAL: Duration = Duration::from_millis(2);
/// Time limit for draining the pipes of an ended command: a process that left the group may hold them open forever.
pub(super) const DRAIN_TIMEOUT: Duration = Duration::from_secs(2);

/// Result of a command.
pub(super) struct Ended {
    /// Its standard output, or why it is unusable.
    pub output: Result<String, PlannerFault>,
    /// Its standard error.
    pub log: String,
    /// Its wall time.
    pub wall: Duration,
}

/// Runs `command` in `folder` with `request` on its standard input, for `time_limit` at most. When this returns, neither the
/// command nor any process of its process group is running.
pub(super) fn run(command: &[String], folder: &Path, request: Vec<u8>, time_limit: Duration) -> Ended {
    let began = Instant::now();
    let (mut child, guard) = match spawn(command, folder) {
        Ok(started) => started,
        Err(error) => {
            let output = Err(PlannerFault::cannot_start(command, &error));
            return Ended { output, log: String::new(), wall: began.elapsed() };
        }
    };
    feed(&mut child, request);
    let output = drain(child.stdout.take(), MAX_OUTPUT_BYTES);
    let log = drain(child.stderr.take(), MAX_LOG_BYTES);
    let status = wait(&mut child, &guard, began, time_limit);
    let wall = began.elapsed();
    let log = String::from_utf8_lossy(&log.recv_timeout(DRAIN_TIMEOUT).unwrap_or_default()).into_owned();
    let output = match fault(status, time_limit) {
        Some(fault) => Err(fault.with_last_line_of(&log)),
        None => text(&output.recv_timeout(DRAIN_TIMEOUT).unwrap_or_default()),
    };
    Ended { output, log, wall }
}

/// Starts a command with three pipes, in a process group of its own.
pub(super) fn spawn(command: &[String], folder: &Path) -> std::io::Result<(Child, group::Guard)> {
    let program = command.first().cloned().unwrap_or_default();
    // A program with a folder is relative to the working directory; one without is searched on the PATH.
    let is_path = program.contains(std::path::MAIN_SEPARATOR);
    let program = if is_path { folder.canonicalize()?.join(program) } else { PathBuf::from(program) };
    let mut process = Command::new(program);
    process.args(command.iter().skip(1)).current_dir(folder);
    process.stdin(Stdio::piped()).stdout(Stdio::piped()).stderr(Stdio::piped());
    group::Guard::start(&mut process)
}

/// Writes the request from a thread of its own, since a command that never reads would block.
fn feed(child: &mut Child, request: Vec<u8>) {
    if let Some(mut stdin) = child.stdin.take() {
        // An error means that the command has ended or closed its input. Its exit code and its reply tell the rest.
        thread::spawn(move || drop(stdin.write_all(&request)));
    }
}

/// The content of a pipe once it is closed: `max_bytes + 1` bytes at most, the rest is discarded.
pub(super) fn drain(pipe: Option<impl Read + Send + 'static>, max_bytes: u64) -> Receiver<Vec<u8>> {
    let (sender, receiver) = channel();
    thread::spawn(move || {
        let mut bytes = Vec::new();
        if let Some(mut pipe) = pipe {
            let _ = pipe.by_ref().take(max_bytes + 1).read_to_end(&mut bytes);
            let _ = std::io::copy(&mut pipe, &mut std::io::sink());
        }
        let _ = sender.send(bytes);
    });
    receiver
}

/// The exit status of the command; `None` after a timeout. Its process group is terminated in any case.
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
        thread::sleep(POLL_INTERVAL);
    };
    guard.end(child);
    let status = child.wait();
    in_time.then_some(status)
}

/// Why the output of a command is unusable; `None` if it succeeded.
fn fault(status: Option<std::io::Result<ExitStatus>>, limit: Duration) -> Option<PlannerFault> {
    match status {
        None => Some(PlannerFault::TimedOut(limit)),
        Some(Err(error)) => Some(PlannerFault::UnknownStatus(error.to_string())),
        Some(Ok(status)) if status.success() => None,
        Some(Ok(status)) => Some(PlannerFault::Ended(status)),
    }
}

fn text(output: &[u8]) -> Result<String, PlannerFault> {
    if output.len() as u64 > MAX_OUTPUT_BYTES {
        return Err(PlannerFault::LongOutput(MAX_OUTPUT_BYTES >> 20));
    }
    String::from_utf8(output.to_vec()).map_err(|_| PlannerFault::NotText)
}
