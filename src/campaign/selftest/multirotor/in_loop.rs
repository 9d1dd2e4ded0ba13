//! Faults of the planning logs of in-loop flights.

use scenarios::in_loop::ReplanStatus;
use sim::{EventKind, PlanningLog, Replan};

use crate::campaign::selftest::{Fault, ReferenceCase};

/// The faults.
pub fn faults() -> Vec<Fault> {
    [times(), answers(), planners()].into_iter().flatten().collect()
}

fn times() -> Vec<Fault> {
    vec![
        Fault::new("flight.conditions", "an answer was flown before it was there", |it| {
            planning(it).replans[9].ready_s += 0.1;
        }),
        Fault::new("flight.conditions", "an answer was flown before its deadline", |it| {
            planning(it).replans[9].takes_effect_s -= 0.02;
        }),
        Fault::new("flight.conditions", "answers took no time", |it| {
            planning(it).replans.iter_mut().for_each(|replan| replan.ready_s = replan.asked_s);
        }),
        Fault::new("flight.conditions", "a planner was asked between its periods", |it| {
            let replans = &mut planning(it).replans;
            let mut again = replans[9].clone();
            again.asked_s += 0.1;
            again.ready_s += 0.1;
            again.takes_effect_s += 0.1;
            replans.insert(10, again);
        }),
        Fault::new("flight.conditions", "planners were asked twice as often as the scenario says", |it| {
            it.scenario.simulation.planning.period_s *= 2.0;
        }),
        Fault::new("flight.conditions", "a replan is missing", |it| {
            planning(it).replans.remove(9);
        }),
        Fault::new("flight.conditions", "an answer was late, and the log calls it in time", |it| {
            let late = &mut planning(it).replans[9];
            late.takes_effect_s += 0.05;
        }),
        Fault::new("flight.conditions", "an answer was late without an event in the log", |it| {
            let mut slow = it.scenario.clone();
            slow.simulation.planning.median_s = slow.simulation.planning.deadline_s + 0.05;
            it.fly_in(&slow);
            it.scenario = slow;
            it.flight().events.retain(|event| !matches!(event.kind, EventKind::ReplanLate { .. }));
        }),
    ]
}

fn answers() -> Vec<Fault> {
    vec![
        Fault::new("flight.finite", "an answer holds a value that is not a number", |it| {
            planning(it).replans.iter_mut().find(|it| !it.nodes.is_empty()).expect("an answer").nodes[1].position_m
                [0] = f64::NAN;
        }),
        Fault::new("flight.conditions", "an answer is for a vehicle that does not exist", |it| {
            planning(it).replans[9].vehicle = 99;
        }),
        Fault::new("flight.conditions", "an answer was flown that had been rejected", |it| {
            let reason = "it is not a motion".to_owned();
            let flown = planning(it).replans.iter_mut().skip(9).find(|it| it.outcome == ReplanStatus::InTime);
            flown.expect("an answer").outcome = ReplanStatus::Rejected { reason };
        }),
        Fault::new("flight.conditions", "the flown reference is not the answer", |it| {
            let flown = planning(it).replans.iter_mut().skip(9).find(|it| it.outcome == ReplanStatus::InTime);
            let nodes = &mut flown.expect("an answer").nodes;
            nodes.iter_mut().for_each(|node| node.position_m[2] += 0.01);
        }),
        Fault::new("flight.conditions", "the reported plan is not the followed reference", |it| {
            it.multirotor(0).states.iter_mut().for_each(|state| state.position_m[2] += 5e-3);
        }),
        Fault::new("flight.conditions", "the reported plan ends before the flight", |it| {
            let trajectory = it.multirotor(0);
            let kept = trajectory.times_s.len() * 3 / 4;
            trajectory.times_s.truncate(kept);
            trajectory.states.truncate(kept);
        }),
        Fault::new("flight.separation", "one vehicle flies beside another", |it| {
            let beside_m = 0.9 * it.scenario.fleet.separation_m.unwrap_or(0.0);
            let beside = it.samples(0).clone();
            for (sample, beside) in it.samples(1).iter_mut().zip(beside) {
                sample.position_m = [beside.position_m[0], beside.position_m[1] + beside_m, beside.position_m[2]];
                sample.velocity_mps = beside.velocity_mps;
            }
        }),
        Fault::new("flight.goal", "a goal was moved after the flight", |it| {
            let max_m = it.scenario.limits().goal_m;
            it.scenario.vehicles[0].goal.z_m += 1.5 * max_m;
        }),
    ]
}

fn planners() -> Vec<Fault> {
    vec![
        Fault::new("flight.planner", "a planner crashed on the way, and the flight went on", |it| {
            planning(it).replans[9].outcome = ReplanStatus::Failed { reason: "it ended with exit code 1".into() };
        }),
        Fault::new("flight.planner", "an answer could not be flown", |it| {
            planning(it).replans[9].outcome = ReplanStatus::Rejected { reason: "it jumps".into() };
        }),
        Fault::new("flight.planner", "answers are left over for which there is no request", |it| {
            planning(it).remarks.failure = Some("1 of its replies is left over".into());
        }),
        Fault::new("flight.planner", "a reference that jumps was flown", |it| {
            let reference = flown_in_motion(it);
            reference.nodes.iter_mut().for_each(|node| node.position_m[2] += 1.0);
        }),
        Fault::new("flight.planner", "a reference whose velocity jumps was flown", |it| {
            let reference = flown_in_motion(it);
            reference.nodes.iter_mut().for_each(|node| node.velocity_mps[2] += 1.0);
        }),
        Fault::new("flight.planner", "a reference was flown to its end in motion", |it| {
            let reference = flown_in_motion(it);
            let takes_effect_s = reference.takes_effect_s;
            reference.nodes.truncate(1);
            let mut end = reference.nodes[0];
            end.t_s = takes_effect_s + 1e-3;
            reference.nodes.push(end);
        }),
    ]
}

/// A reference that was flown in time and begins in motion.
fn flown_in_motion(it: &mut ReferenceCase) -> &mut Replan {
    let moves = |replan: &Replan| replan.nodes[0].velocity_mps.iter().any(|speed_mps| speed_mps.abs() > 0.5);
    let is_such = |replan: &&mut Replan| replan.outcome == ReplanStatus::InTime && moves(replan);
    planning(it).replans.iter_mut().skip(9).find(is_such).expect("a vehicle in motion")
}

fn planning(it: &mut ReferenceCase) -> &mut PlanningLog {
    it.flight().planning.as_mut().expect("it was planned in the loop")
}
