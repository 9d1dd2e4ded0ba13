//! Clearance of body, cable and load, and of the envelope circle.

use scenarios::CheckSpec;
use scenarios::slung_load::Trajectory;
use sim::slung_load::{GROUND, Part};

use super::closest::ClosestApproach;
use super::motion::SlungLoadMotion;
use super::shape_pairs::{Shape, ShapePairs};
use crate::verdict::Check;
use crate::verdict::evidence::{CheckResult, Decide, Evidence, Measurement};
use crate::verdict::missing_evidence::MissingEvidence;

impl ShapePairs<'_> {
    /// SlungLoadState, cable and load against every obstacle, and the body against the ground. The limit is 0.
    pub fn check(&self, spec: &CheckSpec, motion: Evidence<'_, SlungLoadMotion>) -> CheckResult {
        self.check_pairs(spec, &self.parts(), 0.0, |shapes| Ok(self.closest(motion?, shapes)))
    }

    /// The same at the planner's nodes.
    pub fn check_nodes(&self, spec: &CheckSpec, trajectory: Evidence<'_, Trajectory>) -> CheckResult {
        self.check_pairs(spec, &self.parts(), 0.0, |shapes| Ok(self.closest_node(trajectory?, shapes)))
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
            Shape::Envelope(obstacle) => ("envelope", self.obstacles[obstacle].name.as_str()),
            Shape::AboveGround => (Part::Body.name(), GROUND),
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
