//! Planning in the loop: whether planners were called at the scenario's instants, and whether each result was flown when
//! it was due, unchanged.
//!
//! A simulator that flies a result before it is ready, or calls a planner more often than the scenario allows, makes every
//! planner look better than it is.

use scenarios::in_loop::{Node, ReplanStatus};
use scenarios::multirotor::Trajectory;
use scenarios::{Plan, Planning, PlanningClock, Scenario};
use sim::multirotor::Reference;
use sim::{EventKind, Flight, PlanningLog, Replan};

use crate::verdict::compare::exceeds;

/// Rounding of two instants that should be equal, s.
pub const ROUNDING_S: f64 = 1e-6;
/// Rounding of two positions that should be equal, m.
const ROUNDING_M: f64 = 1e-6;

/// The numbers of a planning log, to find those that are not finite.
pub fn numbers(log: &PlanningLog) -> impl Iterator<Item = f64> + '_ {
    log.replans.iter().flat_map(|replan| {
        let times = [replan.asked_s, replan.ready_s, replan.takes_effect_s, replan.wall_s];
        times.into_iter().chain(replan.nodes.iter().flat_map(node_numbers))
    })
}

fn node_numbers(node: &Node) -> impl Iterator<Item = f64> {
    let Node { t_s, position_m, velocity_mps } = *node;
    [t_s].into_iter().chain(position_m).chain(velocity_mps)
}

/// The first defect of a planning log, in words.
///
/// - `plan`: the references that were followed according to the flight, flyable
pub fn defect(scenario: &Scenario, plan: &Plan, flight: &Flight) -> Option<String> {
    let log = flight.planning.as_ref()?;
    if let Some(replan) = log.replans.iter().find(|replan| replan.vehicle >= scenario.vehicles.len()) {
        return Some(format!(
            "the result requested at {} s is for vehicle {}, which does not exist",
            replan.asked_s, replan.vehicle
        ));
    }
    let of_vehicle = |(index, trajectory): (usize, &scenarios::Trajectory)| {
        let scenarios::Trajectory::Multirotor(followed) = trajectory else { return None };
        let results: Vec<&Replan> = log.replans.iter().filter(|replan| replan.vehicle == index).collect();
        let turns = Turns { settings: &scenario.simulation.planning, step_s: scenario.simulation.step_s };
        let first_s = index as f64 / scenario.vehicles.len() as f64 * turns.settings.period_s;
        let end_s = flight.vehicles.get(index)?.samples.last()?.t_s;
        let defect = turns
            .order_defect(&results, first_s, end_s)
            .or_else(|| results.iter().find_map(|replan| turns.result_defect(replan)))
            .or_else(|| reference_defect(&results, followed, turns.step_s))
            .or_else(|| end_defect(followed, flight.plan_end_s));
        defect.map(|defect| format!("{}: {defect}", followed.vehicle))
    };
    plan.trajectories.iter().enumerate().find_map(of_vehicle).or_else(|| events_defect(flight, log))
}

/// When a planner may be called, and when its result may be flown.
struct Turns<'a> {
    settings: &'a Planning,
    step_s: f64,
}

impl Turns<'_> {
    /// The defect of calls that are not at every turn at which the planner was idle, and only there.
    ///
    /// - `first_s`: its first turn, s
    /// - `end_s`: end of the flight, s
    fn order_defect(&self, results: &[&Replan], first_s: f64, end_s: f64) -> Option<String> {
        let out_of_turn = |at_s: f64| Some(format!("its planner was called at {at_s} s, between its turns"));
        let mut turns_s: Vec<f64> = (0..)
            .map(|turn| self.on_step(first_s + f64::from(turn) * self.settings.period_s))
            .take_while(|turn_s| *turn_s <= end_s + ROUNDING_S)
            .collect();
        turns_s.dedup();
        let (mut asked, mut busy_s) = (results.iter().peekable(), f64::NEG_INFINITY);
        for turn_s in turns_s {
            match asked.next_if(|replan| !exceeds(replan.asked_s, turn_s + ROUNDING_S)) {
                Some(replan) if exceeds(turn_s, replan.asked_s + ROUNDING_S) => return out_of_turn(replan.asked_s),
                Some(replan) if exceeds(busy_s, turn_s + ROUNDING_S) => {
                    return Some(format!("its planner was called at {} s, while it was busy", replan.asked_s));
                }
                Some(replan) => busy_s = replan.ready_s,
                // A call in the last step makes no difference.
                None if busy_s <= turn_s - ROUNDING_S && turn_s < end_s - self.step_s => {
                    return Some(format!("its planner was not called at {turn_s:.3} s, its turn"));
                }
                None => {}
            }
        }
        asked.next().and_then(|replan| out_of_turn(replan.asked_s))
    }

    /// The defect of a result that did not take the time that the scenario prescribes, or was not flown when it was due.
    fn result_defect(&self, replan: &Replan) -> Option<String> {
        let Replan { asked_s, ready_s, takes_effect_s, .. } = *replan;
        let took_s = ready_s - asked_s;
        let is_known = self.settings.time == PlanningClock::Modelled && self.settings.spread == 0.0;
        let is_recorded = |asked: &f64| !exceeds((took_s - asked).abs(), ROUNDING_S);
        let is_right = match self.settings.time {
            PlanningClock::Modelled if is_known => is_recorded(&self.settings.median_s),
            PlanningClock::Recorded => self.settings.recorded_s.iter().any(is_recorded),
            PlanningClock::Modelled | PlanningClock::Measured => took_s > 0.0,
        };
        if !is_right {
            return Some(format!(
                "the result requested at {asked_s} s took {took_s:.3} s, which the scenario does not allow"
            ));
        }
        let planned_s = self.on_step(asked_s + self.settings.deadline_s);
        let due_s = planned_s.max(self.on_step(ready_s));
        if exceeds((takes_effect_s - due_s).abs(), ROUNDING_S) {
            return Some(format!(
                "the result requested at {asked_s} s was due at {due_s:.3} s and was flown from {takes_effect_s} s on"
            ));
        }
        let late_s = due_s - planned_s;
        let is_logged = match replan.outcome {
            ReplanStatus::InTime => late_s <= ROUNDING_S,
            ReplanStatus::Late { by_s } => late_s > 0.0 && !exceeds((by_s - late_s).abs(), ROUNDING_S),
            ReplanStatus::None
            | ReplanStatus::Kept { .. }
            | ReplanStatus::Rejected { .. }
            | ReplanStatus::Failed { .. } => true,
        };
        (!is_logged).then(|| {
            format!("the result requested at {asked_s} s was {late_s:.3} s late, but the log gives another delay")
        })
    }

    /// The first step of the simulator that is not before `t_s`, s.
    fn on_step(&self, t_s: f64) -> f64 {
        (t_s / self.step_s - ROUNDING_S).ceil() * self.step_s
    }
}

/// The first step at which the followed reference is not that of the latest result, in words.
fn reference_defect(results: &[&Replan], followed: &Trajectory, step_s: f64) -> Option<String> {
    let flown = Reference::new(followed.nodes());
    let end_s = followed.times_s.last()?;
    let standing = Node::at_rest(0.0, followed.states.first()?.position_m);
    let mut in_force = (0.0, Reference::new(vec![standing]));
    let mut next =
        taken(results).map(|replan| (replan.takes_effect_s, Reference::new(replan.nodes.clone()))).peekable();
    for step in 0.. {
        let t_s = f64::from(step) * step_s;
        if t_s >= *end_s {
            return None;
        }
        while let Some(due) = next.next_if(|(from_s, _)| *from_s <= t_s + ROUNDING_S) {
            in_force = due;
        }
        // Just after the step: at the instant of a change both are valid.
        let at_s = (t_s + 0.5 * step_s).min(*end_s);
        let distance_m = (flown.at(at_s).position_m - in_force.1.at(at_s).position_m).norm();
        if exceeds(distance_m, ROUNDING_M) {
            let from_s = in_force.0;
            return Some(format!(
                "at {at_s:.3} s the followed reference is {distance_m:.3e} m away from the result in force since {from_s:.3} s"
            ));
        }
    }
    None
}

/// The defect of followed references that do not end with the planned part of the flight.
fn end_defect(followed: &Trajectory, end_s: f64) -> Option<String> {
    let last_s = *followed.times_s.last()?;
    exceeds((last_s - end_s).abs(), ROUNDING_S).then(|| {
        format!("the followed references end at {last_s:.3} s, the planned part of the flight at {end_s:.3} s")
    })
}

/// The results that came into force: a new one replaces one that has not taken effect yet.
pub fn taken<'a>(results: &'a [&'a Replan]) -> impl Iterator<Item = &'a Replan> {
    let flown: Vec<&Replan> =
        results.iter().copied().filter(|replan| replan.outcome.is_flown() && !replan.nodes.is_empty()).collect();
    let next_s: Vec<f64> = flown.iter().skip(1).map(|next| next.asked_s).chain([f64::INFINITY]).collect();
    flown
        .into_iter()
        .zip(next_s)
        .filter(|(replan, next_s)| *next_s >= replan.takes_effect_s - ROUNDING_S)
        .map(|pair| pair.0)
}

/// The defect of late, rejected or missing results without an event. Consecutive equal failures have one event.
fn events_defect(flight: &Flight, log: &PlanningLog) -> Option<String> {
    let is_event = |event: &&sim::Event| {
        use EventKind::{ReplanFailed, ReplanLate, ReplanRejected};
        matches!(event.kind, ReplanLate { .. } | ReplanRejected { .. } | ReplanFailed { .. })
    };
    let previous = |index: usize| {
        let vehicle = log.replans[index].vehicle;
        log.replans[..index].iter().rfind(|earlier| earlier.vehicle == vehicle)
    };
    let is_odd = |(index, replan): &(usize, &Replan)| match replan.outcome {
        ReplanStatus::Late { .. } | ReplanStatus::Rejected { .. } => true,
        ReplanStatus::Failed { .. } => previous(*index).is_none_or(|earlier| earlier.outcome != replan.outcome),
        ReplanStatus::None | ReplanStatus::InTime | ReplanStatus::Kept { .. } => false,
    };
    let logged = flight.events.iter().filter(is_event).count();
    let odd = log.replans.iter().enumerate().filter(is_odd).count();
    (logged != odd)
        .then(|| format!("{odd} results were late, rejected or missing, but the log has {logged} events of them"))
}

#[cfg(test)]
mod tests;
