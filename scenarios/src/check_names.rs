/// Every check that a verdict may hold, by its full name, in the order in which a verdict lists them.
///
/// - `nodes.*`: what the planner's own constraints saw, at its own nodes;
/// - `plan.*`: the plan as a continuous motion between the nodes;
/// - `flight.*`: what the simulated vehicle did.
pub const CHECK_NAMES: &[&str] = &[
    "nodes.separation",
    "nodes.clearance",
    "nodes.state_limits",
    "nodes.control_limits",
    "nodes.goal",
    "plan.finite",
    "plan.complete",
    "plan.separation",
    "plan.clearance",
    "plan.state_limits",
    "plan.control_limits",
    "plan.dynamics",
    "plan.rollout",
    "plan.goal",
    "plan.arrival",
    "plan.duration",
    "flight.finite",
    "flight.complete",
    "flight.crash",
    "flight.separation",
    "flight.clearance",
    "flight.state_limits",
    "flight.control_limits",
    "flight.goal",
    "flight.arrival",
    "flight.duration",
    "flight.tracking_rms",
    "flight.tracking_max",
    "flight.saturation",
    "flight.tension",
    "flight.slack",
    "flight.swing",
];
