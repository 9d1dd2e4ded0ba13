//! Sessions with shell scripts that keep to the protocol, and with some that do not.

use std::time::{Duration, Instant};

use scenarios::in_loop::{Decision, PlannerRemarks, ReplanResult};

use super::session::Session;
use crate::plan_source::external::ExternalPlanner;

/// Replies to every request with its number, as an id.
const COUNTING: &str = "n=0; while read line; do n=$((n+1)); echo \"{\\\"id\\\": $n, \\\"keep\\\": \\\"on\\\"}\"; done";

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

/// The result of a request, or why there is none.
fn ask(session: &mut Session) -> Result<ReplanResult, String> {
    session.request(|id| format!("{{\"id\": {id}}}\n").into_bytes()).map_err(|fault| fault.to_string())
}

/// The reason why the first request has no result, which is also that of the next one, if the session is over.
#[track_caller]
fn failure_of(script: &str) -> String {
    let mut session = session(script, 5.0);
    let reason = ask(&mut session).expect_err("no result");
    assert_eq!(ask(&mut session), Err(reason.clone()));
    reason
}

#[test]
fn requests_are_answered_by_their_ids() {
    let mut counting = session(COUNTING, 10.0);
    for _ in 0..3 {
        assert_eq!(ask(&mut counting), Ok(ReplanResult::keep("on")));
    }
    assert!(counting.replies_have_ids());
    // The script replies to `end` too.
    assert!(counting.finish().failure.expect("a reply without a request").contains("1 of its replies are left over"));
}

#[test]
fn a_session_that_keeps_to_the_protocol_leaves_no_remark() {
    let mut session = session(
        "read a; echo '{\"id\": 1, \"keep\": \"on\"}'; read end; test \"$end\" = '{\"request\":\"end\"}'",
        10.0,
    );
    assert!(ask(&mut session).is_ok());
    assert_eq!(session.finish(), PlannerRemarks::default());
}

#[test]
fn a_silent_or_ended_command_has_a_reason() {
    let mut silent = session("sleep 60", 0.05);
    assert!(ask(&mut silent).unwrap_err().contains("longer than its limit of 0.05 s"));
    let mut endless = session("yes", 0.2);
    assert!(ask(&mut endless).unwrap_err().contains("longer than its limit of 0.2 s"));
    let reason = failure_of("read a; echo 'out of memory' >&2; exit 3");
    assert_eq!(reason, "it ended with exit code 3; the last line in planner.log: out of memory");
    assert_eq!(failure_of("read a; exit 0"), "it ended with exit code 0");
    assert!(failure_of("read a; kill -SEGV $$").starts_with("it crashed (signal: 11"));
    assert_eq!(failure_of("read a; exec >&-; sleep 60"), "it closed its standard output");
}

#[test]
fn replies_that_cannot_be_matched_end_the_session() {
    assert!(
        failure_of("read a; echo '{\"id\": 2, \"keep\": \"\"}'; cat").contains("has the id 2, and the request has 1")
    );
    assert!(failure_of("read a; echo '{\"path\": []}'; cat").contains("without an `id`"));
    let mut early = session("echo '{\"keep\": \"\"}'; cat", 5.0);
    std::thread::sleep(Duration::from_millis(300));
    assert!(ask(&mut early).unwrap_err().contains("before it was asked"));
    let mut forgetful =
        session("read a; echo '{\"id\": 1, \"keep\": \"\"}'; read b; echo '{\"keep\": \"\"}'; cat", 5.0);
    assert!(ask(&mut forgetful).is_ok());
    assert!(ask(&mut forgetful).unwrap_err().contains("has no id, and the request has 2"));
}

#[test]
fn an_invalid_reply_with_the_right_id_fails_alone() {
    let mut session =
        session("read a; echo '{\"id\": 1, \"fly\": 3}'; read b; echo '{\"id\": 2, \"keep\": \"\"}'; cat", 5.0);
    assert!(ask(&mut session).unwrap_err().contains("its reply is invalid"));
    assert!(matches!(ask(&mut session).unwrap().decision, Decision::Keep { .. }));
}

#[test]
fn stray_lines_and_missing_ids_are_told() {
    let script = "echo '[INFO] ready'; while read line; do echo 'step'; echo '{\"keep\": \"\"}'; done";
    let mut session = session(script, 5.0);
    assert!(ask(&mut session).is_ok() && ask(&mut session).is_ok());
    let PlannerRemarks { notes, failure } = session.finish();
    assert_eq!(failure, None);
    assert!(notes[0].ends_with("no replies: 3; the first: `[INFO] ready`"), "{notes:?}");
    assert!(notes[1].contains("no `id` (protocol 1)"), "{notes:?}");
    assert_eq!(session.finish(), PlannerRemarks::default(), "they are told once");
}

#[test]
fn a_command_may_save_its_log_at_the_end() {
    let folder = tempfile::tempdir().unwrap();
    let file = folder.path().join("saved");
    let script = format!(
        "read a; echo '{{\"id\": 1, \"keep\": \"\"}}'; cat > /dev/null; seq 20000; sleep 1; touch {}; exit 4",
        file.display()
    );
    let mut session = session(&script, 5.0);
    assert!(ask(&mut session).is_ok());
    let notes = session.finish().notes;
    assert_eq!(notes[0], "after the flight it ended with exit code 4");
    assert!(notes[1].ends_with("no replies: 20000; the first: `1`"), "{notes:?}");
    assert!(file.exists());
}

#[test]
fn a_command_that_does_not_end_is_killed_after_its_grace() {
    let mut session = session("read a; echo '{\"id\": 1, \"keep\": \"\"}'; sleep 600", 5.0);
    assert!(ask(&mut session).is_ok());
    let began = Instant::now();
    assert!(session.finish().notes[0].contains("did not end within 5 s"));
    assert!((4.0..60.0).contains(&began.elapsed().as_secs_f64()));
}
