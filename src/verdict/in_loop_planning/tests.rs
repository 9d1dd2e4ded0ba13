use scenarios::in_loop::{ReplanDiagnostics, ReplanStatus};
use scenarios::{Planning, PlanningClock};
use sim::Replan;

use super::Turns;

const STEP_S: f64 = 0.02;

/// A result that is requested at 1 s, ready at `ready_s` and flown from `takes_effect_s` on.
fn replan(ready_s: f64, takes_effect_s: f64, outcome: ReplanStatus) -> Replan {
    Replan {
        vehicle: 0,
        asked_s: 1.0,
        ready_s,
        takes_effect_s,
        outcome,
        nodes: Vec::new(),
        diagnostics: ReplanDiagnostics::default(),
        discovered: Vec::new(),
        wall_s: 0.0,
    }
}

/// A period of 0.25 s, a deadline of 0.05 s: on the steps of 0.02 s a result is due 0.06 s after the request.
fn settings(time: PlanningClock, median_s: f64) -> Planning {
    Planning { time, median_s, recorded_s: vec![0.03, 0.07], ..Planning::default() }
}

fn defect(settings: &Planning, replan: &Replan) -> Option<String> {
    Turns { settings, step_s: STEP_S }.result_defect(replan)
}

#[track_caller]
fn assert_defect(settings: &Planning, replan: &Replan, expected: &str) {
    let found = defect(settings, replan).expect("a defect");
    assert!(found.contains(expected), "`{expected}` is missing in: {found}");
}

#[test]
fn a_result_is_flown_on_the_step_at_which_it_is_due() {
    let quick = settings(PlanningClock::Modelled, 0.01);
    assert_eq!(defect(&quick, &replan(1.01, 1.06, ReplanStatus::InTime)), None);
    for early_or_late_s in [1.04, 1.05, 1.08] {
        assert_defect(&quick, &replan(1.01, early_or_late_s, ReplanStatus::InTime), "was due at 1.060 s");
    }
    // 0.09 s of planning end on the step at 1.10 s, 0.04 s late.
    let slow = settings(PlanningClock::Modelled, 0.09);
    let late = |by_s| ReplanStatus::Late { by_s };
    assert_eq!(defect(&slow, &replan(1.09, 1.1, late(1.1 - 1.06))), None);
    assert_defect(&slow, &replan(1.09, 1.06, late(0.04)), "was due at 1.100 s");
    for outcome in [ReplanStatus::InTime, late(0.0), late(0.02), late(0.06)] {
        assert_defect(&slow, &replan(1.09, 1.1, outcome), "was 0.040 s late");
    }
    assert_defect(&quick, &replan(1.01, 1.06, late(0.0)), "was 0.000 s late");
}

#[test]
fn a_result_takes_the_time_that_the_scenario_prescribes() {
    let modelled = settings(PlanningClock::Modelled, 0.01);
    assert_defect(&modelled, &replan(1.02, 1.06, ReplanStatus::InTime), "took 0.020 s");
    let spread = Planning { spread: 0.5, ..modelled };
    assert_eq!(defect(&spread, &replan(1.02, 1.06, ReplanStatus::InTime)), None);
    assert_defect(&spread, &replan(1.0, 1.06, ReplanStatus::InTime), "took 0.000 s");
    let recorded = settings(PlanningClock::Recorded, 0.01);
    assert_eq!(defect(&recorded, &replan(1.03, 1.06, ReplanStatus::InTime)), None);
    assert_defect(&recorded, &replan(1.01, 1.06, ReplanStatus::InTime), "took 0.010 s");
}
