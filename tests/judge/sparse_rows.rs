//! Between sparse rows a vehicle may do anything that its limits allow; where that includes a collision, nothing passes.

use harness::plan_source::plan_import::complete;
use harness::verdict::{Check, Status, Verdict, judge_imported};
use scenarios::fixed_wing::{Control, State, states_from_velocities};
use scenarios::plan_input::parse_csv;
use scenarios::{Cylinder, Scenario};
use sim::fixed_wing::{Knot, propagate};

const PAIR: &str = include_str!("../scenarios/pair.toml");
const SPEED_MPS: f64 = 35.0;

/// A single aircraft with a long map and no goal in time.
fn scenario() -> Scenario {
    let mut scenario = scenarios::parse("pair.toml", PAIR).expect("the smallest fleet");
    scenario.vehicles.truncate(1);
    scenario.fleet.simultaneous_arrival = false;
    scenario.world.map.x_m = scenarios::Range::new(-500.0, 4000.0);
    scenario
}

/// Straight flight for `lead_s`, then a swerve to the left and back within `swerve_s` at the largest side force, then straight
/// flight again: the motion of an author, every 0.05 s or more often.
fn swerve(lead_s: f64, swerve_s: f64) -> Vec<Knot> {
    let quarter_s = swerve_s / 4.0;
    let legs = [(lead_s, 0.0), (quarter_s, 0.5), (2.0 * quarter_s, -0.5), (quarter_s, 0.5), (lead_s, 0.0)];
    let mut state = State::from_array([0.0, -100.0, 400.0, SPEED_MPS, 0.0, 0.0]);
    let mut knots: Vec<Knot> = Vec::new();
    let mut t_s = 0.0;
    for (duration_s, n_y) in legs {
        let control = Control { n_x: 0.0, n_y, n_z: 1.0 };
        let flown = propagate(&state, [control, control], t_s, duration_s, 0.05);
        let end = flown[flown.len() - 1];
        state = states_from_velocities(&[end.position_m.into()], &[end.velocity_mps.into()])[0];
        t_s += duration_s;
        knots.pop();
        knots.extend(flown);
    }
    knots
}

fn csv<'a>(knots: impl Iterator<Item = &'a Knot>, with_velocities: bool) -> String {
    let header = if with_velocities { "t_s,x_m,y_m,z_m,vx_mps,vy_mps,vz_mps" } else { "t_s,x_m,y_m,z_m" };
    let lines = knots.map(|Knot { t_s, position_m: p, velocity_mps: v }| {
        let velocity = if with_velocities { format!(",{},{},{}", v.x, v.y, v.z) } else { String::new() };
        format!("{t_s},{},{},{}{velocity}", p.x, p.y, p.z)
    });
    std::iter::once(header.to_owned()).chain(lines).collect::<Vec<_>>().join("\n")
}

fn verdict(scenario: &Scenario, text: &str) -> Verdict {
    let (header, tracks) = parse_csv("plan.csv", text, scenario).expect("a table");
    let completed = complete(scenario, header, tracks, "theirs", 0);
    let flight = sim::fly(scenario, &completed.plan, 0, &mut |_| {});
    judge_imported(scenario, &completed.plan, &completed.provenance, Some(&flight))
}

/// The swerve of `swerve_s`, with an obstacle that the author's motion enters by 3 m in the middle of it, and the rows that
/// `is_row` leaves.
fn entered(swerve_s: f64, with_velocities: bool, is_row: impl Fn(f64) -> bool) -> Verdict {
    let motion = swerve(10.0, swerve_s);
    let middle = motion.iter().min_by(|a, b| {
        let off_s = |knot: &Knot| (knot.t_s - 10.0 - swerve_s / 2.0).abs();
        off_s(a).total_cmp(&off_s(b))
    });
    let middle = middle.expect("a motion").position_m;
    let mut scenario = scenario();
    let end = motion[motion.len() - 1];
    (scenario.vehicles[0].goal.x_m, scenario.vehicles[0].goal.y_m) = (end.position_m.x, end.position_m.y);
    let center_m = [middle.x, middle.y + 60.0 - 3.0];
    scenario.world.cylinders = vec![Cylinder { name: "tower".to_owned(), center_m, radius_m: 60.0 }];
    let last_s = end.t_s;
    let rows = motion.iter().filter(|knot| knot.t_s == last_s || is_row(knot.t_s));
    verdict(&scenario, &csv(rows, with_velocities))
}

fn clearances(verdict: &Verdict) -> [&Check; 2] {
    ["plan.clearance", "flight.clearance"].map(|name| verdict.check(name).expect("a check"))
}

fn is_multiple(t_s: f64, step_s: f64) -> bool {
    (t_s / step_s - (t_s / step_s).round()).abs() < 1e-6
}

#[test]
fn what_may_hide_between_sparse_rows_does_not_pass() {
    for (swerve_s, with_velocities) in [(5.0, false), (5.0, true), (10.0, false), (10.0, true)] {
        // Rows at the ends of the swerve, and before and after it at the same spacing.
        let sparse = entered(swerve_s, with_velocities, |t_s| is_multiple(t_s - 10.0, swerve_s));
        for check in clearances(&sparse) {
            assert_ne!(check.status, Status::Pass, "{swerve_s} s, velocities {with_velocities}: {check:?}");
        }
        let dense = entered(swerve_s, with_velocities, |t_s| is_multiple(t_s, 0.1));
        let [planned, _] = clearances(&dense);
        assert_eq!(planned.status, Status::Fail, "{swerve_s} s, velocities {with_velocities}: {planned:?}");
        assert!(dense.failed_checks().contains(&"flight.crash".to_owned()), "{:?}", dense.failed_checks());
    }
}

/// Rows every 0.25 s, and none during a swerve of 4 s: nineteen rows are missing.
#[test]
fn what_may_hide_in_a_gap_between_dense_rows_does_not_pass() {
    let gap = entered(4.0, false, |t_s| is_multiple(t_s, 0.25) && !(10.01..13.99).contains(&t_s));
    for check in clearances(&gap) {
        assert_ne!(check.status, Status::Pass, "{check:?}");
    }
}

/// The allowance between rows is no larger than necessary: a few centimetres for rows 0.2 s apart.
#[test]
fn dense_rows_cost_centimetres() {
    let mut scenario = scenario();
    let rows = swerve(10.0, 4.0);
    let end = rows[rows.len() - 1];
    (scenario.vehicles[0].goal.x_m, scenario.vehicles[0].goal.y_m) = (end.position_m.x, end.position_m.y);
    let tower = Cylinder { name: "tower".to_owned(), center_m: [400.0, -170.0], radius_m: 60.0 };
    scenario.world.cylinders = vec![tower];
    let last_s = end.t_s;
    let text = csv(rows.iter().filter(|knot| knot.t_s == last_s || is_multiple(knot.t_s, 0.2)), false);
    let verdict = verdict(&scenario, &text);
    for check in clearances(&verdict) {
        let (lower, upper) = (check.lower.expect("a bound"), check.upper.expect("a bound"));
        assert!(check.status == Status::Pass && upper - lower < 0.12, "{check:?}");
    }
}
