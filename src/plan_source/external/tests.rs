//! Whatever a command does, there is a reply in time, and none of its processes survives.

use std::path::{Path, PathBuf};
use std::time::{Duration, Instant};

use scenarios::{PlanStatus, Scenario};

use super::ExternalPlanner;
use crate::damage::copies_of;

fn scenario() -> Scenario {
    let path = Path::new(env!("CARGO_MANIFEST_DIR")).join("scenarios/fixed-wing/rendezvous-1.toml");
    scenarios::load(&path).expect("a shipped scenario")
}

/// Runs `script` in a shell as a planner. Returns status, reason and log.
fn plan_by(script: &str, time_limit_s: f64) -> (PlanStatus, String, String) {
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

/// The command has no plan, and the reason contains `expected`.
#[track_caller]
fn assert_no_plan(script: &str, expected: &str) {
    let (status, reason, _) = plan_by(script, 20.0);
    assert_eq!(status, PlanStatus::NoPlan, "{reason}");
    assert!(reason.contains(expected), "`{expected}` is missing in: {reason}");
}

/// A straight line.
const REPLY: &str = r#"{"protocol": 1, "status": "solved", "trajectories": [{"vehicle": "uav-1", "t_s": [0, 100, 200],
    "x_m": [2450, 5950, 9450], "y_m": [1750, 1750, 1750], "z_m": [400, 400, 400]}]}"#;

#[test]
fn a_reply_becomes_a_plan() {
    let (status, reason, log) = plan_by(&format!("cat > /dev/null; echo thinking >&2; echo '{REPLY}'"), 20.0);
    assert_eq!((status, reason.as_str(), log.as_str()), (PlanStatus::Solved, "", "thinking\n"));
}

#[test]
fn the_request_is_complete_and_holds_no_disturbances() {
    let mut request = super::request::document(&scenario(), 3, 20.0);
    assert_eq!(request["verdict"]["goal_heading_deg"], 5.0);
    assert_eq!((&request["protocol"], &request["seed"]), (&2.into(), &3.into()));
    let vehicle = &request["vehicles"][0];
    assert_eq!(vehicle["limits"]["n_y"], serde_json::json!([-0.5, 0.5]));
    assert_eq!(vehicle["start"]["heading_rad"], 0.0);
    let steepest = vehicle["limits"]["flight_path_rad"][1].as_f64().unwrap();
    assert!((steepest - 12_f64.to_radians()).abs() < 1e-15);
    assert_eq!(request["world"]["cylinders"].as_array().unwrap().len(), 7);
    // Apart from the limits of the judge, angles are in radians.
    request["verdict"].take();
    let text = request.to_string();
    assert!(!text.contains("wind") && !text.contains("mismatch") && !text.contains("_deg"), "{text}");
}

#[test]
fn the_request_for_a_slung_load_holds_the_model_without_disturbances() {
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

fn request_of(file: &str) -> serde_json::Value {
    let path = Path::new(env!("CARGO_MANIFEST_DIR")).join("scenarios").join(file);
    let scenario = scenarios::load(&path).expect("a shipped scenario");
    super::request::document(&scenario.planner_view(), 0, 20.0)
}

#[test]
fn the_request_holds_the_gates() {
    let gates = request_of("slung/gate.toml")["world"]["gates"].take();
    let gate = &gates.as_array().expect("a list of gates")[0];
    assert!(gate["name"].is_string() && gate["load"].is_object() && gate["quadrotor"].is_object(), "{gates}");
}

#[test]
fn the_request_holds_everything_that_is_known_before_the_flight() {
    for (file, key) in [
        ("fixed-wing/rendezvous-1.toml", "cylinders"),
        ("slung/rectangle.toml", "prisms"),
        ("multirotor/paper-map.toml", "prisms"),
    ] {
        let request = request_of(file);
        assert!(!request["world"][key].as_array().expect("a list").is_empty(), "{file}: {key}");
        let vehicle = &request["vehicles"][0];
        let model = if vehicle["model"].is_object() { &vehicle["model"] } else { vehicle };
        for field in ["mass_kg", "limits", "planning_limits"] {
            assert!(!model[field].is_null(), "{file}: {field} is missing in {vehicle}");
        }
    }
}

#[test]
fn a_command_may_ignore_its_request() {
    let (status, ..) = plan_by(&format!("echo '{REPLY}'"), 20.0);
    assert_eq!(status, PlanStatus::Solved);
}

#[test]
fn failures_have_a_reason() {
    assert_no_plan("exit 3", "it ended with exit code 3");
    assert_no_plan("echo 'Traceback' >&2; echo 'ValueError: no' >&2; exit 1", "planner.log: ValueError: no");
    assert_no_plan("kill -SEGV $$", "it crashed (signal: 11");
    assert_no_plan("true", "it wrote no reply");
    assert_no_plan("echo hello", "JSON syntax");
    assert_no_plan("echo iteration 1; echo '{}'", "standard output must hold the reply only");
    assert_no_plan("printf '\\377\\376'", "not valid UTF-8");
    assert_no_plan("echo '{}'", "no `protocol`");
    assert_no_plan(r#"echo '{"protocol": 3}'"#, "protocol version 3; expected 2");
    assert_no_plan(r#"echo '{"protocol": 1, "trajectories": []}'"#, "its reply has no `status`");
    assert_no_plan(r#"echo '{"protocol": 1, "status": "no-plan", "reason": "too hard"}'"#, "too hard");
    assert_no_plan(r#"echo '{"protocol": 1, "status": "solved", "trajectories": []}'"#, "no row of `uav-1`");
    assert_no_plan(&format!("echo '{REPLY}'; exit 3"), "it ended with exit code 3");
    let doubled = REPLY.replace("\"x_m\":", "\"x_m\": [0, 0, 0], \"x_m\":");
    assert_no_plan(&format!("echo '{doubled}'"), "the key `x_m` twice");
    let negative = REPLY.replace("\"solved\",", "\"solved\", \"timings\": {\"wall_s\": -1, \"distributed_s\": 0},");
    assert_no_plan(&format!("echo '{negative}'"), "timings.wall_s: found -1 s, expected 0 s or more");
    assert_no_plan(&format!("echo '{}'", REPLY.replace("100", "NaN")), "JSON has no NaN");
    assert_no_plan(&format!("echo '{}'", REPLY.replace("100", "300")), "t_s of uav-1: found 200 s after 300 s");
}

#[test]
fn a_missing_program_is_a_reason() {
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
fn a_command_that_hangs_is_terminated_with_its_process_group() {
    let folder = tempfile::tempdir().unwrap();
    let mark = folder.path().join("alive");
    let script = format!("(sleep 3; touch {}) & sleep 1000", mark.display());
    let began = Instant::now();
    let (status, reason, _) = plan_by(&script, 0.5);
    assert_eq!(status, PlanStatus::NoPlan);
    assert!(reason.contains("longer than its limit of 0.5 s"), "{reason}");
    assert!(began.elapsed() < Duration::from_secs(100), "the limit was half a second");
    std::thread::sleep(Duration::from_secs(4));
    assert!(!mark.exists(), "a process of the command survived");
}

#[test]
fn background_processes_are_not_waited_for() {
    let (status, ..) = plan_by(&format!("echo '{REPLY}'; sleep 1000 &"), 100.0);
    assert_eq!(status, PlanStatus::Solved);
}

#[test]
fn endless_output_fills_neither_memory_nor_pipe() {
    let (status, reason, log) = plan_by("yes >&2 & yes nonsense", 1.0);
    assert_eq!(status, PlanStatus::NoPlan);
    assert!(reason.contains("longer than its limit"), "{reason}");
    assert!(log.len() < 5 << 20, "{} bytes of log", log.len());
}

/// Replies with flipped, missing and duplicate bytes: never a panic, and every accepted plan is well-formed.
#[test]
fn damaged_replies_are_rejected_or_well_formed() {
    let scenario = scenario();
    let mut rejected = 0;
    for (round, text) in copies_of(REPLY, 2000).enumerate() {
        match super::reply::read(&text, &scenario, "shell", 0) {
            Err(_) => rejected += 1,
            Ok(answer) if answer.plan.status == PlanStatus::NoPlan => rejected += 1,
            Ok(answer) => {
                assert_eq!(answer.plan.trajectories.len(), 1, "round {round}: {text}");
                let times_s = answer.plan.trajectories[0].times_s();
                let whole = times_s.len() >= 2 && times_s.windows(2).all(|pair| pair[0] < pair[1]);
                assert!(whole && times_s.iter().all(|t_s| t_s.is_finite()), "round {round}: {text}");
            }
        }
    }
    assert!(rejected > 1000, "only {rejected} of 2000 damaged replies were rejected");
}

/// The same for in-loop replies. `FUZZ_ROUNDS=1000000` asks for a million copies of each.
#[test]
fn damaged_in_loop_replies_are_results_or_rejected_with_a_reason() {
    let rounds: usize = std::env::var("FUZZ_ROUNDS").ok().and_then(|it| it.parse().ok()).unwrap_or(2000);
    for original in [
        r#"{"id": 7, "fly": [{"t_s": 1.05, "position_m": [1, 1, 2], "velocity_mps": [0, 0, 0]},
            {"t_s": 2.5, "position_m": [2, 1, 2], "velocity_mps": [0, 0, 0]}]}"#,
        r#"{"id": 8, "keep": "nothing better"}"#,
    ] {
        assert!(super::protocol::read_replan(original).is_ok(), "{original}");
        let mut rejected = 0;
        for text in copies_of(original, rounds) {
            if let Err(reason) = super::protocol::read_replan(&text) {
                assert!(!reason.to_string().is_empty(), "{text}");
                rejected += 1;
            }
        }
        assert!(rejected > rounds / 4 && rejected < rounds, "{rejected} rejected: {original}");
    }
}
