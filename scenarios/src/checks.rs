//! The checks of a verdict, declared once: name, unit, source of the limit, families.

use std::fmt;

use crate::Family::{self, FixedWing, Multirotor, SlungLoad};

/// The object of a check.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Group {
    /// The plan at the planner's nodes, where its constraints apply.
    Nodes,
    /// The plan as a continuous motion.
    Plan,
    /// The simulated flight.
    Flight,
}

/// The source of the limit of a check in a scenario file.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum LimitField {
    /// The first of these fields that the file gives.
    Fields(&'static [&'static str]),
    /// The obstacle concerned.
    Obstacles,
    /// The limits of the vehicle's model (the planning limits for `nodes.*`), or the map.
    ModelLimits,
    /// The goal of the vehicle, or its tolerances: `verdict.goal_m` and, for fixed wings, those of the velocity.
    Goal,
    /// The gate concerned.
    Gates,
    /// The formula of the requirement.
    Requirement,
    /// None: the limit is fixed.
    None,
}

/// The declaration of a check.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct CheckSpec {
    /// The object of the check.
    pub group: Group,
    /// Full name, with the group: `flight.separation`.
    pub name: &'static str,
    /// Unit of value, limit and margin; `-` for checks of several quantities, which report the unit of the worst one.
    pub unit: &'static str,
    /// The source of its limit.
    pub limit: LimitField,
    /// The families that it applies to.
    pub families: &'static [Family],
    /// What it measures, in one sentence.
    pub description: &'static str,
}

const ALL: &[Family] = &Family::ALL;
const HOVERING: &[Family] = &[SlungLoad, Multirotor];
const LOADS: &[Family] = &[SlungLoad];
const MULTIROTORS: &[Family] = &[Multirotor];
/// Skipped, with the reason, for fixed wings.
const LOADS_NAMED: &[Family] = &[FixedWing, SlungLoad];

const SEPARATION: LimitField = LimitField::Fields(&["fleet.separation_m", "fleet.separation_volume"]);
const ENVELOPE: LimitField = LimitField::Fields(&["verdict.envelope_m"]);
const REST: LimitField = LimitField::Fields(&["verdict.rest_mps"]);
const ARRIVAL: LimitField = LimitField::Fields(&["verdict.arrival_spread_s", "fleet.simultaneous_arrival"]);
const DURATION: LimitField = LimitField::Fields(&["simulation.max_duration_s"]);
const DYNAMICS: LimitField = LimitField::Fields(&["verdict.dynamics_m"]);
const ROLLOUT: LimitField = LimitField::Fields(&["verdict.rollout_m"]);
const SWITCHES: LimitField = LimitField::Fields(&["verdict.switch_s"]);
const TRACKING_RMS: LimitField = LimitField::Fields(&["verdict.tracking_rms_m"]);
const TRACKING_MAX: LimitField = LimitField::Fields(&["verdict.tracking_max_m"]);
const SATURATION: LimitField = LimitField::Fields(&["verdict.saturation"]);

const fn nodes(
    name: &'static str,
    unit: &'static str,
    limit: LimitField,
    families: &'static [Family],
    description: &'static str,
) -> CheckSpec {
    CheckSpec { group: Group::Nodes, name, unit, limit, families, description }
}

const fn plan(
    name: &'static str,
    unit: &'static str,
    limit: LimitField,
    families: &'static [Family],
    description: &'static str,
) -> CheckSpec {
    CheckSpec { group: Group::Plan, ..nodes(name, unit, limit, families, description) }
}

const fn flight(
    name: &'static str,
    unit: &'static str,
    limit: LimitField,
    families: &'static [Family],
    description: &'static str,
) -> CheckSpec {
    CheckSpec { group: Group::Flight, ..nodes(name, unit, limit, families, description) }
}

/// Every check, in the order of a verdict.
#[rustfmt::skip]
pub const CHECKS: &[CheckSpec] = {
    use LimitField::{Gates, Goal, ModelLimits, None, Obstacles};
    &[
        nodes("nodes.separation", "m", SEPARATION, ALL, "Smallest distance between two vehicles at the planner's nodes."),
        nodes("nodes.clearance", "m", Obstacles, ALL, "Smallest distance to an obstacle at the planner's nodes."),
        nodes("nodes.envelope", "m", ENVELOPE, LOADS, "Smallest distance of the envelope circle to an obstacle at the planner's nodes."),
        nodes("nodes.rotor_clearance", "m", None, LOADS, "Smallest distance of load and cable from the vehicle's own body and rotors at the planner's nodes."),
        nodes("nodes.state_limits", "-", ModelLimits, ALL, "State closest to or furthest beyond its planning limits at the nodes."),
        nodes("nodes.control_limits", "-", ModelLimits, ALL, "Control closest to or furthest beyond its planning limits at the nodes."),
        nodes("nodes.goal", "m", Goal, ALL, "Distance of the last node from the goal; of fixed wings heading, flight-path angle and speed too, the worst in its own unit."),
        nodes("nodes.gates", "m", Gates, LOADS, "Smallest depth inside the windows of a gate, at the nodes."),
        plan("plan.finite", "numbers", None, ALL, "Number of values in the plan that are not finite."),
        plan("plan.complete", "vehicles", None, ALL, "Number of vehicles whose trajectory is missing, malformed, or does not begin at the start."),
        plan("plan.separation", "m", SEPARATION, ALL, "Smallest distance between two vehicles over continuous time."),
        plan("plan.clearance", "m", Obstacles, ALL, "Smallest distance to an obstacle over continuous time."),
        plan("plan.envelope", "m", ENVELOPE, LOADS, "Smallest distance of the envelope circle to an obstacle over continuous time."),
        plan("plan.rotor_clearance", "m", None, LOADS, "Smallest distance of load and cable from the vehicle's own body and rotors over continuous time."),
        plan("plan.state_limits", "-", ModelLimits, ALL, "State closest to or furthest beyond its physical limits, over continuous time."),
        plan("plan.control_limits", "-", ModelLimits, ALL, "Control closest to or furthest beyond its physical limits, over continuous time."),
        plan("plan.dynamics", "m", DYNAMICS, ALL, "Largest distance between a node and the position to which the controls lead from an earlier node, over one interval or at least 1 s."),
        plan("plan.rollout", "m", ROLLOUT, ALL, "Largest distance from a node when the controls are flown open loop from the start."),
        plan("plan.goal", "m", Goal, ALL, "Distance of the end of the planned motion from the goal; of fixed wings heading, flight-path angle and speed too, the worst in its own unit."),
        plan("plan.rest", "m/s", REST, HOVERING, "Speed relative to the goal at the end of the plan."),
        plan("plan.arrival", "s", ARRIVAL, ALL, "Time between the first and the last planned arrival."),
        plan("plan.duration", "s", DURATION, ALL, "Planned flight time."),
        plan("plan.tension", "N", ModelLimits, LOADS, "Highest mean tension of the planned cable over 20 ms."),
        plan("plan.slack", "m", DYNAMICS, LOADS, "Largest violation of the cable length by the planned motion, taut or slack."),
        plan("plan.swing", "deg", ModelLimits, LOADS, "Planned cable angle closest to or furthest beyond its limits."),
        plan("plan.gates", "m", Gates, LOADS, "Smallest depth inside the windows of a gate, over continuous time."),
        flight("flight.finite", "numbers", None, ALL, "Number of values in the flight log that are not finite."),
        flight("flight.complete", "vehicles", None, ALL, "Number of vehicles whose log is missing, has gaps, or follows another plan."),
        flight("flight.crash", "crashes", Obstacles, ALL, "Number of contacts with obstacles, the ground or other vehicles."),
        flight("flight.conditions", "vehicles", None, ALL, "Number of vehicles whose logged wind and noise are not those of the scenario."),
        flight("flight.planner", "failures", None, MULTIROTORS, "Number of requests to an in-loop planner without a usable reply, and of references that jump or are flown to an end in motion."),
        flight("flight.separation", "m", SEPARATION, ALL, "Smallest distance between two vehicles in flight, over continuous time."),
        flight("flight.clearance", "m", Obstacles, ALL, "Smallest distance to an obstacle in flight, over continuous time."),
        flight("flight.envelope", "m", ENVELOPE, LOADS, "Smallest distance of the envelope circle to an obstacle in flight."),
        flight("flight.rotor_clearance", "m", None, LOADS, "Smallest distance of load and cable from the vehicle's own body and rotors in flight."),
        flight("flight.state_limits", "-", ModelLimits, ALL, "Flown state closest to or furthest beyond its physical limits."),
        flight("flight.control_limits", "-", ModelLimits, ALL, "Applied control closest to or furthest beyond its physical limits."),
        flight("flight.dynamics", "m", None, ALL, "Largest distance between the logged motion and its reintegration from the logged controls and wind."),
        flight("flight.goal", "m", Goal, ALL, "Distance from the goal on arrival; of fixed wings heading, flight-path angle and speed too, the worst in its own unit."),
        flight("flight.rest", "m/s", REST, HOVERING, "Speed relative to the goal on arrival."),
        flight("flight.arrival", "s", ARRIVAL, ALL, "Time between the first and the last flown arrival."),
        flight("flight.duration", "s", DURATION, ALL, "Time until the last vehicle has arrived."),
        flight("flight.tracking_rms", "m", TRACKING_RMS, ALL, "Root mean square of the tracking error, of the worst vehicle."),
        flight("flight.tracking_max", "m", TRACKING_MAX, ALL, "Largest tracking error."),
        flight("flight.saturation", "-", SATURATION, ALL, "Fraction of the time steps with a saturated command, of the worst vehicle."),
        flight("flight.tension", "N", ModelLimits, LOADS_NAMED, "Highest mean tension of the flown cable over 20 ms."),
        flight("flight.slack", "s", SWITCHES, LOADS_NAMED, "Largest time difference between planned and flown switches of the cable."),
        flight("flight.swing", "deg", ModelLimits, LOADS_NAMED, "Flown cable angle closest to or furthest beyond its limits."),
        flight("flight.gates", "m", Gates, LOADS, "Smallest depth inside the windows of a gate in flight."),
    ]
};

/// What the checks of all requirements have in common; the name, the unit and the description are those of the requirement.
pub const REQUIREMENT_CHECKS: [CheckSpec; 2] = {
    const DESCRIPTION: &str = "Robustness of a requirement of the scenario, in the unit of the signal that decides.";
    [
        plan("plan.requirement", "-", LimitField::Requirement, ALL, DESCRIPTION),
        flight("flight.requirement", "-", LimitField::Requirement, ALL, DESCRIPTION),
    ]
};

/// The check with the full name `name`. For `plan.requirement.NAME` and `flight.requirement.NAME`, what the checks of all
/// requirements have in common.
pub fn check_spec(name: &str) -> Option<&'static CheckSpec> {
    let is_of = |check: &&CheckSpec| name.strip_prefix(check.name).is_some_and(|rest| rest.starts_with('.'));
    CHECKS.iter().find(|check| check.name == name).or_else(|| REQUIREMENT_CHECKS.iter().find(is_of))
}

/// The checks that apply to a family, in the order of a verdict.
pub fn checks_of(family: Family) -> impl Iterator<Item = &'static CheckSpec> {
    CHECKS.iter().filter(move |check| check.families.contains(&family))
}

/// The names of the checks that apply to a family, in the order of a verdict.
pub fn check_names(family: Family) -> impl Iterator<Item = &'static str> {
    checks_of(family).map(|check| check.name)
}

/// Checks of whether there is a plan, a flight and a log that can be believed at all.
const ALWAYS_DECISIVE: [&str; 5] = ["finite", "complete", "crash", "conditions", "dynamics"];

impl CheckSpec {
    /// Whether a scenario may list it as advisory. A crash, a log that is incomplete or not finite, and motion that violates
    /// the equations of motion always decide.
    pub fn may_be_advisory(&self) -> bool {
        !ALWAYS_DECISIVE.contains(&self.quantity())
    }

    /// The name without the group: `separation` of `flight.separation`.
    pub fn quantity(&self) -> &'static str {
        self.name.split_once('.').map_or(self.name, |(_, quantity)| quantity)
    }
}

impl fmt::Display for Group {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        f.write_str(match self {
            Self::Nodes => "nodes",
            Self::Plan => "plan",
            Self::Flight => "flight",
        })
    }
}

#[cfg(test)]
mod tests {
    use std::collections::BTreeSet;

    use super::{CHECKS, check_spec};

    #[test]
    fn names_are_unique_and_begin_with_their_group() {
        let names: BTreeSet<&str> = CHECKS.iter().map(|check| check.name).collect();
        assert_eq!(names.len(), CHECKS.len());
        for check in CHECKS {
            assert_eq!(check.name, format!("{}.{}", check.group, check.quantity()));
            assert_eq!(check_spec(check.name), Some(check));
        }
    }
}
