//! The report page, as text and in a browser.

use std::fs;
use std::path::Path;
use std::process::Command;

use serde_json::Value;

use crate::workplace::{PAIR, Workplace, code, shooting_pair, skip_without, stderr};

/// A page about one run with everything on it: it passes, or fails for its tracking limit.
fn page_of(scenario: &str, arguments: &[&str]) -> (Workplace, Value) {
    let workplace = Workplace::new(&[("pair.toml", scenario)]);
    let output = workplace.harness(&[&["run", "pair.toml", "-q", "--record", "none", "--html"], arguments].concat());
    assert!(code(&output) < 2, "{}", stderr(&output));
    let report = workplace.json("out/pair/parallel-scp/report.json");
    (workplace, report)
}

fn failing() -> String {
    PAIR.to_owned() + "\n[simulation]\nwind = { mean_mps = [0, 5, 0] }\n[verdict]\ntracking_max_m = 0.001\n"
}

/// What a reader sees of the page, by tests/browser/page.mjs; `None` without a browser.
fn seen(workplace: &Workplace, check: &str) -> Option<Value> {
    let root = Path::new(env!("CARGO_MANIFEST_DIR"));
    let is_there = root.join("tests/browser/node_modules/playwright-core").is_dir()
        && Path::new("/usr/bin/chromium").exists()
        && Command::new("node").arg("--version").output().is_ok_and(|output| output.status.success());
    if !is_there {
        skip_without("chromium, node and `npm ci --prefix tests/browser`");
        return None;
    }
    let page = workplace.path("out/index.html");
    let output = Command::new("node").arg(root.join("tests/browser/page.mjs")).arg(page).arg(check).output().unwrap();
    assert!(output.status.success(), "{}", stderr(&output));
    Some(serde_json::from_slice(&output.stdout).unwrap())
}

fn at_s(report: &Value, check: &str) -> f64 {
    let checks = report["checks"].as_array().unwrap();
    checks.iter().find(|it| it["name"] == check).and_then(|it| it["at_s"].as_f64()).expect(check)
}

#[test]
fn the_page_opens_on_the_closest_approach_and_shows_what_the_report_says() {
    let (workplace, report) = page_of(&shooting_pair(), &[]);
    let Some(seen) = seen(&workplace, "flight.tracking_max") else { return };
    assert_eq!(seen["verdict"], "PASS");
    assert!(seen["title"].as_str().unwrap().starts_with("1 passed: pair"), "{seen}");
    assert_eq!(seen["start_s"].as_f64(), Some(at_s(&report, "flight.separation")), "{seen}");
    assert_eq!(seen["clicked_s"].as_f64(), Some(at_s(&report, "flight.tracking_max")), "{seen}");
    assert_eq!((&seen["slid_s"], &seen["output"], &seen["moved"]), (&1.5.into(), &"1.50 s".into(), &true.into()));
    assert!(seen["inked"].as_u64() > Some(500) && seen["played_s"].as_f64() > Some(0.1), "{seen}");
    let checks = report["checks"].as_array().unwrap();
    let passed = checks.iter().filter(|check| check["status"] == "pass").count();
    assert_eq!((seen["rows"].as_u64(), seen["passed_rows"].as_u64()), (Some(checks.len() as u64), Some(passed as u64)));
    assert_eq!(seen["is_sorted"], true);
    assert!(seen["plots"].as_u64() >= Some(7) && seen["pdf_bytes"].as_u64() > Some(50_000), "{seen}");
    assert_eq!(seen["phone_width"], 390, "the page is wider than a phone");
}

#[test]
fn the_page_of_a_failed_run_opens_on_the_first_failure_and_lists_it_first() {
    let (workplace, report) = page_of(&failing(), &["--waterfall"]);
    let Some(seen) = seen(&workplace, "flight.tracking_max") else { return };
    assert_eq!(seen["verdict"], "FAIL");
    let checks = report["checks"].as_array().unwrap();
    let bad = |check: &&Value| check["status"] == "fail" || check["status"] == "undecided";
    let failures = checks.iter().filter(bad).filter(|check| check["name"].as_str().unwrap().starts_with("flight."));
    let first_s = failures.filter_map(|check| check["at_s"].as_f64()).reduce(f64::min);
    assert_eq!(seen["start_s"].as_f64(), first_s, "{seen}");
    let first = checks.iter().find(|check| check["name"] == seen["first_row"]).unwrap();
    assert_eq!(first["status"], "fail", "{seen}");
}

/// Nothing is loaded from elsewhere, and the page is the same whenever it is written.
#[test]
fn the_page_is_complete_in_itself_and_can_be_written_afterwards() {
    let (workplace, _) = page_of(PAIR, &[]);
    let page = fs::read_to_string(workplace.path("out/index.html")).unwrap();
    for elsewhere in ["<link rel=\"stylesheet", "src=\"http", "href=\"http", "import "] {
        assert!(!page.contains(elsewhere), "`{elsewhere}` in the page");
    }
    assert!(page.contains("uPlot") && page.contains("id=\"scene-1\"") && page.contains("flight.separation"));
    assert!(page.len() < 1_000_000, "{} bytes", page.len());
    fs::remove_file(workplace.path("out/index.html")).unwrap();
    assert_eq!(code(&workplace.harness(&["report", "out", "-q"])), 0);
    assert_eq!(fs::read_to_string(workplace.path("out/index.html")).unwrap(), page);
}

#[test]
fn a_folder_without_results_is_bad_input() {
    let workplace = Workplace::new(&[("empty/nothing.txt", "")]);
    let output = workplace.harness(&["report", "empty"]);
    assert_eq!(code(&output), 2);
    assert!(stderr(&output).contains("empty: found neither summary.json"), "{}", stderr(&output));
    assert!(!workplace.path("empty/index.html").exists());
}

/// A comparison shows the old result beside the new one.
#[test]
fn the_page_of_a_comparison_holds_both_runs() {
    let workplace = Workplace::new(&[("pair.toml", PAIR)]);
    workplace.harness(&["run", "pair.toml", "-q", "--record", "page", "-o", "old"]);
    fs::write(workplace.path("pair.toml"), PAIR.replace("separation_m = 100", "separation_m = 120")).unwrap();
    workplace.harness(&["run", "pair.toml", "-q", "--record", "page", "-o", "new"]);
    assert_eq!(code(&workplace.harness(&["compare", "old", "new", "--html"])), 1);
    let page = fs::read_to_string(workplace.path("new/index.html")).unwrap();
    assert!(
        page.contains("id=\"scene-2\"") && page.contains("margin of flight.separation"),
        "both scenes are in the page"
    );
    assert_eq!(workplace.json("new/comparison.json")["counts"], "1 result compared: 5 worse, 0 better");
}

/// Two machines ran two scenarios: the merged folder is that of one run of both, with its exit code.
#[cfg(feature = "parquet")]
#[test]
fn result_folders_merge() {
    let other = failing().replace("\"pair\"", "\"other\"");
    let workplace = Workplace::new(&[("pair.toml", PAIR), ("other.toml", &other)]);
    workplace.harness(&["run", "pair.toml", "-q", "--record", "page", "-o", "one"]);
    workplace.harness(&["run", "other.toml", "-q", "--record", "page", "-o", "two"]);
    assert_eq!(code(&workplace.harness(&["merge", "one", "two", "-o", "all", "--html", "-q"])), 1);
    let names = ["index.html", "junit.xml", "other", "pair", "summary.json", "summary.md"];
    assert_eq!(workplace.files("all"), names);
    let junit = fs::read_to_string(workplace.path("all/junit.xml")).unwrap();
    assert!(junit.contains("pair · parallel-scp") && junit.contains("other · parallel-scp"), "{junit}");
    assert!(fs::read_to_string(workplace.path("all/summary.md")).unwrap().starts_with("# 1 failed, 1 passed"));
    let output = workplace.harness(&["merge", "one", "all", "-o", "twice"]);
    assert_eq!(code(&output), 2);
    assert!(stderr(&output).contains("pair/parallel-scp is also in one"), "{}", stderr(&output));
}

/// The samples of a sweep and the levels of a stress test are on the page.
#[cfg(feature = "parquet")]
#[test]
fn campaigns_have_a_page_too() {
    let workplace = Workplace::new(&[("pair.toml", PAIR)]);
    let output = workplace.harness(&["sweep", "pair.toml", "-n", "6", "--html", "-q"]);
    assert!(code(&output) < 2, "{}", stderr(&output));
    let output = workplace.harness(&["stress", "pair.toml", "--over", "noise", "--html", "-q"]);
    assert!(code(&output) < 2, "{}", stderr(&output));
    let page = fs::read_to_string(workplace.path("out/index.html")).unwrap();
    for part in [
        "\"kind\":\"sweep\"",
        "\"kind\":\"stress\"",
        "standard deviation of the measured position [m]",
        "\"margins\":[[",
    ] {
        assert!(page.contains(part), "`{part}` is missing");
    }
}

/// The flight of an earlier run is in a recording beside the new one, and in no table.
#[cfg(feature = "rrd")]
#[test]
fn an_earlier_flight_is_shown_as_a_ghost() {
    let workplace = Workplace::new(&[("pair.toml", PAIR)]);
    workplace.harness(&["run", "pair.toml", "-q", "-o", "old"]);
    let size = |out: &str| fs::metadata(workplace.path(out).join("pair/parallel-scp/flight.rrd")).unwrap().len();
    let output = workplace.harness(&["run", "pair.toml", "-q", "-o", "new", "--ghost", "old"]);
    assert_eq!(code(&output), 0, "{}", stderr(&output));
    assert!(size("new") > size("old") + 5_000, "{} and {} bytes", size("new"), size("old"));
    let scene = workplace.json("new/pair/parallel-scp/scene.json");
    assert!(scene["bodies"].as_array().unwrap().iter().all(|body| body["kind"] == "vehicle"));
}

/// Every figure of the list is written and shows something.
#[test]
fn the_papers_figures_are_drawn() {
    let workplace = Workplace::new(&[]);
    let output = workplace.harness(&["figures", "--quick", "-q", "-o", "drawn", "--html"]);
    assert_eq!(code(&output), 0, "{}", stderr(&output));
    let names: Vec<String> = harness::campaign::figures::names().iter().map(|name| format!("{name}.svg")).collect();
    assert_eq!(workplace.files("drawn/figures"), names);
    let list = fs::read_to_string(workplace.path("drawn/papers.md")).unwrap();
    for name in names {
        let svg = fs::read_to_string(workplace.path("drawn/figures").join(&name)).unwrap();
        assert!(svg.contains("<polyline") || svg.contains("<path"), "{name} is empty: {svg}");
        assert!(list.contains(&name), "{name} is not on the page");
    }
    assert!(workplace.path("drawn/index.html").exists());
}

/// What a picture has to show depends on the run: the open-loop path where it ends elsewhere, the wind where there is any.
#[test]
fn the_scene_holds_the_open_loop_path_and_the_wind_only_where_they_differ_from_nothing() {
    let kinds = |scenario: &str, list: &str| -> Vec<String> {
        let workplace = Workplace::new(&[("pair.toml", scenario)]);
        workplace.harness(&["run", "pair.toml", "-q", "--record", "page"]);
        let scene = workplace.json("out/pair/parallel-scp/scene.json");
        let items = scene[list].as_array().unwrap();
        items.iter().map(|item| item["path"][0].as_str().unwrap().to_owned()).collect()
    };
    let strict = PAIR.to_owned() + "\n[verdict]\nrollout_m = 0.5\n";
    let has = |kinds: &[String], kind: &str| kinds.iter().any(|it| it == kind);
    assert!(has(&kinds(&strict, "items"), "open_loop") && !has(&kinds(PAIR, "items"), "open_loop"));
    assert!(has(&kinds(&failing(), "animations"), "wind") && !has(&kinds(PAIR, "animations"), "wind"));
}
