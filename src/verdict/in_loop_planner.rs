//! Did the in-loop planners do their work: a usable reply to every request, and references that the vehicle can follow?
//!
//! A vehicle whose planner has crashed may still reach its goal on its last reference. The flight is then as good as any
//! other, and the planner is not.

use scenarios::in_loop::{Node, ReplanStatus};
use scenarios::{CheckSpec, Scenario};
use sim::multirotor::Reference;
use sim::{Flight, PlanningLog, Replan};

use crate::verdict::Check;
use crate::verdict::compare::exceeds;
use crate::verdict::evidence::{Decide, Measurement};
use crate::verdict::in_loop_planning::{ROUNDING_S, taken};

/// Why the check is skipped for a plan that was made before the flight.
const PLANNED_BEFORE: &str = "planned before the flight";

/// What a planner did wrong.
struct Violation {
    t_s: f64,
    /// Index of the vehicle; `None` if it concerns all.
    vehicle: Option<usize>,
    reason: String,
}

/// Number of requests without a usable reply, and of references that jump or end in motion while they are flown. What
/// happens after the end of the planned flight is told, and does not decide.
pub fn check(spec: &CheckSpec, scenario: &Scenario, flight: &Flight) -> Check {
    let Some(log) = &flight.planning else { return spec.skip(PLANNED_BEFORE) };
    let end_s = flight.plan_end_s;
    let (deciding, later): (Vec<Violation>, Vec<Violation>) = violations(scenario, flight, log)
        .into_iter()
        .partition(|violation| !exceeds(violation.t_s, end_s + ROUNDING_S));
    let measured = Measurement::value(deciding.len() as f64);
    let Some(first) = deciding.first() else {
        let told = later.first().map(|later| format!("after the flight's planned end: {}", later.reason));
        return spec.at_most(told.map_or(measured.clone(), |told| measured.with_reason(told)), 0.0);
    };
    let names = first.vehicle.and_then(|index| scenario.vehicles.get(index)).map(|vehicle| vehicle.name.as_str());
    let measured = measured.at(first.t_s).with_reason(&first.reason);
    spec.at_most(names.into_iter().fold(measured, Measurement::with), 0.0)
}

/// All violations in the order of time.
fn violations(scenario: &Scenario, flight: &Flight, log: &PlanningLog) -> Vec<Violation> {
    let mut all: Vec<Violation> = log.replans.iter().filter_map(unusable).collect();
    for index in 0..scenario.vehicles.len() {
        let replans: Vec<&Replan> = log.replans.iter().filter(|replan| replan.vehicle == index).collect();
        let flown: Vec<&Replan> = taken(&replans).collect();
        let followed = FollowedReferences { scenario, flight, index, flown: &flown };
        all.extend(followed.jumps());
        all.extend(followed.ends_in_motion());
    }
    let failure = log.remarks.failure.clone();
    all.extend(failure.map(|reason| Violation { t_s: flight.plan_end_s, vehicle: None, reason }));
    all.sort_by(|a, b| a.t_s.total_cmp(&b.t_s));
    all
}

fn unusable(replan: &Replan) -> Option<Violation> {
    let reason = match &replan.outcome {
        ReplanStatus::Failed { reason } => format!("no reply that can be used: {reason}"),
        ReplanStatus::Rejected { reason } => format!("a reference that cannot be flown: {reason}"),
        ReplanStatus::None | ReplanStatus::InTime | ReplanStatus::Late { .. } | ReplanStatus::Kept { .. } => {
            return None;
        }
    };
    Some(Violation { t_s: replan.asked_s, vehicle: Some(replan.vehicle), reason })
}

/// The references that one vehicle followed, one after the other.
struct FollowedReferences<'a> {
    scenario: &'a Scenario,
    flight: &'a Flight,
    index: usize,
    flown: &'a [&'a Replan],
}

impl FollowedReferences<'_> {
    /// References in time that begin neither where the one before them is, nor where the vehicle was measured:
    ///
    /// ```text
    /// |p - p_f| > |e_p| + |e_v| T + v_max h   or   |v - v_f| > |e_v| + a_max h
    /// ```
    ///
    /// e: measured minus reference, T: time since the measurement, h: step of the simulator. Late references jump by
    /// nature.
    fn jumps(&self) -> Vec<Violation> {
        let start_m = self.scenario.vehicles[self.index].start.position_m();
        let mut in_force = Reference::new(vec![Node::at_rest(0.0, start_m)]);
        let mut found = Vec::new();
        for replan in self.flown {
            let reference = Reference::new(replan.nodes.clone());
            if replan.outcome == ReplanStatus::InTime && self.is_jump(replan, &in_force, &reference) {
                let reason = "a reference that jumps from the one before it was flown".to_owned();
                found.push(Violation { t_s: replan.takes_effect_s, vehicle: Some(self.index), reason });
            }
            in_force = reference;
        }
        found
    }

    fn is_jump(&self, replan: &Replan, in_force: &Reference, reference: &Reference) -> bool {
        let Replan { asked_s, takes_effect_s, .. } = *replan;
        let sample = self.flight.vehicles.get(self.index).and_then(|log| {
            let before = log.samples.partition_point(|sample| sample.t_s <= asked_s + ROUNDING_S);
            log.samples.get(before.checked_sub(1)?)
        });
        let Some(sample) = sample else { return true };
        let (limits, step_s) = (self.limits(), self.scenario.simulation.step_s);
        let (now, expected, begin) =
            (in_force.at(asked_s), in_force.before(takes_effect_s), reference.at(takes_effect_s));
        let error_m = (nalgebra::Vector3::from(sample.measured_position_m) - now.position_m).norm();
        let error_mps = (nalgebra::Vector3::from(sample.measured_velocity_mps) - now.velocity_mps).norm();
        let lead_s = takes_effect_s - asked_s;
        let allowed_m = error_m + error_mps * lead_s + limits.speed_mps * step_s;
        let allowed_mps = error_mps + limits.acceleration_mps2 * step_s;
        exceeds((begin.position_m - expected.position_m).norm(), allowed_m + ROUNDING_S)
            || exceeds((begin.velocity_mps - expected.velocity_mps).norm(), allowed_mps + ROUNDING_S)
    }

    /// References that were flown to an end in motion: no vehicle stops at once.
    fn ends_in_motion(&self) -> Vec<Violation> {
        let next_s = self.flown.iter().skip(1).map(|next| next.takes_effect_s).chain([self.flight.plan_end_s]);
        let max_mps = self.limits().acceleration_mps2 * self.scenario.simulation.step_s;
        let of_pair = |(replan, until_s): (&&Replan, f64)| {
            let last = replan.nodes.last()?;
            let speed_mps = nalgebra::Vector3::from(last.velocity_mps).norm();
            let is_flown_on = last.t_s < until_s - ROUNDING_S;
            (is_flown_on && exceeds(speed_mps, max_mps)).then(|| Violation {
                t_s: last.t_s,
                vehicle: Some(self.index),
                reason: format!("a reference ended at {speed_mps:.3} m/s, and no other had taken its place"),
            })
        };
        self.flown.iter().zip(next_s).filter_map(of_pair).collect()
    }

    fn limits(&self) -> scenarios::multirotor::Limits {
        self.scenario.multirotor_model(&self.scenario.vehicles[self.index]).limits
    }
}
