use std::collections::VecDeque;

use scenarios::in_loop::{Node, ReplanStatus};

use super::reference::Reference;
use crate::planning_log::{PlanningLog, Replan};
use crate::request::FlightRequest;

/// Times that differ by less than this, s, are equal up to rounding.
const ROUNDING_S: f64 = 1e-9;

/// The references of an earlier flight that was planned in the loop, each in force from the same instant on.
pub(super) struct RecordedReferences(Vec<RecordedReference>);

/// Those of one vehicle.
struct RecordedReference {
    in_force: Reference,
    /// An accepted reference, and the time at which it takes effect, s.
    pending: Option<(f64, Reference)>,
    /// Results that were flown, in the order in which they were asked for.
    coming: VecDeque<Replan>,
}

impl RecordedReferences {
    pub fn new(request: &FlightRequest<'_>, log: &PlanningLog) -> Self {
        let vehicles = request.scenario.vehicles.iter().enumerate();
        let recorded = vehicles.map(|(index, vehicle)| RecordedReference {
            in_force: Reference::new(vec![Node::at_rest(0.0, vehicle.start.position_m())]),
            pending: None,
            coming: log.replans.iter().filter(|it| it.vehicle == index && is_flown(it)).cloned().collect(),
        });
        Self(recorded.collect())
    }

    /// The reference in force of a vehicle.
    pub fn of(&self, index: usize) -> &Reference {
        &self.0[index].in_force
    }

    /// Puts into force what is in force at `t_s`, s.
    pub fn update(&mut self, t_s: f64) {
        self.0.iter_mut().for_each(|vehicle| vehicle.update(t_s));
    }
}

impl RecordedReference {
    /// A result replaces one that was accepted before it and has not taken effect.
    fn update(&mut self, t_s: f64) {
        self.put_into_force(t_s);
        while self.coming.front().is_some_and(|replan| replan.asked_s <= t_s + ROUNDING_S) {
            let accepted = self.coming.pop_front().map(|replan| (replan.takes_effect_s, Reference::new(replan.nodes)));
            self.pending = accepted;
            self.put_into_force(t_s);
        }
    }

    fn put_into_force(&mut self, t_s: f64) {
        if let Some((_, reference)) = self.pending.take_if(|(begin_s, _)| *begin_s <= t_s + ROUNDING_S) {
            self.in_force = reference;
        }
    }
}

fn is_flown(replan: &Replan) -> bool {
    matches!(replan.outcome, ReplanStatus::InTime | ReplanStatus::Late { .. }) && !replan.nodes.is_empty()
}
