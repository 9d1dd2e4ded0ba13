//! When planners are called, what they observe, and when their results take effect.

use std::sync::{Arc, Mutex};

use scenarios::in_loop::{InLoopPlanner, Node, Observation, PlannerRemarks, ReplanResult, ReplanStatus};
use scenarios::{Cylinder, PlanningClock, Scenario};
use sim::multirotor::Reference;
use sim::{EventKind, Flight, FlightOptions, ReferenceSource, fly, fly_with};

use crate::arena::scenario;

/// What a planner observed.
#[derive(Clone, Debug)]
struct Observed {
    t_s: f64,
    takes_effect_s: f64,
    first_in_force_m: [f64; 3],
    last: ReplanStatus,
    known: Vec<String>,
    discovered: Vec<String>,
}

/// Records its observations, and moves east.
struct RecordingPlanner {
    observed: Arc<Mutex<Vec<Observed>>>,
}

impl InLoopPlanner for RecordingPlanner {
    fn replan(&mut self, observation: &Observation<'_>) -> ReplanResult {
        let mut observed = self.observed.lock().expect("nobody panicked");
        observed.push(Observed {
            t_s: observation.t_s,
            takes_effect_s: observation.takes_effect_s,
            first_in_force_m: observation.in_force[0].position_m,
            last: observation.last.clone(),
            known: observation.known.obstacle_names().map(str::to_owned).collect(),
            discovered: observation.discovered.to_vec(),
        });
        ReplanResult::fly(accelerating_nodes(observation))
    }
}

/// From the reference in force, 0.25 s at 1 m/s², and then 1 s to rest.
fn accelerating_nodes(observation: &Observation<'_>) -> Vec<Node> {
    let from_s = observation.takes_effect_s;
    let from = Reference::new(observation.in_force.to_vec()).at(from_s);
    let node = |after_s: f64, x_m: f64, speed_mps: f64| Node {
        t_s: from_s + after_s,
        position_m: [x_m, 0.0, 5.0],
        velocity_mps: [speed_mps, 0.0, 0.0],
    };
    let (x_m, speed_mps) = (from.position_m.x, from.velocity_mps.x);
    let (fast_m, fast_mps) = (x_m + 0.25 * speed_mps + 0.03125, speed_mps + 0.25);
    vec![node(0.0, x_m, speed_mps), node(0.25, fast_m, fast_mps), node(1.25, fast_m + fast_mps / 2.0, 0.0)]
}

fn flown(change: impl FnOnce(&mut Scenario)) -> (Vec<Observed>, Flight) {
    let mut scenario = scenario("point-mass");
    scenario.simulation.max_duration_s = 3.0;
    scenario.simulation.wind = None;
    change(&mut scenario);
    let observed = Arc::new(Mutex::new(Vec::new()));
    let planner: Box<dyn InLoopPlanner> = Box::new(RecordingPlanner { observed: Arc::clone(&observed) });
    let flight = fly(&scenario, vec![planner], 1, &mut |_| {});
    let observed = observed.lock().expect("nobody panicked").clone();
    (observed, flight)
}

#[test]
fn results_in_time_take_effect_at_the_deadline() {
    let (observed, flight) = flown(|scenario| {
        scenario.simulation.planning.period_s = 0.25;
        scenario.simulation.planning.deadline_s = 0.1;
        scenario.simulation.planning.median_s = 0.08;
    });
    assert_eq!(observed.len(), 13);
    for (index, observed) in observed.iter().enumerate() {
        assert!(
            (observed.t_s - 0.25 * index as f64).abs() < 1e-9
                && (observed.takes_effect_s - observed.t_s - 0.1).abs() < 1e-9
        );
        assert_eq!(observed.last, if index == 0 { ReplanStatus::None } else { ReplanStatus::InTime });
    }
    assert_eq!(observed[0].first_in_force_m, [0.0, 0.0, 5.0]);
    assert!((observed[2].first_in_force_m[0] - 0.03125).abs() < 1e-9);
    let reference_m = |t_s: f64| flight.vehicles[0].samples[(t_s * 100.0).round() as usize].reference_position_m[0];
    assert!(reference_m(0.1) == 0.0 && (reference_m(0.2) - 0.005).abs() < 1e-9);
}

#[test]
fn a_late_result_is_entered_after_its_beginning() {
    let (observed, flight) = flown(|scenario| {
        scenario.simulation.planning.deadline_s = 0.1;
        scenario.simulation.planning.time = PlanningClock::Recorded;
        scenario.simulation.planning.recorded_s = vec![0.05, 0.17];
    });
    assert_eq!(observed[1].last, ReplanStatus::InTime);
    let ReplanStatus::Late { by_s } = observed[2].last else { panic!("{:?}", observed[2].last) };
    assert!((by_s - 0.07).abs() < 1e-9, "{by_s}");
    // Called at 0.25 s for 0.35 s, available at 0.42 s: until then the first reference decelerates.
    let reference_m = |t_s: f64| flight.vehicles[0].samples[(t_s * 100.0).round() as usize].reference_position_m[0];
    let braking_m = |t_s: f64| 0.03125 + 0.25 * (t_s - 0.35) - 0.125 * (t_s - 0.35) * (t_s - 0.35);
    assert!((reference_m(0.41) - braking_m(0.41)).abs() < 1e-9);
    let entered_m = 0.03125 + 0.25 * 0.07 + 0.5 * 0.07 * 0.07;
    assert!((reference_m(0.42) - entered_m).abs() < 1e-9, "{}", reference_m(0.42));
    let followed = &flight.planning.as_ref().expect("a log").followed[0];
    assert!(followed.times_s.windows(2).any(|pair| pair[0] == pair[1]), "{:?}", followed.times_s);
}

#[test]
fn a_busy_planner_misses_its_call() {
    let (observed, _) = flown(|scenario| {
        scenario.simulation.planning.median_s = 0.6;
    });
    let asked: Vec<f64> = observed.iter().map(|observed| observed.t_s).collect();
    assert_eq!(asked.len(), 5, "{asked:?}");
    assert!(asked.windows(2).all(|pair| (pair[1] - pair[0] - 0.75).abs() < 1e-9), "{asked:?}");
}

#[test]
fn an_obstacle_is_known_once_its_surface_is_within_range() {
    let (observed, flight) = flown(|scenario| {
        scenario.simulation.max_duration_s = 4.0;
        scenario.world.cylinders.push(Cylinder { name: "far".into(), center_m: [10.5, 0.0], radius_m: 0.5 });
        scenario.world.cylinders.push(Cylinder { name: "near".into(), center_m: [0.0, 5.0], radius_m: 0.5 });
        scenario.world.cylinders.push(Cylinder { name: "known".into(), center_m: [30.0, 5.0], radius_m: 0.5 });
        scenario.world.hidden = vec!["far".into(), "near".into()];
    });
    assert_eq!(observed[0].known, ["near", "known"]);
    assert_eq!(observed[0].discovered, ["near"]);
    // 8 m from its surface at x = 2 m, where the vehicle is a little after 2 s.
    let first = observed.iter().find(|observed| observed.known.contains(&"far".to_owned())).expect("it is found");
    assert!((2.0..2.6).contains(&first.t_s), "{first:?}");
    assert_eq!(first.discovered, ["far"]);
    assert_eq!(observed.iter().filter(|observed| !observed.discovered.is_empty()).count(), 2);
    let found: Vec<f64> = flight.events.iter().map(|event| event.t_s).collect();
    assert_eq!(found.len(), 2, "{:?}", flight.events);
}

/// Late, rejected, superseded and missed results included.
#[test]
fn a_recorded_flight_is_followed_again_exactly_and_with_finer_steps() {
    let mut scenario = scenario("point-mass");
    scenario.simulation.max_duration_s = 3.0;
    scenario.simulation.planning.period_s = 0.3;
    scenario.simulation.planning.deadline_s = 0.5;
    scenario.simulation.planning.time = PlanningClock::Recorded;
    scenario.simulation.planning.recorded_s = vec![0.01, 0.7, 0.2];
    let planner: Box<dyn InLoopPlanner> = Box::new(RecordingPlanner { observed: Arc::default() });
    let flight = fly(&scenario, vec![planner], 1, &mut |_| {});
    let again = |halvings| {
        fly_with(&scenario, ReferenceSource::Recorded(&flight), 1, &FlightOptions::finer(halvings), &mut |_| {})
    };
    assert!(
        flight
            .planning
            .as_ref()
            .is_some_and(|it| it.replans.iter().any(|replan| replan.takes_effect_s > replan.asked_s + 0.6))
    );
    assert_eq!(again(0).vehicles, flight.vehicles);
    let finer = again(1);
    let pairs = finer.vehicles[0].samples.iter().zip(&flight.vehicles[0].samples);
    let apart_m = |(a, b): (&sim::Sample, &sim::Sample)| {
        (0..3).map(|axis| (a.position_m[axis] - b.position_m[axis]).abs()).fold(0.0, f64::max)
    };
    let largest_m = pairs.map(apart_m).fold(0.0, f64::max);
    assert!(finer.vehicles[0].samples.len() == flight.vehicles[0].samples.len());
    assert!(largest_m > 1e-12 && largest_m < 1e-3, "{largest_m} m");
}

/// Replies with what `reply` makes of the observation and of the number of earlier calls.
struct ScriptedPlanner {
    calls: usize,
    reply: fn(&Observation<'_>, usize) -> ReplanResult,
}

impl InLoopPlanner for ScriptedPlanner {
    fn replan(&mut self, observation: &Observation<'_>) -> ReplanResult {
        self.calls += 1;
        (self.reply)(observation, self.calls - 1)
    }

    fn finish(&mut self) -> PlannerRemarks {
        PlannerRemarks { notes: vec!["a note".into()], failure: None }
    }
}

fn flown_by(reply: fn(&Observation<'_>, usize) -> ReplanResult) -> Flight {
    let mut scenario = scenario("point-mass");
    scenario.simulation.max_duration_s = 2.0;
    scenario.simulation.wind = None;
    let planner: Box<dyn InLoopPlanner> = Box::new(ScriptedPlanner { calls: 0, reply });
    fly(&scenario, vec![planner], 1, &mut |_| {})
}

#[test]
fn a_reference_that_jumps_is_rejected_and_the_one_in_force_is_kept() {
    let flight = flown_by(|observation, calls| {
        let mut nodes = accelerating_nodes(observation);
        if calls == 2 {
            nodes.iter_mut().for_each(|node| node.position_m[1] += 1.0);
        }
        ReplanResult::fly(nodes)
    });
    let replans = &flight.planning.as_ref().expect("a log").replans;
    let rejected: Vec<usize> = (0..replans.len())
        .filter(|index| matches!(&replans[*index].outcome, ReplanStatus::Rejected { reason } if reason.contains("1.000 m away")))
        .collect();
    assert_eq!(rejected, [2], "{replans:?}");
    assert!(flight.vehicles[0].samples.iter().all(|sample| sample.reference_position_m[1] == 0.0));
    assert_eq!(flight.events.iter().filter(|event| matches!(event.kind, EventKind::ReplanRejected { .. })).count(), 1);
}

#[test]
fn a_failed_planner_is_one_event_and_its_remarks_are_told() {
    let flight = flown_by(|observation, calls| {
        if calls < 3 { ReplanResult::fly(accelerating_nodes(observation)) } else { ReplanResult::failed("it crashed") }
    });
    let log = flight.planning.as_ref().expect("a log");
    let failed = ReplanStatus::Failed { reason: "it crashed".into() };
    assert_eq!(log.replans.iter().filter(|replan| replan.outcome == failed).count(), 6);
    let kinds = || flight.events.iter().map(|event| &event.kind);
    assert_eq!(kinds().filter(|kind| matches!(kind, EventKind::ReplanFailed { .. })).count(), 1);
    assert_eq!(kinds().filter(|kind| **kind == EventKind::PlannerRemark { text: "a note".into() }).count(), 1);
    assert_eq!(log.remarks.notes, ["a note"]);
}

#[test]
fn a_planner_knows_acceleration_and_attitude_of_its_vehicle() {
    let flight = flown_by(|observation, calls| {
        let ([ax, ..], [_, pitch, _, w]) = (observation.acceleration_mps2, observation.world_from_body);
        if calls == 0 {
            assert_eq!((ax, pitch, w), (0.0, 0.0, 1.0), "it hovers, level");
        } else {
            assert!((ax - 1.0).abs() < 0.1 && (2.0 * pitch.atan2(w)).tan() > 0.1, "{observation:?}");
        }
        ReplanResult::fly(accelerating_nodes(observation))
    });
    assert_eq!(flight.planning.as_ref().expect("a log").replans.len(), 9);
}
