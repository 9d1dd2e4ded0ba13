//! The judge of fixed-wing fleets.

mod between_rows;
mod clearance;
mod coast;
mod dynamics;
mod limits;
mod physics;
mod planned;
mod recorded;
mod reference;

use std::ops::Deref;
use std::sync::OnceLock;

use scenarios::{CheckSpec, Family, Trajectory, Vehicle};

pub use between_rows::max_acceleration_mps2;
pub use clearance::{at_instant as clearance_at, at_nodes as clearance_at_nodes, closest as closest_obstacle};
pub use planned::PlannedMotions;
pub use recorded::checks as recorded_checks;

use between_rows::RowTube;

use crate::verdict::case::{Case, CheckTable, function_of};
use crate::verdict::evidence::{CheckResult, Decide, Evidence};
use crate::verdict::missing_evidence::MissingEvidence;
use crate::verdict::motion::{Knot, Motion};
use crate::verdict::tube::EndError;
use crate::verdict::{Check, collision, end, flight_integrity, goal, requirements, separation};

/// Every check of a fixed-wing fleet, in the order of a verdict.
pub fn checks(case: &Case<'_>) -> Vec<Check> {
    let fleet = FleetCase::new(case);
    let mut checks = case.checks(Family::FixedWing, |spec| Some(function_of(CHECKS, spec)?(spec, &fleet)));
    if !case.scenario.all_requirements().is_empty() {
        let (planned, flown) = (fleet.planned_mission(), fleet.flown_mission());
        requirements::insert(&mut checks, case, planned.as_ref().map(Vec::as_slice), flown.as_ref().map(Vec::as_slice));
    }
    checks
}

/// A fleet's plan and flight, with the plan as a continuous motion.
struct FleetCase<'a> {
    shared: &'a Case<'a>,
    planned: Result<PlannedMotions, MissingEvidence>,
    /// Per vehicle, what may lie between the rows of a reconstructed plan.
    tubes: Vec<RowTube>,
    /// The flown motions in their tubes; `None` if nothing was reconstructed.
    flown_in_tubes: Option<Vec<Motion>>,
    /// The motions after the first arrival, until the last, computed when they are first asked for.
    planned_coast: OnceLock<Vec<Motion>>,
    flown_coast: OnceLock<Result<Vec<Motion>, MissingEvidence>>,
}

const CHECKS: &CheckTable<fn(&CheckSpec, &FleetCase<'_>) -> CheckResult> = &[
    ("nodes.separation", |spec, it| separation::check_nodes(spec, it.scenario, it.flyable())),
    ("nodes.clearance", |spec, it| clearance::check_nodes(spec, it.scenario, it.flyable())),
    ("nodes.state_limits", |spec, it| limits::check_node_states(spec, it.scenario, it.flyable()?, it.provenance)),
    ("nodes.control_limits", |spec, it| limits::check_node_controls(spec, it.scenario, it.flyable()?, it.provenance)),
    ("nodes.goal", |spec, it| {
        goal::check_nodes(spec, it.scenario, it.flyable()?, |index, end| it.end_error(index, end))
    }),
    ("plan.separation", |spec, it| {
        separation::check_with_coast(spec, it.scenario, it.planned_motions(), |motions| Ok(it.planned_coast(motions)))
    }),
    ("plan.clearance", |spec, it| {
        clearance::check(spec, it.scenario, it.planned_motions(), |motions| Ok(it.planned_coast(motions)))
    }),
    ("plan.state_limits", |spec, it| {
        let motions = it.planned_motions()?;
        limits::check_planned_states(spec, it.scenario, motions, it.planned_coast(motions), &it.tubes)
    }),
    ("plan.control_limits", |spec, it| limits::check_planned_controls(spec, it.scenario, it.flyable()?)),
    ("plan.dynamics", |spec, it| dynamics::check_defects(spec, it.scenario, it.plan, it.planned()?, it.provenance)),
    ("plan.rollout", |spec, it| dynamics::check_rollout(spec, it.scenario, it.planned()?, it.provenance)),
    ("plan.goal", |spec, it| {
        goal::check_planned(spec, it.scenario, it.plan, it.planned_motions()?, |index, end| it.end_error(index, end))
    }),
    ("flight.complete", |spec, it| {
        Ok(flight_integrity::check_complete(spec, it.scenario, it.plan, it.flight()?, reference::defect))
    }),
    ("flight.crash", |spec, it| {
        let contact = || collision::deepest(it.scenario, it.shared.flown_motions().ok()?, clearance::entered_obstacle);
        Ok(flight_integrity::check_crash(spec, it.flight()?, it.mission_end_s(), contact))
    }),
    ("flight.separation", |spec, it| {
        separation::check_with_coast(spec, it.scenario, it.flown_motions(), |_| it.flown_coast())
    }),
    ("flight.clearance", |spec, it| clearance::check(spec, it.scenario, it.flown_motions(), |_| it.flown_coast())),
    ("flight.state_limits", |spec, it| {
        let motions = (it.flown_motions()?, it.flown_coast()?);
        limits::check_flown_states(spec, it.scenario, it.flown()?, motions, &it.tubes)
    }),
    ("flight.control_limits", |spec, it| limits::check_flown_controls(spec, it.scenario, it.flown()?)),
    ("flight.dynamics", |spec, it| physics::check(spec, it.scenario, it.flight()?)),
    ("flight.goal", |spec, it| goal::check_flown(spec, it.scenario, it.flown()?, |index| it.planned_end_error(index))),
    ("flight.tension", no_load),
    ("flight.slack", no_load),
    ("flight.swing", no_load),
];

impl<'a> FleetCase<'a> {
    fn new(shared: &'a Case<'a>) -> Self {
        let plan = shared.flyable().map_err(MissingEvidence::from);
        let planned = plan.and_then(|plan| PlannedMotions::new(shared.scenario, plan));
        let tubes = planned.as_ref().map_or_else(|_| Vec::new(), |planned| tubes(shared, planned));
        let flown = shared.flown_motions().ok().filter(|_| tubes.iter().any(|tube| tube.tube.has_width()));
        let flown_in_tubes = flown.map(|motions| surround(motions.to_vec(), &tubes));
        let planned = planned.map(|planned| PlannedMotions { motions: surround(planned.motions, &tubes), ..planned });
        let (planned_coast, flown_coast) = (OnceLock::new(), OnceLock::new());
        Self { shared, planned, tubes, flown_in_tubes, planned_coast, flown_coast }
    }

    /// The planned motions after the first arrival, until the last.
    fn planned_coast(&self, planned: &[Motion]) -> &[Motion] {
        self.planned_coast.get_or_init(|| coast::planned(planned, |index| self.planned_end_error(index)))
    }

    /// The flown motions after the first arrival, until the last.
    fn flown_coast(&self) -> Evidence<'_, [Motion]> {
        let compute =
            || coast::flown(self.shared.flight()?, self.shared.flown()?, |index, motion| self.in_tube(index, motion));
        self.flown_coast.get_or_init(compute).as_ref().map(Vec::as_slice)
    }

    /// The planned motions until the last arrival, those that arrive earlier flying on.
    fn planned_mission(&self) -> Result<Vec<Motion>, MissingEvidence> {
        let motions = self.planned_motions()?;
        Ok(coast::planned_mission(motions, |index| self.planned_end_error(index)))
    }

    /// The flown motions until the last arrival, those that arrived earlier flying on.
    fn flown_mission(&self) -> Result<Vec<Motion>, MissingEvidence> {
        coast::flown_mission(self.shared.flight()?, self.shared.flown()?, |index, motion| self.in_tube(index, motion))
    }

    /// The end of a flown motion in the tube in which it would have been flown: beyond the plan's end, the error of the last
    /// velocity accumulates.
    fn in_tube(&self, index: usize, motion: Motion) -> Motion {
        let Some(tube) = self.tubes.get(index).map(|tube| &tube.tube).filter(|tube| tube.has_width()) else {
            return motion;
        };
        let planned_end_s = self.planned_motions().map_or(f64::INFINITY, |motions| motions[index].end_s());
        let drift_mps = self.planned_end_error(index).velocity_mps;
        motion.within(|segment| tube.distance_m(segment.t_s) + drift_mps * (segment.t_s[1] - planned_end_s).max(0.0))
    }

    fn planned(&self) -> Evidence<'_, PlannedMotions> {
        self.planned.as_ref()
    }

    fn planned_motions(&self) -> Evidence<'_, [Motion]> {
        self.planned().map(|planned| planned.motions.as_slice())
    }

    /// How far the true arrival of a vehicle's plan may be from this one.
    fn end_error(&self, vehicle: usize, end: &Knot) -> EndError {
        self.tubes.get(vehicle).map_or_else(EndError::default, |tube| tube.end_error(end))
    }

    /// How far the true arrival of a vehicle's plan may be from the one that was flown.
    fn planned_end_error(&self, vehicle: usize) -> EndError {
        let (scenario, trajectory) = (self.scenario, &self.plan.trajectories[vehicle]);
        let arrival = |motions: &'_ [Motion]| {
            end::arrival_knot(scenario, &scenario.vehicles[vehicle], trajectory, &motions[vehicle]).copied()
        };
        let end = self.planned_motions().ok().and_then(arrival);
        end.map_or_else(EndError::default, |end| self.end_error(vehicle, &end))
    }

    /// The flown motions. If the plan was reconstructed, the vehicle would have flown what lies in the tube around it.
    fn flown_motions(&self) -> Evidence<'_, [Motion]> {
        self.flown_in_tubes.as_deref().map_or_else(|| self.shared.flown_motions(), Ok)
    }
}

fn tubes(case: &Case<'_>, planned: &PlannedMotions) -> Vec<RowTube> {
    let vehicles = case.scenario.vehicles.iter().zip(&case.plan.trajectories).zip(&planned.motions);
    let tube = |(index, ((vehicle, trajectory), motion)): (usize, ((&Vehicle, &Trajectory), &Motion))| {
        let limits = &case.scenario.fixed_wing_model(vehicle).limits;
        let (given, end_velocity) = (case.provenance.given(index), case.provenance.end_velocity(index));
        let arrival = end::arrival_node(case.scenario, vehicle, trajectory).unwrap_or(0);
        RowTube::around(motion, trajectory.fixed_wing(), given, end_velocity, arrival, limits)
            .widened(case.provenance.rounding_m(index))
    };
    vehicles.enumerate().map(tube).collect()
}

fn surround(motions: Vec<Motion>, tubes: &[RowTube]) -> Vec<Motion> {
    motions.into_iter().zip(tubes).map(|(motion, tube)| tube.tube.surround(motion)).collect()
}

impl<'a> Deref for FleetCase<'a> {
    type Target = Case<'a>;

    fn deref(&self) -> &Case<'a> {
        self.shared
    }
}

fn no_load(spec: &CheckSpec, _: &FleetCase<'_>) -> CheckResult {
    Ok(spec.skip("no vehicle carries a load"))
}

#[cfg(test)]
mod tests {
    use scenarios::Family;

    use super::CHECKS;
    use crate::verdict::case::tests::assert_complete;

    #[test]
    fn every_check_has_one_function() {
        assert_complete(Family::FixedWing, CHECKS);
    }
}
