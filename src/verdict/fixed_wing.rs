//! The judge of fixed-wing fleets.

mod clearance;
mod dynamics;
mod limits;
mod physics;
mod planned;

use scenarios::{CheckSpec, Family};

pub use clearance::at_nodes as clearance_at_nodes;
pub use planned::PlannedMotions;

use crate::verdict::case::Case;
use crate::verdict::evidence::{Decide, Evidence};
use crate::verdict::{Check, arrival, separation};

/// Every check of a fixed-wing fleet.
pub fn checks(case: &Case<'_>) -> Vec<Check> {
    let planned = case.flyable().map_err(str::to_owned).and_then(|plan| PlannedMotions::new(case.scenario, plan));
    let planned = planned.as_ref().map_err(String::as_str);
    case.checks(Family::FixedWing, |spec| check(spec, case, planned))
}

fn check(spec: &CheckSpec, case: &Case<'_>, planned: Evidence<'_, PlannedMotions>) -> Check {
    let (scenario, plan, flyable, flown) = (case.scenario, case.plan, case.flyable(), case.flown());
    let planned_motions = planned.map(|planned| planned.motions.as_slice());
    let flown_motions = flown.map(|flown| flown.motions.as_slice());
    match spec.name {
        "nodes.separation" => separation::check_nodes(spec, scenario, flyable),
        "nodes.clearance" => clearance::check_nodes(spec, scenario, flyable),
        "nodes.state_limits" => limits::check_node_states(spec, scenario, flyable),
        "nodes.control_limits" => limits::check_planned_controls(spec, scenario, flyable),
        "nodes.goal" => arrival::check_node_goals(spec, scenario, flyable),
        "plan.separation" => separation::check(spec, scenario, planned_motions),
        "plan.clearance" => clearance::check(spec, scenario, planned_motions),
        "plan.state_limits" => limits::check_planned_states(spec, scenario, planned_motions),
        "plan.control_limits" => limits::check_planned_controls(spec, scenario, flyable),
        "plan.dynamics" => dynamics::check_defects(spec, scenario, plan, planned),
        "plan.rollout" => dynamics::check_rollout(spec, scenario, plan, planned),
        "plan.goal" => arrival::check_planned_goals(spec, scenario, planned_motions),
        "flight.crash" => case.crash(spec, flown),
        "flight.separation" => separation::check(spec, scenario, flown_motions),
        "flight.clearance" => clearance::check(spec, scenario, flown_motions),
        "flight.state_limits" => limits::check_flown_states(spec, scenario, flown),
        "flight.control_limits" => limits::check_flown_controls(spec, scenario, flown),
        "flight.dynamics" => physics::check(spec, scenario, case.flight()),
        "flight.goal" => arrival::check_flown_goals(spec, scenario, flown),
        "flight.tension" | "flight.slack" | "flight.swing" => spec.skip("no vehicle carries a load"),
        _ => case.shared(spec),
    }
}
