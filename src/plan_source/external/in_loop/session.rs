//! The process of an in-loop command: requests, replies, and its end.

use std::io::{BufRead, BufReader, Read, Write};
use std::process::{Child, ChildStdout, ExitStatus};
use std::sync::mpsc::{Receiver, RecvTimeoutError, Sender, SyncSender, channel, sync_channel};
use std::thread;
use std::time::{Duration, Instant};

use scenarios::in_loop::{PlannerRemarks, ReplanResult};
use serde_json::json;

use super::message::{self, Line};
use crate::plan_source::external::fault::ending;
use crate::plan_source::external::process::{DRAIN_TIMEOUT, MAX_LOG_BYTES, drain, spawn};
use crate::plan_source::external::{ExternalPlanner, PlannerFault, group};

/// Largest size of a reply, bytes.
const MAX_REPLY_BYTES: u64 = 16 << 20;
/// Time for which the command may continue after the end of its input, for example to write a log.
const GRACE: Duration = Duration::from_secs(5);
/// Time for which a command that has closed its standard output may take to end.
const EXIT_TIMEOUT: Duration = Duration::from_secs(1);
/// Polling interval of an ending command.
const POLL_INTERVAL: Duration = Duration::from_millis(2);
/// Number of lines that are read ahead.
const MAX_LINES: usize = 64;
/// Number of characters of a stray line that are shown.
const SHOWN_CHARACTERS: usize = 100;

/// The process of an in-loop command.
pub struct Session {
    time_limit: Duration,
    /// The process; after it has failed or ended, why.
    running: Result<Running, PlannerFault>,
    /// Its standard error, once it has ended.
    log: String,
    /// Number of requests so far, which is the id of the last one.
    requests: u64,
    /// Whether replies carry the id of their request; `None` before the first reply.
    replies_have_ids: Option<bool>,
    stray: StrayLines,
}

struct Running {
    child: Child,
    guard: group::Guard,
    requests: Sender<Vec<u8>>,
    lines: Receiver<Result<String, PlannerFault>>,
    log: Receiver<Vec<u8>>,
}

/// Lines on standard output that are no replies.
#[derive(Default)]
struct StrayLines {
    count: usize,
    first: Option<String>,
}

impl Session {
    /// Starts the command.
    pub fn start(planner: &ExternalPlanner, time_limit_s: f64) -> Self {
        let running = match spawn(&planner.command, &planner.folder) {
            Ok((child, guard)) => Ok(Running::new(child, guard)),
            Err(error) => Err(PlannerFault::cannot_start(&planner.command, &error)),
        };
        Self {
            time_limit: Duration::try_from_secs_f64(time_limit_s).unwrap_or(Duration::MAX),
            running,
            log: String::new(),
            requests: 0,
            replies_have_ids: None,
            stray: StrayLines::default(),
        }
    }

    /// Whether the command is known to put the id of the request into its replies, as protocol 2 demands.
    pub fn replies_have_ids(&self) -> bool {
        self.replies_have_ids == Some(true)
    }

    /// Sends a line that has no reply.
    pub fn send(&self, line: Vec<u8>) {
        if let Ok(running) = &self.running {
            // An ended command fails to reply.
            let _ = running.requests.send(line);
        }
    }

    /// Sends a request, which is written for its id, and waits for the reply.
    ///
    /// # Errors
    ///
    /// Why there is no result. After a timeout, the end of the process, or a reply that does not match, no
    /// further request is sent.
    pub fn request(&mut self, line: impl FnOnce(u64) -> Vec<u8>) -> Result<ReplanResult, PlannerFault> {
        while let Ok(unasked) = self.running()?.lines.try_recv() {
            self.take(unasked, None)?;
        }
        self.requests += 1;
        let began = Instant::now();
        self.send(line(self.requests));
        loop {
            let remaining = self.time_limit.saturating_sub(began.elapsed());
            if remaining.is_zero() {
                return Err(self.time_out());
            }
            match self.running()?.lines.recv_timeout(remaining) {
                Ok(line) => {
                    if let Some(result) = self.take(line, Some(self.requests))? {
                        return result;
                    }
                }
                Err(RecvTimeoutError::Timeout) => return Err(self.time_out()),
                Err(RecvTimeoutError::Disconnected) => return Err(self.crash()),
            }
        }
    }

    /// Ends the command: the message `end` if it speaks protocol 2, end of file, and time to end by itself. Returns what is
    /// to be said of it beyond its replies, once.
    pub fn finish(&mut self) -> PlannerRemarks {
        let mut notes = Vec::new();
        let ended = self.end(PlannerFault::FlightOver, GRACE);
        match ended.as_ref().map(|ended| ended.status) {
            Some(None) => {
                notes.push(format!("it did not end within {} s after the flight, and was killed", GRACE.as_secs()));
            }
            Some(Some(status)) if !status.success() => notes.push(format!("after the flight {}", ending(status))),
            Some(Some(_)) | None => {}
        }
        if let Some(first) = self.stray.first.take() {
            notes.push(format!(
                "lines on its standard output that are no replies: {}; the first: {first}",
                self.stray.count
            ));
        }
        if self.replies_have_ids.take() == Some(false) {
            notes.push("its replies carry no `id` (protocol 1): they were matched by their order".into());
        }
        let unasked = ended.map_or(0, |ended| ended.replies);
        let failure =
            (unasked > 0).then(|| format!("{unasked} of its replies are left over, for which there is no request"));
        PlannerRemarks { notes, failure }
    }

    /// Terminates the command and returns its standard error.
    pub fn log(&mut self) -> String {
        self.end(PlannerFault::FlightOver, Duration::ZERO);
        std::mem::take(&mut self.log)
    }

    fn running(&self) -> Result<&Running, PlannerFault> {
        self.running.as_ref().map_err(Clone::clone)
    }

    /// Takes a line of standard output: the result of request `id`, an error if that request has none, or `None` if the line
    /// is no reply.
    ///
    /// # Errors
    ///
    /// The line is a reply that cannot be matched with a request, so that no later one could be trusted either.
    fn take(
        &mut self,
        line: Result<String, PlannerFault>,
        id: Option<u64>,
    ) -> Result<Option<Result<ReplanResult, PlannerFault>>, PlannerFault> {
        let line = line.map_err(|fault| self.fail(fault))?;
        let (found, result) = match Line::parse(&line) {
            Line::Blank => return Ok(None),
            Line::Stray => {
                self.stray.add(&line);
                return Ok(None);
            }
            Line::Reply { id, result } => (id, result),
        };
        let mismatch = match (id, found) {
            (None, _) => PlannerFault::Unasked,
            (Some(expected), Some(found)) if found != expected => PlannerFault::WrongId { found, expected },
            (Some(id), None) if self.replies_have_ids() => PlannerFault::NoId(id),
            (Some(_), Some(_)) => {
                self.replies_have_ids = Some(true);
                return Ok(Some(result));
            }
            (Some(_), None) => {
                self.replies_have_ids = Some(false);
                match result {
                    Ok(_) => return Ok(Some(result)),
                    Err(fault) => PlannerFault::Unmatched(Box::new(fault)),
                }
            }
        };
        Err(self.fail(mismatch))
    }

    /// Ends the command because of a reply.
    fn fail(&mut self, fault: PlannerFault) -> PlannerFault {
        self.end(fault.clone(), GRACE);
        fault
    }

    fn time_out(&mut self) -> PlannerFault {
        let fault = PlannerFault::TimedOut(self.time_limit);
        self.end(fault.clone(), Duration::ZERO);
        fault
    }

    /// It has closed its standard output.
    fn crash(&mut self) -> PlannerFault {
        let ended = self.end(PlannerFault::Silent, EXIT_TIMEOUT);
        let status = ended.and_then(|ended| ended.status);
        let fault = status.map_or(PlannerFault::Silent, PlannerFault::Ended).with_last_line_of(&self.log);
        self.running = Err(fault.clone());
        fault
    }

    /// Closes the command's input, waits until it ends, kills it otherwise, and keeps its standard error. `None` if it has
    /// ended before.
    fn end(&mut self, why: PlannerFault, grace: Duration) -> Option<EndedSession> {
        if self.replies_have_ids() {
            self.send(message::line(&json!({ "request": "end" })));
        }
        let Running { mut child, guard, requests, lines, log } = std::mem::replace(&mut self.running, Err(why)).ok()?;
        drop(requests);
        let (began, mut replies) = (Instant::now(), 0);
        let mut has_exited = guard.has_exited(&mut child);
        while !has_exited && began.elapsed() < grace {
            // A full pipe would keep it from ending.
            replies += lines.try_iter().take(MAX_LINES).flatten().filter(|line| self.is_unasked(line)).count();
            thread::sleep(POLL_INTERVAL);
            has_exited = guard.has_exited(&mut child);
        }
        guard.end(&mut child);
        let status = child.wait().ok().filter(|_| has_exited);
        self.log = String::from_utf8_lossy(&log.recv_timeout(DRAIN_TIMEOUT).unwrap_or_default()).into_owned();
        let drained_by = Instant::now() + DRAIN_TIMEOUT;
        while let Ok(Ok(line)) = lines.recv_timeout(drained_by.saturating_duration_since(Instant::now())) {
            replies += usize::from(self.is_unasked(&line));
            if Instant::now() > drained_by {
                break;
            }
        }
        Some(EndedSession { status, replies })
    }

    /// Whether a line after the last request is a reply.
    fn is_unasked(&mut self, line: &str) -> bool {
        match Line::parse(line) {
            Line::Blank => false,
            Line::Stray => {
                self.stray.add(line);
                false
            }
            Line::Reply { .. } => true,
        }
    }
}

/// A command that has ended.
struct EndedSession {
    /// Its exit status; `None` if it was killed.
    status: Option<ExitStatus>,
    /// Number of replies that it had written without a request.
    replies: usize,
}

impl Running {
    fn new(mut child: Child, guard: group::Guard) -> Self {
        let (requests, to_write) = channel::<Vec<u8>>();
        if let Some(mut stdin) = child.stdin.take() {
            // In a thread of its own, since a command that does not read would block.
            thread::spawn(move || while to_write.recv().is_ok_and(|line| stdin.write_all(&line).is_ok()) {});
        }
        let (sender, lines) = sync_channel(MAX_LINES);
        if let Some(stdout) = child.stdout.take() {
            thread::spawn(move || read_lines(stdout, &sender));
        }
        let log = drain(child.stderr.take(), MAX_LOG_BYTES);
        Self { child, guard, requests, lines, log }
    }
}

impl StrayLines {
    fn add(&mut self, line: &str) {
        self.count += 1;
        self.first
            .get_or_insert_with(|| format!("`{}`", line.trim().chars().take(SHOWN_CHARACTERS).collect::<String>()));
    }
}

impl Drop for Session {
    fn drop(&mut self) {
        self.end(PlannerFault::FlightOver, Duration::ZERO);
    }
}

/// Sends every line, until the pipe is closed, or a line is too long or not UTF-8.
fn read_lines(stdout: ChildStdout, sender: &SyncSender<Result<String, PlannerFault>>) {
    let mut reader = BufReader::new(stdout);
    loop {
        let mut line = Vec::new();
        let read = reader.by_ref().take(MAX_REPLY_BYTES).read_until(b'\n', &mut line);
        let text = match read {
            Err(_) | Ok(0) => return,
            Ok(_) if line.len() as u64 >= MAX_REPLY_BYTES => Err(PlannerFault::LongLine(MAX_REPLY_BYTES >> 20)),
            Ok(_) => String::from_utf8(line).map_err(|_| PlannerFault::NotText),
        };
        let is_last = text.is_err();
        if sender.send(text).is_err() || is_last {
            return;
        }
    }
}
