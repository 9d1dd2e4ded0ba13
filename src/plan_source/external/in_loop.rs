//! A command that plans in the loop: one JSON request per line on its standard input, one JSON reply per line on its
//! standard output, for as long as its vehicles fly.
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

use super::process::{DRAIN, MOST_LOG, drain, spawn};
use super::{ExternalPlanner, group, request};

/// Time for one answer if nobody says, s.
const TIME_LIMIT_S: f64 = 10.0;
/// Longest reply that is read, bytes.
const MOST_REPLY: u64 = 16 << 20;

/// A command that plans in the loop, and what it writes to its standard error.
pub struct ExternalSession {
    /// One for each vehicle; all of them talk to the same process.
    pub planners: Vec<Box<dyn InLoopPlanner>>,
    /// The process.
    session: Arc<Mutex<Session>>,
}

impl ExternalSession {
    /// Starts the command. If that cannot be, every answer says why.
    pub fn start(planner: &ExternalPlanner, scenario: &Scenario, seed: u64) -> Self {
        let time_limit_s = planner.time_limit_s.unwrap_or(TIME_LIMIT_S);
        let session = Session::start(planner, time_limit_s);
        let mut begin = request::document(scenario, seed, time_limit_s);
        begin["request"] = "begin".into();
        begin["planning"] = json!({
            "period_s": scenario.simulation.planning.period_s,
            "deadline_s": scenario.simulation.planning.deadline_s,
        });
        session.tell(&begin);
        let session = Arc::new(Mutex::new(session));
        let seat = |vehicle: &scenarios::Vehicle| -> Box<dyn InLoopPlanner> {
            Box::new(ExternalInLoopPlanner { vehicle: vehicle.name.clone(), session: Arc::clone(&session) })
        };
        Self { planners: scenario.vehicles.iter().map(seat).collect(), session }
    }

    /// Everything that the command writes to its standard error; it is ended.
    pub fn log(&self) -> impl FnOnce() -> String + use<> {
        let session = Arc::clone(&self.session);
        move || session.lock().unwrap_or_else(PoisonError::into_inner).finish()
    }
}

/// The planner of one vehicle: its side of the conversation.
struct ExternalInLoopPlanner {
    vehicle: String,
    session: Arc<Mutex<Session>>,
}

impl InLoopPlanner for ExternalInLoopPlanner {
    fn replan(&mut self, observation: &Observation<'_>) -> ReplanResult {
        let mut question = json!(observation);
        question["known"] = request::world(observation.known);
        question["request"] = "replan".into();
        question["vehicle"] = self.vehicle.clone().into();
        let mut session = self.session.lock().unwrap_or_else(PoisonError::into_inner);
        session.ask(&question).and_then(|text| read(&text)).unwrap_or_else(ReplanResult::keep)
    }
}

/// A reply: to fly through nodes, or to keep what is flown.
#[derive(Deserialize)]
#[serde(deny_unknown_fields)]
struct Reply {
    fly: Option<Vec<Node>>,
    keep: Option<String>,
    #[serde(default, rename = "account")]
    diagnostics: ReplanDiagnostics,
}

fn read(text: &str) -> Result<ReplanResult, String> {
    let reply: Reply = serde_json::from_str(text).map_err(|error| format!("its reply makes no sense: {error}"))?;
    let decision = match (reply.fly, reply.keep) {
        (Some(nodes), None) => Decision::Fly(nodes),
        (None, Some(reason)) => Decision::Keep { reason },
        _ => return Err("its reply has neither `fly` nor `keep`, or both".into()),
    };
    Ok(ReplanResult { decision, diagnostics: reply.diagnostics })
}

/// The running command.
struct Session {
    time_limit: Duration,
    /// The process, while it is good for anything; else why it is not.
    running: Result<Running, String>,
    log: Option<Receiver<Vec<u8>>>,
}

struct Running {
    child: Child,
    guard: group::Guard,
    questions: Sender<Vec<u8>>,
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
        let (questions, to_write) = channel::<Vec<u8>>();
        if let Some(mut stdin) = child.stdin.take() {
            // A command that does not read must not block us; one that has ended is seen by its silence.
            thread::spawn(move || while to_write.recv().is_ok_and(|line| stdin.write_all(&line).is_ok()) {});
        }
        let (sender, replies) = channel();
        if let Some(stdout) = child.stdout.take() {
            thread::spawn(move || read_lines(stdout, &sender));
        }
        let log = Some(drain(child.stderr.take(), MOST_LOG));
        Self { time_limit, running: Ok(Running { child, guard, questions, replies }), log }
    }

    fn tell(&self, message: &Value) {
        if let Ok(running) = &self.running {
            let _ = running.questions.send(format!("{message}\n").into_bytes());
        }
    }

    /// Puts a question and waits for its answer. After a silence that is too long, or the process's end, it is not asked
    /// again.
    fn ask(&mut self, question: &Value) -> Result<String, String> {
        self.tell(question);
        let time_limit = self.time_limit;
        let running = self.running.as_ref().map_err(Clone::clone)?;
        let reply = running.replies.recv_timeout(time_limit).unwrap_or_else(|error| {
            Err(match error {
                RecvTimeoutError::Timeout => {
                    format!("it took longer than its limit of {} s and was ended", time_limit.as_secs_f64())
                }
                RecvTimeoutError::Disconnected => "it has ended; see planner.log".to_owned(),
            })
        });
        if let Err(reason) = &reply {
            self.end(reason.clone());
        }
        reply
    }

    /// Ends the process, and returns its standard error.
    fn finish(&mut self) -> String {
        self.end("the flight is over".into());
        let bytes = self.log.take().and_then(|log| log.recv_timeout(DRAIN).ok()).unwrap_or_default();
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

/// Sends every line, until there is none, or one that is too long or no text.
fn read_lines(stdout: ChildStdout, sender: &Sender<Result<String, String>>) {
    let mut reader = BufReader::new(stdout);
    loop {
        let mut line = Vec::new();
        let read = reader.by_ref().take(MOST_REPLY).read_until(b'\n', &mut line);
        let text = match read {
            Err(_) | Ok(0) => return,
            Ok(_) if line.len() as u64 >= MOST_REPLY => Err(format!("it wrote a line of {} MiB", MOST_REPLY >> 20)),
            Ok(_) => String::from_utf8(line).map_err(|_| "its reply is no text (UTF-8)".to_owned()),
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
    fn a_command_answers_line_by_line_until_it_fails() {
        let mut echo = session("while read line; do echo \"$line\"; done", 10.0);
        assert_eq!(echo.ask(&json!({"a": 1})).unwrap().trim(), r#"{"a":1}"#);
        assert_eq!(echo.ask(&json!(2)).unwrap().trim(), "2");
        let mut silent = session("sleep 60", 0.05);
        assert!(silent.ask(&json!(1)).unwrap_err().contains("longer than its limit"));
        assert!(silent.ask(&json!(1)).is_err());
        let mut short = session("echo broken >&2; exit 3", 10.0);
        assert!(short.ask(&json!(1)).unwrap_err().contains("has ended"));
        assert_eq!(short.finish().trim(), "broken");
    }
}
