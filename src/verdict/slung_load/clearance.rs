//! Do body, cable and load keep clear of the obstacles, and does the envelope?

use scenarios::slung_load::Trajectory;
use sim::slung_load::{GROUND, Part};

use super::closest::ClosestApproach;
use super::motion::SlungLoadMotion;
use super::shape_pairs::{Shape, ShapePairs};
use crate::verdict::Check;
use crate::verdict::evidence::{Decide, Evidence, Measurement};
use scenarios::CheckSpec;

impl ShapePairs<'_> {
    /// Body, cable and load against every obstacle, the body against the ground as well; the limit is 0.
    pub fn check(&self, spec: &CheckSpec, motion: Evidence<'_, SlungLoadMotion>) -> Check {
        let shapes = self.parts();
        self.answer(spec, &shapes, motion.map(|motion| self.closest(motion, &shapes)), 0.0)
    }

    /// The same at the planner's own nodes.
    pub fn check_nodes(&self, spec: &CheckSpec, trajectory: Evidence<'_, Trajectory>) -> Check {
        let shapes = self.parts();
        let closest = trajectory.map(|trajectory| self.closest_node(trajectory, &shapes));
        self.answer(spec, &shapes, closest, 0.0)
    }

    /// The envelope circle against every obstacle, if the scenario asks for it.
    pub fn check_envelope(
        &self,
        spec: &CheckSpec,
        motion: Evidence<'_, SlungLoadMotion>,
        limit_m: Option<f64>,
    ) -> Check {
        let shapes = self.envelopes();
        let closest = motion.map(|motion| self.closest(motion, &shapes));
        limit_m.map_or_else(|| no_envelope(spec), |limit_m| self.answer(spec, &shapes, closest, limit_m))
    }

    /// The same at the planner's own nodes.
    pub fn check_envelope_nodes(
        &self,
        spec: &CheckSpec,
        trajectory: Evidence<'_, Trajectory>,
        limit_m: Option<f64>,
    ) -> Check {
        let shapes = self.envelopes();
        let closest = trajectory.map(|trajectory| self.closest_node(trajectory, &shapes));
        limit_m.map_or_else(|| no_envelope(spec), |limit_m| self.answer(spec, &shapes, closest, limit_m))
    }

    fn answer(
        &self,
        spec: &CheckSpec,
        shapes: &[Shape],
        closest: Result<Option<ClosestApproach>, &str>,
        limit_m: f64,
    ) -> Check {
        if shapes.is_empty() {
            return spec.skip("there are no obstacles");
        }
        match closest {
            Err(reason) => spec.fail(reason),
            Ok(None) => spec.fail("there was no time at which the vehicle could be compared with an obstacle"),
            Ok(Some(closest)) => {
                let (what, with) = match closest.shape {
                    Shape::Part(part, obstacle) => (part.name(), self.obstacles[obstacle].name.as_str()),
                    Shape::Envelope(obstacle) => ("envelope", self.obstacles[obstacle].name.as_str()),
                    Shape::AboveGround => (Part::Body.name(), GROUND),
                };
                let upper_m = closest.upper_m + 2.0 * closest.deviation_m;
                let measured = Measurement::bounds(closest.lower_m, upper_m).at(closest.at_s);
                let measured = measured.with(self.vehicle).with(with).with_reason(format!("it is the {what}"));
                spec.at_least(measured, limit_m)
            }
        }
    }
}

fn no_envelope(spec: &CheckSpec) -> Check {
    spec.skip("the scenario asks for the true shapes only")
}
