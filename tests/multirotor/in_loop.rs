//! Flights that are planned in the loop: by a planner that flies straight to the goal and stops, and by planners that
//! return nonsense.

use harness::plan_source::in_loop::as_plan;
use harness::verdict::{Check, Outcome, Status, Verdict, judge};
use scenarios::in_loop::{InLoopPlanner, Node, Observation, PlannerRemarks, ReplanResult};
use scenarios::{Plan, PlanStatus, Scenario};
use sim::{EventKind, Flight, fly};

use crate::case::scenario;

/// Flies to its goal at 1 m/s and stops there: the simplest planner that works.
struct Straight {
    goal_m: [f64; 3],
}

impl InLoopPlanner for Straight {
    fn replan(&mut self, observation: &Observation<'_>) -> ReplanResult {
        let (from_m, t_s) = (observation.position_m, observation.takes_effect_s);
        let way_m: [f64; 3] = std::array::from_fn(|axis| self.goal_m[axis] - from_m[axis]);
        let length_m = way_m.iter().map(|x| x * x).sum::<f64>().sqrt();
        if length_m < 0.05 || observation.in_force.len() > 1 {
            return ReplanResult::keep("on the way");
        }
        // Accelerating to 1 m/s in 1 s and braking in 1 s cover 1 m; the rest is flown at 1 m/s.
        let at = |t_s: f64, share: f64, speed_mps: f64| Node {
            t_s,
            position_m: std::array::from_fn(|axis| from_m[axis] + share * way_m[axis]),
            velocity_mps: way_m.map(|x| x / length_m * speed_mps),
        };
        let cruise_s = length_m - 1.0;
        ReplanResult::fly(vec![
            at(t_s, 0.0, 0.0),
            at(t_s + 1.0, 0.5 / length_m, 1.0),
            at(t_s + 1.0 + cruise_s, 1.0 - 0.5 / length_m, 1.0),
            at(t_s + 2.0 + cruise_s, 1.0, 0.0),
        ])
    }
}

/// Returns the same result every time.
struct Stubborn(fn(&Observation<'_>) -> ReplanResult);

impl InLoopPlanner for Stubborn {
    fn replan(&mut self, observation: &Observation<'_>) -> ReplanResult {
        (self.0)(observation)
    }
}

fn flown(scenario: &Scenario, planner: impl Fn(usize) -> Box<dyn InLoopPlanner>) -> (Plan, Flight, Verdict) {
    let planners: Vec<Box<dyn InLoopPlanner>> = (0..scenario.vehicles.len()).map(planner).collect();
    let flight = fly(scenario, planners, 5, &mut |_| {});
    let plan = as_plan(scenario, "by-hand", 5, flight.planning.as_ref().expect("a log of the planning"));
    let verdict = judge(scenario, &plan, Some(&flight));
    (plan, flight, verdict)
}

fn straight(scenario: &Scenario) -> (Plan, Flight, Verdict) {
    let goals: Vec<[f64; 3]> = scenario.vehicles.iter().map(|vehicle| vehicle.goal.position_m()).collect();
    flown(scenario, |index| Box::new(Straight { goal_m: goals[index] }))
}

fn check<'v>(verdict: &'v Verdict, name: &str) -> &'v Check {
    verdict.checks.iter().find(|check| check.name == name).unwrap_or_else(|| panic!("no check {name}"))
}

#[test]
fn who_flies_to_his_goal_passes_and_is_asked_for_no_plan() {
    let mut scenario = scenario();
    scenario.fleet.simultaneous_arrival = false;
    let (plan, flight, verdict) = straight(&scenario);
    let bad: Vec<_> = verdict.checks.iter().filter(|check| check.is_bad()).collect();
    assert!(bad.is_empty(), "{bad:#?}");
    assert_eq!((verdict.outcome, plan.status), (Outcome::Pass, PlanStatus::Solved));
    let of_plan = |check: &&Check| check.name.starts_with("nodes.") || check.name.starts_with("plan.");
    assert!(verdict.checks.iter().filter(of_plan).all(|check| check.status == Status::Skip));
    assert!(flight.events.iter().any(|event| event.kind == EventKind::Arrived));
    // Both take 7 s, less the part slow enough to count as rest; the second is called first half a period later.
    assert!((plan.flight_time_s().unwrap() - 7.0).abs() < 0.3, "{:?}", plan.flight_time_s());
}

/// References of 0.4 s from rest to 1 m/s: until the next one takes effect, the vehicle is told to hover.
#[test]
fn what_was_followed_is_what_was_asked_for_also_where_references_end_in_motion() {
    let mut scenario = scenario();
    scenario.simulation.planning.period_s = 0.5;
    let (_, _, verdict) = flown(&scenario, |_| {
        Box::new(Stubborn(|observation| {
            let [x_m, y_m, z_m] = observation.position_m;
            let node = |after_s: f64, by_m: f64, speed_mps: f64| Node {
                t_s: observation.takes_effect_s + after_s,
                position_m: [x_m + by_m, y_m, z_m],
                velocity_mps: [speed_mps, 0.0, 0.0],
            };
            ReplanResult::fly(vec![node(0.0, 0.0, 0.0), node(0.4, 0.2, 1.0)])
        }))
    });
    let complete = check(&verdict, "flight.complete");
    assert_eq!(complete.status, Status::Pass, "{complete:?}");
    let planner = check(&verdict, "flight.planner");
    assert_eq!((planner.status, planner.at_s.map(|at_s| (at_s * 100.0).round())), (Status::Fail, Some(45.0)));
    assert!(planner.reason.as_ref().unwrap().contains("a reference ended at 1.000 m/s"), "{planner:?}");
}

/// Flies straight to its goal, but returns something else at one of its turns.
struct OneFault {
    straight: Straight,
    turn: usize,
    faulty: fn(&Observation<'_>) -> ReplanResult,
    remarks: PlannerRemarks,
}

impl InLoopPlanner for OneFault {
    fn replan(&mut self, observation: &Observation<'_>) -> ReplanResult {
        self.turn = self.turn.wrapping_sub(1);
        if self.turn == 0 { (self.faulty)(observation) } else { self.straight.replan(observation) }
    }

    fn finish(&mut self) -> PlannerRemarks {
        self.remarks.clone()
    }
}

fn with_one_fault(
    turn: usize,
    faulty: fn(&Observation<'_>) -> ReplanResult,
    remarks: &PlannerRemarks,
) -> (Plan, Flight, Verdict) {
    let mut scenario = scenario();
    scenario.fleet.simultaneous_arrival = false;
    let goals: Vec<[f64; 3]> = scenario.vehicles.iter().map(|vehicle| vehicle.goal.position_m()).collect();
    flown(&scenario, |index| {
        let (straight, remarks) = (Straight { goal_m: goals[index] }, remarks.clone());
        Box::new(OneFault { straight, turn: if index == 1 { turn } else { usize::MAX }, faulty, remarks })
    })
}

#[test]
fn a_planner_that_fails_once_fails_a_check_although_the_vehicles_arrive() {
    for (faulty, reason) in [
        (
            (|_| ReplanResult::failed("it crashed")) as fn(&Observation<'_>) -> ReplanResult,
            "no reply that can be used: it crashed",
        ),
        (
            |seen| {
                let moved = |node: &Node| Node { position_m: node.position_m.map(|x| x + 1.0), ..*node };
                ReplanResult::fly(seen.in_force.iter().map(moved).collect())
            },
            "a reference that cannot be flown: at 1.430 s it is 1.732 m away",
        ),
    ] {
        let (plan, flight, verdict) = with_one_fault(6, faulty, &PlannerRemarks::default());
        let bad: Vec<&str> =
            verdict.checks.iter().filter(|check| check.is_bad()).map(|check| check.name.as_str()).collect();
        assert_eq!((verdict.outcome, bad.as_slice()), (Outcome::Fail, ["flight.planner"].as_slice()));
        let planner = check(&verdict, "flight.planner");
        assert_eq!(
            (planner.value, planner.at_s.map(|at_s| (at_s * 100.0).round() / 100.0), planner.between.as_slice()),
            (Some(1.0), Some(1.38), ["uav-2".into()].as_slice())
        );
        assert!(planner.reason.as_ref().unwrap().starts_with(reason), "{planner:?}");
        assert!(flight.events.iter().any(|event| event.kind == EventKind::Arrived));
        assert_eq!(plan.status == PlanStatus::NotConverged, reason.contains("crashed"));
    }
}

#[test]
fn remarks_are_told_and_left_over_replies_fail() {
    let keep = |_: &Observation<'_>| ReplanResult::keep("on the way");
    let notes = vec!["3 lines are no replies".to_owned()];
    let (_, _, verdict) = with_one_fault(6, keep, &PlannerRemarks { notes: notes.clone(), failure: None });
    assert_eq!(verdict.outcome, Outcome::Pass);
    let failure = Some("1 of its replies is left over".to_owned());
    let (_, _, verdict) = with_one_fault(6, keep, &PlannerRemarks { notes, failure });
    assert_eq!(check(&verdict, "flight.planner").reason.as_deref(), Some("1 of its replies is left over"));
    assert_eq!(verdict.outcome, Outcome::Fail);
}

#[test]
fn a_failure_after_all_have_arrived_is_told_and_does_not_decide() {
    let crash = |_: &Observation<'_>| ReplanResult::failed("it crashed");
    // Arrival at about 7 s, and one more second to coast: turn 31 of the second vehicle is at 7.625 s.
    let (plan, _, verdict) = with_one_fault(31, crash, &PlannerRemarks::default());
    assert!(plan.flight_time_s().is_some_and(|time_s| time_s < 7.5), "{:?}", plan.flight_time_s());
    let planner = check(&verdict, "flight.planner");
    assert_eq!((planner.status, verdict.outcome), (Status::Pass, Outcome::Pass));
    assert!(planner.reason.as_ref().unwrap().contains("after the flight's planned end"), "{planner:?}");
}

#[test]
fn a_wall_that_nobody_told_of_is_flown_into_and_judged() {
    let mut scenario = scenario();
    scenario.world.boxes[0].size_m[1] = 5.0;
    scenario.world.hidden = vec!["wall".into()];
    let (_, flight, verdict) = straight(&scenario);
    assert_eq!(verdict.outcome, Outcome::Fail);
    for name in ["flight.crash", "flight.goal", "flight.complete"] {
        assert_eq!(check(&verdict, name).status, Status::Fail, "{name}");
    }
    let found = EventKind::Discovered { obstacle: "wall".into() };
    assert!(flight.events.iter().any(|event| event.kind == found && event.vehicles == ["uav-1"]));
}

#[test]
fn the_same_seed_gives_the_same_flight() {
    let mut scenario = scenario();
    scenario.simulation.sensors.position_noise_m = 0.02;
    scenario.simulation.planning.spread = 0.5;
    let [first, second] = [straight(&scenario), straight(&scenario)];
    assert_eq!(first.1.vehicles, second.1.vehicles);
    assert_eq!(first.0.trajectories, second.0.trajectories);
}

#[test]
fn nonsense_is_no_plan_and_never_a_panic() {
    let nonsense: [fn(&Observation<'_>) -> ReplanResult; 6] = [
        |_| ReplanResult::keep("no idea"),
        |_| ReplanResult::fly(Vec::new()),
        |seen| ReplanResult::fly(vec![Node::at_rest(seen.t_s, [0.0; 3])]),
        |seen| ReplanResult::fly(vec![Node::at_rest(seen.t_s, [f64::NAN; 3]), Node::at_rest(seen.t_s + 1.0, [0.0; 3])]),
        |_| ReplanResult::fly(vec![Node::at_rest(-2.0, [0.0; 3]), Node::at_rest(-1.0, [0.0; 3])]),
        |seen| {
            ReplanResult::fly(vec![Node::at_rest(seen.t_s + 9.0, [0.0; 3]), Node::at_rest(seen.t_s + 10.0, [0.0; 3])])
        },
    ];
    let mut scenario = scenario();
    scenario.simulation.max_duration_s = 3.0;
    for (index, answer) in nonsense.into_iter().enumerate() {
        let (plan, _, verdict) = flown(&scenario, |_| Box::new(Stubborn(answer)));
        assert_eq!((plan.status, verdict.outcome), (PlanStatus::NoPlan, Outcome::NoPlan), "{index}");
        assert_eq!(check(&verdict, "flight.goal").status, Status::Fail, "{index}");
    }
}

/// Comes to its goal almost at rest, and flies on at once or after 3 s.
fn through_the_goal(waits_s: f64) -> impl Fn(&Observation<'_>) -> ReplanResult {
    move |seen| {
        if seen.in_force.len() > 1 {
            return ReplanResult::keep("on the way");
        }
        let ([x_m, y_m, z_m], t_s) = (seen.position_m, seen.takes_effect_s);
        let node = |after_s: f64, by_m: f64, speed_mps: f64| Node {
            t_s: t_s + after_s,
            position_m: [x_m + by_m, y_m, z_m],
            velocity_mps: [speed_mps, 0.0, 0.0],
        };
        let arrived_s = 8.0 + waits_s;
        let last = [
            node(8.0, 6.0, 0.0),
            node(arrived_s, 6.0, 0.0),
            node(arrived_s + 2.0, 7.5, 1.0),
            node(arrived_s + 4.0, 8.5, 0.0),
        ];
        let from = if waits_s > 0.0 { 0 } else { 1 };
        ReplanResult::fly([vec![node(0.0, 0.0, 0.0), node(4.0, 3.0, 1.0)], last[from..].to_vec()].concat())
    }
}

struct Replies<F>(F);

impl<F: Fn(&Observation<'_>) -> ReplanResult + Send> InLoopPlanner for Replies<F> {
    fn replan(&mut self, observation: &Observation<'_>) -> ReplanResult {
        (self.0)(observation)
    }
}

#[test]
fn a_reference_that_leads_on_through_the_goal_into_a_wall_is_flown_into_the_wall() {
    let mut scenario = scenario();
    scenario.vehicles.truncate(1);
    scenario.fleet = scenarios::FleetRules::default();
    scenario.world.moving.clear();
    for waits_s in [0.0, 3.0] {
        let mut walled = scenario.clone();
        walled.world.boxes[0].center_m = [8.0, 0.0];
        walled.world.boxes[0].size_m = [1.0, 4.0];
        let fly_on = |scenario: &Scenario| flown(scenario, |_| Box::new(Replies(through_the_goal(waits_s))));
        let (_, flight, verdict) = fly_on(&walled);
        let crash = check(&verdict, "flight.crash");
        assert_eq!((verdict.outcome, crash.status), (Outcome::Fail, Status::Fail), "{waits_s}: {crash:?}");
        assert!(flight.events.iter().all(|event| event.kind != EventKind::Arrived), "{waits_s}");
        // Without the wall it ends beyond its goal.
        let (_, _, verdict) = fly_on(&scenario);
        assert_eq!(check(&verdict, "flight.goal").status, Status::Fail, "{waits_s}");
    }
}

#[test]
fn a_vehicle_that_is_sent_away_while_it_rests_at_its_goal_has_not_arrived() {
    let mut scenario = scenario();
    scenario.vehicles.truncate(1);
    scenario.fleet = scenarios::FleetRules::default();
    let goal_m = scenario.vehicles[0].goal.position_m();
    let away = |seen: &Observation<'_>| {
        let [x_m, y_m, z_m] = seen.position_m;
        let from = Node { t_s: seen.takes_effect_s, position_m: [x_m, y_m, z_m], velocity_mps: seen.velocity_mps };
        ReplanResult::fly(vec![from, Node::at_rest(seen.takes_effect_s + 4.0, [x_m, y_m + 2.0, z_m])])
    };
    // Arrival at about 7 s, and one more second to coast.
    let turn = (7.5 / scenario.simulation.planning.period_s).round() as usize;
    let planner = |_| -> Box<dyn InLoopPlanner> {
        let (straight, remarks) = (Straight { goal_m }, PlannerRemarks::default());
        Box::new(OneFault { straight, turn, faulty: away, remarks })
    };
    let (_, flight, verdict) = flown(&scenario, planner);
    assert_eq!((verdict.outcome, check(&verdict, "flight.goal").status), (Outcome::Fail, Status::Fail));
    assert!(flight.plan_end_s == scenario.simulation.max_duration_s, "{}", flight.plan_end_s);
}

#[test]
fn who_is_at_his_goal_already_has_nothing_to_do_and_passes() {
    let mut scenario = scenario();
    scenario.fleet.simultaneous_arrival = false;
    for off_m in [0.0, 0.4] {
        for vehicle in &mut scenario.vehicles {
            vehicle.goal = vehicle.start;
            vehicle.goal.x_m += off_m;
        }
        let (plan, flight, verdict) = flown(&scenario, |_| Box::new(Stubborn(|_| ReplanResult::keep("at the goal"))));
        assert_eq!((plan.status, verdict.outcome), (PlanStatus::Solved, Outcome::Pass), "{off_m}: {verdict:#?}");
        assert!((flight.vehicles[0].samples.last().unwrap().t_s - scenario.simulation.coast_s).abs() < 0.02);
    }
}
