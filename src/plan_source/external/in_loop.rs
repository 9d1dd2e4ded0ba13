//! An external in-loop planner: one JSON request per line on its standard input, one JSON reply per line on its standard
//! output, until the flight ends.
//!
//! ```text
//! {"request": "begin", scenario ...}                       no reply
//! {"request": "replan", "vehicle": ..., observation ...}   {"fly": [nodes]} or {"keep": reason}
//! ```

use std::io::{BufRead, BufReader, Read, Write};
use std::process::{Child, ChildStdout};
use std::sync::mpsc::{Receiver, RecvTimeoutError, Sender, channel};
use std::sync::{Arc, Mutex, PoisonError};
use std::thread;
use std::time::Duration;

use scenarios::Scenario;
use scenarios::in_loop::{Decision, InLoopPlanner, Node, Observation, ReplanDiagnostics, ReplanResult};
use serde::Deserialize;
use serde_json::{Value, json};

use super::process::{DRAIN_TIMEOUT, MAX_LOG_BYTES, drain, spawn};
use super::{ExternalPlanner, group, request};

/// Default time limit of a reply, s.
const DEFAULT_TIME_LIMIT_S: f64 = 10.0;
/// Largest size of a reply, bytes.
const MAX_REPLY_BYTES: u64 = 16 << 20;

/// A running external in-loop planner.
pub struct ExternalSession {
    /// One planner per vehicle; all share the same process.
    pub planners: Vec<Box<dyn InLoopPlanner>>,
    /// The process.
    session: Arc<Mutex<Session>>,
}

impl ExternalSession {
    /// Starts the command. If it cannot be started, every reply holds the reason.
    pub fn start(planner: &ExternalPlanner, scenario: &Scenario, seed: u64) -> Self {
        let time_limit_s = planner.time_limit_s.unwrap_or(DEFAULT_TIME_LIMIT_S);
        let session = Session::start(planner, time_limit_s);
        let mut begin = request::document(scenario, seed, time_limit_s);
        begin["request"] = "begin".into();
        begin["planning"] = json!({
            "period_s": scenario.simulation.planning.period_s,
            "deadline_s": scenario.simulation.planning.deadline_s,
        });
        session.send(&begin);
        let session = Arc::new(Mutex::new(session));
        let planner = |vehicle: &scenarios::Vehicle| -> Box<dyn InLoopPlanner> {
            Box::new(ExternalInLoopPlanner { vehicle: vehicle.name.clone(), session: Arc::clone(&session) })
        };
        Self { planners: scenario.vehicles.iter().map(planner).collect(), session }
    }

    /// Returns a function that terminates the command and returns its standard error.
    pub fn log(&self) -> impl FnOnce() -> String + use<> {
        let session = Arc::clone(&self.session);
        move || session.lock().unwrap_or_else(PoisonError::into_inner).finish()
    }
}

/// The in-loop planner of one vehicle.
struct ExternalInLoopPlanner {
    vehicle: String,
    session: Arc<Mutex<Session>>,
}

impl InLoopPlanner for ExternalInLoopPlanner {
    fn replan(&mut self, observation: &Observation<'_>) -> ReplanResult {
        let mut request = json!(observation);
        request["known"] = super::request::world(observation.known);
        request["request"] = "replan".into();
        request["vehicle"] = self.vehicle.clone().into();
        let mut session = self.session.lock().unwrap_or_else(PoisonError::into_inner);
        session.request(&request).and_then(|text| read(&text)).unwrap_or_else(ReplanResult::keep)
    }
}

/// A reply: nodes of a new reference, or the reason to keep the reference in force.
#[derive(Deserialize)]
#[serde(deny_unknown_fields)]
struct Reply {
    fly: Option<Vec<Node>>,
    keep: Option<String>,
    #[serde(default, rename = "account")]
    diagnostics: ReplanDiagnostics,
}

fn read(text: &str) -> Result<ReplanResult, String> {
    let reply: Reply = serde_json::from_str(text).map_err(|error| format!("its reply is invalid: {error}"))?;
    let decision = match (reply.fly, reply.keep) {
        (Some(nodes), None) => Decision::Fly(nodes),
        (None, Some(reason)) => Decision::Keep { reason },
        _ => return Err("its reply needs either `fly` or `keep`".into()),
    };
    Ok(ReplanResult { decision, diagnostics: reply.diagnostics })
}

/// The process of the command.
struct Session {
    time_limit: Duration,
    /// The process; after it has failed or ended, the reason.
    running: Result<Running, String>,
    log: Option<Receiver<Vec<u8>>>,
}

struct Running {
    child: Child,
    guard: group::Guard,
    requests: Sender<Vec<u8>>,
    replies: Receiver<Result<String, String>>,
}

impl Session {
    fn start(planner: &ExternalPlanner, time_limit_s: f64) -> Self {
        let time_limit = Duration::try_from_secs_f64(time_limit_s).unwrap_or(Duration::MAX);
        let mut child = match spawn(&planner.command, &planner.folder) {
            Ok(child) => child,
            Err(reason) => {
                let running = Err(format!("cannot start `{}`: {reason}", planner.command.join(" ")));
                return Self { time_limit, running, log: None };
            }
        };
        let guard = group::Guard::of(&child);
        let (requests, to_write) = channel::<Vec<u8>>();
        if let Some(mut stdin) = child.stdin.take() {
            // In a thread of its own, since a command that does not read would block. An ended command fails to reply.
            thread::spawn(move || while to_write.recv().is_ok_and(|line| stdin.write_all(&line).is_ok()) {});
        }
        let (sender, replies) = channel();
        if let Some(stdout) = child.stdout.take() {
            thread::spawn(move || read_lines(stdout, &sender));
        }
        let log = Some(drain(child.stderr.take(), MAX_LOG_BYTES));
        Self { time_limit, running: Ok(Running { child, guard, requests, replies }), log }
    }

    fn send(&self, message: &Value) {
        if let Ok(running) = &self.running {
            let _ = running.requests.send(format!("{message}\n").into_bytes());
        }
    }

    /// Sends a request and waits for the reply. After a timeout, or the end of the process, all further requests fail.
    fn request(&mut self, request: &Value) -> Result<String, String> {
        self.send(request);
        let time_limit = self.time_limit;
        let running = self.running.as_ref().map_err(Clone::clone)?;
        let reply = running.replies.recv_timeout(time_limit).unwrap_or_else(|error| {
            Err(match error {
                RecvTimeoutError::Timeout => {
                    format!("it took longer than its limit of {} s and was terminated", time_limit.as_secs_f64())
                }
                RecvTimeoutError::Disconnected => "it has ended; see planner.log".to_owned(),
            })
        });
        if let Err(reason) = &reply {
            self.end(reason.clone());
        }
        reply
    }

    /// Terminates the process and returns its standard error.
    fn finish(&mut self) -> String {
        self.end("the flight is over".into());
        let bytes = self.log.take().and_then(|log| log.recv_timeout(DRAIN_TIMEOUT).ok()).unwrap_or_default();
        String::from_utf8_lossy(&bytes).into_owned()
    }

    fn end(&mut self, reason: String) {
        if let Ok(mut running) = std::mem::replace(&mut self.running, Err(reason)) {
            running.guard.end(&mut running.child);
            let _ = running.child.wait();
        }
    }
}

impl Drop for Session {
    fn drop(&mut self) {
        self.end("the flight is over".into());
    }
}

/// Sends every line, until the pipe is closed, or a line is too long or not UTF-8.
fn read_lines(stdout: ChildStdout, sender: &Sender<Result<String, String>>) {
    let mut reader = BufReader::new(stdout);
    loop {
        let mut line = Vec::new();
        let read = reader.by_ref().take(MAX_REPLY_BYTES).read_until(b'\n', &mut line);
        let text = match read {
            Err(_) | Ok(0) => return,
            Ok(_) if line.len() as u64 >= MAX_REPLY_BYTES => {
                Err(format!("it wrote a line of {} MiB", MAX_REPLY_BYTES >> 20))
            }
            Ok(_) => String::from_utf8(line).map_err(|_| "its reply is not valid UTF-8".to_owned()),
        };
        let is_last = text.is_err();
        if sender.send(text).is_err() || is_last {
            return;
        }
    }
}

#[cfg(all(test, unix))]
mod tests {
    use super::*;

    fn session(script: &str, time_limit_s: f64) -> Session {
        let planner = ExternalPlanner {
            name: "test".into(),
            command: ["sh", "-c", script].map(str::to_owned).into(),
            folder: std::env::temp_dir(),
            time_limit_s: None,
            in_loop: true,
        };
        Session::start(&planner, time_limit_s)
    }

    #[test]
    fn a_reply_is_a_reference_or_a_reason_to_keep_the_last() {
        let answer = read(r#"{"fly": [{"t_s": 1.0, "position_m": [0, 0, 1], "velocity_mps": [0, 0, 0]}]}"#).unwrap();
        assert!(matches!(answer.decision, Decision::Fly(nodes) if nodes == [Node::at_rest(1.0, [0.0, 0.0, 1.0])]));
        assert_eq!(read(r#"{"keep": "nothing better"}"#).unwrap(), ReplanResult::keep("nothing better"));
        for nonsense in ["", "hello", "{}", "[]", r#"{"fly": 3}"#, r#"{"fly": [], "keep": "both"}"#] {
            assert!(read(nonsense).is_err(), "{nonsense}");
        }
    }

    #[test]
    fn a_command_replies_line_by_line_until_it_fails() {
        let mut echo = session("while read line; do echo \"$line\"; done", 10.0);
        assert_eq!(echo.request(&json!({"a": 1})).unwrap().trim(), r#"{"a":1}"#);
        assert_eq!(echo.request(&json!(2)).unwrap().trim(), "2");
        let mut silent = session("sleep 60", 0.05);
        assert!(silent.request(&json!(1)).unwrap_err().contains("longer than its limit"));
        assert!(silent.request(&json!(1)).is_err());
        let mut short = session("echo broken >&2; exit 3", 10.0);
        assert!(short.request(&json!(1)).unwrap_err().contains("has ended"));
        assert_eq!(short.finish().trim(), "broken");
    }
}
