//! Clearance of body, cable and load from obstacles, of the envelope circle, and of load and cable from the vehicle's own body
//! and rotors.

use scenarios::CheckSpec;
use scenarios::slung_load::Trajectory;
use sim::GROUND;
use sim::slung_load::Part;

use super::closest::ClosestApproach;
use super::motion::SlungLoadMotion;
use super::shape_pairs::{Shape, ShapePairs};
use crate::verdict::Check;
use crate::verdict::compare::{exceeds, is_smaller};
use crate::verdict::evidence::{CheckResult, Decide, Evidence, Measurement};
use crate::verdict::missing_evidence::MissingEvidence;

/// A load that lies on the ground may be this deep in it: the contact of the simulator is not rigid, m.
const RESTING_TOLERANCE_M: f64 = 1e-3;
/// Name of the vehicle's own body in reports.
const OWN_BODY: &str = "own body";
/// Name of its rotors.
const OWN_ROTORS: &str = "own rotors";

impl ShapePairs<'_> {
    /// Body, cable and load against every obstacle, and the body against the ground, in which the load must not be either. The
    /// limit is 0.
    pub fn check(&self, spec: &CheckSpec, motion: Evidence<'_, SlungLoadMotion>) -> CheckResult {
        let lowest = motion.ok().and_then(SlungLoadMotion::lowest_load_m);
        let check = self.check_pairs(spec, &self.parts(), 0.0, |shapes| Ok(self.closest(motion?, shapes)))?;
        Ok(lowest.and_then(|lowest| self.load_in_ground(spec, lowest)).unwrap_or(check))
    }

    /// The same at the planner's nodes.
    pub fn check_nodes(&self, spec: &CheckSpec, trajectory: Evidence<'_, Trajectory>) -> CheckResult {
        let check = self.check_pairs(spec, &self.parts(), 0.0, |shapes| Ok(self.closest_node(trajectory?, shapes)))?;
        let height = |it: &Trajectory, node: usize| (it.states[node].load_position_m[2], it.times_s[node]);
        let heights = trajectory.iter().flat_map(|it| it.planner_nodes().into_iter().map(|node| height(it, node)));
        let lowest = heights.reduce(|lowest, next| if is_smaller(next.0, lowest.0) { next } else { lowest });
        Ok(lowest.and_then(|lowest| self.load_in_ground(spec, lowest)).unwrap_or(check))
    }

    /// The failed check of a load in the ground. It may lie on it, so that its height above the ground is no clearance.
    ///
    /// - `lowest`: smallest altitude of the load's centre, m, and its time, s
    fn load_in_ground(&self, spec: &CheckSpec, (altitude_m, at_s): (f64, f64)) -> Option<Check> {
        let height_m = altitude_m - self.parts.load_radius_m() - self.ground_m?;
        exceeds(-RESTING_TOLERANCE_M, height_m).then(|| {
            let measured = Measurement::value(height_m).at(at_s).with(self.vehicle).with(GROUND);
            spec.at_least(measured.with_reason(format!("it is the {}", Part::Load.name())), 0.0)
        })
    }

    /// The envelope circle against every obstacle.
    ///
    /// - `limit_m`: `None` if the scenario has no envelope
    pub fn check_envelope(
        &self,
        spec: &CheckSpec,
        motion: Evidence<'_, SlungLoadMotion>,
        limit_m: Option<f64>,
    ) -> CheckResult {
        let Some(limit_m) = limit_m else { return Ok(no_envelope(spec)) };
        self.check_pairs(spec, &self.envelopes(), limit_m, |shapes| Ok(self.closest(motion?, shapes)))
    }

    /// The same at the planner's nodes.
    pub fn check_envelope_nodes(
        &self,
        spec: &CheckSpec,
        trajectory: Evidence<'_, Trajectory>,
        limit_m: Option<f64>,
    ) -> CheckResult {
        let Some(limit_m) = limit_m else { return Ok(no_envelope(spec)) };
        self.check_pairs(spec, &self.envelopes(), limit_m, |shapes| Ok(self.closest_node(trajectory?, shapes)))
    }

    /// Load and cable against the vehicle's own body and rotors. The limit is 0.
    pub fn check_own(&self, spec: &CheckSpec, motion: Evidence<'_, SlungLoadMotion>) -> CheckResult {
        self.check_pairs(spec, &Self::own(), 0.0, |shapes| Ok(self.closest(motion?, shapes)))
    }

    /// The same at the planner's nodes.
    pub fn check_own_nodes(&self, spec: &CheckSpec, trajectory: Evidence<'_, Trajectory>) -> CheckResult {
        self.check_pairs(spec, &Self::own(), 0.0, |shapes| Ok(self.closest_node(trajectory?, shapes)))
    }

    fn check_pairs(
        &self,
        spec: &CheckSpec,
        shapes: &[Shape],
        limit_m: f64,
        closest: impl FnOnce(&[Shape]) -> Result<Option<ClosestApproach>, MissingEvidence>,
    ) -> CheckResult {
        if shapes.is_empty() {
            return Ok(spec.skip("there are no obstacles"));
        }
        let closest = closest(shapes)?.ok_or(MissingEvidence::NoApproach)?;
        let (part, obstacle) = match closest.shape {
            Shape::Part(part, obstacle) => (part.name(), self.obstacles[obstacle].name.as_str()),
            Shape::Solid(part, solid) => (part.name(), self.solids[solid].name()),
            Shape::Envelope(obstacle) => ("envelope", self.obstacles[obstacle].name.as_str()),
            Shape::AboveGround => (Part::Body.name(), GROUND),
            Shape::LoadToBody => (Part::Load.name(), OWN_BODY),
            Shape::CableToRotor(_) => (Part::Cable.name(), OWN_ROTORS),
        };
        let upper_m = closest.upper_m + 2.0 * closest.deviation_m;
        let measured = Measurement::bounds(closest.lower_m, upper_m).at(closest.at_s);
        let measured = measured.with(self.vehicle).with(obstacle).with_reason(format!("it is the {part}"));
        Ok(spec.at_least(measured, limit_m))
    }
}

fn no_envelope(spec: &CheckSpec) -> Check {
    spec.skip("the scenario has no envelope")
}
