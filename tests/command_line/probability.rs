//! `harness probability` and `harness ab-test`.

use crate::workplace::{PAIR, Workplace, code, shooting_pair, stderr, stdout};

const FOLDER: &str = "out/pair/parallel-scp";
const STRONG_WIND: [&str; 2] = ["--vary", "simulation.wind.mean_mps[0]=normal(0, 6)"];

/// The pair in a mean wind that the planner does not know.
fn windy() -> Workplace {
    let calm = "\n[simulation.wind]\nmean_mps = [0.0, 0.0, 0.0]\n";
    Workplace::new(&[("pair.toml", &(shooting_pair() + calm))])
}

fn probability(workplace: &Workplace, more: &[&str]) -> (i32, String) {
    let output = workplace.harness(&[&["probability", "pair.toml"][..], more].concat());
    (code(&output), stdout(&output) + &stderr(&output).replace("\n  │ ", " "))
}

#[test]
fn a_probability_does_not_depend_on_the_threads_and_its_likeliest_failure_can_be_flown_again() {
    let workplace = windy();
    let asked = ["--check", "flight.state_limits", "--runs", "2", "--particles", "6", "--at-most", "1e-6"];
    let estimate = |out: &str, jobs: &str| {
        let (code, said) = probability(&workplace, &[&STRONG_WIND[..], &asked, &["-o", out, "-j", jobs]].concat());
        assert_eq!(code, 1, "{said}");
        assert!(
            said.contains("at most 1e-6: no") && said.contains("likeliest failure met: flight.state_limits -"),
            "{said}"
        );
        workplace.json(&format!("{out}/pair/parallel-scp/probability.json"))
    };
    let found = estimate("out", "1");
    assert_eq!(estimate("two", "2"), found);
    let [lower, estimate, upper] = ["lower", "estimate", "upper"].map(|key| found[key].as_f64().unwrap());
    assert!(0.0 < lower && lower < estimate && estimate < upper && upper <= 1.0, "{found}");
    assert_eq!(found["is_at_most"], "no");
    let flights: u64 = found["runs"].as_array().unwrap().iter().map(|run| run["flights"].as_u64().unwrap()).sum();
    assert_eq!(found["flights"], flights);

    let scenario = format!("{FOLDER}/failures/pair-likeliest-failure.toml");
    let output = workplace.harness(&["run", &scenario, "--record", "none", "-q", "-o", "again"]);
    assert_eq!(code(&output), 1, "{}", stderr(&output));
    let report = workplace.json("again/pair-likeliest-failure/parallel-scp/report.json");
    let check = report["checks"].as_array().unwrap().iter().find(|it| it["name"] == "flight.state_limits").unwrap();
    assert_eq!(check["margin"], found["likeliest"]["margin"]);
}

/// The plain draws of the same distribution: the two intervals overlap.
#[test]
fn splitting_and_plain_draws_agree_on_a_scenario() {
    let workplace = windy();
    let interval = |more: &[&str]| {
        let check = ["--check", "flight.state_limits"];
        let (code, said) = probability(&workplace, &[&STRONG_WIND[..], &check, more].concat());
        assert_eq!(code, 0, "{said}");
        let found = workplace.json(&format!("{FOLDER}/probability.json"));
        ["lower", "upper"].map(|key| found[key].as_f64().unwrap())
    };
    let [split, plain] =
        [&["--runs", "3", "--particles", "12"][..], &["--method", "monte-carlo", "-n", "150"]].map(interval);
    assert!(split[0] <= plain[1] && plain[0] <= split[1], "{split:?} {plain:?}");
    assert!(plain[0] > 0.0 && split[0] > 0.0);
}

#[test]
fn a_probability_that_is_small_enough_passes_and_one_that_is_not_decided_does_not() {
    let workplace = windy();
    let breeze = ["--vary", "simulation.wind.mean_mps[0]=normal(0, 0.1)", "--method", "monte-carlo", "-n", "20"];
    let (code, said) = probability(&workplace, &[&breeze[..], &["--at-most", "0.2"]].concat());
    assert!(code == 0 && said.contains("at most 2e-1: yes") && said.contains("no failure was met"), "{said}");
    let (code, said) = probability(&workplace, &[&breeze[..], &["--at-most", "0.01"]].concat());
    assert!(code == 1 && said.contains("at most 1e-2: undecided"), "{said}");
    assert!(!workplace.path(format!("{FOLDER}/failures/pair-likeliest-failure.toml")).exists());
}

#[test]
fn wrong_distributions_fields_and_questions_are_refused() {
    let workplace = windy();
    let vary = ["--vary", "simulation.wind.mean_mps[0]=normal(0, 1)"];
    for (arguments, wanted) in [
        (&[][..], "--vary"),
        (&["--vary", "simulation.wind.mean_mps[0]=gauss(0, 1)"], "weibull(SHAPE, SCALE)"),
        (&["--vary", "simulation.wind.mean_mps[0]=normal(0, -1)"], "above 0"),
        (&["--vary", "simulation.wind.mean_mps[7]=normal(0, 1)"], "there is no such number in the file"),
        (&[vary[0], vary[1], "--at-most", "1.5"], "a probability above 0 and below 1"),
        (&[vary[0], vary[1], "--confidence", "100"], "from 50 to below 100"),
        (&[vary[0], vary[1], "--check", "flight.clearence"], "did you mean `flight.clearance`?"),
        (&["--vary", "vehicles[0].start.x_m=1e9..2e9", "-n", "20"], "nothing was judged"),
    ] {
        let (code, said) = probability(&workplace, arguments);
        assert!(code == 2 && said.contains(wanted), "{arguments:?}: {code} {said}");
    }
    assert!(!workplace.path("out").exists());
}

/// The trapezoid rule leaves defects between the nodes that multiple shooting does not.
#[test]
fn the_better_of_two_settings_is_found_in_either_order() {
    let workplace = Workplace::new(&[("rough/pair.toml", PAIR), ("fine/pair.toml", &shooting_pair())]);
    let test = |a: &str, b: &str, out: &str| {
        let output = workplace.harness(&["ab-test", a, b, "--check", "plan.rollout", "-o", out, "-n", "40"]);
        (code(&output), stdout(&output), workplace.json(&format!("{out}/pair/parallel-scp/ab-test.json")))
    };
    let (exit, said, found) = test("rough/pair.toml", "fine/pair.toml", "better");
    assert!(exit == 0 && said.contains("B is better: plan.rollout +"), "{said}");
    let reverse = test("fine/pair.toml", "rough/pair.toml", "worse");
    assert!(reverse.0 == 1 && reverse.1.contains("B is worse: plan.rollout -"), "{}", reverse.1);
    assert_eq!(found["median"].as_f64().unwrap(), -reverse.2["median"].as_f64().unwrap());
    assert_eq!(found["unit"], "m");
    // Nothing random acts on this pair: the smallest number of equal differences that decides.
    assert!(found["pairs"] == 8 && said.contains("nothing random acts on the flights"), "{said}");
}

#[test]
fn a_planner_is_equivalent_to_itself_and_one_system_is_no_comparison() {
    let workplace = Workplace::new(&[("pair.toml", &shooting_pair())]);
    let twice = ["-p", "parallel-scp", "-p", "parallel-scp"];
    let output = workplace.harness(&[&["ab-test", "pair.toml", "-n", "12"][..], &twice].concat());
    assert_eq!(code(&output), 0, "{}{}", stdout(&output), stderr(&output));
    assert!(stdout(&output).contains("B is equivalent within 0.000"), "{}", stdout(&output));
    for (more, wanted) in [
        (&[][..], "expected two systems to compare"),
        (&["-p", "a", "-p", "b"], "there is no planner of that name"),
        (&["-p", "fleet-scp", "-p", "fleet-scp", "-p", "fleet-scp"], "found 3 planners"),
        (&["-p", "fleet-scp", "--alpha", "0"], "a probability from 1e-9 to 0.5"),
        (&["-p", "fleet-scp", "--tolerance=-1"], "a difference >= 0"),
    ] {
        let output = workplace.harness(&[&["ab-test", "pair.toml"][..], more].concat());
        let said = stderr(&output).replace("\n  │ ", " ");
        assert!(code(&output) == 2 && said.contains(wanted), "{more:?}: {said}");
    }
}
