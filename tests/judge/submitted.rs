//! Damaged plan files are completed, flown and judged without a panic or a hang, and none passes wrongly.

use harness::plan_source::plan_import::complete;
use harness::verdict::{Outcome, is_flyable, judge_imported};
use scenarios::plan_input::parse_csv;
use scenarios::{Plan, Scenario};

use crate::damage;

const PAIR: &str = include_str!("../scenarios/pair.toml");
const ROUNDS: usize = 3000;

/// Both aircraft straight ahead at constant speed, a row per quarter of a second: positions only.
fn table() -> String {
    let row = |(name, y): (&str, f64), k: i32| {
        let share = f64::from(k) / 112.0;
        format!("{name},{},{},{y},400\n", share * 1000.0 / 35.0, share * 1000.0)
    };
    let vehicles = [("uav-1", -100.0), ("uav-2", 100.0)];
    let rows = vehicles.into_iter().flat_map(|vehicle| (0..=112).map(move |k| row(vehicle, k)));
    "vehicle,t_s,x_m,y_m,z_m\n".to_owned() + &rows.collect::<String>()
}

fn verdict_of(text: &str, scenario: &Scenario) -> Option<(Plan, Outcome)> {
    let (header, tracks) = parse_csv("plan.csv", text, scenario).ok()?;
    let answer = complete(scenario, header, tracks, "theirs", 0);
    let flight = is_flyable(scenario, &answer.plan).is_ok().then(|| sim::fly(scenario, &answer.plan, 0, &mut |_| {}));
    let verdict = judge_imported(scenario, &answer.plan, &answer.provenance, flight.as_ref());
    Some((answer.plan, verdict.outcome))
}

#[test]
fn the_undamaged_plan_passes() {
    let scenario = scenarios::parse("pair.toml", PAIR).expect("the smallest fleet");
    assert_eq!(verdict_of(&table(), &scenario).expect("a plan").1, Outcome::Pass);
}

#[test]
fn damaged_plans_are_judged_and_those_that_pass_still_lead_to_the_goals() {
    let scenario = scenarios::parse("pair.toml", PAIR).expect("the smallest fleet");
    let (mut judged, mut failed) = (0, 0);
    for text in damage::copies_of(&table(), ROUNDS) {
        let Some((plan, outcome)) = verdict_of(&text, &scenario) else { continue };
        judged += 1;
        failed += usize::from(outcome != Outcome::Pass);
        if outcome == Outcome::Pass {
            for (trajectory, vehicle) in plan.trajectories.iter().zip(&scenario.vehicles) {
                let (end, goal) = (trajectory.fixed_wing().states[trajectory.node_count() - 1], &vehicle.goal);
                let off_m = (end.x_m - goal.x_m).hypot(end.y_m - goal.y_m).hypot(end.z_m - goal.z_m);
                assert!(off_m < 10.0, "{off_m} m from the goal, and it passes:\n{text}");
            }
        }
    }
    assert!(judged > ROUNDS / 50 && failed > 10, "{judged} judged, {failed} of them failed");
}
