use crate::Family;

/// Every check that a verdict may hold, by its full name, in the order in which a verdict lists them.
///
/// - `nodes.*`: what the planner's own constraints saw, at its own nodes;
/// - `plan.*`: the plan as a continuous motion between the nodes;
/// - `flight.*`: what the simulated vehicle did.
pub const CHECK_NAMES: &[&str] = &[
    "nodes.separation",
    "nodes.clearance",
    "nodes.envelope",
    "nodes.state_limits",
    "nodes.control_limits",
    "nodes.goal",
    "nodes.gates",
    "plan.finite",
    "plan.complete",
    "plan.separation",
    "plan.clearance",
    "plan.envelope",
    "plan.state_limits",
    "plan.control_limits",
    "plan.dynamics",
    "plan.rollout",
    "plan.goal",
    "plan.rest",
    "plan.arrival",
    "plan.duration",
    "plan.tension",
    "plan.slack",
    "plan.swing",
    "plan.gates",
    "flight.finite",
    "flight.complete",
    "flight.crash",
    "flight.conditions",
    "flight.separation",
    "flight.clearance",
    "flight.envelope",
    "flight.state_limits",
    "flight.control_limits",
    "flight.dynamics",
    "flight.goal",
    "flight.rest",
    "flight.arrival",
    "flight.duration",
    "flight.tracking_rms",
    "flight.tracking_max",
    "flight.saturation",
    "flight.tension",
    "flight.slack",
    "flight.swing",
    "flight.gates",
];

/// Checks that are put to vehicles alone that come to rest.
const OF_HOVERING: [&str; 2] = ["plan.rest", "flight.rest"];

/// Checks that are put to slung loads alone.
const OF_SLUNG_LOADS: [&str; 9] = [
    "nodes.envelope",
    "nodes.gates",
    "plan.envelope",
    "plan.tension",
    "plan.slack",
    "plan.swing",
    "plan.gates",
    "flight.envelope",
    "flight.gates",
];

/// Checks of loads, which of fixed wings are skipped.
const OF_LOADS: [&str; 3] = ["flight.tension", "flight.slack", "flight.swing"];

/// The checks of a verdict on vehicles of this family, in its order.
pub fn check_names(family: Family) -> impl Iterator<Item = &'static str> {
    let is_put = move |name: &&str| match family {
        Family::FixedWing => !OF_SLUNG_LOADS.contains(name) && !OF_HOVERING.contains(name),
        Family::SlungLoad => true,
        Family::Multirotor => !OF_SLUNG_LOADS.contains(name) && !OF_LOADS.contains(name),
    };
    CHECK_NAMES.iter().copied().filter(is_put)
}
