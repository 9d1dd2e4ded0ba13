//! Whatever a command does, there is an answer, in time, and nothing of it lives on.

use std::path::{Path, PathBuf};
use std::time::{Duration, Instant};

use scenarios::{PlanStatus, Scenario};

use super::ExternalPlanner;
use crate::damage::copies_of;

fn scenario() -> Scenario {
    let path = Path::new(env!("CARGO_MANIFEST_DIR")).join("scenarios/fixed-wing/rendezvous-1.toml");
    scenarios::load(&path).expect("a shipped scenario")
}

/// What the shell makes of `script`, given `time_limit_s`: status, reason, log.
fn ask(script: &str, time_limit_s: f64) -> (PlanStatus, String, String) {
    let planner = ExternalPlanner {
        name: "shell".into(),
        command: ["sh", "-c", script].map(str::to_owned).to_vec(),
        folder: PathBuf::from("."),
        time_limit_s: Some(time_limit_s),
        in_loop: false,
    };
    let external = planner.plan(&scenario(), 3);
    let plan = external.answer.plan;
    assert_eq!((plan.planner.as_str(), plan.seed, plan.scenario.as_str()), ("shell", 3, "rendezvous-1"));
    (plan.status, plan.reason.unwrap_or_default(), external.log)
}

/// The command has no plan, and the reason says `what`.
#[track_caller]
fn assert_no_plan(script: &str, what: &str) {
    let (status, reason, _) = ask(script, 20.0);
    assert_eq!(status, PlanStatus::NoPlan, "{reason}");
    assert!(reason.contains(what), "`{what}` is missing in: {reason}");
}

/// A straight line, which the judge may think of what it likes.
const REPLY: &str = r#"{"protocol": 1, "status": "solved", "trajectories": [{"vehicle": "uav-1", "t_s": [0, 100, 200],
    "x_m": [2450, 5950, 9450], "y_m": [1750, 1750, 1750], "z_m": [400, 400, 400]}]}"#;

#[test]
fn a_reply_becomes_a_plan() {
    let (status, reason, log) = ask(&format!("cat > /dev/null; echo thinking >&2; echo '{REPLY}'"), 20.0);
    assert_eq!((status, reason.as_str(), log.as_str()), (PlanStatus::Solved, "", "thinking\n"));
}

#[test]
fn the_request_holds_what_a_planner_needs_and_nothing_of_the_disturbances() {
    let request = super::request::document(&scenario(), 3, 20.0);
    assert_eq!((&request["protocol"], &request["seed"]), (&1.into(), &3.into()));
    let vehicle = &request["vehicles"][0];
    assert_eq!(vehicle["limits"]["n_y"], serde_json::json!([-0.5, 0.5]));
    assert_eq!(vehicle["start"]["heading_rad"], 0.0);
    let steepest = vehicle["limits"]["flight_path_rad"][1].as_f64().unwrap();
    assert!((steepest - 12_f64.to_radians()).abs() < 1e-15);
    assert_eq!(request["world"]["cylinders"].as_array().unwrap().len(), 7);
    let text = request.to_string();
    assert!(!text.contains("wind") && !text.contains("mismatch") && !text.contains("_deg"), "{text}");
}

#[test]
fn the_request_for_a_slung_load_tells_the_model_and_not_what_disturbs_it() {
    let path = Path::new(env!("CARGO_MANIFEST_DIR")).join("scenarios/slung/rectangle.toml");
    let request = super::request::document(&scenarios::load(&path).expect("a shipped scenario"), 0, 20.0);
    let vehicle = &request["vehicles"][0];
    assert_eq!(vehicle["family"], "slung-load");
    assert!(vehicle["model"]["cable_length_m"].as_f64().is_some_and(|length_m| length_m > 0.0));
    assert_eq!(vehicle["start"]["load_position_m"].as_array().map(Vec::len), Some(3));
    assert!(request["world"]["prisms"].as_array().is_some_and(|prisms| !prisms.is_empty()));
    assert!(request["verdict"]["tracking_max_m"].as_f64().is_some(), "defaults are filled in");
    assert!(!request.to_string().contains("drag"));
}

#[test]
fn a_command_may_ignore_its_question() {
    let (status, ..) = ask(&format!("echo '{REPLY}'"), 20.0);
    assert_eq!(status, PlanStatus::Solved);
}

#[test]
fn what_goes_wrong_is_said() {
    assert_no_plan("exit 3", "it ended with exit code 3");
    assert_no_plan("echo 'Traceback' >&2; echo 'ValueError: no' >&2; exit 1", "planner.log: ValueError: no");
    assert_no_plan("kill -SEGV $$", "it crashed (signal: 11");
    assert_no_plan("true", "it wrote no reply");
    assert_no_plan("echo hello", "JSON syntax");
    assert_no_plan("echo iteration 1; echo '{}'", "only the reply belongs on standard output");
    assert_no_plan("printf '\\377\\376'", "no text (UTF-8)");
    assert_no_plan("echo '{}'", "no `protocol`");
    assert_no_plan(r#"echo '{"protocol": 2}'"#, "protocol version 2, this harness speaks version 1");
    assert_no_plan(r#"echo '{"protocol": 1, "trajectories": []}'"#, "its reply has no `status`");
    assert_no_plan(r#"echo '{"protocol": 1, "status": "no-plan", "reason": "too hard"}'"#, "too hard");
    assert_no_plan(r#"echo '{"protocol": 1, "status": "solved", "trajectories": []}'"#, "no row of `uav-1`");
    assert_no_plan(&format!("echo '{}'", REPLY.replace("100", "NaN")), "JSON has no NaN");
    assert_no_plan(&format!("echo '{}'", REPLY.replace("100", "300")), "t_s of uav-1: found 200 s after 300 s");
}

#[test]
fn a_program_that_is_not_there_is_a_reason_too() {
    let planner = ExternalPlanner {
        name: "missing".into(),
        command: vec!["no-such-program".into()],
        folder: PathBuf::from("."),
        time_limit_s: None,
        in_loop: false,
    };
    let reason = planner.plan(&scenario(), 0).answer.plan.reason.expect("a reason");
    assert!(reason.contains("cannot start `no-such-program`"), "{reason}");
}

#[test]
fn a_command_that_hangs_is_ended_with_everything_that_it_started() {
    let folder = tempfile::tempdir().unwrap();
    let mark = folder.path().join("alive");
    let script = format!("(sleep 3; touch {}) & sleep 1000", mark.display());
    let began = Instant::now();
    let (status, reason, _) = ask(&script, 0.5);
    assert_eq!(status, PlanStatus::NoPlan);
    assert!(reason.contains("longer than its limit of 0.5 s"), "{reason}");
    assert!(began.elapsed() < Duration::from_secs(100), "the limit was half a second");
    std::thread::sleep(Duration::from_secs(4));
    assert!(!mark.exists(), "what the command had started lived on");
}

#[test]
fn a_command_that_leaves_something_behind_is_not_waited_for() {
    let (status, ..) = ask(&format!("echo '{REPLY}'; sleep 1000 &"), 100.0);
    assert_eq!(status, PlanStatus::Solved);
}

#[test]
fn a_command_that_talks_without_end_fills_neither_memory_nor_pipe() {
    let (status, reason, log) = ask("yes >&2 & yes nonsense", 1.0);
    assert_eq!(status, PlanStatus::NoPlan);
    assert!(reason.contains("longer than its limit"), "{reason}");
    assert!(log.len() < 5 << 20, "{} bytes of log", log.len());
}

/// Replies with bytes flipped, cut and doubled: never a panic, and what is taken as a plan is one.
#[test]
fn damaged_replies_are_refused_or_sound() {
    let scenario = scenario();
    let mut refused = 0;
    for (round, text) in copies_of(REPLY, 2000).enumerate() {
        match super::reply::read(&text, &scenario, "shell", 0) {
            Err(_) => refused += 1,
            Ok(answer) if answer.plan.status == PlanStatus::NoPlan => refused += 1,
            Ok(answer) => {
                assert_eq!(answer.plan.trajectories.len(), 1, "round {round}: {text}");
                let times_s = answer.plan.trajectories[0].times_s();
                let whole = times_s.len() >= 2 && times_s.windows(2).all(|pair| pair[0] < pair[1]);
                assert!(whole && times_s.iter().all(|t_s| t_s.is_finite()), "round {round}: {text}");
            }
        }
    }
    assert!(refused > 1000, "only {refused} of 2000 damaged replies were refused");
}
