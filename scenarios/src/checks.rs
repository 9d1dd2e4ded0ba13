//! Every check that a verdict may hold, declared once: its name, its unit, where its limit stands, whom it is put to.

use std::fmt;

use crate::Family::{self, FixedWing, Multirotor, SlungLoad};

/// What a check looks at.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Group {
    /// The plan at the planner's own nodes: what its constraints saw.
    Nodes,
    /// The plan as a continuous motion between the nodes.
    Plan,
    /// What the simulated vehicles did.
    Flight,
}

/// Where the limit of a check stands in a scenario file.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum LimitField {
    /// In one of these fields; the first that the file has.
    Fields(&'static [&'static str]),
    /// In the obstacles concerned.
    Obstacles,
    /// In the limits of the vehicle's model (the planning limits for `nodes.*`), or in the map.
    ModelLimits,
    /// In the vehicle's goal, or in the tolerance `verdict.goal_m`.
    Goal,
    /// In the gate concerned.
    Gates,
    /// Nowhere: the limit belongs to the harness.
    None,
}

/// The declaration of a check.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct CheckSpec {
    /// What it looks at.
    pub group: Group,
    /// Its full name, group included: `flight.separation`.
    pub name: &'static str,
    /// Unit of value, limit and margin. Checks of several quantities (`-`) report the unit of the decisive one.
    pub unit: &'static str,
    /// Where its limit stands.
    pub limit: LimitField,
    /// The families to whose vehicles it is put.
    pub families: &'static [Family],
    /// What it measures, in one sentence.
    pub description: &'static str,
}

const ALL: &[Family] = &Family::ALL;
const HOVERING: &[Family] = &[SlungLoad, Multirotor];
const LOADS: &[Family] = &[SlungLoad];
/// Skipped for fixed wings with the reason, so that a reader of their reports learns that it exists.
const LOADS_NAMED: &[Family] = &[FixedWing, SlungLoad];

const SEPARATION: LimitField = LimitField::Fields(&["fleet.separation_m"]);
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

/// Every check, in the order in which a verdict lists them.
#[rustfmt::skip]
pub const CHECKS: &[CheckSpec] = {
    use LimitField::{Gates, Goal, ModelLimits, None, Obstacles};
    &[
        nodes("nodes.separation", "m", SEPARATION, ALL, "Smallest distance between two vehicles at the planner's nodes."),
        nodes("nodes.clearance", "m", Obstacles, ALL, "Smallest distance to an obstacle at the planner's nodes."),
        nodes("nodes.envelope", "m", ENVELOPE, LOADS, "Smallest distance of the envelope circle to an obstacle at the planner's nodes."),
        nodes("nodes.state_limits", "-", ModelLimits, ALL, "The state that uses most of its planning limits at the nodes."),
        nodes("nodes.control_limits", "-", ModelLimits, ALL, "The control that uses most of its planning limits at the nodes."),
        nodes("nodes.goal", "m", Goal, ALL, "Distance of the last node from the goal."),
        nodes("nodes.gates", "m", Gates, LOADS, "Depth inside the windows of the gate that is passed least deeply, at the nodes."),
        plan("plan.finite", "numbers", None, ALL, "Number of values in the plan that are not finite."),
        plan("plan.complete", "vehicles", None, ALL, "Number of vehicles whose trajectory is missing, malformed, or does not begin at the start."),
        plan("plan.separation", "m", SEPARATION, ALL, "Smallest distance between two vehicles over continuous time."),
        plan("plan.clearance", "m", Obstacles, ALL, "Smallest distance to an obstacle over continuous time."),
        plan("plan.envelope", "m", ENVELOPE, LOADS, "Smallest distance of the envelope circle to an obstacle over continuous time."),
        plan("plan.state_limits", "-", ModelLimits, ALL, "The state that uses most of its physical limits between the nodes."),
        plan("plan.control_limits", "-", ModelLimits, ALL, "The control that uses most of its physical limits between the nodes."),
        plan("plan.dynamics", "m", DYNAMICS, ALL, "Largest distance between a node and where the controls lead from the node before it."),
        plan("plan.rollout", "m", ROLLOUT, ALL, "Distance from the plan's end when its controls are flown from the start, open loop."),
        plan("plan.goal", "m", Goal, ALL, "Distance of the planned motion's end from the goal."),
        plan("plan.rest", "m/s", REST, HOVERING, "Speed relative to the goal at the plan's end."),
        plan("plan.arrival", "s", ARRIVAL, ALL, "Time between the first and the last planned arrival."),
        plan("plan.duration", "s", DURATION, ALL, "Planned flight time."),
        plan("plan.tension", "N", ModelLimits, LOADS, "Highest mean tension of the planned cable over 20 ms."),
        plan("plan.slack", "m", DYNAMICS, LOADS, "Largest difference between the cable's length and its planned state, taut or slack."),
        plan("plan.swing", "deg", ModelLimits, LOADS, "The planned cable angle that uses most of its limits."),
        plan("plan.gates", "m", Gates, LOADS, "Depth inside the windows of the gate that is passed least deeply, over continuous time."),
        flight("flight.finite", "numbers", None, ALL, "Number of values in the flight log that are not finite."),
        flight("flight.complete", "vehicles", None, ALL, "Number of vehicles whose log is missing, has gaps, or follows another plan."),
        flight("flight.crash", "crashes", Obstacles, ALL, "Number of contacts with obstacles, the ground or other vehicles."),
        flight("flight.conditions", "vehicles", None, ALL, "Number of vehicles whose logged air and noise are not the scenario's."),
        flight("flight.separation", "m", SEPARATION, ALL, "Smallest distance between two vehicles in flight, over continuous time."),
        flight("flight.clearance", "m", Obstacles, ALL, "Smallest distance to an obstacle in flight, over continuous time."),
        flight("flight.envelope", "m", ENVELOPE, LOADS, "Smallest distance of the envelope circle to an obstacle in flight."),
        flight("flight.state_limits", "-", ModelLimits, ALL, "The flown state that uses most of its physical limits."),
        flight("flight.control_limits", "-", ModelLimits, ALL, "The applied control that uses most of its physical limits."),
        flight("flight.dynamics", "m", None, ALL, "Largest distance between the log and what a second integrator makes of its controls and air."),
        flight("flight.goal", "m", Goal, ALL, "Distance from the goal on arrival."),
        flight("flight.rest", "m/s", REST, HOVERING, "Speed relative to the goal on arrival."),
        flight("flight.arrival", "s", ARRIVAL, ALL, "Time between the first and the last flown arrival."),
        flight("flight.duration", "s", DURATION, ALL, "Time until the last vehicle has arrived."),
        flight("flight.tracking_rms", "m", TRACKING_RMS, ALL, "Root mean square of the distance from the plan, of the worst vehicle."),
        flight("flight.tracking_max", "m", TRACKING_MAX, ALL, "Largest distance from the plan."),
        flight("flight.saturation", "-", SATURATION, ALL, "Fraction of the steps in which the command was cut off at a limit, of the worst vehicle."),
        flight("flight.tension", "N", ModelLimits, LOADS_NAMED, "Highest mean tension of the flown cable over 20 ms."),
        flight("flight.slack", "s", SWITCHES, LOADS_NAMED, "Largest difference between planned and flown switches of the cable."),
        flight("flight.swing", "deg", ModelLimits, LOADS_NAMED, "The flown cable angle that uses most of its limits."),
        flight("flight.gates", "m", Gates, LOADS, "Depth inside the windows of the gate that is passed least deeply in flight."),
    ]
};

/// The declaration of the check of this full name.
pub fn check_spec(name: &str) -> Option<&'static CheckSpec> {
    CHECKS.iter().find(|check| check.name == name)
}

/// The checks of a verdict on vehicles of this family, in its order.
pub fn checks_of(family: Family) -> impl Iterator<Item = &'static CheckSpec> {
    CHECKS.iter().filter(move |check| check.families.contains(&family))
}

/// The names of [`checks_of`] a family.
pub fn check_names(family: Family) -> impl Iterator<Item = &'static str> {
    checks_of(family).map(|check| check.name)
}

impl CheckSpec {
    /// The name without its group: `separation` of `flight.separation`.
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
